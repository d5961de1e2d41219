// cases/*.gltf: each with the diagnostics and the contents that reading it must give, in NAME.expected. Files
// below cases/permissive are read with ReadOptions::permissive.
#include <gtest/gtest.h>

#include "gltf/dump.h"
#include "support/cases.h"
#include "support/materials.h"

namespace lacquer::test {
namespace {

void readCase(const std::filesystem::path& file) {
  const bool permissive = file.parent_path().filename() == "permissive";
  const auto document = materialsOf(readFile(file), file.filename().string(), permissive);
  std::string text;
  if (document) {
    text = formatAll(*document) + "----\n" + dump(*document);
  } else {
    for (const Diagnostic& one : document.error()) text += format(one) + '\n';
    text += "---- not read\n";
  }
  expectFile(std::filesystem::path(file).replace_extension(".expected"), text);
}

const bool kRegistered = registerFiles("GltfCase", sourceFolder() / "tests/gltf/cases", ".gltf", readCase);

TEST(GltfCases, areRegistered) { EXPECT_TRUE(kRegistered); }

}  // namespace
}  // namespace lacquer::test
