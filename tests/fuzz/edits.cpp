// Sequences of edits of a graph, written from any bytes: whatever is done, in any order, what fails changes
// nothing, a call does what the same edit in JSON does, and what takes the edits back leaves the same bytes.
#include <fmt/format.h>

#include <array>
#include <functional>
#include <vector>

#include "choices.h"
#include "feeds.h"

namespace lacquer::fuzz {

namespace {

/// A graph of its own in a group, and one group in another.
constexpr std::string_view kGroups = R"({"lacquer_graph": 1, "name": "rusty", "template": "bsdf",
  "parameters": {"rust": {"type": "float", "value": 0.25, "range": [0, 1]}, "tint": {"type": "vec3", "value": [1, 0.5, 0.25], "range": [0, 1]},
    "n": {"type": "float", "value": 1.5, "range": [1, null], "or_zero": true}},
  "textures": {"mask": {"type": "sampler2D", "file": "rust.png", "wrap": "mirror", "default": [0, 0, 0, 1]}},
  "groups": {
    "worn": {"inputs": {"color": {"type": "vec3"}, "amount": {"type": "float", "default": 0.5, "range": [0, 1]},
        "image": {"type": "sampler2D", "default": {"texture": "mask"}}, "uv": {"type": "vec2", "default": {"given": "uv0"}}},
      "nodes": [{"id": "texel", "node": "texture_sample", "inputs": {"image": {"input": "image"}, "uv": {"input": "uv"}}, "ui": {"x": 40}},
        {"id": "glow", "node": "emission", "inputs": {"factor": {"input": "color"}, "strength": {"input": "amount"}, "texel": {"node": "texel", "swizzle": "rgb"}}}],
      "outputs": {"light": {"node": "glow"}, "mask": {"node": "texel", "swizzle": "a"}}},
    "twice": {"inputs": {"color": {"type": "vec3", "default": {"parameter": "tint"}}},
      "nodes": [{"id": "a", "group": "worn", "inputs": {"color": {"input": "color"}}},
        {"id": "sum", "node": "add", "inputs": {"in1": {"node": "a", "output": "light"}, "in2": {"node": "a", "output": "mask"}}}],
      "outputs": {"light": {"node": "sum"}}, "ui": 1}},
  "nodes": [{"id": "iron", "group": "worn", "inputs": {"color": 1, "amount": {"parameter": "rust"}}},
    {"id": "two", "group": "twice"},
    {"id": "F0", "node": "coat_boundary_f0", "inputs": {"ior": {"parameter": "n"}}}],
  "outputs": {"emission": {"node": "two", "output": "light"}, "alpha": {"node": "iron", "output": "mask"}}, "skipped": {}})";
constexpr std::string_view kLeast =
    R"({"lacquer_graph": 1, "template": "surface", "outputs": {"base_color": [1, 1, 1]}})";
constexpr std::string_view kForward = R"({"lacquer_graph": 1, "template": "forward",
  "nodes": [{"id": "e", "node": "emission", "inputs": {"factor": [1, 0.5, 0.25], "strength": 2.5}}],
  "outputs": {"emission": {"node": "e"}}})";
constexpr std::array kStarts = {kGroups, kLeast, kForward};

constexpr std::array kNames = {"a", "b", "worn", "iron", "my.own", "9", "a/b", "rust"};
constexpr std::array kTypes = {"emission", "texture_sample", "add", "schlick", "coat_boundary_f0", "nothing"};
constexpr std::array kInputs = {"color", "amount", "image", "uv",     "factor", "strength",
                                "texel", "in1",    "in2",   "cosine", "F0",     "ior"};
constexpr std::array kPorts = {"emission", "alpha", "base_color", "light", "mask", "nowhere"};
constexpr std::array kSources = {"0.5",
                                 "1",
                                 "-3e38",
                                 "1e39",
                                 "[0.25, 0.5, 1]",
                                 "[1",
                                 "true",
                                 R"({"given": "uv0"})",
                                 R"({"given": "view", "swizzle": "zyx"})",
                                 R"({"value": [1, 0, 0], "swizzle": "xx"})",
                                 R"({"input": "color"})",
                                 R"({"input": "amount"})",
                                 R"({"nothing": 1})"};
constexpr std::array kKinds = {"float", "vec2", "vec3", "vec4", "bool", "sampler2D"};
constexpr std::array kUi = {R"({"x": 1, "y": [2, null]})", "null", R"("\u0000")", "-0.0", "{}"};
constexpr std::array kNumbers = {0.0, 0.25, 1.0, 1.5, -1.0, 1e30, 1e300};

/// Edits that a sequence has at most, and bytes of a graph: groups that are put in their places can double
/// it.
constexpr size_t kMostEdits = 40;
constexpr size_t kMostText = size_t{64} << 10;
/// A graph is put into itself while it has less.
constexpr size_t kSmallText = size_t{8} << 10;
/// Of the inputs, one in so many has shaders made, at first and at last.
constexpr uint64_t kShadersEvery = 8;

/// An edit in its JSON form and, where there is one, the call that does the same.
struct Step {
  std::string json;
  std::function<bool(Graph&, Messages&)> call{};
  /// There is no JSON form: what was there before takes it back.
  bool call_alone = false;
};

/// Text in quotes; the names of a graph that is accepted need no escapes.
std::string quoted(std::string_view text) { return fmt::format("\"{}\"", text); }

/// Edits that an input's bytes choose, mostly of what is there.
class Writer : Choices {
public:
  explicit Writer(std::string_view bytes) : Choices(bytes) {}

  using Choices::done;
  std::string_view start() { return kStarts[next() % kStarts.size()]; }
  Step step(const Graph& graph);

private:
  template <class T, size_t N>
  T pick(const std::array<T, N>& list) {
    return list[next() % N];
  }
  std::string of(const Strings& names) {
    return names.empty() || one(8) ? pick(kNames) : names[next() % names.size()];
  }
  template <class List>
  std::string nameOf(const List& list) {
    return list.empty() || one(8) ? pick(kNames) : list[next() % list.size()].name;
  }

  /// The group that is spoken of, "" for the graph, for all that follows in a step.
  void choose(const Graph& graph) {
    graph_ = &graph;
    group_ = one(3) ? of(graph.groups()) : "";
  }
  std::string path(std::string_view name) const {
    return group_.empty() ? std::string(name) : fmt::format("{}/{}", group_, name);
  }
  std::string id() {
    const std::vector<NodeUse> nodes = graph_->nodes(group_);
    return nodes.empty() || one(8) ? pick(kNames) : nodes[next() % nodes.size()].id;
  }
  std::string input(const std::string& node) {
    Messages said;
    const std::optional<Sockets> sockets = graph_->sockets(path(node), said);
    if (!sockets || one(8)) return pick(kInputs);
    return nameOf(sockets->inputs);
  }
  std::string output() { return one(2) ? std::string(pick(kPorts)) : path(nameOf(graph_->outputs(group_))); }
  std::string source() {
    const std::string swizzle = one(6) ? R"(, "swizzle": "x")" : "";
    switch (next() % 6) {
      case 0: return fmt::format(R"({{"parameter": "{}"{}}})", nameOf(graph_->parameters()), swizzle);
      case 1: return fmt::format(R"({{"texture": "{}"}})", nameOf(graph_->textures()));
      case 2: return fmt::format(R"({{"node": "{}"{}}})", id(), swizzle);
      case 3: return fmt::format(R"({{"node": "{}", "output": "{}"{}}})", id(), pick(kPorts), swizzle);
      default: return pick(kSources);
    }
  }
  std::string place() { return one(3) ? fmt::format(R"(, "place": {})", next() % 5) : ""; }

  Step ofNode();
  Step ofParameter();
  Step ofTexture();
  Step ofGroup();
  Step ofUi();

  const Graph* graph_ = nullptr;
  std::string group_;
};

Step Writer::ofNode() {
  switch (next() % 8) {
    case 0: {
      const std::string node = path(pick(kNames)), type = pick(kTypes);
      return {fmt::format(R"({{"do": "add_node", "node": {{"id": "{}", "node": "{}"}}}})", node, type),
              [=](Graph& to, Messages& said) { return to.addNode(node, type, said); }};
    }
    case 1: {
      const std::string node = path(pick(kNames)), type = of(graph_->groups());
      return {fmt::format(R"({{"do": "add_node", "node": {{"id": "{}", "group": "{}"}}}})", node, type),
              [=](Graph& to, Messages& said) { return to.addInstance(node, type, said); }};
    }
    case 2: {
      const std::string node = path(id());
      return {fmt::format(R"({{"do": "remove_node", "node": "{}"}})", node),
              [=](Graph& to, Messages& said) { return to.removeNode(node, said); }};
    }
    case 3: {
      const std::string node = path(id()), name = pick(kNames);
      return {fmt::format(R"({{"do": "rename_node", "node": "{}", "to": "{}"}})", node, name),
              [=](Graph& to, Messages& said) { return to.renameNode(node, name, said); }};
    }
    case 4: {
      const std::string node = id(), at = path(node), name = input(node);
      return {fmt::format(R"({{"do": "disconnect", "node": "{}", "input": "{}"}})", at, name),
              [=](Graph& to, Messages& said) { return to.disconnect(at, name, said); }};
    }
    case 5:
      if (one(2))
        return {fmt::format(R"({{"do": "set_stage", "node": "{}", "stage": "{}"}})", path(id()),
                            one(2) ? "vertex" : "fragment")};
      return {fmt::format(R"({{"do": "set_variant", "node": "{}", "variant": "{}"}})", path(id()),
                          one(2) ? "" : "fast")};
    default: {
      const std::string node = id(), at = path(node), name = input(node), from = source();
      if (const std::string where = place(); !where.empty())
        return {fmt::format(R"({{"do": "connect", "node": "{}", "input": "{}", "source": {}{}}})", at, name,
                            from, where)};
      return {
          fmt::format(R"({{"do": "connect", "node": "{}", "input": "{}", "source": {}}})", at, name, from),
          [=](Graph& to, Messages& said) { return to.connect(at, name, from, said); }};
    }
  }
}

Step Writer::ofParameter() {
  const std::string name = nameOf(graph_->parameters());
  switch (next() % 6) {
    case 0: return {fmt::format(R"({{"do": "remove_parameter", "parameter": "{}"}})", name)};
    case 1:
      return {
          fmt::format(R"({{"do": "rename_parameter", "parameter": "{}", "to": "{}"}})", name, pick(kNames))};
    case 2: {
      const double low = pick(kNumbers), high = pick(kNumbers);
      const bool or_zero = one(4);
      return {{},
              [=](Graph& to, Messages& said) {
                return to.setRange(name, {low, high, or_zero}, said);
              },
              true};
    }
    case 3:
      return {
          fmt::format(R"({{"do": "{}_parameter", "parameter": "{}", "as": {{"type": "{}", "value": {}}}{}}})",
                      one(2) ? "add" : "set", name, pick(kKinds), pick(kSources), place())};
    default: {
      std::vector<double> value(one(4) ? 3 : 1);
      for (double& x : value) x = pick(kNumbers);
      for (const Parameter& parameter : graph_->parameters()) {
        if (parameter.name != name || parameter.value.size() != value.size() || parameter.type == "bool")
          continue;
        return {fmt::format(R"({{"do": "set_value", "parameter": "{}", "value": {}}})", name,
                            value.size() == 1 ? fmt::format("{}", value[0])
                                              : fmt::format("[{}]", fmt::join(value, ", "))),
                [=](Graph& to, Messages& said) { return to.setParameter(name, value, said); }};
      }
      return {{}, [=](Graph& to, Messages& said) { return to.setParameter(name, value, said); }, true};
    }
  }
}

Step Writer::ofTexture() {
  const std::string name = nameOf(graph_->textures());
  switch (next() % 3) {
    case 0: return {fmt::format(R"({{"do": "remove_texture", "texture": "{}"}})", name)};
    case 1:
      return {fmt::format(R"({{"do": "rename_texture", "texture": "{}", "to": "{}"}})", name, pick(kNames))};
    default:
      return {fmt::format(
          R"({{"do": "{}_texture", "texture": "{}", "as": {{"type": "sampler2D", "srgb": true}}{}}})",
          one(2) ? "add" : "set", name, place())};
  }
}

Step Writer::ofGroup() {
  const std::string group = of(graph_->groups());
  switch (next() % 8) {
    case 0: return {fmt::format(R"({{"do": "remove_group", "group": "{}"}})", group)};
    case 1:
      return {fmt::format(R"({{"do": "rename_group", "group": "{}", "to": "{}"}})", group, pick(kNames))};
    case 2:
      return {
          fmt::format(R"({{"do": "{}_input", "input": "{}/{}", "as": {{"type": "{}", "default": {}}}{}}})",
                      one(2) ? "add" : "set", group, pick(kInputs), pick(kKinds), source(), place())};
    case 3: return {fmt::format(R"({{"do": "remove_input", "input": "{}/{}"}})", group, pick(kInputs))};
    case 4:
      return {fmt::format(R"({{"do": "rename_input", "input": "{}/{}", "to": "{}"}})", group, pick(kInputs),
                          pick(kInputs))};
    case 5: {
      const std::string node = path(id());
      return {fmt::format(R"({{"do": "expand", "node": "{}"}})", node),
              [=](Graph& to, Messages& said) { return to.expand(node, said); }};
    }
    case 6: {
      const std::string name = pick(kNames), text = graph_->toJson();
      if (text.size() > kSmallText) return {R"({"do": "set_name", "name": "large"})"};
      return {fmt::format(R"({{"do": "add_group", "group": "{}", "graph": {}}})", name, text),
              [=](Graph& to, Messages& said) {
                const Graph other = Graph::fromJson(text, "other.json", said);
                return to.addGroup(name, other, said);
              }};
    }
    default: {
      Strings nodes{path(id())};
      if (one(2)) nodes.push_back(path(id()));
      const std::string name = pick(kNames), instance = pick(kNames);
      Strings list;
      for (const std::string& node : nodes) list.push_back(quoted(node));
      return {fmt::format(R"({{"do": "make_group", "nodes": [{}], "group": "{}", "node": "{}"}})",
                          fmt::join(list, ", "), name, instance),
              [=](Graph& to, Messages& said) { return to.makeGroup(nodes, name, instance, said); }};
    }
  }
}

Step Writer::ofUi() {
  std::string what;
  switch (next() % 6) {
    case 0: what = fmt::format(R"(, "node": "{}")", path(id())); break;
    case 1: what = fmt::format(R"(, "parameter": "{}")", nameOf(graph_->parameters())); break;
    case 2: what = fmt::format(R"(, "texture": "{}")", nameOf(graph_->textures())); break;
    case 3: what = fmt::format(R"(, "group": "{}")", of(graph_->groups())); break;
    case 4: what = fmt::format(R"(, "input": "{}")", path(pick(kInputs))); break;
    default: break;
  }
  if (!one(4)) what += fmt::format(R"(, "ui": {})", pick(kUi));
  return {fmt::format(R"({{"do": "set_ui"{}}})", what)};
}

Step Writer::step(const Graph& graph) {
  choose(graph);
  switch (next() % 9) {
    case 0: return ofParameter();
    case 1: return ofTexture();
    case 2:
    case 3: return ofGroup();
    case 4: return ofUi();
    case 5: {
      const std::string port = output();
      if (one(3))
        return {fmt::format(R"({{"do": "remove_output", "output": "{}"}})", port),
                [=](Graph& to, Messages& said) { return to.removeOutput(port, said); }};
      const std::string from = source();
      return {fmt::format(R"({{"do": "set_output", "output": "{}", "source": {}}})", port, from),
              [=](Graph& to, Messages& said) { return to.setOutput(port, from, said); }};
    }
    case 6: {
      // All or none.
      const Step first = ofNode(), second = ofNode();
      return {fmt::format("[{}, {}]", first.json, second.json)};
    }
    default: return ofNode();
  }
}

/// A sequence, and what is wrong with it.
class Session {
public:
  explicit Session(std::string_view bytes)
      : writer_(bytes), with_shaders_(numberOf(bytes) % kShadersEvery == 0) {
    options_.targets = {Target::Spirv};
    options_.validate = false;
    options_.jobs = 1;
    options_.parameters = static_cast<Parameters>(numberOf(bytes, 1) % 2);
  }

  std::string run() {
    Messages said;
    graph_ = Graph::fromJson(writer_.start(), "start.json", said);
    if (!graph_) return "the first graph is refused:\n" + errorsOf(said);
    if (std::string wrong = generate(); !wrong.empty()) return wrong;
    for (size_t count = 0; !writer_.done() && count < kMostEdits; ++count) {
      const std::string before = graph_.toJson();
      if (before.size() > kMostText) break;
      const Step step = writer_.step(graph_);
      if (const std::string wrong = make(step, before); !wrong.empty())
        return fmt::format("{}\nof {}\nof {}", wrong, step.json, before);
    }
    said.clear();
    if (!graph_.check(said) && !hasError(said)) return "a graph fails without an error";
    if (std::string wrong = generate(); !wrong.empty()) return wrong;
    return takeBack();
  }

private:
  std::string make(const Step& step, const std::string& before) {
    Messages said;
    Graph twin = Graph::fromJson(before, "twin.json", said);
    if (!twin || twin.toJson() != before) return "an edited graph does not read back:\n" + errorsOf(said);
    Messages called;
    const bool done = step.call && step.call(twin, called);
    if (step.call && done == hasError(called)) return "a call and its messages say different things";
    if (step.call && !done && twin.toJson() != before) return "a call that fails changes something";
    if (step.call_alone) {
      if (!done) return {};
      graph_ = twin;
      history_.emplace_back(before, fmt::format(R"({{"do": "replace", "graph": {}}})", before));
      return {};
    }
    said.clear();
    const std::string inverse = graph_.edit(step.json, said);
    if (inverse.empty() != hasError(said)) return "an edit and its messages say different things";
    if (inverse.empty() && graph_.toJson() != before) return "an edit that fails changes something";
    if (step.call && done == inverse.empty())
      return "a call and its edit differ in what they accept:\n" + errorsOf(called) + errorsOf(said);
    if (step.call && twin.toJson() != graph_.toJson())
      return "a call and its edit make different graphs:\n" + twin.toJson() + graph_.toJson();
    if (!inverse.empty()) history_.emplace_back(before, inverse);
    return {};
  }

  /// Makes a shader; one that is said to do is the same.
  std::string generate() {
    if (!with_shaders_) return {};
    Messages said;
    const bool good = graph_.check(said);
    said.clear();
    const Change change = graph_.changes();
    const Shader shader = graph_.generate(options_, said);
    if (bool(shader) != good) return "check() and generate() differ:\n" + errorsOf(said) + graph_.toJson();
    if (!shader) return change == Change::Program ? "" : "a graph without a shader is no change";
    if (graph_.changes() != Change::Nothing) return "something has changed since now";
    if (change != Change::Program && shader.id() != id_) return "another shader is no change of the program";
    id_ = shader.id();
    return {};
  }

  std::string takeBack() {
    for (; !history_.empty(); history_.pop_back()) {
      const auto& [text, inverse] = history_.back();
      Messages said;
      if (graph_.edit(inverse, said).empty())
        return fmt::format("an edit is not taken back:\n{}by {}\nto {}", errorsOf(said), inverse, text);
      if (graph_.toJson() != text)
        return fmt::format("taken back by {} it is\n{}and was\n{}", inverse, graph_.toJson(), text);
    }
    return {};
  }

  Writer writer_;
  bool with_shaders_;
  Options options_;
  Graph graph_;
  std::string id_;                                            ///< of the last shader
  std::vector<std::pair<std::string, std::string>> history_;  ///< what was there, and what brings it back
};

}  // namespace

std::string feedEdits(std::string_view bytes) { return Session(bytes).run(); }

}  // namespace lacquer::fuzz
