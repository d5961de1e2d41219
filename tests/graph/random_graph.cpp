#include "graph/random_graph.h"

#include <bit>
#include <cmath>
#include <limits>

namespace lacquer::test {

namespace {

using graph::Source;
using ir::Type;

class Maker {
public:
  explicit Maker(std::mt19937_64& random) : random_(random) {}

  graph::Graph graph() {
    graph::Graph graph;
    graph.name = text();
    graph.template_name = text();
    for (size_t i = pick(4); i > 0; --i) graph.parameters.push_back(parameter(i));
    for (size_t i = pick(4); i > 0; --i) graph.textures.push_back(texture(i));
    for (size_t i = pick(3); i > 0; --i) graph.groups.push_back(group(i));
    graph.nodes = nodes();
    graph.outputs = sources();
    for (size_t i = pick(3); i > 0; --i) graph.skipped.push_back({unique(i), text()});
    graph.ui = ui();
    return graph;
  }

private:
  size_t pick(size_t count) { return random_() % count; }

  /// Any text, with all that JSON must escape.
  std::string text() {
    static const std::vector<std::string> kPieces = {"a",      "coat.",      "_",  "\"",   "\\",   "/",
                                                     "~",      "\n",         "\t", "\x01", "\x7f", "é",
                                                     "\u2028", "\U0001F600", " ",  "<b>"};
    std::string text;
    for (size_t i = pick(6); i > 0; --i) text += kPieces[pick(kPieces.size())];
    return text;
  }

  /// Different for each i.
  std::string unique(size_t i) { return text() + std::to_string(i); }

  Type valueType() {
    constexpr std::array kTypes = {Type::Float, Type::Vec2, Type::Vec3, Type::Vec4, Type::Bool};
    return kTypes[pick(kTypes.size())];
  }

  ir::Components components(Type type) {
    ir::Components value{};
    if (type == Type::Bool)
      value[0] = static_cast<double>(pick(2));
    else
      for (int i = 0; i < ir::componentCount(type); ++i)
        value[static_cast<size_t>(i)] = randomDouble(random_);
    return value;
  }

  ir::Range range() {
    ir::Range range;
    if (pick(2) == 0) range.lo = randomDouble(random_);
    if (pick(2) == 0) range.hi = randomDouble(random_);
    if (pick(3) == 0) range = {{0, range.hi}, std::abs(randomDouble(random_)) + 1e-300};
    return range;
  }

  /// Any JSON of a tool's, on one line; often none.
  std::string ui() {
    static const std::vector<std::string> kTexts = {
        "null", "true", "[1,2.5,-3]", R"({"x":12,"y":-7.25,"color":"#ff8000"})",
        R"({"comment":"a \"word\"\n","collapsed":false,"deep":[[{"":[]}],{}]})"};
    return pick(3) == 0 ? kTexts[pick(kTexts.size())] : std::string();
  }

  graph::Parameter parameter(size_t i) {
    graph::Parameter parameter;
    parameter.name = unique(i);
    parameter.type = valueType();
    parameter.value = components(parameter.type);
    parameter.range = range();
    parameter.pointer = text();
    parameter.animated = pick(4) == 0;
    parameter.ui = ui();
    return parameter;
  }

  std::vector<graph::Node> nodes() {
    graph::Graph graph;
    for (size_t i = pick(6); i > 0; --i) {
      graph::Node& node = graph.nodes[graph.add(text(), text())];
      node.group = pick(4) == 0;
      if (!node.group && pick(2) == 0) node.variant = text();
      if (!node.group && pick(2) == 0) node.term = text();
      if (!node.group && pick(2) == 0) node.place = static_cast<uint32_t>(pick(1000));
      node.at_vertices = !node.group && pick(4) == 0;
      node.inputs = sources();
      node.ui = ui();
    }
    return graph.nodes;
  }

  graph::Group group(size_t i) {
    graph::Group group;
    group.name = unique(i);
    for (size_t k = pick(4); k > 0; --k) {
      graph::GroupInput& input = group.inputs.emplace_back();
      input.name = unique(k);
      constexpr std::array kTypes = {Type::Float, Type::Vec3, Type::Bool, Type::Int, Type::Texture2D};
      input.type = kTypes[pick(kTypes.size())];
      input.range = range();
      if (pick(2) == 0) input.by_default = source();
      input.ui = ui();
    }
    group.nodes = nodes();
    group.outputs = sources();
    group.ui = ui();
    return group;
  }

  graph::Texture texture(size_t i) {
    graph::Texture slot;
    slot.name = unique(i);
    slot.type = pick(2) == 0 ? Type::Texture2D : Type::TextureCube;
    slot.srgb = pick(2) == 0;
    slot.texture = static_cast<int>(pick(5)) - 1;
    slot.pointer = text();
    if (pick(3) == 0) slot.file = text();
    for (graph::Wrap& wrap : slot.wrap) wrap = static_cast<graph::Wrap>(pick(3));
    slot.nearest = pick(2) == 0;
    slot.own_sampler =
        slot.texture >= 0 && slot.file.empty() &&
        (slot.wrap[0] != graph::Wrap::Repeat || slot.wrap[1] != graph::Wrap::Repeat || slot.nearest);
    if (pick(3) == 0) slot.color = components(Type::Vec4);
    slot.ui = ui();
    return slot;
  }

  Source source() {
    Source source;
    switch (pick(7)) {
      case 0: {
        const Type type = valueType();
        source.from = graph::Literal{type, components(type)};
        break;
      }
      case 1: source.from = graph::ParameterRef{text()}; break;
      case 2: source.from = graph::TextureRef{text()}; break;
      case 3: source.from = graph::GivenRef{text()}; break;
      case 4: source.from = graph::InputRef{text()}; break;
      case 5: source.from = graph::AttributeRef{text(), ir::floatType(static_cast<int>(pick(4)) + 1)}; break;
      default: source.from = graph::NodeRef{text(), pick(2) == 0 ? std::string() : text()}; break;
    }
    if (pick(3) == 0) source.swizzle = pick(2) == 0 ? "xyz" : text();
    return source;
  }

  std::vector<std::pair<std::string, Source>> sources() {
    std::vector<std::pair<std::string, Source>> list;
    for (size_t i = pick(5); i > 0; --i) list.emplace_back(unique(i), source());
    return list;
  }

  std::mt19937_64& random_;
};

}  // namespace

graph::Graph randomGraph(std::mt19937_64& random) { return Maker(random).graph(); }

double randomDouble(std::mt19937_64& random) {
  switch (random() % 6) {
    case 0: return static_cast<double>(random() % 2000) - 1000;
    case 1: return static_cast<double>(random() % 2000) / 1000;
    case 2: return random() % 2 == 0 ? -0.0 : 0.0;
    case 3: return std::numeric_limits<double>::denorm_min() * static_cast<double>(random() % 100);
    case 4: return std::ldexp(1.0, static_cast<int>(random() % 100)) + 1;
    default: break;
  }
  while (true) {
    const auto x = std::bit_cast<double>(static_cast<uint64_t>(random()));
    if (std::isfinite(x)) return x;
  }
}

}  // namespace lacquer::test
