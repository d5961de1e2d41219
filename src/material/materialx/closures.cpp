#include "materialx/closures.h"

#include <fmt/format.h>

#include <algorithm>

#include "materialx/patterns.h"

namespace lacquer::materialx {

using graph::Source;

std::span<const ClosurePart> closureParts(std::string_view type) {
  using ir::Type;
  static constexpr ClosurePart kBsdf[] = {{"direct", Type::Vec3, 0},
                                          {"indirect", Type::Vec3, 0},
                                          {"transmitted", Type::Vec3, 0},
                                          {"through", Type::Vec3, 1},
                                          {"passed", Type::Vec3, 1}};
  static constexpr ClosurePart kEdf[] = {{"emission", Type::Vec3, 0}};
  static constexpr ClosurePart kVdf[] = {{"passed", Type::Vec3, 1}};
  static constexpr ClosurePart kSurface[] = {{"direct", Type::Vec3, 0},
                                             {"indirect", Type::Vec3, 0},
                                             {"emission", Type::Vec3, 0},
                                             {"alpha", Type::Float, 1}};
  if (type == "BSDF") return kBsdf;
  if (type == "EDF") return kEdf;
  if (type == "VDF") return kVdf;
  if (type == "surfaceshader") return kSurface;
  return {};
}

std::string libraryName(const Element& element) {
  const std::string_view type = element.get("type");
  if (type == "surfaceshader") {
    if (element.category == "surface") return "surface_of_closures";
    if (element.category == "surface_unlit") return "surface_without_light";
  }
  constexpr std::string_view kCombinators[] = {"layer", "mix", "add", "multiply"};
  const bool combines =
      std::find(std::begin(kCombinators), std::end(kCombinators), element.category) != std::end(kCombinators);
  if (!combines || (type != "BSDF" && type != "EDF" && type != "VDF")) return element.category;
  const Element* base = element.category == "layer" ? element.child("input", "base") : nullptr;
  const bool medium = type == "VDF" || (base != nullptr && base->get("type") == "VDF");
  return fmt::format("{}_{}", element.category, medium ? "vdf" : type == "EDF" ? "edf" : "bsdf");
}

std::string_view refusedClosure(const Element& element) {
  constexpr std::pair<std::string_view, std::string_view> kRefused[] = {
      {"chiang_hair_bsdf", "hair has curves, and these are surfaces"},
      {"chiang_hair_roughness", "it is for hair"},
      {"chiang_hair_absorption_from_color", "it is for hair"},
      {"deon_hair_absorption_from_melanin", "it is for hair"},
      {"measured_edf", "a profile of a luminaire belongs to a light"},
      {"volume", "volumes are not drawn"},
      {"light", "lights are the application's"}};
  for (const auto& [name, why] : kRefused) {
    if (element.category == name) return why;
  }
  const std::string name = libraryName(element);
  if (name != element.category && name.ends_with("_vdf"))
    return "media are combined with nothing but what lies on them";
  return {};
}

bool Patterns::givesClosure(const Element& node) const {
  return definitionOf(node) != nullptr || node.category == "nodegraph" ||
         !library_.forms(libraryName(node)).empty() || !refusedClosure(node).empty();
}

bool Patterns::isOpaque(const Scope& scope, const Element& surface) {
  const Element* nodedef = definitionOf(surface);
  if (nodedef == nullptr && surface.category != "surface") return false;
  if (nodedef == nullptr) {
    const Element* opacity = surface.child("input", "opacity");
    return opacity == nullptr || (!isConnected(*opacity) && opacity->get("value").empty());
  }
  (void)scope;
  const Element* graph = definition(*nodedef)->graph;
  if (graph == nullptr) return false;
  for (const Element& output : graph->children) {
    if (output.category != "output" || output.get("type") != "surfaceshader") continue;
    const Element* inner = nodeOf(*graph, output.get("nodename"));
    return inner != nullptr && inner != &surface && isOpaque(scope, *inner);
  }
  return false;
}

/// Whether the two alphas of a closure are one, whatever its numbers become: it has no direction then.
bool Patterns::hasOneRoughness(const Scope& scope, const Element& element) const {
  const Element* roughness = element.child("input", "roughness");
  if (roughness == nullptr) return true;
  const Element* from = upstream(scope, *roughness);
  return from != nullptr && definitionOf(*from) == nullptr &&
         ((from->category == "roughness_anisotropy" || from->category == "glossiness_anisotropy")
              ? from->child("input", "anisotropy") == nullptr
              : from->category == "convert");
}

/// What a closure takes beside what the document says: light of the surroundings along its lobe, by a node of
/// the parameter's name, and the tangent.
void Patterns::surroundings(Scope& scope, const Element& element, const lang::NodeDecl& form,
                            graph::Node& made) {
  const auto given = [&](std::string_view name) {
    return std::find_if(made.inputs.begin(), made.inputs.end(),
                        [&](const auto& input) { return input.first == name; });
  };
  const auto choice = given("scatter_mode");
  const auto* mode = choice == made.inputs.end() ? nullptr : std::get_if<graph::Choice>(&choice->second.from);
  const std::string_view scatters = mode == nullptr ? std::string_view("R") : mode->name;
  graph::Inputs more;
  for (const lang::Param& param : form.params) {
    const std::string_view name = param.name;
    const bool lobe = name == "lobe_radiance";
    const bool refracted = name.starts_with("refracted_radiance");
    if (name == "tangent" && given(name) == made.inputs.end() && !hasOneRoughness(scope, element))
      more.emplace_back("tangent", Source{graph::GivenRef{"tangent"}, "xyz"});
    if (!lobe && !refracted && !name.ends_with("_irradiance")) continue;
    if ((lobe && scatters == "T") || (refracted && scatters == "R")) continue;
    const Result<const lang::NodeDecl*> decl = library_.node(name);
    if (!decl) continue;
    graph::Inputs inputs;
    for (const lang::Param& own : (*decl)->params) {
      if (ir::isTexture(own.type))
        inputs.emplace_back(own.name, Source{graph::TextureRef{std::string(own.name)}, {}});
      if (const auto it = given(own.name); it != made.inputs.end()) inputs.push_back(*it);
    }
    more.emplace_back(name,
                      add(scope, fmt::format("{}_{}", made.id, name), std::string(name), std::move(inputs)));
  }
  for (auto& one : more) made.inputs.push_back(std::move(one));
}

}  // namespace lacquer::materialx
