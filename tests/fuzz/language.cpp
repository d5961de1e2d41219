// Node files. The library consists of the input alone, so that an input takes no longer than it is long.
#include <array>

#include "feeds.h"
#include "graph/graph.h"
#include "lower/lower.h"
#include "prove/nodes.h"
#include "setting/language.h"
#include "shader/module.h"
#include "shader/print.h"

namespace lacquer::fuzz {

namespace {

constexpr size_t kMostNodes = 4;

/// Materials for the extensions of the corpus: every property, at its default and elsewhere.
constexpr std::string_view kMaterials = R"({"asset": {"version": "2.0"}, "textures": [{}, {}], "materials": [
  {"name": "plain"},
  {"name": "some", "tint": [0.5, 0.25, 1], "doubleSided": true, "extensions": {"FUZZ_film": {"filmFactor": 0.5}}},
  {"name": "all", "tint": [1, 1, 1], "tintTexture": {"index": 0}, "extensions": {
    "FUZZ_film": {"filmFactor": 1, "filmMode": "thick", "filmTexture": {"index": 1, "scale": 0.5}},
    "FUZZ_glow": {"glowColor": [4, 0, 1]}}}]})";

/// Every node that is good, inlined in each of its bodies, with what is proved of it.
void useNodes(const lang::Library& library) {
  size_t left = kMostNodes;
  for (const std::string_view name : library.names(lang::DeclKind::Node)) {
    const Result<const lang::NodeDecl*> node = library.node(name);
    // The largest take seconds to prove, as they should.
    if (!node || (*node)->weight > 2000 || left-- == 0) continue;
    (void)proveNode(**node, {});
    for (const lang::Variant& variant : (*node)->variants) (void)nodeModule(**node, variant.name);
  }
}

}  // namespace

std::string feedNode(std::string_view bytes) {
  const Result<lang::Library> library = lang::Library::fromFiles({{"fuzz.node", std::string(bytes)}});
  if (!library) return library.error().empty() ? "a node file is refused without an error" : "";
  if (library->checkAll().empty()) useNodes(*library);
  return {};
}

std::string feedDeclaration(std::string_view bytes) {
  Result<lang::Library> library = lang::Library::fromFiles({{"fuzz.node", std::string(bytes)}});
  if (!library) return library.error().empty() ? "a node file is refused without an error" : "";
  const bool good = library->checkAll().empty();
  const Language language(std::move(*library));
  const Result<const material::Schema*> schema = language.models.schema();
  if (!schema) return schema.error().empty() ? "a schema is refused without an error" : "";
  Options options = optionsOf(bytes);
  options.template_name.clear();
  options.profile.clear();
  options.simplify.clear();
  if (!resolveNames(language, options) || !language.models.of(options.profile)) return {};
  const auto document = material::readText(std::string(kMaterials), "fuzz.gltf", **schema, {});
  if (!document || !good) return {};
  for (const material::Material& material : document->materials) {
    if (lacquer::hasError(material.diagnostics)) continue;
    Diagnostics said;
    Result<graph::Graph> graph =
        buildGraph(material, {true, false, false, {true, false, false, false}}, language, options, said);
    if (!graph || lacquer::hasError(graph::check(*graph, language))) continue;
    Result<ir::Module> module = toModule(*graph, language, options, {});
    if (!module) continue;
    ShaderData data;
    data.has_vertex = hasVertexStage(*module);
    data.module = std::move(*module);
    Wrong wrong;
    print(data, options, wrong);
  }
  return {};
}

}  // namespace lacquer::fuzz
