#include "exchange/pattern_out.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "gltf/texture_source.h"
#include "graph/text.h"
#include "ir/types.h"
#include "mtlx/values.h"
#include "support/say_once.h"

namespace lacquer::exchange {

using graph::Source;
using ir::Components;
using ir::Type;
using materialx::Element;

namespace {

template <size_t N>
bool isOneOf(std::string_view name, const std::string_view (&names)[N]) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

// Which of MaterialX's nodes have vectors alone, or colours alone; all others have both, and all ports of one
// are the same.
constexpr std::string_view kOfVectors[] = {"acos",
                                           "asin",
                                           "atan2",
                                           "bitangent",
                                           "bump",
                                           "cellnoise3d",
                                           "cos",
                                           "creatematrix",
                                           "crossproduct",
                                           "distance",
                                           "dotproduct",
                                           "exp",
                                           "flake2d",
                                           "flake3d",
                                           "gltf_normalmap",
                                           "heighttonormal",
                                           "ln",
                                           "hextilednormalmap",
                                           "magnitude",
                                           "normal",
                                           "normalize",
                                           "normalmap",
                                           "position",
                                           "reflect",
                                           "refract",
                                           "rotate3d",
                                           "sin",
                                           "sqrt",
                                           "tan",
                                           "tangent",
                                           "texcoord",
                                           "transformmatrix",
                                           "transformnormal",
                                           "transformpoint",
                                           "transformvector",
                                           "unifiednoise3d",
                                           "viewdirection",
                                           "worleynoise2d",
                                           "worleynoise3d",
                                           "facingratio"};
constexpr std::string_view kOfColors[] = {"burn",
                                          "checkerboard",
                                          "colorcorrect",
                                          "crosshatch",
                                          "difference",
                                          "disjointover",
                                          "dodge",
                                          "geomcolor",
                                          "grid",
                                          "hextiledimage",
                                          "hsvadjust",
                                          "hsvtorgb",
                                          "in",
                                          "inside",
                                          "latlongimage",
                                          "luminance",
                                          "mask",
                                          "matte",
                                          "minus",
                                          "out",
                                          "outside",
                                          "over",
                                          "overlay",
                                          "plus",
                                          "premult",
                                          "ramp",
                                          "ramp_gradient",
                                          "randomcolor",
                                          "rgbtohsv",
                                          "saturate",
                                          "screen",
                                          "tiledcircles",
                                          "tiledcloverleafs",
                                          "tiledhexagons",
                                          "unpremult",
                                          "gltf_colorimage",
                                          "UsdUVTexture",
                                          "gooch_shade"};
/// Inputs that are vectors, whatever else the node has.
constexpr std::string_view kVectorPorts[] = {"amplitude", "position", "normal",   "tangent",
                                             "bitangent", "viewdir",  "texcoord", "light_direction"};
/// Inputs that are numbers there, whatever their values are called here.
constexpr std::string_view kNumberPorts[] = {"index", "interpolation", "operationorder",
                                             "style", "type",          "upaxis"};
/// Inputs of this library's own: of all nodes, and of one.
/// Of nodes of images: along which axes these end, which is an address mode in a document.
constexpr std::string_view kEnds = "ends";
constexpr std::string_view kOwnPorts[] = {"metric"};
constexpr std::string_view kOwnOfNormalMaps[] = {"normal", "tangent", "bitangent"};
constexpr std::string_view kAddressed[] = {"image", "gltf_image", "gltf_colorimage", "gltf_normalmap"};
constexpr std::string_view kFiltered[] = {"image",           "tiledimage",     "gltf_image",
                                          "gltf_colorimage", "gltf_normalmap", "triplanarprojection"};

bool hasColor(Type type) { return type == Type::Vec3 || type == Type::Vec4; }

bool portColor(const lang::NodeDecl& decl, const lang::Param& port, bool color) {
  const std::string_view family = decl.family;
  if (family == "hsvadjust" && port.name == "amount") return false;
  // A conversion between types that are one here.
  if (family == "convert" && decl.results[0].type == port.type) return !color;
  return color && hasColor(port.type) && !isOneOf(port.name, kVectorPorts);
}

std::string_view familyOf(const lang::NodeDecl& decl) {
  return decl.family.empty() ? decl.name.substr(0, decl.name.find('<')) : decl.family;
}

Element inputOf(std::string_view name, std::string_view type) {
  Element input;
  input.category = "input";
  input.attributes = {{"name", std::string(name)}, {"type", std::string(type)}};
  return input;
}

Element valueOf(std::string_view name, std::string_view type, std::string value) {
  Element input = inputOf(name, type);
  input.set("value", std::move(value));
  return input;
}

/// The word of a choice that a number stands for.
std::string_view wordOf(const lang::Param& param, double number) {
  const auto chosen = static_cast<size_t>(std::max(number, 0.0));
  return param.choices[std::min(chosen, param.choices.size() - 1)];
}

}  // namespace

/// One body that is written: which elements its nodes are, and what stands between them.
struct PatternsOut::Scope {
  size_t group = 0;
  Element* into = nullptr;
  materialx::NameSet* names = nullptr;
  materialx::NameSet own{};
  std::map<std::string, std::string> elements{};  ///< by the nodes' ids
  std::map<std::string, Link> helpers{};          ///< by all that is said of one
};

PatternsOut::PatternsOut(const graph::Graph& graph, const lang::Library& library, const gltf::Scene& scene,
                         const std::vector<SurfaceOut>& surfaces, const Moved& moved, Diagnostics& said,
                         Number number)
    : graph_(graph),
      scene_(scene),
      surfaces_(surfaces),
      moved_(moved),
      said_(said),
      number_(std::move(number)),
      contracts_(graph, library),
      bodies_(graph.groups.size() - surfaces.size()) {
  plan();
}

PatternsOut::~PatternsOut() = default;

void PatternsOut::lost(std::string message, std::string help) {
  addBoundedOnce(said_, {"not-said", Severity::Warning, {}, std::move(message), std::move(help), {}});
}

// -- colours and vectors --

void PatternsOut::mark(size_t group, const Source& source, bool color) {
  if (!color) return;
  const graph::Body& body = contracts_.body(group);
  if (const auto* ref = std::get_if<graph::NodeRef>(&source.from)) {
    const std::optional<size_t> place = body.find(ref->node);
    if (!place) return;
    const graph::Node& node = body.nodes()[*place];
    if (!node.group) {
      node_color_[group][*place] = true;
    } else if (const auto it = groups_.find(node.type); it != groups_.end()) {
      output_color_[it->second][ref->output] = true;
    }
  } else if (const auto* input = std::get_if<graph::InputRef>(&source.from)) {
    input_color_[group][input->name] = true;
  }
}

bool PatternsOut::colorOf(const lang::NodeDecl& decl, size_t group, const graph::Node& node) const {
  const std::string_view family = familyOf(decl);
  if (isOneOf(family, kOfVectors)) return false;
  if (isOneOf(family, kOfColors) || decl.category == "colortransform") return true;
  for (const auto& [name, source] : node.inputs) {
    // A decoded texture is a colour.
    const auto* ref = std::get_if<graph::TextureRef>(&source.from);
    const std::optional<size_t> place = ref == nullptr ? std::nullopt : graph_.findTexture(ref->name);
    if (place && graph_.textures[*place].srgb) return true;
  }
  // As a vector it has three components and no factor.
  const bool factor = std::any_of(node.inputs.begin(), node.inputs.end(),
                                  [](const auto& input) { return input.first == "factor"; });
  if (family == "gltf_image" && (factor || decl.results[0].type == Type::Vec4)) return true;
  const std::vector<graph::Node>& nodes = contracts_.body(group).nodes();
  return node_color_[group][static_cast<size_t>(&node - nodes.data())];
}

/// From what takes values to what gives them: a value is a colour where something wants one.
void PatternsOut::classify(size_t group) {
  const graph::Body& body = contracts_.body(group);
  for (const auto& [name, source] : body.outputs()) {
    const auto it = output_color_[group].find(name);
    mark(group, source, it != output_color_[group].end());
  }
  const std::vector<size_t> order = body.order().order;
  for (auto place = order.rbegin(); place != order.rend(); ++place) {
    if (!reached_[group][*place]) continue;
    const graph::Node& node = body.nodes()[*place];
    const graph::Contract* contract = contracts_.of(node);
    if (contract == nullptr || contract->decl == nullptr) continue;
    const bool color = colorOf(*contract->decl, group, node);
    node_color_[group][*place] = color;
    for (const auto& [name, source] : node.inputs) {
      const lang::Param* param = contract->param(name);
      if (param != nullptr) mark(group, source, portColor(*contract->decl, *param, color));
    }
  }
}

/// Which nodes anything takes a value of, and which groups have to be definitions: those with several
/// instances, or with one in another group.
void PatternsOut::instances() {
  std::vector<size_t> uses(graph_.groups.size(), 0);
  std::vector<bool> nested(graph_.groups.size(), false);
  std::vector<bool> given(graph_.groups.size(), false);
  std::vector<size_t> users = contracts_.groups().order;
  std::reverse(users.begin(), users.end());
  wanted_.resize(graph_.groups.size());
  for (size_t i = bodies_; i < graph_.groups.size(); ++i) wanted_[i] = true;
  for (const size_t group : users) {
    if (!wanted_[group]) continue;
    const graph::Body& body = contracts_.body(group);
    std::vector<bool>& reached = reached_[group];
    std::vector<size_t> left;
    const auto reach = [&](const Source& source) {
      const auto* ref = std::get_if<graph::NodeRef>(&source.from);
      const std::optional<size_t> place = ref == nullptr ? std::nullopt : body.find(ref->node);
      if (!place || reached[*place]) return;
      reached[*place] = true;
      left.push_back(*place);
    };
    for (const auto& [name, source] : body.outputs()) reach(source);
    while (!left.empty()) {
      const graph::Node& node = body.nodes()[left.back()];
      left.pop_back();
      for (const auto& [name, source] : node.inputs) reach(source);
      const auto it = node.group ? groups_.find(node.type) : groups_.end();
      if (it == groups_.end()) continue;
      wanted_[it->second] = true;
      ++uses[it->second];
      nested[it->second] = nested[it->second] || group < bodies_;
      given[it->second] = given[it->second] || !node.inputs.empty();
    }
  }
  for (size_t i = 0; i < bodies_; ++i) definition_[i] = nested[i] || (given[i] && uses[i] > 1);
}

void PatternsOut::plan() {
  const size_t count = graph_.groups.size();
  definition_.resize(count);
  input_color_.resize(count);
  output_color_.resize(count);
  for (size_t i = 0; i < count; ++i) {
    groups_.emplace(graph_.groups[i].name, i);
    node_color_.emplace_back(graph_.groups[i].nodes.size());
    reached_.emplace_back(graph_.groups[i].nodes.size());
  }
  instances();
  for (size_t i = 0; i < surfaces_.size(); ++i) {
    for (const SurfaceInput& input : surfaces_[i].inputs) {
      if (input.source) mark(bodies_ + i, *input.source, input.type == "color3");
    }
  }
  std::vector<size_t> users = contracts_.groups().order;
  std::reverse(users.begin(), users.end());
  for (const size_t group : users) classify(group);
}

// -- links --

PatternsOut::Link PatternsOut::helper(Scope& scope, std::string_view category, std::string_view name,
                                      Typed type, std::vector<Element> inputs) {
  std::string key = fmt::format("{} {}", category, typeName(type));
  for (const Element& input : inputs) {
    for (const auto& [attribute, value] : input.attributes) key += fmt::format(" {}={}", attribute, value);
  }
  const auto [it, fresh] = scope.helpers.try_emplace(std::move(key));
  if (!fresh) return it->second;
  Element element;
  element.category = category;
  element.attributes = {{"name", scope.names->free(materialx::graphName(name))}, {"type", typeName(type)}};
  element.children = std::move(inputs);
  it->second = {{{"nodename", std::string(element.name())}}, type};
  scope.into->children.push_back(std::move(element));
  return it->second;
}

/// What the template gives, as the node that reads it.
PatternsOut::Link PatternsOut::given(Scope& scope, const std::string& name) {
  if (name.starts_with("uv") && name.size() == 3) {
    std::vector<Element> inputs;
    if (name != "uv0") inputs.push_back(valueOf("index", "integer", name.substr(2)));
    return helper(scope, "texcoord", name, {Type::Vec2, false}, std::move(inputs));
  }
  const bool object = name.starts_with("object_");
  const std::string what = object ? name.substr(7) : name;
  constexpr std::string_view kGiven[] = {"position", "normal", "tangent"};
  if (isOneOf(what, kGiven))
    return helper(scope, what, name, {Type::Vec3, false},
                  {valueOf("space", "string", object ? "object" : "world")});
  if (name == "time" || name == "frame_number")
    return helper(scope, name == "time" ? name : "frame", name, {Type::Float, false}, {});
  lost(fmt::format("a pattern takes {} from the template, which MaterialX has no node for", name));
  return {{{"value", "0"}}, {Type::Float, false}};
}

PatternsOut::Link PatternsOut::nodeLink(Scope& scope, const graph::NodeRef& ref) {
  const graph::Body& body = contracts_.body(scope.group);
  const size_t place = body.find(ref.node).value_or(0);
  const graph::Node& node = body.nodes()[place];
  const graph::Contract* contract = contracts_.of(node);
  const size_t result = contract->result(ref.output).value_or(0);
  const Type type = contract->results[result].type;
  Link link;
  if (node.group) {
    const size_t group = groups_.at(node.type);
    const auto color = output_color_[group].find(std::string(contract->results[result].name));
    link.type = {type, hasColor(type) && color != output_color_[group].end()};
    const bool plain = !isDefinition(group);
    link.attributes = {{plain ? "nodegraph" : "nodename", scope.elements.at(ref.node)}};
    if (plain || contract->results.size() > 1)
      link.attributes.emplace_back("output", std::string(contract->results[result].name));
    return link;
  }
  link.type = {type, hasColor(type) && node_color_[scope.group][place]};
  link.attributes = {{"nodename", scope.elements.at(ref.node)}};
  if (contract->results.size() < 2) return link;
  std::string output(contract->results[result].name);
  // The components of a colour have other names than those of a vector.
  if (node.type.starts_with("separate") && output.size() == 4) {
    constexpr std::string_view kColors = "rgba";
    constexpr std::string_view kVectors = "xyzw";
    const size_t channel = std::min(kColors.find(output[3]), kVectors.find(output[3]));
    const bool color = node_color_[scope.group][place] && node.type != "separate2";
    if (channel < 4) output[3] = (color ? kColors : kVectors)[channel];
  }
  link.attributes.emplace_back("output", output);
  return link;
}

PatternsOut::Link PatternsOut::swizzled(Scope& scope, Link link, const std::string& swizzle) {
  const std::string components = graph::swizzleComponents(swizzle);
  const size_t count = components.size();
  const std::string& from = link.attributes[0].second;
  const auto input = [&](std::string_view name, const Link& of) {
    Element made = inputOf(name, typeName(of.type));
    for (const auto& [attribute, value] : of.attributes) made.set(attribute, value);
    return made;
  };
  constexpr Type kTypes[] = {Type::Float, Type::Vec2, Type::Vec3, Type::Vec4};
  const Type type = kTypes[count - 1];
  const bool color = link.type.color && hasColor(type);
  if (ir::componentCount(link.type.type) == 1)
    return count == 1 ? link : converted(scope, link, {type, false});
  std::vector<Link> parts;
  for (const char c : components) {
    parts.push_back(helper(
        scope, "extract", fmt::format("{}_{}", from, "xyzw"[static_cast<size_t>(c)]), {Type::Float, false},
        {input("in", link), valueOf("index", "integer", std::to_string(static_cast<int>(c)))}));
  }
  if (count == 1) return parts[0];
  std::vector<Element> inputs;
  for (size_t i = 0; i < count; ++i) inputs.push_back(input(fmt::format("in{}", i + 1), parts[i]));
  return helper(scope, fmt::format("combine{}", count), from + "_swizzled", {type, color}, std::move(inputs));
}

/// Colours and vectors, and a number where more are wanted.
PatternsOut::Link PatternsOut::converted(Scope& scope, Link link, Typed wanted) {
  wanted.color = wanted.color && hasColor(wanted.type);
  if (link.type == wanted || link.attributes[0].first == "value") return link;
  Element in = inputOf("in", typeName(link.type));
  for (const auto& [attribute, value] : link.attributes) in.set(attribute, value);
  const std::string name = fmt::format("{}_as_{}", link.attributes[0].second, typeName(wanted));
  return helper(scope, "convert", name, wanted, {std::move(in)});
}

PatternsOut::Link PatternsOut::link(Scope& scope, const Source& source) {
  Link made;
  if (const auto* ref = std::get_if<graph::NodeRef>(&source.from)) {
    made = nodeLink(scope, *ref);
  } else if (const auto* input = std::get_if<graph::InputRef>(&source.from)) {
    Type type = Type::Float;
    for (const graph::GroupInput& own : graph_.groups[scope.group].inputs) {
      if (own.name == input->name) type = own.type;
    }
    made = {{{"interfacename", input->name}},
            {type, hasColor(type) && input_color_[scope.group].contains(input->name)}};
  } else if (const auto* from = std::get_if<graph::GivenRef>(&source.from)) {
    made = given(scope, from->name);
    // The vertices' tangent has its side as the fourth.
    if (from->name.ends_with("tangent") && source.swizzle == "xyz") return made;
  } else if (const auto* attribute = std::get_if<graph::AttributeRef>(&source.from)) {
    made = helper(scope, "geompropvalue", attribute->name.substr(attribute->name.starts_with('_') ? 1 : 0),
                  {attribute->type, false}, {valueOf("geomprop", "string", attribute->name)});
  }
  return source.swizzle.empty() ? made : swizzled(scope, std::move(made), source.swizzle);
}

/// The numbers of a matrix that is written or a parameter, column by column; none of others.
std::vector<double> PatternsOut::matrixOf(const Source& source) const {
  if (const auto* literal = std::get_if<graph::Literal>(&source.from)) return literal->matrix;
  const auto* ref = std::get_if<graph::ParameterRef>(&source.from);
  const graph::Parameter* parameter = ref == nullptr ? nullptr : contracts_.parameter(ref->name);
  if (parameter == nullptr || !ir::isMatrix(parameter->type)) return {};
  return parameter->numbers();
}

/// A number that is written; nothing for what is computed.
std::optional<std::pair<Typed, Components>> PatternsOut::constant(const Source& source) const {
  Type type = Type::Float;
  Components value{};
  if (const auto* literal = std::get_if<graph::Literal>(&source.from)) {
    if (ir::isMatrix(literal->type)) return std::nullopt;
    type = literal->type;
    value = literal->value;
  } else if (const auto* ref = std::get_if<graph::ParameterRef>(&source.from)) {
    const graph::Parameter* parameter = contracts_.parameter(ref->name);
    if (parameter == nullptr || ir::isMatrix(parameter->type)) return std::nullopt;
    type = parameter->type;
    value = parameter->value;
  } else {
    return std::nullopt;
  }
  const std::string components = graph::swizzleComponents(source.swizzle);
  if (components.empty()) return std::pair{Typed{type, false}, value};
  Components picked{};
  for (size_t i = 0; i < components.size(); ++i) picked[i] = value[static_cast<size_t>(components[i])];
  constexpr Type kTypes[] = {Type::Float, Type::Vec2, Type::Vec3, Type::Vec4};
  return std::pair{Typed{kTypes[components.size() - 1], false}, picked};
}

void PatternsOut::give(Scope& scope, Element& element, std::string_view name, const Source& source,
                       Typed wanted) {
  Element input = inputOf(name, typeName(wanted));
  if (const std::vector<double> matrix = matrixOf(source); !matrix.empty()) {
    input.set("value", fmt::format("{}", fmt::join(matrix, ", ")));
  } else if (const auto number = constant(source)) {
    Components value = number->second;
    if (ir::componentCount(number->first.type) == 1) value.fill(value[0]);
    input.set("value", valueText(wanted.type, value));
  } else if (const auto* file = std::get_if<graph::TextureRef>(&source.from)) {
    // Of an instance; a node that samples it is not here.
    if (const std::optional<size_t> place = graph_.findTexture(file->name))
      texture(input, graph_.textures[*place]);
  } else {
    const Link made = converted(scope, link(scope, source), wanted);
    for (const auto& [attribute, value] : made.attributes) input.set(attribute, value);
  }
  element.children.push_back(std::move(input));
}

// -- elements --

std::string PatternsOut::fileOf(const graph::Texture& texture) {
  // A document names files, not URIs, from where it lies itself.
  const auto named = [&](const std::string& uri) {
    return uri.empty() || uri.starts_with("data:") ? uri : moved_(gltf::percentDecoded(uri));
  };
  if (texture.texture < 0) return named(texture.file);
  const auto number = static_cast<size_t>(texture.texture);
  const int image = number < scene_.textures.size() ? scene_.textures[number].image() : -1;
  if (image < 0 || static_cast<size_t>(image) >= scene_.images.size()) return {};
  const gltf::Image& found = scene_.images[static_cast<size_t>(image)];
  if (!found.uri.empty()) return named(found.uri);
  std::string file = fmt::format("image_{}.{}", image, found.mimeType == "image/jpeg" ? "jpg" : "png");
  addBounded(said_, {"embedded-image",
                     Severity::Warning,
                     {scene_.path, 0, 0, found.pointer},
                     "the image is in the file itself",
                     fmt::format("the document names it {}: put it there", file),
                     {}});
  return file;
}

void PatternsOut::texture(Element& input, const graph::Texture& texture) {
  input.set("type", "filename");
  if (number_) {
    if (const std::optional<uint64_t> number = number_(texture))
      input.set("texture", std::to_string(*number));
  } else {
    input.set("value", fileOf(texture));
  }
  if (texture.srgb) input.set("colorspace", "srgb_texture");
}

/// How a texture is read, as inputs of the node that reads it.
void PatternsOut::sampler(Element& element, const lang::NodeDecl& decl, const graph::Texture& texture,
                          Typed type, std::string_view ends) {
  const std::string_view family = familyOf(decl);
  std::array<graph::Wrap, 2> wrap = texture.wrap;
  bool nearest = texture.nearest;
  if (!texture.own_sampler && texture.texture >= 0 &&
      static_cast<size_t>(texture.texture) < scene_.textures.size()) {
    const gltf::Texture& of = scene_.textures[static_cast<size_t>(texture.texture)];
    constexpr int kClamp = 33071;
    constexpr int kMirror = 33648;
    constexpr int kNearest = 9728;
    const auto mode = [&](int gl) {
      return gl == kClamp ? graph::Wrap::Clamp : gl == kMirror ? graph::Wrap::Mirror : graph::Wrap::Repeat;
    };
    wrap = {mode(of.wrapS), mode(of.wrapT)};
    nearest = of.magFilter == kNearest;
  }
  constexpr const char* kModes[] = {"periodic", "clamp", "mirror"};
  const bool usd = family == "UsdUVTexture";
  for (size_t i = 0; i < 2; ++i) {
    const bool over = ends == "both" || ends == (i == 0 ? "u" : "v");
    if (wrap[i] == graph::Wrap::Repeat && !over) continue;
    if (!usd && !isOneOf(family, kAddressed)) {
      lost(fmt::format("{} of {} has no address modes", family, texture.name), "its image is repeated");
      break;
    }
    const char* name = i == 0 ? (usd ? "wrapS" : "uaddressmode") : (usd ? "wrapT" : "vaddressmode");
    const char* mode = over ? (usd ? "black" : "constant") : kModes[static_cast<size_t>(wrap[i])];
    element.children.push_back(valueOf(name, "string", mode));
  }
  if (nearest && isOneOf(family, kFiltered))
    element.children.push_back(valueOf("filtertype", "string", "closest"));
  // Beyond its edge an image has the node's own.
  if (!ends.empty() || !texture.color || *texture.color == Components{0, 0, 0, 0}) return;
  if (element.child("input", usd ? "fallback" : "default") != nullptr) return;
  if (usd || family == "gltf_colorimage") type = {Type::Vec4, true};
  element.children.push_back(
      valueOf(usd ? "fallback" : "default", typeName(type), valueText(type.type, *texture.color)));
}

void PatternsOut::element(Scope& scope, size_t place) {
  const graph::Node& node = contracts_.body(scope.group).nodes()[place];
  const graph::Contract* contract = contracts_.of(node);
  if (contract == nullptr) return;
  Element made;
  const std::string& name = scope.elements.at(node.id);
  if (node.group) {
    const size_t group = groups_.at(node.type);
    if (!isDefinition(group)) return;  // the nodegraph stands for it
    made.category = node.type;
    Typed type{contract->results[0].type, false};
    const auto color = output_color_[group].find(std::string(contract->results[0].name));
    type.color = color != output_color_[group].end();
    made.attributes = {{"name", name},
                       {"type", contract->results.size() > 1 ? "multioutput" : typeName(type)}};
    for (const auto& [input, source] : node.inputs) {
      const lang::Param* param = contract->param(input);
      if (param == nullptr) continue;
      give(scope, made, input, source, {param->type, input_color_[group].contains(input)});
    }
    scope.into->children.push_back(std::move(made));
    return;
  }
  const lang::NodeDecl& decl = *contract->decl;
  const bool color = node_color_[scope.group][place];
  Typed type{decl.results[0].type, false};
  type.color = color && hasColor(type.type);
  const std::string_view family = familyOf(decl);
  made.category = family == "texel_product" ? "multiply" : std::string(family);
  made.attributes = {{"name", name}, {"type", decl.results.size() > 1 ? "multioutput" : typeName(type)}};
  if (!decl.source.starts_with("MaterialX"))
    lost(fmt::format("the node {} is none of MaterialX's", family),
         "who reads the document needs a definition of it");
  std::string_view ends;
  for (const auto& [input, source] : node.inputs) {
    const lang::Param* param = contract->param(input);
    if (input != kEnds || param == nullptr || param->choices.empty()) continue;
    const auto* choice = std::get_if<graph::Choice>(&source.from);
    const auto number = constant(source);
    if (choice == nullptr && !number)
      lost(fmt::format("MaterialX's {} has no input {}", family, input), "it is left out");
    else
      ends = choice != nullptr ? choice->name : wordOf(*param, number->second[0]);
  }
  if (ends == "none") ends = {};
  for (const auto& [input, source] : node.inputs) {
    const lang::Param* param = contract->param(input);
    if (input == kEnds && param != nullptr) continue;
    if (input == "default" || input == "fallback") {
      if (ends.empty() && contract->param(kEnds) != nullptr) continue;  // the texture's alone
      std::erase_if(made.children, [&own = input](const Element& child) { return child.name() == own; });
    }
    if (param == nullptr || (param->hints.advanced && !param->given.empty())) continue;
    const bool own =
        isOneOf(input, kOwnPorts) || (family == "gltf_normalmap" && isOneOf(input, kOwnOfNormalMaps));
    if (own) {
      const auto number = constant(source);
      if (!number || !param->default_value || number->second != *param->default_value)
        lost(fmt::format("MaterialX's {} has no input {}", family, input), "it is left out");
      continue;
    }
    std::string port = input;
    if (family == "texel_product") port = input == "a" ? "in1" : "in2";
    const bool number_port = isOneOf(port, kNumberPorts);
    const bool of_attribute = (family == "geompropvalue" && port == "geomprop") ||
                              (family == "UsdPrimvarReader" && port == "varname");
    if (const auto* choice = std::get_if<graph::Choice>(&source.from)) {
      const auto chosen = std::find(param->choices.begin(), param->choices.end(), choice->name);
      made.children.push_back(number_port
                                  ? valueOf(port, "integer", std::to_string(chosen - param->choices.begin()))
                                  : valueOf(port, "string", choice->name));
    } else if (const auto* attribute = std::get_if<graph::AttributeRef>(&source.from);
               attribute != nullptr && of_attribute && source.swizzle.empty()) {
      made.children.push_back(valueOf(port, "string", attribute->name));
    } else if (of_attribute) {
      lost(fmt::format("MaterialX's {} takes the name of an attribute", family), "its input is left out");
    } else if (const auto* ref = std::get_if<graph::TextureRef>(&source.from)) {
      const std::optional<size_t> slot = graph_.findTexture(ref->name);
      if (!slot) continue;
      Element file = inputOf(port, "filename");
      texture(file, graph_.textures[*slot]);
      made.children.push_back(std::move(file));
      sampler(made, decl, graph_.textures[*slot], type, ends);
    } else {
      give(scope, made, port, source, {param->type, portColor(decl, *param, color)});
      Element& last = made.children.back();
      const auto number = constant(source);
      if (param->choices.empty() || number_port || !number) continue;
      last.set("type", "string");
      last.set("value", std::string(wordOf(*param, number->second[0])));
    }
  }
  scope.into->children.push_back(std::move(made));
}

void PatternsOut::body(Scope& scope, const std::vector<bool>& reached) {
  const graph::Body& body = contracts_.body(scope.group);
  for (size_t i = 0; i < body.nodes().size(); ++i) {
    const graph::Node& node = body.nodes()[i];
    if (!reached[i]) continue;
    const auto it = node.group ? groups_.find(node.type) : groups_.end();
    const bool plain = it != groups_.end() && !isDefinition(it->second);
    scope.elements[node.id] = plain ? node.type : scope.names->free(materialx::graphName(node.id));
  }
  for (size_t i = 0; i < body.nodes().size(); ++i) {
    if (reached[i]) element(scope, i);
  }
}

void PatternsOut::group(size_t group, Element& root) {
  const graph::Group& of = graph_.groups[group];
  Element made;
  made.category = "nodegraph";
  made.attributes = {{"name", of.name}};
  Scope scope;
  scope.group = group;
  scope.names = &scope.own;
  std::vector<Element> ports;
  for (const graph::GroupInput& input : of.inputs) {
    const Typed type{input.type, hasColor(input.type) && input_color_[group].contains(input.name)};
    scope.own.take(input.name);
    Element port = inputOf(input.name, typeName(type));
    const Source* source = input.by_default ? &*input.by_default : nullptr;
    const auto* given = source == nullptr ? nullptr : std::get_if<graph::GivenRef>(&source->from);
    const auto* file = source == nullptr ? nullptr : std::get_if<graph::TextureRef>(&source->from);
    const auto number = source == nullptr ? std::nullopt : constant(*source);
    constexpr std::pair<std::string_view, std::string_view> kGiven[] = {
        {"uv0", "UV0"}, {"uv1", "UV1"}, {"position", "Pworld"}, {"normal", "Nworld"}, {"tangent", "Tworld"}};
    for (const auto& [name, geomprop] : kGiven) {
      if (given != nullptr && given->name == name) port.set("defaultgeomprop", std::string(geomprop));
    }
    if (file != nullptr) {
      if (const std::optional<size_t> slot = graph_.findTexture(file->name))
        texture(port, graph_.textures[*slot]);
    } else if (number) {
      Components value = number->second;
      if (ir::componentCount(number->first.type) == 1) value.fill(value[0]);
      port.set("value", valueText(input.type, value));
    }
    ports.push_back(std::move(port));
  }
  for (const auto& [name, source] : of.outputs) scope.own.take(name);
  const bool definition = isDefinition(group);
  if (definition) {
    Element nodedef;
    nodedef.category = "nodedef";
    nodedef.attributes = {{"name", "ND_" + of.name}, {"node", of.name}};
    nodedef.children = ports;
    made.set("nodedef", "ND_" + of.name);
    for (const auto& [name, source] : of.outputs) {
      const std::optional<graph::Offer> offer = contracts_.offer(source, contracts_.body(group));
      const Typed type{offer ? offer->type : Type::Float, output_color_[group].contains(name)};
      Element output = inputOf(name, typeName(type));
      output.category = "output";
      nodedef.children.push_back(std::move(output));
    }
    root.children.push_back(std::move(nodedef));
  } else {
    // What is connected stands at the only instance.
    for (size_t i = bodies_; i < graph_.groups.size(); ++i) {
      for (size_t k = 0; k < graph_.groups[i].nodes.size(); ++k) {
        const graph::Node& node = graph_.groups[i].nodes[k];
        if (!node.group || node.type != of.name || !reached_[i][k]) continue;
        for (const auto& [name, source] : node.inputs) {
          for (Element& port : ports) {
            if (port.name() != name) continue;
            Element connected;
            give(*scopes_[i - bodies_], connected, name, source, *typedOf(port.get("type")));
            for (const auto& [attribute, value] : connected.children[0].attributes)
              port.set(attribute, value);
          }
        }
      }
    }
  }
  Element nodes;
  scope.into = &nodes;
  body(scope, reached_[group]);
  std::vector<Element> outputs;
  for (const auto& [name, source] : of.outputs) {
    const std::optional<graph::Offer> offer = contracts_.offer(source, contracts_.body(group));
    const Typed type{offer ? offer->type : Type::Float, output_color_[group].contains(name)};
    Element holder;
    give(scope, holder, name, source, type);
    holder.children[0].category = "output";
    outputs.push_back(std::move(holder.children[0]));
  }
  Element asking;
  asking.children = outputs;
  orderElements(nodes.children, {asking});
  if (!definition) made.children = std::move(ports);
  for (std::vector<Element>* list : {&nodes.children, &outputs})
    std::move(list->begin(), list->end(), std::back_inserter(made.children));
  root.children.push_back(std::move(made));
}

void PatternsOut::write(Element& root) {
  for (size_t i = 0; i < bodies_; ++i) {
    names_.take(graph_.groups[i].name);
    names_.take("ND_" + graph_.groups[i].name);
  }
  for (size_t i = 0; i < surfaces_.size(); ++i) {
    Scope& scope = *scopes_.emplace_back(std::make_unique<Scope>());
    scope.group = bodies_ + i;
    scope.into = &root;
    scope.names = &names_;
    body(scope, reached_[bodies_ + i]);
  }
  // Definitions stand before what uses them: nothing asks for it, but people read it so.
  for (const size_t i : contracts_.groups().order) {
    if (i < bodies_ && wanted_[i]) group(i, root);
  }
}

void PatternsOut::inputs(size_t surface, Element& shader) {
  for (const SurfaceInput& input : surfaces_[surface].inputs) {
    if (input.source) {
      give(*scopes_[surface], shader, input.name, *input.source, *typedOf(input.type));
    } else {
      const Type type = *materialx::typeOf(input.type);
      shader.children.push_back(valueOf(input.name, input.type, valueText(type, input.value)));
    }
  }
}

}  // namespace lacquer::exchange
