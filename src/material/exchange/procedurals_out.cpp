#include "exchange/procedurals_out.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "exchange/pattern_out.h"
#include "exchange/surface_out.h"
#include "graph/contracts.h"
#include "graph/text.h"
#include "mtlx/values.h"
#include "support/plain_name.h"
#include "support/say_once.h"

namespace lacquer::exchange {

using graph::Source;
using json::Json;
using materialx::Element;

namespace {

Source numberSource(double x) { return {graph::Literal{ir::Type::Float, {x}}, {}}; }

Source vectorSource(double x) { return {graph::Literal{ir::Type::Vec3, {x, x, x}}, {}}; }

/// The nodes behind texels, which are this library's own, in MaterialX's terms.
class Texels {
public:
  explicit Texels(std::vector<graph::Node>& nodes) : nodes_(nodes) {
    for (size_t i = 0; i < nodes.size(); ++i) places_.emplace(nodes[i].id, i);
  }

  /// What a texel is made of, as a number, a colour or a colour with alpha.
  Source value(const Source& texel) {
    const auto* ref = std::get_if<graph::NodeRef>(&texel.from);
    const auto it = ref == nullptr ? places_.end() : places_.find(ref->node);
    if (it == places_.end() || !texel.swizzle.empty()) return texel;
    const graph::Node node = nodes_[it->second];
    if (node.type.starts_with("texel_of<")) return input(node, "value").value_or(numberSource(0));
    if (node.type == "texel_of_color") {
      const Source color = input(node, "color").value_or(vectorSource(1));
      const std::optional<Source> alpha = input(node, "a");
      if (!alpha) return color;
      return add(
          node.id, "combine4",
          {{"in1", part(color, 0)}, {"in2", part(color, 1)}, {"in3", part(color, 2)}, {"in4", *alpha}});
    }
    if (node.type != "texel_of_channels") return texel;
    const auto channel = [&](std::string_view name) { return input(node, name).value_or(numberSource(1)); };
    graph::Inputs inputs{{"in1", channel("r")}, {"in2", channel("g")}, {"in3", channel("b")}};
    const std::optional<Source> alpha = input(node, "a");
    if (alpha) inputs.emplace_back("in4", *alpha);
    return add(node.id, alpha ? "combine4" : "combine3", std::move(inputs));
  }

  void rewrite() {
    const size_t count = nodes_.size();
    for (size_t i = 0; i < count; ++i) {
      graph::Node& node = nodes_[i];
      if (node.type == "texel_luminance") {
        node.type = "dotproduct<vec3>";
        node.inputs = {{"in1", input(node, "color").value_or(vectorSource(0))},
                       {"in2", {graph::Literal{ir::Type::Vec3, {0.2126, 0.7152, 0.0722}}, {}}}};
      } else if (node.type == "texel_normal") {
        const Source normal = input(node, "normal").value_or(vectorSource(0));
        const std::string id = node.id;
        node.type = "add<vec3>";
        node.inputs.clear();
        const Source half = add(id, "multiply<vec3>", {{"in1", normal}, {"in2", vectorSource(0.5)}});
        nodes_[i].inputs = {{"in1", half}, {"in2", vectorSource(0.5)}};
      }
    }
  }

private:
  static std::optional<Source> input(const graph::Node& node, std::string_view name) {
    for (const auto& [own, source] : node.inputs) {
      if (own == name) return source;
    }
    return std::nullopt;
  }

  static Source part(Source source, size_t channel) {
    if (auto* literal = std::get_if<graph::Literal>(&source.from);
        literal != nullptr && source.swizzle.empty())
      return numberSource(literal->type == ir::Type::Float ? literal->value[0] : literal->value[channel]);
    source.swizzle = graph::swizzleBehind(source.swizzle, std::string(1, "xyzw"[channel]));
    return source;
  }

  Source add(const std::string& beside, std::string type, graph::Inputs inputs) {
    std::string id = beside + "_value";
    for (size_t n = 2; places_.contains(id); ++n) id = fmt::format("{}_value_{}", beside, n);
    places_.emplace(id, nodes_.size());
    graph::Node& node = nodes_.emplace_back();
    node.id = id;
    node.type = std::move(type);
    node.inputs = std::move(inputs);
    return {graph::NodeRef{id, {}}, {}};
  }

  std::vector<graph::Node>& nodes_;
  std::map<std::string, size_t, std::less<>> places_;
};

/// A value of an input as the extension has it: numbers in an array, even one; a boolean or a text as it is.
Json valueJson(const Element& input) {
  Json made = Json::array();
  const std::string_view type = input.get("type");
  const std::optional<ir::Type> known = materialx::typeOf(type);
  if (type == "boolean") {
    return Json(input.get("value") == "true");
  } else if (!known || ir::isTexture(*known) || type == "string") {
    return Json(input.get("value"));
  } else if (const auto numbers = materialx::numbersOf(input.get("value"))) {
    for (const double x : *numbers)
      made.push_back(type == "integer" ? Json(static_cast<int64_t>(x)) : Json(x));
  }
  return made;
}

/// By their names the places of a graph's nodes, by which the extension refers to them.
using Places = std::map<std::string, uint64_t, std::less<>>;

Json portOf(const Element& port, const Places& places) {
  Json made = Json::object();
  made["nodetype"] = port.category;
  made["type"] = port.get("type");
  for (const char* key : {"colorspace", "unit", "unittype"}) {
    if (const std::string* text = port.find(key)) made[key] = *text;
  }
  if (const std::string* node = port.find("nodename")) made["node"] = places.at(*node);
  if (const std::string* output = port.find("output")) made["output"] = *output;
  if (const std::string* texture = port.find("texture"))
    made["texture"] = static_cast<uint64_t>((*materialx::numbersOf(*texture))[0]);
  else if (port.find("value") != nullptr)
    made["value"] = valueJson(port);
  return made;
}

/// The ports by which others take values of a node that has several.
using Taken = std::map<std::string, std::map<std::string, std::string>>;

void takes(const Element& element, Taken& taken) {
  for (const Element& port : element.children) {
    const std::string* node = port.find("nodename");
    if (node != nullptr)
      taken[*node].emplace(port.find("output") == nullptr ? "out" : std::string(port.get("output")),
                           port.get("type"));
  }
}

Json nodeOf(const Element& element, const Taken& taken, const Places& places) {
  Json made = Json::object();
  made["name"] = element.name();
  made["nodetype"] = element.category;
  made["type"] = element.get("type");
  Json inputs = Json::object();
  for (const Element& input : element.children) inputs[std::string(input.name())] = portOf(input, places);
  made["inputs"] = std::move(inputs);
  Json outputs = Json::object();
  const auto it = taken.find(std::string(element.name()));
  if (element.get("type") != "multioutput") {
    outputs["out"]["nodetype"] = "output";
    outputs["out"]["type"] = element.get("type");
  } else if (it != taken.end()) {
    for (const auto& [name, type] : it->second) {
      outputs[name]["nodetype"] = "output";
      outputs[name]["type"] = type;
    }
  }
  made["outputs"] = std::move(outputs);
  return made;
}

}  // namespace

ProceduralsOut::Written ProceduralsOut::ofGroup(const graph::Graph& patterns, std::string_view group) {
  constexpr std::string_view kInstance = "p";
  graph::Graph graph = patterns;
  graph::Node& node = graph.nodes.emplace_back();
  node.id = kInstance;
  node.type = group;
  node.group = true;
  // Definitions that use each other twice double with each: what is too much is not written out.
  for (Diagnostic& one : graph::check(graph, *schema_.library)) {
    if (one.code != "graph-too-large" && one.code != "groups-too-deep") continue;
    said_.push_back(std::move(one));
    return {};
  }
  graph::FlatOutputs told;
  graph = graph::flattened(std::move(graph), *schema_.library, &told);
  graph::Outputs outputs = told.at(std::string(kInstance));
  // Nobody sees the instance, so the names of its nodes go without it.
  const auto shorten = [&](std::string& id) { id.erase(0, kInstance.size() + 1); };
  const auto shortened = [&](Source& source) {
    if (auto* ref = std::get_if<graph::NodeRef>(&source.from)) shorten(ref->node);
  };
  for (graph::Node& one : graph.nodes) {
    shorten(one.id);
    for (auto& [input, source] : one.inputs) shortened(source);
  }
  for (auto& [port, source] : outputs) shortened(source);
  return write(std::move(graph), group, std::move(outputs));
}

ProceduralsOut::Written ProceduralsOut::ofSources(const graph::Graph& flat, std::string_view name,
                                                  const graph::Outputs& sources) {
  return write(flat, name, sources);
}

/// Whether the extension has all that an output is computed from; what it lacks is said.
bool ProceduralsOut::isWhole(const graph::Graph& flat, const std::pair<std::string, Source>& output,
                             std::string_view type) {
  std::vector<SurfaceOut> surfaces(1);
  graph::Graph alone = flat;
  alone.groups[0].outputs = {output};
  surfaces[0].body = alone.groups[0];
  surfaces[0].inputs.push_back({output.first, type, {}, output.second});
  Diagnostics lacks;
  const auto number = [&](const graph::Texture& texture) -> std::optional<uint64_t> {
    if (graph::tileToken(texture.file).empty()) return 0;
    addBoundedOnce(lacks,
                   {"not-said",
                    Severity::Warning,
                    texture.place,
                    fmt::format("{} has an image for each tile, which glTF has no texture for", texture.name),
                    "there is no procedural of it: the texture is the baked image",
                    {}});
    return std::nullopt;
  };
  const Moved stays(".", ".");
  PatternsOut patterns(alone, *schema_.library, scene_, surfaces, stays, lacks, number);
  Element root, shader;
  patterns.write(root);
  patterns.inputs(0, shader);
  for (Diagnostic& one : lacks) addBoundedOnce(said_, std::move(one));
  return lacks.empty();
}

/// An output of a procedural has no value of its own: a node gives it.
static Element constantOf(Element& port, std::string name) {
  Element value = port, node;
  value.set("name", "value");
  node.category = "constant";
  node.attributes = {{"name", name}, {"type", std::string(port.get("type"))}};
  node.children.push_back(std::move(value));
  std::erase_if(port.attributes, [](const auto& one) { return one.first != "name" && one.first != "type"; });
  port.set("nodename", std::move(name));
  return node;
}

ProceduralsOut::Written ProceduralsOut::write(graph::Graph flat, std::string_view name,
                                              graph::Outputs outputs) {
  Texels texels(flat.nodes);
  for (auto& [port, source] : outputs) source = texels.value(source);
  texels.rewrite();
  graph::Group body;
  body.name = "_procedural";
  body.nodes = std::move(flat.nodes);
  body.outputs = outputs;
  flat.nodes.clear();
  flat.outputs.clear();
  flat.groups = {body};
  std::vector<std::string_view> types;
  {
    const graph::Contracts contracts(flat, *schema_.library);
    for (const auto& [port, source] : outputs) {
      const std::optional<graph::Offer> offer = contracts.offer(source, contracts.body(0));
      const ir::Type type = offer ? offer->type : ir::Type::Float;
      types.push_back(type == ir::Type::Vec3   ? "color3"
                      : type == ir::Type::Vec4 ? "color4"
                                               : materialx::nameOf(type));
    }
  }
  Written written{list_.size(), {}};
  std::vector<SurfaceOut> surfaces(1);
  body.outputs.clear();
  for (size_t i = 0; i < outputs.size(); ++i) {
    if (!isWhole(flat, outputs[i], types[i])) continue;
    written.outputs.insert(outputs[i].first);
    body.outputs.push_back(outputs[i]);
    surfaces[0].inputs.push_back({outputs[i].first, types[i], {}, outputs[i].second});
  }
  if (written.outputs.empty()) return written;
  flat.groups = {body};
  surfaces[0].body = body;
  const Moved stays(".", ".");
  PatternsOut patterns(flat, *schema_.library, scene_, surfaces, stays, said_, number_);
  Element root;
  patterns.write(root);
  Element shader;
  patterns.inputs(0, shader);
  for (Element& port : shader.children) {
    if (port.find("value") != nullptr) root.children.push_back(constantOf(port, patterns.free(port.name())));
  }
  orderElements(root.children, {shader});
  Taken taken;
  for (const Element& element : root.children) takes(element, taken);
  takes(shader, taken);
  Json made = Json::object();
  made["name"] = name;
  made["nodetype"] = "nodegraph";
  made["type"] = surfaces[0].inputs.size() == 1 ? surfaces[0].inputs[0].type : "multioutput";
  made["inputs"] = Json::object();
  Json nodes = Json::array();
  Places places;
  for (const Element& element : root.children) places.emplace(element.name(), places.size());
  for (const Element& element : root.children) nodes.push_back(nodeOf(element, taken, places));
  made["nodes"] = std::move(nodes);
  Json ports = Json::object();
  for (Element& port : shader.children) {
    port.category = "output";
    ports[std::string(port.name())] = portOf(port, places);
  }
  made["outputs"] = std::move(ports);
  list_.push_back(std::move(made));
  return written;
}

Json ProceduralsOut::extension() const {
  Json made = Json::object();
  made["procedurals"] = list_;
  return made;
}

}  // namespace lacquer::exchange
