// A graph is a material: what it shows is what the material shows that it was built of, to the last bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "inputs.h"
#include "support/answers.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

/// What points are given of vertices: everything.
const Attributes kAll{true, true, true, {true, true, true, true}, {}, false, false, false, {}};

constexpr const char* kLit = R"([
  {"n": [0, 0, 1], "v": [0, 0.6, 0.8], "l": [0.6, 0, 0.8], "uv0": [0.3, 0.7], "env": [0.3, 0.2, 0.1]},
  {"n": [0, 0, 1], "v": [0.8, 0, 0.6], "l": [0, 0, 1], "env": [1, 0.5, 0.25], "uv0": [-0.4, 1.2]},
  {"n": [0, 1, 0], "v": [0, 0.6, 0.8], "l": [0, 1, 0], "light": [3, 2, 1], "front_facing": false,
   "color0": [1, 0.5, 1, 0.25]}])";
constexpr const char* kDark = R"([{"v": [0, 0.6, 0.8], "l": [0.6, 0, 0.8], "uv0": [0.3, 0.7]}])";

/// Without the profile, which a graph does not have.
std::string colorsOf(std::string answer) {
  const size_t at = answer.find("  \"profile\"");
  if (at != std::string::npos) answer.erase(at, answer.find('\n', at) + 1 - at);
  return answer;
}

/// Another constant for each texel, by its property's name or by that of another property that has it.
Strings texelsOf(const Graph& graph) {
  Strings texels;
  for (const TextureUse& texture : graph.textures()) {
    const std::string& pointer = texture.also.empty() ? texture.pointer : texture.also.back();
    texels.push_back(pointer.substr(pointer.rfind('/') + 1) + "=0." + std::to_string(3 + texels.size() % 5) +
                     ",0.5,0.9,0.8");
  }
  return texels;
}

/// Compares each material of a file, and counts what it has compared.
size_t compareGraphsOf(const std::string& file, const Options& options, bool without_images = false) {
  size_t compared = 0;
  Messages messages;
  const Scene scene = Scene::load(file, options, messages);
  for (size_t i = 0; i < scene.materialCount(); ++i) {
    SCOPED_TRACE(file + ": " + scene.materialName(i));
    for (const char* points : {kLit, kDark}) {
      // For points without an environment a material is built without one.
      Options built = options;
      built.ibl = points == kLit;
      const Graph graph = scene.graph(i, kAll, built, messages);
      const Strings texels = without_images ? texelsOf(graph) : Strings();
      for (const Engine engine : {Engine::Double, Engine::Float}) {
        const std::string expected = jsonOf(evaluate(scene, i, points, engine, texels, options, messages));
        EXPECT_NE(expected, "");
        EXPECT_EQ(jsonOf(evaluate(graph, points, engine, texels, options, messages)), colorsOf(expected));
        ++compared;
      }
    }
  }
  EXPECT_EQ(errorsOf(messages), "") << file;
  return compared;
}

TEST(Graphs, HaveTheColorsOfTheirMaterials) {
  size_t compared = 0;
  for (const std::string& file : examples()) compared += compareGraphsOf(file, quick());
  EXPECT_GT(compared, 100u);
}

/// The same of a folder of files that is no part of the project, LACQUER_ASSETS or ../shared/assets.
TEST(Graphs, HaveTheColorsOfTheirMaterialsInRealFiles) {
  const char* named = std::getenv("LACQUER_ASSETS");
  const std::filesystem::path folder = named != nullptr ? named : sourceFolder() / "../shared/assets";
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << folder << " is not there";
  Strings files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string path = entry.path().string();
    if (path.ends_with(".gltf") || path.ends_with(".glb")) files.push_back(path);
  }
  std::sort(files.begin(), files.end());
  // Their images need not be there.
  for (const std::string& file : files) compareGraphsOf(file, quick(), true);
}

constexpr const char* kCoatNormal = "/materials/0/extensions/KHR_materials_clearcoat/clearcoatNormalTexture";

/// An image that several properties have goes by one of them, whatever the graph is built for, so that a
/// constant for that one reaches it.
TEST(Graphs, NameSharedImagesAsTheirMaterialsDo) {
  const std::string text = R"({"asset": {"version": "2.0"}, "images": [{"uri": "absent.png"}],
    "textures": [{"source": 0}], "extensionsUsed": ["KHR_materials_clearcoat", "KHR_materials_anisotropy"],
    "materials": [{"name": "Lamp", "normalTexture": {"index": 0}, "extensions": {
      "KHR_materials_anisotropy": {"anisotropyStrength": 0.75},
      "KHR_materials_clearcoat": {"clearcoatFactor": 0.25, "clearcoatNormalTexture": {"index": 0}}}}]})";
  Messages messages;
  const Options options = quick();
  const Scene scene = Scene::fromMemory(text, "lamp.gltf", options, messages);
  Options built = options;
  built.ibl = false;
  Attributes bare{true, false, false, {true, false, false, false}, {}, false, false, false, {}};
  for (const Attributes& attributes : {kAll, kUnusedAttributes, bare}) {
    const Graph graph = scene.graph(0, attributes, built, messages);
    ASSERT_EQ(graph.textures().size(), 1U);
    EXPECT_EQ(graph.textures()[0].name, "normal_texture");
    EXPECT_EQ(graph.textures()[0].also, Strings{kCoatNormal});
  }
  const Graph graph = scene.graph(0, kAll, built, messages);
  EXPECT_EQ(Graph::fromJson(graph.toJson(), "lamp.json", messages).textures()[0].also, Strings{kCoatNormal});
  const std::string white =
      jsonOf(evaluate(scene, 0, kDark, Engine::Double, {"normalTexture=0.5,0.5,1,1"}, options, messages));
  // Each name reaches it.
  for (const Strings& texels :
       {Strings{"normalTexture=0.6,0.5,0.9,1"}, Strings{"clearcoatNormalTexture=0.6,0.5,0.9,1"},
        Strings{"normalTexture=0.6,0.5,0.9,1", "clearcoatNormalTexture=0.6,0.5,0.9,1"}}) {
    const std::string expected = jsonOf(evaluate(scene, 0, kDark, Engine::Double, texels, options, messages));
    EXPECT_NE(expected, "");
    EXPECT_NE(expected, white);
    EXPECT_EQ(jsonOf(evaluate(graph, kDark, Engine::Double, texels, options, messages)), colorsOf(expected));
  }
  EXPECT_EQ(errorsOf(messages), "");
  const Strings two{"normalTexture=0.6,0.5,0.9,1", "clearcoatNormalTexture=0.5,0.5,1,1"};
  EXPECT_FALSE(evaluate(scene, 0, kDark, Engine::Double, two, options, messages));
  EXPECT_FALSE(evaluate(graph, kDark, Engine::Double, two, options, messages));
  ASSERT_EQ(messages.size(), 2u);
  for (const Message& message : messages) {
    EXPECT_EQ(message.code, "texels-differ");
    EXPECT_NE(message.message.find("clearcoatNormalTexture and normalTexture are one texel"),
              std::string::npos);
  }
}

TEST(Graphs, LookLikeTheirMaterials) {
  const Options options = quick();
  Messages messages;
  for (const std::string& file : examples()) {
    if (file.find("car_paint") == std::string::npos && file.find("film") == std::string::npos) continue;
    const Scene scene = Scene::load(file, options, messages);
    for (size_t i = 0; i < scene.materialCount(); ++i) {
      const Graph graph = scene.graph(i, kAll, options, messages);
      const std::vector<uint8_t> expected = drawBall(scene, i, 24, {}, options, messages);
      EXPECT_EQ(expected.size(), 24u * 24u * 3u);
      EXPECT_EQ(drawBall(graph, 24, {}, options, messages), expected) << file;
    }
  }
  EXPECT_EQ(errorsOf(messages), "");
}

/// Counts of lights are those of the shader, whichever engine computes it.
TEST(Graphs, AreLitAlikeInBothEngines) {
  Options options = quick();
  Messages messages;
  const Scene scene = Scene::load((sourceFolder() / "examples/coat.gltf").string(), options, messages);
  double lit = 0;
  for (const bool none : {false, true}) {
    options.lights.mode = Lights::Mode::Fixed;
    options.lights.counts = {{"directional", none ? 0U : 1U}};
    const auto exact = evaluate(scene, 0, kDark, Engine::Double, {}, options, messages);
    const auto single = evaluate(scene, 0, kDark, Engine::Float, {}, options, messages);
    ASSERT_TRUE(exact && single) << errorsOf(messages);
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(exact->rgba[0][c], single->rgba[0][c], 1e-5);
    if (none)
      EXPECT_LT(exact->rgba[0][0], lit);
    else
      lit = exact->rgba[0][0];
  }
}

/// A value that was edited is seen at once, without glTF.
TEST(Graphs, ShowWhatWasEdited) {
  const Options options = quick();
  Messages messages;
  Graph graph = paintGraph();
  ASSERT_FALSE(graph.parameters().empty());
  const std::string before = jsonOf(evaluate(graph, kDark, Engine::Double, {}, options, messages));
  const Parameter parameter = graph.parameters()[0];
  std::vector<double> other = parameter.value;
  for (double& x : other) x = x > 0.5 ? 0.25 : 0.75;
  EXPECT_TRUE(graph.setParameter(parameter.name, other, messages));
  const std::string after = jsonOf(evaluate(graph, kDark, Engine::Double, {}, options, messages));
  EXPECT_NE(before, "");
  EXPECT_NE(after, before);
  EXPECT_TRUE(graph.setParameter(parameter.name, parameter.value, messages));
  EXPECT_EQ(jsonOf(evaluate(graph, kDark, Engine::Double, {}, options, messages)), before);
  // The text reads back as the same graph.
  const Graph again = Graph::fromJson(graph.toJson(), "again", messages);
  EXPECT_EQ(jsonOf(evaluate(again, kDark, Engine::Double, {}, options, messages)), before);
  EXPECT_EQ(errorsOf(messages), "");
}

std::vector<std::byte> blockOf(const Shader& shader) {
  std::vector<std::byte> block(shader.uniformSize());
  EXPECT_TRUE(shader.pack([](std::string_view, std::span<double>) { return false; }, block));
  return block;
}

TEST(Graphs, HaveWhatTheyWereBuiltWith) {
  for (const std::string& file : examples()) {
    if (!file.ends_with("/coat.gltf")) continue;
    Options options = quick();
    options.simplify = {"without:coat", "scale:baseColorFactor=0.5"};
    Messages messages;
    const Scene scene = Scene::load(file, options, messages);
    Graph graph = scene.graph(0, kUnusedAttributes, options, messages);
    const Shader shader = graph.generate(options, messages);
    EXPECT_EQ(errorsOf(messages), "");
    // Once, not twice.
    options.simplify = {};
    const Shader again = graph.generate(options, messages);
    EXPECT_EQ(again.id(), shader.id());
    EXPECT_EQ(blockOf(again), blockOf(shader));
    return;
  }
  FAIL() << "examples/coat.gltf is not there";
}

TEST(Graphs, SayWhatTheyCannotBeAskedFor) {
  const Graph graph = paintGraph();
  const auto errors = [&](auto change) {
    Options options = quick();
    change(options);
    Messages messages;
    EXPECT_EQ(jsonOf(evaluate(graph, kDark, Engine::Double, {}, options, messages)), "");
    return errorsOf(messages);
  };
  EXPECT_EQ(errors([](Options& o) { o.profile = "physical"; }), "graph-is-built");
  EXPECT_EQ(errors([](Options& o) { o.template_name = "surface"; }), "graph-is-built");
  EXPECT_EQ(errors([](Options& o) { o.simplify = {"without:coat"}; }), "graph-is-built");
  EXPECT_EQ(errors([](Options& o) { o.live = {"coat.darkening"}; }), "graph-is-built");
  EXPECT_EQ(errors([](Options& o) { o.switches["ibl"] = false; }), "graph-is-built");
  Messages messages;
  EXPECT_EQ(jsonOf(evaluate(Graph(), kDark, Engine::Double, {}, quick(), messages)), "");
  EXPECT_EQ(errorsOf(messages), "empty-handle");
}

/// A run over graphs says all that is wrong with one and makes the others.
TEST(Graphs, ThatAreWrongAreSaidInARun) {
  const std::filesystem::path folder = emptyFolder();
  const auto write = [&](const std::string& name, const std::string& parts) {
    std::ofstream(folder / name) << R"({"lacquer_graph": 1, "template": "bsdf", )" << parts << "}";
    return (folder / name).string();
  };
  const Strings files = {
      write(
          "missing.json",
          R"("nodes": [{"id": "e", "node": "emission", "inputs": {"factor": {"node": "nobody"}, "strength": 1}},
              {"id": "q", "node": "nothing"}, {"id": "g", "group": "none"}], "outputs": {"alpha": {"node": "z"}})"),
      write("circle.json",
            R"("nodes": [{"id": "a", "node": "add", "inputs": {"in1": {"node": "b"}, "in2": 1}},
              {"id": "b", "node": "add", "inputs": {"in1": {"node": "a"}, "in2": 1}}], "outputs": {"alpha": {"node": "a"}})"),
      write("good.json", R"("outputs": {"alpha": 0.5})")};
  Options options = quick();
  options.sync = false;
  Messages messages;
  const Report report = generate(files, {}, (folder / "out").string(), options, messages);
  EXPECT_FALSE(report.ok);
  EXPECT_EQ(errorsOf(messages), "unknown-source unknown-node unknown-group unknown-source cycle");
  EXPECT_TRUE(std::filesystem::exists(folder / "out/manifest.json"));
}

/// Outside of its file a graph has no images: each is given, or said to be absent.
TEST(Graphs, FromATextHaveTheTexelsThatTheyAreGiven) {
  const Options options = quick();
  Messages messages;
  for (const std::string& file : examples()) {
    if (file.find("clearcoat_color") == std::string::npos) continue;
    const Scene scene = Scene::load(file, options, messages);
    for (size_t i = 0; i < scene.materialCount(); ++i) {
      const Graph whole = scene.graph(i, kAll, options, messages);
      if (whole.textures().empty()) continue;
      const Graph graph = Graph::fromJson(whole.toJson(), "graph", messages);
      EXPECT_EQ(errorsOf(messages), "");
      EXPECT_EQ(jsonOf(evaluate(graph, kDark, Engine::Double, {}, options, messages)), "");
      EXPECT_NE(errorsOf(messages).find("image-missing"), std::string::npos);
      messages.clear();
      Strings texels;
      for (const TextureUse& texture : whole.textures()) texels.push_back(texture.name + "=0.25,0.5,0.75,1");
      const std::string expected =
          jsonOf(evaluate(scene, i, kDark, Engine::Double, texels, options, messages));
      EXPECT_NE(expected, "");
      EXPECT_EQ(jsonOf(evaluate(graph, kDark, Engine::Double, texels, options, messages)),
                colorsOf(expected));
      EXPECT_EQ(errorsOf(messages), "");
    }
  }
}

}  // namespace
}  // namespace lacquer::test
