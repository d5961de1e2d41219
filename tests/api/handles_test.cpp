// Empty handles and indices that do not exist: a message or what the header says, never more than that.
#include <gtest/gtest.h>

#include <thread>

#include "inputs.h"

namespace lacquer::test {
namespace {

constexpr auto kNowhere = static_cast<size_t>(-1);

/// Everything that a scene can be asked for.
void useEmpty(const Scene& scene) {
  EXPECT_FALSE(scene);
  EXPECT_EQ(scene.materialCount(), 0U);
  EXPECT_EQ(scene.materialName(0), "");
  EXPECT_TRUE(scene.uses(0).empty());
  Messages messages;
  EXPECT_EQ(scene.findMaterial("Paint", messages), std::nullopt);
  EXPECT_FALSE(scene.graph(0, {}, {}, messages));
  EXPECT_EQ(errorsOf(messages), "empty-handle empty-handle");
}

void useEmpty(Graph& graph) {
  EXPECT_FALSE(graph);
  EXPECT_EQ(graph.toJson(), "");
  EXPECT_EQ(graph.toDot(), "");
  EXPECT_TRUE(graph.parameters().empty());
  Messages messages;
  EXPECT_FALSE(graph.addNode("a", "occluded", messages));
  EXPECT_FALSE(graph.removeNode("a", messages));
  EXPECT_FALSE(graph.connect("a", "light", "1", messages));
  EXPECT_FALSE(graph.setOutput("emission", "1", messages));
  EXPECT_FALSE(graph.setParameter("x", {1}, messages));
  EXPECT_FALSE(graph.setRange("x", {}, messages));
  EXPECT_FALSE(graph.check(messages));
  EXPECT_FALSE(graph.generate({}, messages));
  EXPECT_EQ(graph.dump({}, "", messages), "");
  EXPECT_FALSE(graph.prove({}, messages));
  EXPECT_TRUE(graph.nodes().empty());
  EXPECT_TRUE(graph.outputs().empty());
  EXPECT_TRUE(graph.groups().empty());
  EXPECT_TRUE(graph.textures().empty());
  EXPECT_EQ(graph.changes(), Change::Program);
  EXPECT_FALSE(graph.sockets("a", messages));
  EXPECT_FALSE(graph.addInstance("a", "worn", messages));
  EXPECT_FALSE(graph.renameNode("a", "b", messages));
  EXPECT_FALSE(graph.disconnect("a", "light", messages));
  EXPECT_FALSE(graph.removeOutput("emission", messages));
  EXPECT_FALSE(graph.makeGroup({"a"}, "worn", "b", messages));
  EXPECT_FALSE(graph.addGroup("worn", Graph(), messages));
  EXPECT_FALSE(graph.expand("a", messages));
  EXPECT_EQ(graph.edit("{}", messages), "");
  EXPECT_EQ(graph.structure({}, messages), "");
  ASSERT_EQ(messages.size(), 20U);
  for (const Message& message : messages) EXPECT_EQ(message.code, "empty-handle");
}

void useEmpty(const Shader& shader) {
  EXPECT_FALSE(shader);
  EXPECT_EQ(shader.id(), "");
  EXPECT_FALSE(shader.hasVertexStage());
  for (int target = 0; target < 256; ++target) {
    EXPECT_EQ(shader.vertexText(static_cast<Target>(target)), "");
    EXPECT_EQ(shader.fragmentText(static_cast<Target>(target)), "");
  }
  EXPECT_TRUE(shader.vertexSpirv().empty());
  EXPECT_TRUE(shader.fragmentSpirv().empty());
  EXPECT_EQ(shader.headerText(), "");
  EXPECT_EQ(shader.interfaceJson(), "");
  EXPECT_EQ(shader.uniformSize(), 0U);
  EXPECT_TRUE(shader.pack({}, {}));
}

TEST(EmptyHandles, ofTheDefaultConstructor) {
  useEmpty(Scene());
  Graph graph;
  useEmpty(graph);
  useEmpty(Shader());
}

TEST(EmptyHandles, movedFrom) {
  Scene scene = paintScene();
  const Scene there = std::move(scene);
  useEmpty(scene);
  EXPECT_EQ(there.materialCount(), 1U);
  Graph graph = paintGraph();
  Graph moved = std::move(graph);
  useEmpty(graph);
  Messages messages;
  Shader shader = moved.generate(quick(), messages);
  EXPECT_TRUE(shader);
  const Shader taken = std::move(shader);
  useEmpty(shader);
  EXPECT_NE(taken.id(), "");
}

TEST(EmptyHandles, ofFailedCalls) {
  Messages messages;
  useEmpty(Scene::load("/nowhere.gltf", {}, messages));
  useEmpty(Scene::fromMemory("", "nothing.gltf", {}, messages));
  Graph graph = Graph::fromJson("{", "broken.json", messages);
  EXPECT_EQ(messages.size(), 3U);
  useEmpty(graph);
}

TEST(Indices, thatDoNotExist) {
  const Scene scene = paintScene();
  for (const size_t index : {size_t{1}, size_t{1} << 40, kNowhere}) {
    EXPECT_EQ(scene.materialName(index), "");
    EXPECT_TRUE(scene.uses(index).empty());
    Messages messages;
    EXPECT_FALSE(scene.graph(index, {}, {}, messages));
    EXPECT_EQ(errorsOf(messages), "no-such-material");
    ASSERT_EQ(messages.size(), 1U);
    EXPECT_EQ(messages[0].file, "paint.gltf");
  }
}

TEST(Scenes, findMaterialsByName) {
  Messages messages;
  const char* kThree =
      R"({"asset": {"version": "2.0"}, "materials": [{"name": "a"}, {"name": "b"}, {"name": "b"}]})";
  const Scene scene = Scene::fromMemory(kThree, "three.gltf", {}, messages);
  EXPECT_EQ(scene.findMaterial("a", messages), std::optional<size_t>(0));
  EXPECT_TRUE(messages.empty());
  EXPECT_EQ(scene.findMaterial("b", messages), std::optional<size_t>(1));
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0].code, "duplicate-name");
  EXPECT_EQ(messages[0].level, Message::Level::Warning);
  EXPECT_EQ(scene.findMaterial("c", messages), std::nullopt);
  EXPECT_EQ(scene.findMaterial(std::nullopt, messages), std::nullopt);
  EXPECT_EQ(errorsOf(messages), "no-such-material no-such-material");
  EXPECT_EQ(paintScene().findMaterial(std::nullopt, messages), std::optional<size_t>(0));
  const Scene none = Scene::fromMemory(R"({"asset": {"version": "2.0"}})", "none.gltf", {}, messages);
  EXPECT_EQ(none.findMaterial(std::nullopt, messages), std::nullopt);
}

/// The const functions of one scene, and those of one shader, from several threads at once.
TEST(Threads, readOneSceneAndOneShader) {
  const Scene scene = paintScene();
  Messages messages;
  const Shader shader = paintGraph().generate(quick(), messages);
  std::vector<std::string> texts(4);
  std::vector<std::thread> threads;
  for (std::string& text : texts) {
    threads.emplace_back([&scene, &shader, &text] {
      Messages own;
      text = scene.graph(0, {}, quick(), own).generate(quick(), own).fragmentText(Target::Glsl);
      std::vector<std::byte> block(shader.uniformSize());
      if (!shader.pack({}, block)) text.clear();
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::string& text : texts) EXPECT_EQ(text, shader.fragmentText(Target::Glsl));
}

}  // namespace
}  // namespace lacquer::test
