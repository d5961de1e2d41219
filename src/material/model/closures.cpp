#include "model/closures.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "materialx/patterns.h"
#include "support/text.h"

namespace lacquer::model {

using graph::Source;

Result<void> takesClosures(const lang::TemplateDecl& template_decl, const material::Material& material) {
  constexpr std::string_view kPlain[] = {"emission", "alpha", "hidden", "surface_normal"};
  std::string_view more;
  for (const lang::PortDecl& port : template_decl.ports) {
    if (port.param.name == "direct") return {};
    const bool plain = std::find(std::begin(kPlain), std::end(kPlain), port.param.name) != std::end(kPlain);
    if (!plain && more.empty()) more = port.param.name;
  }
  if (more.empty()) return {};
  return fail("no-properties", {},
              fmt::format("the template {} takes properties such as {}, and {} is made of closures",
                          quote(template_decl.name), quote(more), quote(material.name)),
              "a surface such as gltf_pbr or open_pbr_surface has them");
}

void placeSurroundings(graph::Group& group, const lang::TemplateDecl& template_decl,
                       const BuildOptions& options) {
  const auto on = [&](const char* name, bool otherwise) {
    const auto it = options.switches.find(name);
    return it == options.switches.end() ? otherwise : it->second;
  };
  const bool lit = on("ibl", true);
  const bool turned = on("turned_environment", false);
  const bool areas = template_decl.find("area_sample.centre").has_value();
  const auto has = [&](std::string_view name) {
    return lit && std::any_of(template_decl.environments.begin(), template_decl.environments.end(),
                              [&](const lang::EnvironmentDecl& one) { return one.name == name; });
  };
  std::set<std::string, std::less<>> gone;
  for (graph::Node& node : group.nodes) {
    bool reads = false;
    for (const auto& [input, source] : node.inputs) {
      const auto* texture = std::get_if<graph::TextureRef>(&source.from);
      if (texture == nullptr || !texture->name.starts_with("environment_")) continue;
      reads = true;
      if (!has(texture->name)) gone.insert(node.id);
    }
    if (reads && areas) node.type += "_among_lights";
    if (reads && turned)
      node.inputs.emplace_back("environment_rotation", Source{graph::GivenRef{"environment_rotation"}, {}});
  }
  if (gone.empty()) return;
  std::erase_if(group.nodes, [&](const graph::Node& node) { return gone.contains(node.id); });
  for (graph::Node& node : group.nodes) {
    std::erase_if(node.inputs, [&](const auto& input) {
      const auto* from = std::get_if<graph::NodeRef>(&input.second.from);
      return from != nullptr && gone.contains(from->node);
    });
  }
}

void nameNumbers(graph::Graph& graph, std::string_view surface) {
  std::map<std::string, std::string, std::less<>> names;
  for (graph::Parameter& parameter : graph.parameters) {
    const std::string_view pointer = parameter.pointer;
    if (!pointer.starts_with(surface) || pointer.size() <= surface.size() + 1) continue;
    std::string_view input = pointer.substr(surface.size());
    if (input[0] != '/' || input.find('/', 1) != std::string_view::npos) continue;
    std::string name = materialx::graphName(input.substr(1));
    if (ir::isMatrix(parameter.type) || graph.findParameter(name)) continue;
    names[parameter.name] = name;
    parameter.name = std::move(name);
  }
  graph::eachSource(graph, [&](Source& source) {
    auto* ref = std::get_if<graph::ParameterRef>(&source.from);
    const auto at = ref == nullptr ? names.end() : names.find(ref->name);
    if (at != names.end()) ref->name = at->second;
  });
}

void placeNormals(graph::Graph& graph, const gltf::VertexAttributes& attributes,
                  const lang::Library& library) {
  constexpr const char* kNormal = "normal.unit";
  bool asked = false;
  const auto isNormal = [](const Source& source) {
    const auto* given = std::get_if<graph::GivenRef>(&source.from);
    return given != nullptr && given->name == "normal";
  };
  for (graph::Node& node : graph.nodes) {
    const Result<const lang::NodeDecl*> decl = library.node(node.type);
    if (!decl || !(*decl)->origin.file.starts_with("nodes/materialx/")) continue;
    for (const lang::Param& param : (*decl)->params) {
      const auto it = std::find_if(node.inputs.begin(), node.inputs.end(),
                                   [&](const auto& input) { return input.first == param.name; });
      const bool given = it == node.inputs.end() ? param.given == "normal" : isNormal(it->second);
      if (!given) continue;
      const Source unit{graph::NodeRef{kNormal, {}},
                        it == node.inputs.end() ? std::string() : it->second.swizzle};
      if (it == node.inputs.end())
        node.inputs.emplace_back(param.name, unit);
      else
        it->second = unit;
      asked = true;
    }
    if (!attributes.tangent) {
      std::erase_if(node.inputs, [](const auto& input) {
        const auto* given = std::get_if<graph::GivenRef>(&input.second.from);
        return given != nullptr && given->name == "tangent";
      });
    }
  }
  if (!asked) return;
  if (attributes.normal)
    graph.add(kNormal, "unit_normal", graph::Inputs{{"normal", Source{graph::GivenRef{"normal"}, {}}}});
  else
    graph.add(kNormal, "flat_normal",
              graph::Inputs{{"position", Source{graph::GivenRef{"position"}, {}}},
                            {"V", Source{graph::GivenRef{"view"}, {}}}});
  std::rotate(graph.nodes.begin(), graph.nodes.end() - 1, graph.nodes.end());
}

}  // namespace lacquer::model
