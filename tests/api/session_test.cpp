// A tool's session: a material is edited for a hundred steps. After each one its graph has the colours of the
// file that it is saved to, changes() is right about its shader, and what cannot be done changes nothing.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "inputs.h"
#include "support/answers.h"

namespace lacquer::test {
namespace {

constexpr int kSteps = 100;
constexpr const char* kPoints = R"([{"n": [0, 0, 1], "v": [0, 0.6, 0.8], "l": [0.6, 0, 0.8],
  "uv0": [0.3, 0.7], "env": [0.3, 0.2, 0.1]}])";

/// The name in quotes, as it stands in a source.
std::string jsonName(const std::string& name) { return '"' + name + '"'; }

class Session {
public:
  Session(Graph graph, unsigned seed) : graph_(std::move(graph)), random_(seed) {
    for (const TextureUse& texture : graph_.textures()) texels_.push_back(texture.name + "=0.2,0.4,0.6,0.8");
    options_.targets = {Target::Essl};
    make();
  }

  void step(int number) {
    const std::string before = graph_.toJson();
    switch (number % 10) {
      case 0: EXPECT_TRUE(setNumber()); break;
      case 1: EXPECT_TRUE(addCopy(fmt::format("tool.n{}", number))); break;
      case 2: EXPECT_TRUE(useCopy()); break;
      case 3: EXPECT_TRUE(rename(fmt::format("my.n{}", number))); break;
      case 4: EXPECT_TRUE(group(number)); break;
      case 5: EXPECT_TRUE(setNumber()); break;
      case 6: EXPECT_TRUE(expand()); break;
      case 7: EXPECT_TRUE(disconnect()); break;
      case 8: EXPECT_TRUE(comment()); break;
      default: refused(); break;
    }
    EXPECT_EQ(errorsOf(messages_), "");
    if (number % 10 == 9) {
      EXPECT_EQ(graph_.toJson(), before);
    }
    compare();
  }

private:
  size_t pick(size_t count) { return random_() % count; }

  /// Within what the parameter and all that it goes to accept; another number each time.
  bool setNumber() {
    const std::vector<Parameter> all = graph_.parameters();
    const Parameter& parameter = all[pick(all.size())];
    std::vector<double> value = parameter.value;
    for (double& x : value) {
      const double low = std::isfinite(parameter.range.low) ? parameter.range.low : 0;
      const double high = std::isfinite(parameter.range.high) ? parameter.range.high : low + 1;
      x = low + (high - low) * static_cast<double>(1 + pick(98)) / 100;
    }
    const bool done = graph_.setParameter(parameter.name, value, messages_);
    if (parameter.value != value) {
      EXPECT_GE(graph_.changes(), Change::Numbers);
    }
    return done;
  }

  /// The consumers of a node: their ids, "" for the template, with what is connected there.
  std::vector<std::pair<std::string, Connection>> usersOf(const std::string& id) const {
    std::vector<std::pair<std::string, Connection>> users;
    const auto add = [&](const std::string& user, const std::vector<Connection>& all) {
      for (const Connection& one : all) {
        if (one.source.find("\"node\": " + jsonName(id)) != std::string::npos) users.emplace_back(user, one);
      }
    };
    for (const NodeUse& node : graph_.nodes()) add(node.id, node.inputs);
    add("", graph_.outputs());
    return users;
  }

  /// A node beside another one, connected as that is, which nothing uses yet.
  bool addCopy(const std::string& id) {
    std::vector<NodeUse> models;
    for (NodeUse& node : graph_.nodes()) {
      if (!node.group && !usersOf(node.id).empty()) models.push_back(std::move(node));
    }
    const NodeUse& model = models[pick(models.size())];
    copied_ = model.id;
    copy_ = id;
    bool done = graph_.addNode(id, model.type, messages_);
    for (const Connection& one : model.inputs)
      done = done && graph_.connect(id, one.name, one.source, messages_);
    const std::optional<Sockets> sockets = graph_.sockets(id, messages_);
    EXPECT_TRUE(sockets);
    if (!sockets) return false;
    size_t connected = 0;
    for (const Socket& input : sockets->inputs) connected += input.source.empty() ? 0 : 1;
    EXPECT_EQ(connected, model.inputs.size());
    return done;
  }

  bool useCopy() {
    const auto users = usersOf(copied_);
    const auto& [user, connection] = users[pick(users.size())];
    std::string source = connection.source;
    source.replace(source.find(jsonName(copied_)), jsonName(copied_).size(), jsonName(copy_));
    return user.empty() ? graph_.setOutput(connection.name, source, messages_)
                        : graph_.connect(user, connection.name, source, messages_);
  }

  bool rename(const std::string& to) {
    const size_t users = usersOf(copy_).size();
    const bool done = graph_.renameNode(copy_, to, messages_);
    copy_ = to;
    EXPECT_EQ(usersOf(copy_).size(), users);
    return done;
  }

  bool group(int number) {
    group_ = fmt::format("group_{}", number);
    const bool done = graph_.makeGroup({copy_}, group_, "instance", messages_);
    EXPECT_EQ(graph_.nodes(group_).size(), 1u);
    EXPECT_EQ(graph_.groups().back(), group_);
    return done;
  }

  bool expand() {
    const bool done = graph_.expand("instance", messages_);
    return done &&
           !graph_.edit(fmt::format(R"({{"do": "remove_group", "group": "{}"}})", group_), messages_).empty();
  }

  /// An input that has a default, and back: the same bytes.
  bool disconnect() {
    for (const NodeUse& node : graph_.nodes()) {
      const std::optional<Sockets> sockets = graph_.sockets(node.id, messages_);
      for (const Socket& input : sockets->inputs) {
        // No texture falls out of use, whose texel would be said in vain.
        const bool plain =
            input.source.find("\"node\"") == std::string::npos && !input.type.starts_with("sampler");
        if (!input.optional || input.source.empty() || !plain || pick(3) != 0) continue;
        const std::string before = graph_.toJson();
        const std::string back = graph_.edit(
            fmt::format(R"({{"do": "disconnect", "node": "{}", "input": "{}"}})", node.id, input.name),
            messages_);
        EXPECT_NE(graph_.toJson(), before);
        compare();
        EXPECT_NE(graph_.edit(back, messages_), "");
        EXPECT_EQ(graph_.toJson(), before);
        return graph_.disconnect(node.id, input.name, messages_);
      }
    }
    return true;
  }

  /// No shader is made anew of it.
  bool comment() {
    make();
    const std::vector<NodeUse> nodes = graph_.nodes();
    const std::string back =
        graph_.edit(fmt::format(R"({{"do": "set_ui", "node": "{}", "ui": {{"x": {}, "y": 1}}}})",
                                nodes[pick(nodes.size())].id, pick(1000)),
                    messages_);
    EXPECT_EQ(graph_.changes(), Change::Nothing);
    return !back.empty();
  }

  void refused() {
    const std::string node = graph_.nodes()[0].id;
    for (const std::function<bool(Messages&)>& wrong : std::initializer_list<std::function<bool(Messages&)>>{
             [&](Messages& to) { return graph_.addNode(node, "schlick", to); },
             [&](Messages& to) { return graph_.connect(node, "no_such_input", "1", to); },
             [&](Messages& to) { return graph_.disconnect(node, "no_such_input", to); },
             [&](Messages& to) { return graph_.renameNode("nobody", "body", to); },
             [&](Messages& to) { return graph_.setOutput("nowhere", "1", to); },
             [&](Messages& to) { return graph_.removeOutput("nowhere", to); },
             [&](Messages& to) { return graph_.addInstance("x", "no_such_group", to); },
             [&](Messages& to) { return graph_.expand(node, to); },
             [&](Messages& to) { return !graph_.edit(R"({"do": "fly"})", to).empty(); }}) {
      Messages said;
      EXPECT_FALSE(wrong(said));
      EXPECT_NE(errorsOf(said), "");
    }
  }

  void make() {
    shader_ = graph_.generate(options_, messages_);
    EXPECT_TRUE(shader_);
    EXPECT_EQ(graph_.changes(), Change::Nothing);
  }

  void compare() {
    const auto colors = [&](const Graph& graph) {
      return jsonOf(evaluate(graph, kPoints, Engine::Double, texels_, quick(), messages_));
    };
    const Graph saved = Graph::fromJson(graph_.toJson(), "saved.json", messages_);
    ASSERT_EQ(saved.toJson(), graph_.toJson());
    const std::string expected = colors(saved);
    ASSERT_NE(expected, "");
    ASSERT_EQ(colors(graph_), expected);
    // The shader that is there does unless it is said that it does not.
    const Change change = graph_.changes();
    const std::string id = shader_.id();
    std::vector<std::byte> packed(shader_.uniformSize()), fresh(shader_.uniformSize());
    if (change <= Change::Textures) {
      EXPECT_TRUE(shader_.packGraph(graph_, packed, messages_));
    }
    make();
    if (change > Change::Textures) return;
    EXPECT_EQ(shader_.id(), id);
    EXPECT_TRUE(shader_.pack({}, fresh, messages_));
    EXPECT_EQ(packed, fresh);
    ++kept_;
  }

public:
  /// Steps after which the shader was not made anew.
  int kept_ = 0;

private:
  Graph graph_;
  std::mt19937 random_;
  Strings texels_;
  Options options_ = quick();
  Messages messages_;
  Shader shader_;
  std::string copied_, copy_, group_;
};

void runSession(const std::string& file, unsigned seed) {
  const Attributes all{true, true, true, {true, true, true, true}, {}, false, false, false, {}};
  Messages messages;
  for (const std::string& path : examples()) {
    if (path.find(file) == std::string::npos) continue;
    const Scene scene = Scene::load(path, quick(), messages);
    Session session(scene.graph(0, all, quick(), messages), seed);
    for (int step = 0; step < kSteps && !testing::Test::HasFailure(); ++step) {
      SCOPED_TRACE(fmt::format("{}: step {}", file, step));
      session.step(step);
    }
    EXPECT_GT(session.kept_, kSteps / 4);
    return;
  }
  ADD_FAILURE() << "there is no " << file;
}

TEST(Session, OfACoat) { runSession("/coat.gltf", 1); }
TEST(Session, OfCarPaint) { runSession("/car_paint.gltf", 2); }

TEST(Session, KnowsWhatChanged) {
  Messages messages;
  Graph graph = paintGraph();
  EXPECT_EQ(graph.changes(), Change::Program);
  Options options = quick();
  const Shader shader = graph.generate(options, messages);
  EXPECT_EQ(graph.changes(), Change::Nothing);
  const double metallic = graph.parameters()[0].value[0];
  const std::string name = graph.parameters()[0].name;
  const std::vector<double> value = graph.parameters()[0].value;
  std::vector<double> other = value;
  other[0] = metallic > 0.5 ? 0.25 : 0.75;
  EXPECT_TRUE(graph.setParameter(name, other, messages));
  EXPECT_EQ(graph.changes(), Change::Numbers);
  EXPECT_TRUE(graph.setParameter(name, value, messages));
  EXPECT_EQ(graph.changes(), Change::Nothing);
  // Names of nodes, and nodes that nothing takes values from, are of no shader.
  EXPECT_TRUE(graph.renameNode("base.direct", "another.name", messages));
  EXPECT_TRUE(graph.addNode("idle", "schlick", messages));
  EXPECT_TRUE(graph.connect("idle", "F0", "0.04", messages));
  EXPECT_EQ(graph.changes(), Change::Program);  // until the rest of the node is connected: it cannot be made
  EXPECT_TRUE(graph.removeNode("idle", messages));
  EXPECT_EQ(graph.changes(), Change::Nothing);
  // A parameter's name is an interface.
  EXPECT_NE(graph.edit(fmt::format(R"({{"do": "rename_parameter", "parameter": "{}", "to": "fresh"}})", name),
                       messages),
            "");
  EXPECT_EQ(graph.changes(), Change::Program);
  // Constants are of the code.
  options.parameters = Parameters::Baked;
  EXPECT_TRUE(graph.generate(options, messages));
  EXPECT_TRUE(graph.setParameter("fresh", other, messages));
  EXPECT_EQ(graph.changes(), Change::Program);
  EXPECT_EQ(errorsOf(messages), "");
}

/// An edit is checked against the library that the graph was read with.
TEST(Session, GroupsAndStructures) {
  Messages messages;
  Graph graph = paintGraph();
  const Options options = quick();
  const std::string flat = graph.structure(options, messages);
  EXPECT_TRUE(graph.makeGroup({"base.direct"}, "lit", "base.direct", messages));
  const std::string grouped = graph.structure(options, messages);
  EXPECT_EQ(grouped.size(), 64u);
  EXPECT_EQ(grouped, flat);
  // Another group's contents are another structure.
  const std::vector<NodeUse> nodes = graph.nodes("lit");
  ASSERT_EQ(nodes.size(), 1u);
  ASSERT_FALSE(nodes[0].inputs.empty());
  std::optional<Sockets> sockets = graph.sockets("lit/" + nodes[0].id, messages);
  ASSERT_TRUE(sockets);
  for (const Socket& input : sockets->inputs) {
    if (input.source.empty() || input.type.starts_with("sampler")) continue;
    EXPECT_TRUE(graph.connect("lit/" + nodes[0].id, input.name, "0.5", messages));
    break;
  }
  EXPECT_NE(graph.structure(options, messages), grouped);
  EXPECT_EQ(errorsOf(messages), "");
}

/// The graph with the lists of its file in reverse.
Graph reversed(const Graph& graph, const Options& options, Messages& messages) {
  auto json = nlohmann::ordered_json::parse(graph.toJson());
  for (const char* list : {"nodes", "attributes"}) {
    if (json.contains(list)) std::reverse(json[list].begin(), json[list].end());
  }
  const auto turned = [](const nlohmann::ordered_json& of) {
    auto made = nlohmann::ordered_json::object();
    for (auto it = of.rbegin(); it != of.rend(); ++it) made[it.key()] = it.value();
    return made;
  };
  for (const char* names : {"parameters", "textures", "outputs"}) json[names] = turned(json[names]);
  for (auto& node : json["nodes"]) {
    if (node.contains("inputs")) node["inputs"] = turned(node["inputs"]);
  }
  return Graph::fromJson(json.dump(), "reversed", messages, options);
}

/// The key of the structure is equal where the shader is: not the ways in which a tool keeps a graph count.
TEST(Session, StructuresAreCanonical) {
  const Options options = quick();
  for (const std::string& file : examples()) {
    SCOPED_TRACE(file);
    Messages messages;
    const Scene scene = Scene::load(file, options, messages);
    Graph graph = scene.graph(0, kUnusedAttributes, options, messages);
    const std::string structure = graph.structure(options, messages);
    const std::string shader = graph.generate(options, messages).id();
    const auto expectSame = [&](Graph other) {
      EXPECT_EQ(other.structure(options, messages), structure);
      EXPECT_EQ(other.generate(options, messages).id(), shader);
    };
    expectSame(reversed(graph, options, messages));
    Graph edited = Graph::fromJson(graph.toJson(), "edited", messages, options);
    size_t count = 0;
    for (const NodeUse& node : graph.nodes())
      EXPECT_TRUE(edited.renameNode(node.id, fmt::format("tool.n{}", ++count), messages));
    EXPECT_NE(edited.edit(R"({"do": "set_ui", "ui": {"x": 1}})", messages), "");
    EXPECT_NE(edited.edit(R"({"do": "set_name", "name": "Another"})", messages), "");
    EXPECT_TRUE(edited.addNode("tool.unused", "emission", messages));
    EXPECT_TRUE(edited.connect("tool.unused", "factor", "1", messages));
    EXPECT_TRUE(edited.connect("tool.unused", "strength", "1", messages));
    expectSame(edited);
    EXPECT_TRUE(edited.makeGroup({edited.nodes().front().id}, "folded", "tool.folded", messages));
    expectSame(edited);
    // Numbers are of it where they are of the code.
    ASSERT_FALSE(graph.parameters().empty());
    const Parameter parameter = graph.parameters().front();
    Graph other = Graph::fromJson(graph.toJson(), "other", messages, options);
    std::vector<double> value = parameter.value;
    for (double& x : value) x = x > 0.5 ? 0.25 : 0.75;
    Options baked = options;
    baked.parameters = Parameters::Baked;
    EXPECT_EQ(other.structure(baked, messages), graph.structure(baked, messages));
    EXPECT_TRUE(other.setParameter(parameter.name, value, messages));
    expectSame(other);
    EXPECT_NE(other.structure(baked, messages), graph.structure(baked, messages));
    // Names of parameters are an interface.
    EXPECT_NE(other.edit(fmt::format(R"({{"do": "rename_parameter", "parameter": "{}", "to": "another"}})",
                                     parameter.name),
                         messages),
              "");
    EXPECT_NE(other.structure(options, messages), structure);
    EXPECT_EQ(errorsOf(messages), "");
  }
}

}  // namespace
}  // namespace lacquer::test
