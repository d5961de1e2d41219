#include "materialx/closures.h"

#include <fmt/format.h>

#include <algorithm>

#include "graph/contracts.h"
#include "lang/suggest.h"
#include "materialx/patterns.h"
#include "mtlx/looks.h"
#include "mtlx/models.h"
#include "support/text.h"

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
    if (element.category == "mix") return "mix_surface";
  }
  constexpr std::string_view kCombinators[] = {"layer", "mix", "add", "multiply"};
  const bool combines =
      std::find(std::begin(kCombinators), std::end(kCombinators), element.category) != std::end(kCombinators);
  if (!combines || (type != "BSDF" && type != "EDF" && type != "VDF")) return element.category;
  const Element* base = element.category == "layer" ? element.child("input", "base") : nullptr;
  const bool medium = type == "VDF" || (base != nullptr && base->get("type") == "VDF");
  return fmt::format("{}_{}", element.category, medium ? "vdf" : type == "EDF" ? "edf" : "bsdf");
}

std::string_view combines(const Element& element) {
  const std::string_view type = element.get("type");
  if (type != "BSDF" && type != "EDF") return {};
  if (element.category == "layer") return "it is a BSDF, its top is one, and its base a BSDF or a VDF";
  if (element.category == "mix") return "it is a BSDF or an EDF, and fg and bg are such, too";
  if (element.category == "add") return "it is a BSDF or an EDF, and in1 and in2 are such, too";
  if (element.category == "multiply")
    return "it is a BSDF or an EDF, in1 is such, too, and in2 a number or a colour";
  return {};
}

std::optional<Refusal> refused(const Element& element) {
  constexpr std::pair<std::string_view, std::string_view> kRefused[] = {
      {"chiang_hair_bsdf", "hair has curves, and these are surfaces"},
      {"chiang_hair_roughness", "it is for hair"},
      {"chiang_hair_absorption_from_color", "it is for hair"},
      {"deon_hair_absorption_from_melanin", "it is for hair"},
      {"thin_film_bsdf",
       "since MaterialX 1.39 a film is thinfilm_thickness and thinfilm_ior of what it lies on"},
      {"measured_edf", "a profile of a luminaire belongs to a light"}};
  for (const auto& [name, why] : kRefused) {
    if (element.category == name) return Refusal{std::string(why), "there are " + listOf(kClosures)};
  }
  const std::string_view type = element.get("type");
  if (type == "lightshader" || element.category == "light")
    return Refusal{"lights are the application's",
                   "a document's surfaces are drawn, with emission by an EDF"};
  constexpr std::string_view kMedia =
      "an absorption_vdf or an anisotropic_vdf may lie below the top of a layer";
  if (type == "volumeshader" || element.category == "volume" || element.category == "volumematerial")
    return Refusal{"volumes are surfaces' insides alone", std::string(kMedia)};
  const std::string name = libraryName(element);
  if (name != element.category && name != "layer_vdf" && name.ends_with("_vdf"))
    return Refusal{"media are not combined", std::string(kMedia)};
  if (element.category == "layer" && type == "VDF")
    return Refusal{"a medium has nothing on top that is a medium", std::string(kMedia)};
  return std::nullopt;
}

bool Patterns::givesClosure(const Element& node) const {
  return !definitionsCalled(node).empty() || node.category == "nodegraph" ||
         !library_.forms(libraryName(node)).empty() || refused(node).has_value();
}

const Element* Patterns::modelOf(const Element& surface) const {
  const auto of = definitions_of_.find(surface.category);
  if (options_.models == nullptr || of == definitions_of_.end()) return nullptr;
  const Element* best = nullptr;
  for (const size_t place : of->second) {
    if (!definitions_[place].model) continue;
    const Element& nodedef = *definitions_[place].nodedef;
    if (!surface.get("version").empty() && surface.get("version") == nodedef.get("version")) return &nodedef;
    if (best == nullptr || nodedef.get("isdefaultversion") == "true") best = &nodedef;
  }
  return best;
}

std::string_view Patterns::unitOf(const Element& surface, std::string_view input) const {
  const Element* model = modelOf(surface);
  const Element* port = model == nullptr ? nullptr : model->child("input", input);
  return port == nullptr ? std::string_view() : port->get("unit");
}

namespace {

/// Whether an input is not there, or a number that is the same in all components.
bool isAll(const Element& node, std::string_view name, double number) {
  const Element* input = node.child("input", name);
  if (input == nullptr) return true;
  if (isConnected(*input)) return false;
  const std::optional<std::vector<double>> numbers = numbersOf(input->get("value"));
  return numbers && std::all_of(numbers->begin(), numbers->end(), [&](double x) { return x == number; });
}

std::vector<std::string_view> inputsOf(const Element& interface) {
  std::vector<std::string_view> names;
  for (const Element& child : interface.children) {
    if (child.category == "input") names.push_back(child.name());
  }
  return names;
}

Alpha alphaOfModel(const Element& surface) {
  if (surface.category == "gltf_pbr") {
    if (isAll(surface, "alpha_mode", 0)) return Alpha::Opaque;
    return isAll(surface, "alpha_mode", 1) ? Alpha::Mask : Alpha::Blend;
  }
  if (surface.category == "UsdPreviewSurface") {
    const bool presence = !isAll(surface, "opacityMode", 0);
    if (!isAll(surface, "opacityThreshold", 0)) return Alpha::Mask;
    return presence && !isAll(surface, "opacity", 1) ? Alpha::Blend : Alpha::Opaque;
  }
  const std::string_view opacity =
      surface.category == "open_pbr_surface" ? std::string_view("geometry_opacity") : "opacity";
  return isAll(surface, opacity, 1) ? Alpha::Opaque : Alpha::Blend;
}

}  // namespace

/// The surface that one is in the end, whose definitions' graphs are surfaces of others. Null where that is
/// not known.
const Element* Patterns::innermost(const Element& surface) {
  constexpr int kDeepest = 64;
  const Element* at = &surface;
  for (int depth = 0; depth < kDeepest; ++depth) {
    const Element* nodedef = definitionOf(*at);
    if (nodedef == nullptr || definition(*nodedef)->model) return at;
    const Element* graph = definition(*nodedef)->graph;
    if (graph == nullptr) return nullptr;
    const auto is = [](const Element& one) {
      return one.category == "output" && one.get("type") == "surfaceshader";
    };
    const auto output = std::find_if(graph->children.begin(), graph->children.end(), is);
    at = output == graph->children.end() ? nullptr : nodeOf(*graph, output->get("nodename"));
    if (at == nullptr) return nullptr;
  }
  return nullptr;
}

namespace {

bool isSaid(const Element& node, std::string_view name) {
  const Element* input = node.child("input", name);
  return input != nullptr && (isConnected(*input) || !input->get("value").empty());
}

}  // namespace

Alpha Patterns::alphaOf(const Element& surface) {
  const Element* inner = innermost(surface);
  if (inner == nullptr) return Alpha::Blend;
  if (definitionOf(*inner) != nullptr) return alphaOfModel(*inner);
  return inner->category == "surface" && !isSaid(*inner, "opacity") ? Alpha::Opaque : Alpha::Blend;
}

/// The error of an input whose type is not its port's; nothing where the types agree.
std::optional<Diagnostic> Patterns::wrongType(const Element& input, const Element& port) {
  const std::string_view type = input.get("type");
  if (type.empty() || typeOf(type) == typeOf(port.get("type"))) return std::nullopt;
  return Diagnostic{"wrong-type",
                    Severity::Error,
                    input.place,
                    fmt::format("{} is of the type {}", quote(input.name()), quote(type)),
                    fmt::format("it must be {}", quote(port.get("type"))),
                    {}};
}

/// A number of a model's input: with some of them the surface is another one, and they are no parameters.
std::optional<Source> Patterns::modelNumber(Scope& scope, const Element& element, const Element& input,
                                            const Element& port) {
  const ir::Type wanted = *typeOf(port.get("type"));
  const Result<ir::Components> read = valueOf(input, wanted, units_, port.get("unit"));
  if (!read) {
    for (const Diagnostic& one : read.error()) error(input, one.code, one.message, one.help);
    return std::nullopt;
  }
  ir::Components value = *read;
  if (wanted == ir::Type::Int || wanted == ir::Type::Bool)
    return Source{graph::Literal{wanted == ir::Type::Int ? ir::Type::Float : wanted, value}, {}};
  const auto all = value.begin() + ir::componentCount(wanted);
  ir::Range range;
  const std::optional<std::vector<double>> least = numbersOf(port.get("uimin"));
  const std::optional<std::vector<double>> most = numbersOf(port.get("uimax"));
  if (least && most) {
    range.lo = (*least)[0], range.hi = (*most)[0];
    if (!std::all_of(value.begin(), all, [&](double x) { return range.contains(x); })) {
      warning(input, "out-of-range", fmt::format("{} is {}", quote(input.name()), quote(input.get("value"))),
              fmt::format("the range is {}, and the nearest number is taken", ir::rangeText(range)));
      for (double& x : value) x = std::clamp(x, range.lo, range.hi);
    }
  }
  const std::optional<std::vector<double>> removes = numbersOf(port.get(kRemoves));
  for (const double number : removes.value_or(std::vector<double>())) {
    if (std::all_of(value.begin(), all, [&](double x) { return x == number; }))
      return Source{graph::Literal{wanted, value}, {}};
  }
  // The default is the model's: that of a material would be in the shader of all.
  const Result<ir::Components> by_default = port.find("value") == nullptr
                                                ? Result<ir::Components>(value)
                                                : valueOf(port, wanted, units_, port.get("unit"));
  graph::Parameter& made = parameter(scope, element, input, wanted);
  made.value = value;
  made.neutral = by_default.value_or(value);
  made.range = range;
  return Source{graph::ParameterRef{made.name}, {}};
}

/// The inputs of an instance of a model. Inputs that the document leaves out are the definition's constants.
void Patterns::modelInputs(Scope& scope, const Element& element, const Element& interface,
                           graph::Node& made) {
  for (const Element& input : element.children) {
    if (input.category != "input") continue;
    const Element* port = interface.child("input", input.name());
    if (port == nullptr) {
      if (input.find(kOfVariant) == nullptr)
        warning(input, "unknown-input",
                fmt::format("{} has no input {}", quote(element.category), quote(input.name())),
                maySuggest() ? lang::didYouMean(input.name(), inputsOf(interface)) : std::string());
      continue;
    }
    std::optional<Source> source;
    if (const std::optional<Diagnostic> wrong = wrongType(input, *port)) {
      error(input, wrong->code, wrong->message, wrong->help);
    } else if (isConnected(input)) {
      source = connected(scope, input);
    } else if (input.find("value") != nullptr) {
      source = modelNumber(scope, element, input, *port);
    }
    if (source) made.inputs.emplace_back(graphName(input.name()), std::move(*source));
  }
  for (const Element& port : interface.children) {
    const std::optional<ir::Type> type = typeOf(port.get("type"));
    if (port.category != "input" || !type || port.find("value") == nullptr) continue;
    if (element.child("input", port.name()) != nullptr) continue;
    const Result<ir::Components> value = valueOf(port, *type, units_, port.get("unit"));
    if (value)
      made.inputs.emplace_back(
          graphName(port.name()),
          Source{graph::Literal{*type == ir::Type::Int ? ir::Type::Float : *type, *value}, {}});
  }
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
