// In place of src/material/materialx/ and src/material/mtlx/ in lacquer-compiler.wasm: it has the materials of glTF files and
// graphs, and says where those of MaterialX are read.
#include "materialx/materialx.h"

#include "json/json.h"

namespace lacquer::materialx {

static constexpr const char* kWhere = "`load()` of the package's main entry, lacquer.wasm, reads it";

std::string_view Procedural::output(std::string_view /*name*/) const { return {}; }

/// Of closures' inputs, which this module does not read.
std::string graphName(std::string_view name) { return std::string(name); }

bool isXml(std::string_view text) {
  // Marks of an encoding, and the zeros of UTF-16, come before it.
  const size_t first = text.find_first_not_of(std::string_view("\xef\xbb\xbf\xfe\xff\0 \t\r\n", 10));
  return first != std::string_view::npos && text[first] == '<';
}

Result<Definitions> readDefinitions(const std::vector<lang::SourceFile>& files, const Limits& /*limits*/) {
  return fail("not-in-compiler", {files.empty() ? std::string() : files.front().name, 0, 0, {}},
              "the compiler's module reads no MaterialX definitions", kWhere);
}

Result<Materials> readMaterials(std::string_view /*text*/, const std::string& path,
                                const lang::Library& /*library*/, MaterialOptions /*options*/) {
  return fail("not-in-compiler", {path, 0, 0, {}}, "the compiler's module reads no MaterialX documents",
              kWhere);
}

Procedurals readProcedurals(const json::Json& extension, const std::string& path,
                            const lang::Library& /*library*/, const ProceduralOptions& options,
                            Diagnostics& diagnostics) {
  addBounded(diagnostics, {"not-in-compiler",
                           options.required ? Severity::Error : Severity::Warning,
                           {path, 0, 0, "/extensions/KHR_texture_procedurals"},
                           "the compiler's module reads no procedural textures",
                           kWhere,
                           {}});
  Procedurals made;
  made.required = options.required;
  made.list.resize(json::arraySize(extension, "procedurals"));
  for (Procedural& one : made.list) one.wrong = true;
  return made;
}

}  // namespace lacquer::materialx
