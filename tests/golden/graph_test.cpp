// Node graphs through their JSON form and through the public editing functions.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "compare.h"
#include "output.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

class Graphs : public testing::TestWithParam<const char*> {
protected:
  Graphs() {
    options_.template_name = GetParam();
    options_.validate = false;
  }

  void forEach(const std::function<void(Graph&)>& body) {
    const WorkingFolder here(sourceFolder());
    size_t count = 0;
    for (const std::string& file : exampleFiles()) {
      Messages messages;
      const Scene scene = Scene::load(file, options_, messages);
      ASSERT_TRUE(scene) << textOf(messages);
      for (size_t i = 0; i < scene.materialCount(); ++i) {
        for (const Attributes& attributes : scene.uses(i)) {
          SCOPED_TRACE(file + ": " + scene.materialName(i));
          Graph graph = scene.graph(i, attributes, options_, messages);
          ASSERT_TRUE(graph) << textOf(messages);
          body(graph);
          ++count;
        }
      }
    }
    EXPECT_GT(count, 20u);
  }

  Shader made(Graph& graph) const {
    Messages messages;
    Shader shader = graph.generate(options_, messages);
    EXPECT_TRUE(shader) << textOf(messages);
    EXPECT_FALSE(hasError(messages)) << textOf(messages);
    return shader;
  }

  Options options_;
};

TEST_P(Graphs, jsonReadsBackAsTheSameShader) {
  forEach([&](Graph& graph) {
    const Shader before = made(graph);
    const std::string json = graph.toJson();
    Messages messages;
    Graph again = Graph::fromJson(json, "graph.json", messages);
    ASSERT_TRUE(again) << textOf(messages);
    EXPECT_EQ(diffLines(json, again.toJson()), "");
    const Shader after = made(again);
    EXPECT_EQ(before.id(), after.id());
    EXPECT_EQ(codeOf(before), codeOf(after));
    EXPECT_FALSE(graph.toDot().empty());
  });
}

/// A file of the JSON form gives the files that the glTF file gives.
TEST_P(Graphs, generateGraphsWritesTheSameShaders) {
  const Folder folder;
  std::vector<std::string> files;
  forEach([&](Graph& graph) {
    files.push_back(folder / (std::to_string(files.size()) + ".json"));
    writeText(files.back(), graph.toJson());
  });
  const WorkingFolder here(sourceFolder());
  const Json direct = generateWell(exampleFiles(), folder.path() / "direct", options_);
  Messages messages;
  const Report report = generateGraphs(files, folder / "graphs", options_, messages);
  EXPECT_TRUE(report.ok) << textOf(messages);
  const Json through = manifestOf(folder.path() / "graphs");
  EXPECT_EQ(direct["shaders"], through["shaders"]);
  std::filesystem::remove(folder / "direct/manifest.json");
  std::filesystem::remove(folder / "graphs/manifest.json");
  EXPECT_EQ(outputDifferences(folder.path() / "direct", folder.path() / "graphs"), "");
}

/// What an authoring tool does: a node, a parameter, a port.
TEST_P(Graphs, editsReachTheShader) {
  options_.validate = true;
  forEach([&](Graph& graph) {
    Messages messages;
    const Shader before = made(graph);
    ASSERT_TRUE(graph.addNode("my.glow", "occluded", messages));
    EXPECT_FALSE(graph.addNode("my.glow", "occluded", messages));
    EXPECT_TRUE(graph.setParameter("my_light", {0.25, 0.5, 1}, messages));
    EXPECT_TRUE(graph.setParameter("my_amount", {0.5}, messages));
    EXPECT_FALSE(graph.setParameter("my_amount", {0.5, 1}, messages));
    EXPECT_TRUE(graph.connect("my.glow", "light", R"({"parameter": "my_light"})", messages));
    EXPECT_TRUE(graph.connect("my.glow", "visible", R"({"parameter": "my_amount"})", messages));
    EXPECT_FALSE(graph.connect("nobody", "visible", "1", messages));
    EXPECT_FALSE(graph.connect("my.glow", "visible", R"({"nothing": 1})", messages));
    EXPECT_FALSE(graph.setOutput("emission", R"({"node": )", messages));
    EXPECT_TRUE(graph.setOutput("emission", R"({"node": "my.glow"})", messages));
    const Shader after = made(graph);
    EXPECT_NE(before.id(), after.id());
    EXPECT_NE(after.fragmentText(Target::Glsl), before.fragmentText(Target::Glsl));
    // Another number is another uniform, not another shader.
    EXPECT_TRUE(graph.setParameter("my_amount", {0.125}, messages));
    EXPECT_EQ(made(graph).id(), after.id());
    // The edit survives the JSON form.
    Graph again = Graph::fromJson(graph.toJson(), "graph.json", messages);
    EXPECT_EQ(codeOf(made(again)), codeOf(after));
    // Taken back, all is as before.
    EXPECT_TRUE(graph.removeNode("my.glow", messages));
    EXPECT_FALSE(graph.removeNode("my.glow", messages));
    messages.clear();
    EXPECT_FALSE(graph.check(messages));
    EXPECT_NE(textOf(messages).find("my.glow"), std::string::npos) << textOf(messages);
  });
}

/// What a tool may do to a graph that is no edit: other ids, other orders, its own words.
class Disguise {
public:
  explicit Disguise(uint64_t seed) : random_(seed) {}

  Json operator()(Json graph) {
    ids_.clear();
    for (Json& node : graph["nodes"]) {
      ids_[node["id"]] = "n" + std::to_string(random_() % 100000) + ".x" + std::to_string(ids_.size());
    }
    for (Json& node : graph["nodes"]) {
      node["id"] = ids_.at(node["id"]);
      for (auto& [name, source] : node["inputs"].items()) rename(source);
      shuffle(node["inputs"]);
      node["ui"] = {{"x", random_() % 1000}, {"comment", "moved"}};
    }
    for (auto& [port, source] : graph["outputs"].items()) rename(source);
    for (const char* list : {"outputs", "parameters", "textures"}) shuffle(graph[list]);
    std::shuffle(graph["nodes"].begin(), graph["nodes"].end(), random_);
    for (auto& [name, parameter] : graph["parameters"].items()) parameter["ui"] = random_() % 9;
    graph["ui"] = {{"zoom", 2}};
    // What nobody asks for.
    graph["nodes"].push_back(
        {{"id", "unused"}, {"node", "unit_normal"}, {"inputs", {{"normal", {1, 0, 0}}}}});
    return graph;
  }

private:
  void rename(Json& source) const {
    if (source.is_object() && source.contains("node")) source["node"] = ids_.at(source["node"]);
  }
  void shuffle(Json& object) {
    std::vector<std::pair<std::string, Json>> members;
    for (auto& [name, value] : object.items()) members.emplace_back(name, value);
    std::shuffle(members.begin(), members.end(), random_);
    object = Json::object();
    for (auto& [name, value] : members) object[name] = std::move(value);
  }

  std::mt19937_64 random_;
  std::map<std::string, std::string> ids_;
};

TEST_P(Graphs, idsOrdersAndToolsOwnWordsAreNotInTheShader) {
  uint64_t seed = 0;
  forEach([&](Graph& graph) {
    const Shader before = made(graph);
    const std::string text = Disguise(++seed)(Json::parse(graph.toJson())).dump();
    Messages messages;
    Graph other = Graph::fromJson(text, "graph.json", messages);
    ASSERT_TRUE(other) << textOf(messages);
    EXPECT_TRUE(other.check(messages, options_)) << textOf(messages);
    const Shader after = made(other);
    EXPECT_EQ(before.id(), after.id());
    EXPECT_EQ(codeOf(before), codeOf(after));
    EXPECT_EQ(before.interfaceJson(), after.interfaceJson());
    // The names of parameters are an interface.
    if (before.uniformSize() == 0) return;
    Json named = Json::parse(graph.toJson());
    const std::string old = before.reflection().parameters.at(0).name;
    named["parameters"]["another"] = named["parameters"][old];
    for (Json& node : named["nodes"]) {
      for (auto& [name, source] : node["inputs"].items()) {
        if (source.is_object() && source.value("parameter", "") == old) source["parameter"] = "another";
      }
    }
    for (auto& [name, source] : named["outputs"].items()) {
      if (source.is_object() && source.value("parameter", "") == old) source["parameter"] = "another";
    }
    Graph again = Graph::fromJson(named.dump(), "graph.json", messages);
    EXPECT_NE(made(again).id(), before.id());
  });
}

INSTANTIATE_TEST_SUITE_P(Templates, Graphs, testing::Values("forward", "surface", "bsdf"),
                         [](const auto& info) { return info.param; });

/// A graph with an error gives messages and no shader, whatever is called.
TEST(BrokenGraphs, giveMessagesAndNoShader) {
  const char* kWrong[] = {
      "",
      "[]",
      "{}",
      "nonsense",
      R"({"lacquer_graph": 1})",
      R"({"lacquer_graph": 1, "template": "forward"})",
      R"({"lacquer_graph": 1, "template": "nowhere", "outputs": {}})",
      R"({"lacquer_graph": 1, "template": "forward", "outputs": {"nowhere": 1}})",
      R"({"lacquer_graph": 1, "template": "forward", "outputs": {"emission": {"node": "a"}}})",
      R"({"lacquer_graph": 1, "template": "forward", "nodes": [{"id": "a", "node": "b", "inputs": {}}], "outputs": {}})",
      R"({"lacquer_graph": 1, "template": "surface", "outputs": {}})",
  };
  for (const char* text : kWrong) {
    SCOPED_TRACE(text);
    Messages messages;
    Graph graph = Graph::fromJson(text, "graph.json", messages);
    if (graph) {
      EXPECT_FALSE(graph.generate({}, messages));
      EXPECT_EQ(graph.dump({}, "", messages), "");
    }
    ASSERT_TRUE(hasError(messages));
    for (const Message& message : messages) {
      EXPECT_FALSE(message.code.empty());
      EXPECT_FALSE(message.message.empty());
      EXPECT_EQ(message.file, "graph.json") << message.text;
    }
  }
}

}  // namespace
}  // namespace lacquer::test
