// Runs while Lacquer is built: writes the models of the library's own texts to standard output, as a C++ file
// with the bytes of each profile's, or with --default of the default one's.
#include <cstdio>
#include <string>
#include <string_view>

#include "model/bytes.h"
#include "support/diagnostic.h"

using namespace lacquer;

namespace {

int fail(const Diagnostics& wrong) {
  for (const Diagnostic& one : wrong) std::fputs(format(one).c_str(), stderr);
  return 1;
}

void print(const std::string& bytes) {
  for (size_t i = 0; i < bytes.size(); ++i)
    std::printf("%u,%s", static_cast<unsigned>(static_cast<unsigned char>(bytes[i])),
                i % 32 == 31 ? "\n" : "");
}

}  // namespace

int main(int argc, char** argv) {
  const bool default_alone = argc > 1 && std::string_view(argv[1]) == "--default";
  const lang::Library library = lang::Library::embedded();
  const auto profiles = model::profiles(library);
  if (!profiles) return fail(profiles.error());
  const Result<material::Schema> schema = material::schemaOf(library);
  if (!schema) return fail(schema.error());
  std::printf(
      "// Made by src/material/prepare/prepare.cpp.\n#include \"setting/prepared.h\"\n\n#include "
      "\"model/bytes.h\"\n\nnamespace lacquer "
      "{\n");
  std::string rows;
  for (const lang::ProfileDecl* profile : *profiles) {
    const Result<model::Model> model = model::compile(library, *schema, profile->name);
    if (!model) return fail(model.error());
    const std::string name(profile->name), bytes = model::toBytes(*model);
    std::printf("\nstatic const unsigned char k_%s[] = {\n", name.c_str());
    print(bytes);
    std::printf("0};\n");
    rows += "    {\"" + name + "\", {reinterpret_cast<const char*>(k_" + name + "), sizeof(k_" + name +
            ") - 1}, &model::fromBytes},\n";
    if (default_alone) break;  // it comes first
  }
  std::printf("\nstatic const model::Prepared kModels[] = {\n%s};\n", rows.c_str());
  std::printf(
      "\nstd::span<const model::Prepared> preparedModels() { return kModels; }\n\n}  // namespace lacquer\n");
  return 0;
}
