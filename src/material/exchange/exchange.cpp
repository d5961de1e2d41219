#include "exchange/exchange.h"

#include <fmt/format.h>

#include <iterator>
#include <utility>

#include "exchange/displacement_out.h"
#include "exchange/looks_out.h"
#include "exchange/pattern_out.h"
#include "exchange/surface_out.h"
#include "support/plain_name.h"
#include "support/relative.h"
#include "support/text.h"

namespace lacquer::exchange {

using materialx::Element;

namespace {

Element shaderInput(std::string_view shader) {
  Element input;
  input.category = "input";
  input.attributes = {
      {"name", "surfaceshader"}, {"type", "surfaceshader"}, {"nodename", std::string(shader)}};
  return input;
}

/// Such a material is left out, with an error.
bool isOfClosures(const material::Document& document, size_t material, Diagnostics& said) {
  const material::Material& made = document.materials[material];
  if (made.closures.empty()) return false;
  said.push_back({"closures-not-written",
                  Severity::Error,
                  made.surface_place.line == 0 ? Place{document.path, 0, 0, {}} : made.surface_place,
                  fmt::format("the material {} is made of closures", quote(made.name)),
                  "no other surface says the same; without edits the document is written as it was read",
                  {}});
  return true;
}

}  // namespace

Written toMaterialX(const material::Document& document, std::vector<size_t> materials,
                    const material::Schema& schema, std::string_view surface, const std::string& folder,
                    const Element* read) {
  Written written;
  std::erase_if(materials, [&](size_t i) { return isOfClosures(document, i, written.said); });
  if (materials.empty()) return written;
  graph::Graph graph;
  for (const size_t i : materials) {
    if (document.materials[i].patterns == nullptr) continue;
    graph = *document.materials[i].patterns;  // one for all materials of a file
    break;
  }
  graph.nodes.clear();
  graph.outputs.clear();
  const Result<std::string> name = schema.library->defaultTemplate();
  if (name) graph.template_name = *name;
  std::vector<SurfaceOut> surfaces;
  for (const size_t i : materials)
    surfaces.push_back(surfaceOf(document, document.materials[i], schema, graph, surface, written.said));
  // Behind the surfaces, in their order: what moves the vertices of some.
  std::vector<std::optional<size_t>> displacements;
  for (const size_t i : materials) {
    const std::string& group = document.materials[i].displacement;
    displacements.push_back(group.empty() ? std::nullopt : std::optional(surfaces.size()));
    if (!group.empty()) surfaces.push_back(displacementOf(graph, group));
  }
  for (size_t i = 0; i < surfaces.size(); ++i) {
    graph::Group body = surfaces[i].body;
    body.name = fmt::format("_surface_{}", i);
    for (const SurfaceInput& input : surfaces[i].inputs) {
      if (input.source) body.outputs.emplace_back(input.name, *input.source);
    }
    graph.groups.push_back(std::move(body));
  }
  const std::string from = folderOf(document.path);
  const Moved moved(from, folder.empty() ? from : folder);
  PatternsOut patterns(graph, *schema.library, document, surfaces, moved, written.said);
  Element root;
  root.category = "materialx";
  root.attributes = {{"version", "1.39"}, {"colorspace", "lin_rec709"}};
  for (size_t i = 0; read != nullptr && i < read->children.size(); ++i)
    if (isOfGeometry(read->children[i])) patterns.take(read->children[i].name());
  patterns.write(root);
  std::vector<Element> shaders;
  std::vector<Element> surface_materials;
  std::vector<std::string> names(document.materials.size());
  for (size_t i = 0; i < materials.size(); ++i) {
    const std::string& own = document.materials[materials[i]].name;
    const std::string material = patterns.free(own.empty() ? "material" : own);
    names[materials[i]] = material;
    Element shader;
    shader.category = surfaces[i].category;
    shader.attributes = {{"name", patterns.free("SR_" + material)}, {"type", "surfaceshader"}};
    patterns.inputs(i, shader);
    Element made;
    made.category = "surfacematerial";
    made.attributes = {{"name", material}, {"type", "material"}};
    // MaterialX has letters, digits and underscores in names, and any text beside them.
    if (material != own && !own.empty() && isPlainText(own)) made.attributes.emplace_back("uiname", own);
    made.children.push_back(shaderInput(shader.name()));
    if (displacements[i]) patterns.inputs(*displacements[i], made);
    shaders.push_back(std::move(shader));
    surface_materials.push_back(std::move(made));
  }
  std::vector<Element> users = shaders;
  users.insert(users.end(), surface_materials.begin(), surface_materials.end());
  orderElements(root.children, users);
  for (size_t i = 0; i < shaders.size(); ++i) {
    root.children.push_back(std::move(shaders[i]));
    root.children.push_back(std::move(surface_materials[i]));
  }
  nameDisplacements(root);
  if (read != nullptr) {
    std::vector<Element> looks = looksOf(*read, document, names, moved, written.said);
    std::move(looks.begin(), looks.end(), std::back_inserter(root.children));
  }
  written.text = materialx::toXml(root);
  return written;
}

}  // namespace lacquer::exchange
