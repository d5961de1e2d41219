// Images for tiles: an array whose layers are files.
#include <gtest/gtest.h>

#include <fstream>

#include "inputs.h"

namespace lacquer::test {
namespace {

/// A PNG of one pixel, as hexadecimal digits: a red of 51, or of 102.
constexpr const char* kDark =
    "89504e470d0a1a0a0000000d4948445200000001000000010802000000907753de0000000c4944415478da633066600000009d00"
    "34d8a6e4540000000049454e44ae426082";
constexpr const char* kBright =
    "89504e470d0a1a0a0000000d4948445200000001000000010802000000907753de0000000c4944415478da634863600000013600"
    "6744ce5e570000000049454e44ae426082";

void writeImage(const std::filesystem::path& path, std::string_view digits) {
  std::ofstream file(path, std::ios::binary);
  for (size_t i = 0; i + 1 < digits.size(); i += 2)
    file.put(static_cast<char>(std::stoi(std::string(digits.substr(i, 2)), nullptr, 16)));
}

std::string tiledGraph(const std::string& type, const std::string& file) {
  return R"({"lacquer_graph": 1, "name": "tiled", "template": "forward", "parameters": {},
  "textures": {"wood": {"type": ")" +
         type + R"(", "srgb": false, "file": ")" + file + R"(", "wrap": "clamp", "default": [0.8, 0, 0, 1]}},
  "nodes": [{"id": "tile", "node": "texture_tiles", "inputs": {"tiles": {"texture": "wood"}, "outside": [0.1, 0, 0, 1]}}],
  "outputs": {"emission": {"node": "tile", "swizzle": "rgb"}}, "skipped": {}})";
}

std::optional<Evaluation> tileColors(const std::filesystem::path& folder, const std::string& graph,
                                     Engine engine, Messages& messages) {
  const std::string path = (folder / "tiled.json").string();
  std::ofstream(path) << graph;
  constexpr const char* kPoints = R"([{"uv0": [0.5, 0.5], "n": [0, 0, 1], "v": [0, 0, 1], "l": [0, 0, 1]},
    {"uv0": [1.5, 1.5], "n": [0, 0, 1], "v": [0, 0, 1], "l": [0, 0, 1]},
    {"uv0": [2.5, 0.5], "n": [0, 0, 1], "v": [0, 0, 1], "l": [0, 0, 1]},
    {"uv0": [5.5, 5.5], "n": [0, 0, 1], "v": [0, 0, 1], "l": [0, 0, 1]}])";
  return evaluate(path, "", kPoints, "points", engine, {}, quick(), messages);
}

TEST(Tiles, AreFilesBesideTheGraph) {
  const std::filesystem::path folder = emptyFolder();
  std::filesystem::create_directories(folder);
  writeImage(folder / "wood.1001.png", kDark);
  writeImage(folder / "wood.1012.png", kBright);
  const std::string graph = tiledGraph("sampler2DArray", "wood.<UDIM>.png");
  Messages messages;
  for (const Engine engine : {Engine::Double, Engine::Float, Engine::Vulkan, Engine::VulkanHlsl}) {
    const auto colors = tileColors(folder, graph, engine, messages);
    if (!colors && errorsOf(messages) == "vulkan-unavailable")
      GTEST_SKIP() << "NOT TESTED: there is no Vulkan device";
    ASSERT_TRUE(colors) << errorsOf(messages);
    const double expected[] = {0.2, 0.4, 0.8, 0.1};
    for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(colors->rgba[i][0], expected[i], 2e-3) << i;
  }
  EXPECT_EQ(errorsOf(messages), "");
}

/// Four linear numbers, whatever the images' texels hold.
TEST(Tiles, StandForMissingOnesAsTheyAre) {
  const std::filesystem::path folder = emptyFolder();
  std::filesystem::create_directories(folder);
  writeImage(folder / "wood.1001.png", kDark);
  writeImage(folder / "wood.1012.png", kBright);
  std::string graph = tiledGraph("sampler2DArray", "wood.<UDIM>.png");
  graph.replace(graph.find("\"srgb\": false"), 13, "\"srgb\": true");
  graph.replace(graph.find("[0.8, 0, 0, 1]"), 14, "[2, 0.5, 0.001, 1]");
  Messages messages;
  for (const Engine engine : {Engine::Double, Engine::Float, Engine::Vulkan}) {
    const auto colors = tileColors(folder, graph, engine, messages);
    if (!colors && errorsOf(messages) == "vulkan-unavailable")
      GTEST_SKIP() << "NOT TESTED: there is no Vulkan device";
    ASSERT_TRUE(colors) << errorsOf(messages);
    const double expected[] = {2, 0.5, 0.001};
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(colors->rgba[2][c], expected[c], 1e-6);
  }
}

/// A document's image for each tile: found, a layer that is missing between others, and beyond the last.
TEST(Tiles, OfDocuments) {
  for (const std::string token : {"&lt;UDIM&gt;", "&lt;UVTILE&gt;"}) {
    const std::filesystem::path folder = emptyFolder();
    std::filesystem::create_directories(folder);
    const bool numbers = token == "&lt;UDIM&gt;";
    writeImage(folder / (numbers ? "wood.1001.png" : "wood.u1_v1.png"), kDark);
    writeImage(folder / (numbers ? "wood.1012.png" : "wood.u2_v2.png"), kBright);
    for (const std::string node : {"image", "gltf_image", "UsdUVTexture"}) {
      const bool usd = node == "UsdUVTexture";
      const std::string path = (folder / "tiled.mtlx").string();
      std::ofstream(path) << R"(<materialx version="1.39"><nodegraph name="NG"><)" + node +
                                 R"( name="i" type=")" + (usd ? "multioutput" : "color3") +
                                 R"("><input name="file" type="filename" value="wood.)" + token +
                                 R"(.png"/><input name=")" + (usd ? "fallback" : "default") + R"(" type=")" +
                                 (usd ? "color4" : "color3") + R"(" value="0.8, 0, 0)" + (usd ? ", 1" : "") +
                                 R"("/></)" + node + R"(><output name="out" type="color3" nodename="i")" +
                                 (usd ? R"( output="rgb")" : "") + "/></nodegraph></materialx>";
      constexpr const char* kPoints =
          R"([{"uv0": [0.5, 0.5]}, {"uv0": [1.5, 1.5]}, {"uv0": [2.5, 0.5]}, {"uv0": [5.5, 5.5]}, {"uv0": [-0.5, 0.5]}])";
      Messages messages;
      for (const Engine engine : {Engine::Double, Engine::Float}) {
        const auto colors = evaluate(path, "", kPoints, "points", engine, {}, quick(), messages);
        ASSERT_TRUE(colors) << errorsOf(messages);
        const double expected[] = {0.2, 0.4, 0.8, 0.8, 0.8};
        for (size_t i = 0; i < 5; ++i)
          EXPECT_NEAR(colors->rgba[i][0], expected[i], 2e-3) << node << token << i;
      }
      for (const Message& message : messages) EXPECT_EQ(message.code, "") << message.text;
    }
  }
}

TEST(Tiles, AreSaidWhereTheyAreNot) {
  const std::filesystem::path folder = emptyFolder();
  std::filesystem::create_directories(folder);
  // The default stands for an image that is not there; without one that is an error.
  Messages absent;
  const std::string graph = tiledGraph("sampler2DArray", "wood.<UDIM>.png");
  const auto colors = tileColors(folder, graph, Engine::Double, absent);
  ASSERT_TRUE(colors) << errorsOf(absent);
  EXPECT_NEAR(colors->rgba[0][0], 0.8, 1e-6);
  constexpr std::string_view kDefault = R"(, "default": [0.8, 0, 0, 1])";
  std::string bare = graph;
  bare.erase(bare.find(kDefault), kDefault.size());
  Messages none;
  EXPECT_FALSE(tileColors(folder, bare, Engine::Double, none));
  EXPECT_EQ(errorsOf(none), "image-missing");
  Messages one;
  EXPECT_FALSE(tileColors(folder, tiledGraph("sampler2DArray", "wood.png"), Engine::Double, one));
  EXPECT_EQ(errorsOf(one), "wrong-texture");
}

}  // namespace
}  // namespace lacquer::test
