// Whole pictures: what must be equal in them, and what is said of files that are broken.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "renderer.h"
#include "support/base64.h"

namespace lacquer::test::picture_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const fs::path kStillLife = fs::path(LACQUER_SOURCE) / "examples/renderer/still_life.glb";

std::string bytesOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// How many pixels differ by more than a part of themselves.
size_t differing(const Picture& a, const Picture& b, float part) {
  EXPECT_EQ(a.pixels.size(), b.pixels.size());
  size_t count = 0;
  for (size_t i = 0; i < std::min(a.pixels.size(), b.pixels.size()); ++i) {
    bool differs = false;
    for (size_t c = 0; c < 3; ++c)
      differs |= std::abs(a.pixels[i][c] - b.pixels[i][c]) > part * std::max(a.pixels[i][c], 0.01F);
    count += differs ? 1 : 0;
  }
  return count;
}

class Pictures : public testing::Test {
protected:
  void SetUp() override {
    if (!canDraw()) GTEST_SKIP() << "no Vulkan device";
    if (!haveValidation())
      std::printf("the validation layer is not installed (Debian: vulkan-validationlayers)\n");
  }
  const std::vector<std::string> small_{"--size", "320x180", "--samples", "1"};
  std::vector<std::string> with(std::vector<std::string> more) const {
    more.insert(more.end(), small_.begin(), small_.end());
    return more;
  }
};

TEST_F(Pictures, TheValidationLayerIsThere) {
  if (!haveValidation()) GTEST_SKIP() << "it is not installed";
  const Ran made = run({"none.glb", "-o", (place() / "none.png").string(), "--cache", cacheFolder()},
                       "VK_LOADER_DEBUG=layer");
  EXPECT_NE(made.said.find("VK_LAYER_KHRONOS_validation"), std::string::npos) << made.said;
}

TEST_F(Pictures, ADepthPrepassWithEqualDrawsEveryPixel) {
  for (const char* seconds : {"0", "1.25"}) {
    const Picture plain = draw(kStillLife, with({"--time", seconds}));
    const Picture after = draw(kStillLife, with({"--time", seconds, "--prepass"}));
    EXPECT_EQ(differing(plain, after, 0), 0U);
  }
}

TEST_F(Pictures, TheFileMoves) {
  const Picture at_0 = draw(kStillLife, with({}));
  EXPECT_EQ(differing(at_0, draw(kStillLife, with({"--time", "4"})), 0), 0U) << "the end is the beginning";
  EXPECT_GT(differing(at_0, draw(kStillLife, with({"--time", "2"})), 0.1F), 1000U);
}

TEST_F(Pictures, VariantsChooseMaterials) {
  const Picture red = draw(kStillLife, with({})), same = draw(kStillLife, with({"--variant", "red"})),
                green = draw(kStillLife, with({"--variant", "green"}));
  EXPECT_EQ(differing(red, same, 0), 0U);
  // On the vase.
  EXPECT_GT(red.at(140, 100)[0], 2 * red.at(140, 100)[1]);
  EXPECT_GT(green.at(140, 100)[1], 2 * green.at(140, 100)[0]);
  EXPECT_EQ(run({kStillLife.string(), "-o", (place() / "x.png").string(), "--variant", "blue", "--cache",
                 cacheFolder()})
                .status,
            1);
}

/// Glass among what is opaque: the passes are the materials' own.
TEST_F(Pictures, SharedProgramsDrawTheSame) {
  const Picture own = draw(kStillLife, with({})), shared = draw(kStillLife, with({"--programs", "1"}));
  EXPECT_LT(differing(own, shared, 0.002F), own.pixels.size() / 1000);
}

/// The first frame has the fallback's pipelines, the last the materials' own in their places: the same sets,
/// the same vertex buffers.
TEST_F(Pictures, FallbacksDrawTheSame) {
  const Picture own = draw(kStillLife, with({}));
  const Picture first = draw(kStillLife, with({"--fallback", "first"}));
  const Picture last = draw(kStillLife, with({"--fallback", "last"}));
  EXPECT_LT(differing(own, first, 0.002F), own.pixels.size() / 1000);
  EXPECT_GT(differing(own, first, 0), 0U) << "no fallback was drawn with";
  EXPECT_EQ(differing(own, last, 0), 0U);
}

TEST_F(Pictures, OtherTemplatesDraw) {
  const Picture ids = draw(kStillLife, with({"--template", "id"}));
  std::set<float> numbers;
  for (const auto& pixel : ids.pixels) numbers.insert(pixel[0]);
  EXPECT_GT(numbers.size(), 12U);
  for (const char* name : {"surface", "motion", "forward"}) {
    const Picture picture = draw(kStillLife, with({"--template", name}));
    EXPECT_FALSE(picture.pixels.empty()) << name;
  }
}

TEST_F(Pictures, SomethingIsInTheShade) {
  // The vase's shadow falls on the table, to its right; farther to the right the table is lit.
  const Picture picture = draw(kStillLife, with({"--environment", uniformSky(0.001F)}));
  const auto mean = [&](uint32_t x, uint32_t y) {
    float sum = 0;
    for (uint32_t dx = 0; dx < 5; ++dx) sum += picture.at(x + dx, y)[1] / 5;
    return sum;
  };
  EXPECT_LT(mean(172, 120), 0.2F * mean(272, 135));
  EXPECT_GT(mean(272, 135), 0.05F);
}

TEST_F(Pictures, TheScriptWritesTheModel) {
  const fs::path made = place() / "still_life.glb";
  const std::string script = std::string(LACQUER_SOURCE) + "/examples/renderer/still_life.py";
  if (std::system(("python3 '" + script + "' '" + made.string() + "'").c_str()) != 0)
    GTEST_SKIP() << "there is no Python";
  EXPECT_TRUE(bytesOf(made) == bytesOf(kStillLife)) << "run examples/renderer/still_life.py";
}

/// The model's JSON, changed, with its bytes.
fs::path changed(const char* name, const std::function<void(Json&)>& change) {
  const std::string bytes = bytesOf(kStillLife);
  uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, 4);
  Json json = Json::parse(bytes.substr(20, length));
  change(json);
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string glb = bytes.substr(0, 20) + text + bytes.substr(20 + length);
  const auto put = [&](size_t at, size_t value) {
    const auto word = static_cast<uint32_t>(value);
    std::memcpy(glb.data() + at, &word, 4);
  };
  put(8, glb.size());
  put(12, text.size());
  const fs::path path = place() / name;
  std::ofstream(path, std::ios::binary) << glb;
  return path;
}

/// The model with a node that says whether it is seen, and at the beginning of its animation is not.
fs::path hiding(const char* name, bool visible, bool animated) {
  return changed(name, [&](Json& j) {
    size_t node = 0;
    while (!j["nodes"][node].contains("mesh")) ++node;
    j["nodes"][node]["extensions"]["KHR_node_visibility"] = {{"visible", visible}};
    if (!animated) return;
    Json& animation = j["animations"][0];
    const Json times = animation["samplers"][0]["input"];  // 0 is the first
    const std::string pointer = "/nodes/" + std::to_string(node) + "/extensions/KHR_node_visibility/visible";
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size()},
         {"target",
          {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}});
    animation["samplers"].push_back({{"input", times}, {"output", times}, {"interpolation", "STEP"}});
  });
}

TEST_F(Pictures, WhatIsHiddenIsNotDrawn) {
  const Picture still = draw(kStillLife, with({}));
  EXPECT_EQ(differing(still, draw(hiding("visible.glb", true, false), with({})), 0), 0U);
  const Picture hidden = draw(hiding("hidden.glb", false, false), with({}));
  EXPECT_GT(differing(still, hidden, 0.1F), 100U);
  const fs::path blinks = hiding("blinks.glb", true, true);
  EXPECT_EQ(differing(hidden, draw(blinks, with({})), 0), 0U);
  const std::vector<std::string> later = with({"--time", "3"});
  EXPECT_EQ(differing(draw(kStillLife, later), draw(blinks, later), 0), 0U);
}

Ran drawn(const fs::path& path) {
  return run({path.string(), "-o", (place() / "broken.png").string(), "--size", "64x36", "--samples", "1",
              "--cache", cacheFolder()});
}

struct Broken {
  const char* name;
  int status;
  const char* says;
  void (*change)(Json&);
};
constexpr Broken kBroken[] = {
    {"accessor_count", 0, "absent, too short or of a wrong type",
     [](Json& j) { j["accessors"][0]["count"] = 100000000; }},
    {"accessor_type", 0, "absent, too short or of a wrong type",
     [](Json& j) { j["accessors"][0]["type"] = "VEC2"; }},
    {"view_absent", 0, "absent, too short or of a wrong type",
     [](Json& j) { j["accessors"][0]["bufferView"] = 9999; }},
    {"view_outside", 0, "absent, too short or of a wrong type",
     [](Json& j) {
       j["bufferViews"][j["accessors"][0]["bufferView"].get<size_t>()]["byteOffset"] = 1000000000;
     }},
    {"indices_wrong", 0, "absent, too short or of a wrong type",
     [](Json& j) { j["meshes"][0]["primitives"][0]["indices"] = 0; }},
    {"texture_absent", 0, "has no image that can be read",
     [](Json& j) {
       j["images"][0] = {{"uri", "none.png"}};
     }},
    {"children_in_circles", 0, "primitives", [](Json& j) { j["nodes"][0]["children"] = {0}; }},
    {"joints_absent", 0, "primitives", [](Json& j) { j["skins"][0]["joints"][0] = 100000; }},
    {"no_scene", 1, "scene", [](Json& j) { j["scene"] = 12; }},
    {"no_meshes_drawn", 1, "nothing to draw", [](Json& j) { j["scenes"][0]["nodes"] = Json::array(); }},
    {"animation_without_data", 0, "it rests",
     [](Json& j) { j["animations"][0]["samplers"][0]["output"] = 99999; }},
};

TEST_F(Pictures, BrokenFilesAreToldOf) {
  for (const Broken& one : kBroken) {
    SCOPED_TRACE(one.name);
    const Ran made = drawn(changed("broken.glb", one.change));
    EXPECT_EQ(made.status, one.status) << made.said;
    EXPECT_NE(made.said.find(one.says), std::string::npos) << made.said;
  }
  const fs::path path = place() / "short.glb";
  const std::string bytes = bytesOf(kStillLife);
  for (const size_t size : {size_t{0}, size_t{11}, size_t{40}, bytes.size() / 2}) {
    std::ofstream(path, std::ios::binary) << bytes.substr(0, size);
    EXPECT_EQ(drawn(path).status, 1) << size;
  }
  std::ofstream(place() / "absent.gltf")
      << R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 9, "uri": "none.bin"}],
    "scenes": [{"nodes": []}], "scene": 0})";
  const Ran made = drawn(place() / "absent.gltf");
  EXPECT_EQ(made.status, 1);
  EXPECT_NE(made.said.find("none.bin"), std::string::npos) << made.said;
}

/// The container of glTF 2.1: lengths of 64 bits, the JSON behind the buffer, which names its chunk.
TEST_F(Pictures, AGlbOfVersionThreeDrawsTheSame) {
  const std::string bytes = bytesOf(kStillLife);
  uint32_t size = 0;
  std::memcpy(&size, bytes.data() + 12, 4);
  Json json = Json::parse(bytes.substr(20, size));
  json["asset"] = {{"version", "2.1"}, {"minVersion", "2.1"}};
  json["buffers"][0]["chunk"] = 1;
  std::string chunks;
  const auto add = [&](const char* type, const std::string& data) {
    chunks.resize((chunks.size() + 7) / 8 * 8);
    const uint64_t length = data.size();
    chunks += std::string(type, 4) + std::string(4, '\0') +
              std::string(reinterpret_cast<const char*>(&length), sizeof length) + data;
  };
  add("mine", "12345");
  add("BIN", bytes.substr(20 + size + 8));
  add("JSON", json.dump());
  const uint64_t head[2] = {uint64_t{3} << 32 | 0x46546C67, sizeof head + chunks.size()};
  const fs::path path = place() / "three.glb";
  std::ofstream(path, std::ios::binary)
      << std::string(reinterpret_cast<const char*>(head), sizeof head) << chunks;
  EXPECT_EQ(differing(draw(kStillLife, with({})), draw(path, with({})), 0), 0U);
}

/// A cube map of one colour to a face in a KTX2 file of floats, as a data URI.
std::string cubeOf(const std::array<std::array<float, 3>, 6>& faces) {
  const auto word = [](uint64_t value, size_t count) {
    return std::string(reinterpret_cast<const char*>(&value), count);
  };
  std::string file("\xABKTX 20\xBB\r\n\x1A\n", 12);
  for (const uint32_t field : {106U, 4U, 8U, 8U, 0U, 0U, 6U, 1U, 0U, 0U, 0U, 0U, 0U}) file += word(field, 4);
  constexpr size_t kTexels = 64, kBytes = 6 * kTexels * 12;
  file += std::string(16, '\0') + word(104, 8) + word(kBytes, 8) + word(kBytes, 8);
  for (const auto& color : faces) {
    for (size_t i = 0; i < kTexels; ++i) file.append(reinterpret_cast<const char*>(color.data()), 12);
  }
  return "data:image/ktx2;base64," + toBase64(file);
}

/// The model in surroundings of its own.
fs::path surrounded(const char* name, const std::array<std::array<float, 3>, 6>& faces, bool box) {
  return changed(name, [&](Json& j) {
    Json light = {{"cubemap", 0}};
    if (box) light.update({{"boundingBoxMin", {-3, -3, -3}}, {"boundingBoxMax", {3, 3, 3}}});
    j["extensions"]["KHR_lights_environment"] = {{"images", {{{"uri", cubeOf(faces)}}}},
                                                 {"cubemaps", {{{"source", 0}, {"intensity", 2}}}},
                                                 {"lights", {light}}};
    j["scenes"][0]["extensions"]["KHR_lights_environment"]["light"] = 0;
  });
}

TEST_F(Pictures, TheScenesOwnEnvironmentLightsIt) {
  const std::array<float, 3> quarter = {0.25F, 0.25F, 0.25F};
  const Picture own =
      draw(surrounded("lit.glb", {quarter, quarter, quarter, quarter, quarter, quarter}, false), with({}));
  const Picture sky = draw(kStillLife, with({"--environment", uniformSky(0.5F)}));
  EXPECT_LT(differing(own, sky, 0.01F), own.pixels.size() / 500);
  EXPECT_GT(differing(own, draw(kStillLife, with({})), 0.05F), own.pixels.size() / 4) << "the studio";
}

/// What is near the walls of a room mirrors other places of them than from its middle.
TEST_F(Pictures, ARoomHasWalls) {
  const std::array<std::array<float, 3>, 6> walls = {
      {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {2, 2, 0}, {0, 2, 2}, {2, 0, 2}}};
  const Picture far = draw(surrounded("far.glb", walls, false), with({}));
  const Picture near = draw(surrounded("near.glb", walls, true), with({}));
  EXPECT_GT(differing(far, near, 0.1F), 300U);
}

TEST_F(Pictures, WrongWordsAreToldOf) {
  const std::string scene = kStillLife.string();
  EXPECT_EQ(run({}).status, 1);
  EXPECT_EQ(run({scene}).status, 1);
  EXPECT_EQ(run({scene, "-o", "x.png", "--size", "0x9"}).status, 1);
  EXPECT_EQ(run({scene, "-o", "x.png", "--samples", "9"}).status, 1);
  EXPECT_EQ(run({scene, "-o", "x.png", "--unknown", "9"}).status, 1);
  EXPECT_EQ(run({scene, "-o", "x.png", "--fallback", "9"}).status, 1);
  EXPECT_EQ(run({scene, "-o", "/nowhere/x.png", "--size", "16x16", "--cache", cacheFolder()}).status, 1);
  EXPECT_EQ(run({scene, "-o", "x.png", "--environment", "none.hdr", "--cache", cacheFolder()}).status, 1);
}

}  // namespace
}  // namespace lacquer::test::picture_test
