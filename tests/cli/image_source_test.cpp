// Images that extensions give textures: eval and preview look into what they can decode, and say what not.
#include <gtest/gtest.h>

#include "command.h"

namespace lacquer::test::image_source_test {
namespace {

using nlohmann::json;

/// One red pixel, and the beginnings of files in formats that nothing here decodes.
const char* const kImages = R"("images": [
  {"uri": "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4z8AAAAMBAQDJ/pLvAAAAAElFTkSuQmCC"},
  {"uri": "data:image/ktx2;base64,q0tUWCAyMLsNChoKAAAAAAAAAAA="},
  {"uri": "data:image/webp;base64,UklGRgQAAABXRUJQVlA4IA=="}],)";

const char* const kPoints = R"([{"n": [0, 0, 1], "v": [0, 0, 1], "l": [0, 0, 1], "uv0": [0.5, 0.5]}])";

class ImageSource : public testing::Test {
protected:
  /// A material with the texture as its base colour.
  void write(const std::string& texture) const {
    place_.write("points.json", kPoints);
    place_.write("t.gltf", std::string(R"({"asset": {"version": "2.0"}, )") + kImages + R"("textures": [)" +
                               texture + R"(], "materials": [{"name": "T", "pbrMetallicRoughness":
        {"baseColorTexture": {"index": 0}}}]})");
  }
  Outcome eval() const { return place_.run({"eval", "t.gltf", "--points", "points.json"}); }
  Outcome preview() const { return place_.run({"preview", "t.gltf", "-o", "t.png", "--size", "32"}); }

  Workplace place_;
};

TEST_F(ImageSource, TheFallbackStandsForWhatCannotBeDecoded) {
  write(R"({"source": 0})");
  const Outcome plain = eval();
  ASSERT_EQ(plain.status, 0) << plain.all();
  EXPECT_EQ(plain.err.find("image-fallback"), std::string::npos) << plain.err;
  for (const char* extensions :
       {R"("KHR_texture_basisu": {"source": 1})", R"("EXT_texture_webp": {"source": 2})"}) {
    write(std::string(R"({"source": 0, "extensions": {)") + extensions + "}}");
    const Outcome outcome = eval();
    ASSERT_EQ(outcome.status, 0) << outcome.all();
    EXPECT_EQ(json::parse(outcome.out)["rgba"], json::parse(plain.out)["rgba"]);
    EXPECT_NE(outcome.err.find("image 0 is looked into [image-fallback]"), std::string::npos) << outcome.err;
    const Outcome drawn = preview();
    EXPECT_EQ(drawn.status, 0) << drawn.all();
    EXPECT_NE(drawn.err.find("[image-fallback]"), std::string::npos) << drawn.err;
  }
}

/// Of a procedural texture the node's address mode counts, and not the sampler of the file's texture: left of
/// a picture that is red, then blue, its last texel is blue, and where it is clamped the first one is red.
TEST_F(ImageSource, ProceduralsLookImagesUpAsTheirNodesSay) {
  const auto colors = [&](const std::string& mode) {
    place_.write("points.json", R"([{"n": [0, 0, 1], "v": [0, 0, 1], "l": [0, 0, 1], "uv0": [-0.25, 0.5]}])");
    place_.write(
        "p.gltf",
        R"({"asset": {"version": "2.0"}, "images": [{"uri": "data:image/png;base64,)"
        "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAADUlEQVR4nGP4zwAE/wEHAAH/4iOeWQAAAABJRU5ErkJggg=="
        R"("}], "samplers": [{"wrapS": 33071}], "textures": [{"source": 0, "sampler": 0}],
      "materials": [{"name": "T", "extensions": {"KHR_materials_unlit": {}}, "pbrMetallicRoughness":
        {"baseColorTexture": {"index": 0, "extensions": {"KHR_texture_procedurals": {"index": 0}}}}}],
      "extensions": {"KHR_texture_procedurals": {"procedurals": [{"nodetype": "nodegraph", "type": "color3",
        "nodes": [{"nodetype": "image", "type": "color3", "inputs": {
          "file": {"nodetype": "input", "type": "filename", "texture": 0},
          "filtertype": {"nodetype": "input", "type": "string", "value": "closest"},
          "uaddressmode": {"nodetype": "input", "type": "string", "value": ")" +
            mode + R"("}}}],
        "outputs": {"out": {"nodetype": "output", "type": "color3", "node": 0}}}]}}})");
    const Outcome outcome = place_.run({"eval", "p.gltf", "--points", "points.json"});
    EXPECT_EQ(outcome.status, 0) << outcome.all();
    return json::parse(outcome.out)["rgba"][0];
  };
  EXPECT_EQ(colors("periodic"), json({0.0, 0.0, 1.0, 1.0}));
  EXPECT_EQ(colors("clamp"), json({1.0, 0.0, 0.0, 1.0}));
}

TEST_F(ImageSource, WithoutAFallbackTheFormatIsNamed) {
  const std::pair<const char*, const char*> kFormats[] = {
      {R"("KHR_texture_basisu": {"source": 1})", "this is a KTX2 file"},
      {R"("EXT_texture_webp": {"source": 2})", "this is a WebP file"}};
  for (const auto& [extension, said] : kFormats) {
    write(std::string(R"({"extensions": {)") + extension + "}}");
    const Outcome outcome = eval();
    EXPECT_EQ(outcome.status, 1) << outcome.all();
    EXPECT_NE(outcome.err.find(said), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("PNG and JPEG are read"), std::string::npos) << outcome.err;
    const Outcome drawn = preview();
    EXPECT_EQ(drawn.status, 0) << drawn.all();
    EXPECT_NE(drawn.err.find(said), std::string::npos) << drawn.err;
  }
}

/// One pixel of (200, 128, 40, 90), and what its channels are in other orders.
constexpr const char* kStored =
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAAEElEQVR4AQEFAPr/AMiAKFoFTwHL9AiRsgAAAABJRU5ErkJggg==";
constexpr std::pair<const char*, const char*> kOrders[] = {
    {"[2, 0, 1, 3]",
     "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAAEElEQVR4AQEFAPr/ACjIgFoEVwHLX/qJ4wAAAABJRU5ErkJggg=="},
    {"[0, 3, 2, 1]",
     "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAAEElEQVR4AQEFAPr/AMhaKIAFAwHLQX7e5QAAAABJRU5ErkJggg=="},
    {"[0, -1, 2]",
     "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAAEElEQVR4AQEFAPr/AMj/KP8HcQLvxT2WlQAAAABJRU5ErkJggg=="}};

std::string storedIn(const std::string& uri, const std::string& texture) {
  return R"({"asset": {"version": "2.0"}, "images": [{"uri": "data:image/png;base64,)" + uri +
         R"("}], "textures": [)" + texture + R"(], "materials": [{"name": "T", "alphaMode": "BLEND",
    "pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.8, 0.7, 0.9], "baseColorTexture": {"index": 0},
                             "metallicRoughnessTexture": {"index": 0}}}]})";
}

std::string optionOf(const std::string& channels) {
  return R"({"extensions": {"NV_texture_swizzle": {"options": [{"source": 0, "channels": )" + channels +
         "}]}}}";
}

TEST_F(ImageSource, ChannelsInAnotherOrderAreTaken) {
  place_.write("points.json", kPoints);
  for (const auto& [channels, ordered] : kOrders) {
    place_.write("t.gltf", storedIn(kStored, optionOf(channels)));
    const Outcome moved = eval();
    ASSERT_EQ(moved.status, 0) << moved.all();
    place_.write("t.gltf", storedIn(ordered, R"({"source": 0})"));
    const Outcome plain = eval();
    ASSERT_EQ(plain.status, 0) << plain.all();
    const json a = json::parse(moved.out)["rgba"][0], b = json::parse(plain.out)["rgba"][0];
    for (size_t c = 0; c < 4; ++c) EXPECT_NEAR(a[c].get<double>(), b[c].get<double>(), 1e-12) << channels;
  }
}

TEST_F(ImageSource, ChannelsThatNoPngHasAreSaid) {
  place_.write("points.json", kPoints);
  place_.write("t.gltf", storedIn(kStored, optionOf("[4, 5, 6]")));
  const Outcome outcome = eval();
  EXPECT_EQ(outcome.status, 1) << outcome.all();
  EXPECT_NE(outcome.err.find("[image-channels]"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("images of four channels and one layer are decoded here"), std::string::npos)
      << outcome.err;
  EXPECT_EQ(preview().status, 0);
}

TEST_F(ImageSource, TheManifestHasTheChannels) {
  place_.write("t.gltf", storedIn(kStored, R"({"extensions": {"NV_texture_swizzle": {"options": [
    {"source": 0, "channels": [4, 5], "arrayLayer": 3}, {"source": 0, "channels": [2, 1, 0]}]}}})"));
  ASSERT_EQ(place_.run({"gen", "t.gltf", "-o", "out"}).status, 0);
  const json made = json::parse(place_.read("out/manifest.json"))["files"][0]["textures"][0];
  EXPECT_EQ(made["swizzled"], true);
  EXPECT_EQ(
      made["images"],
      (json{
          {{"image", 0}, {"extension", "NV_texture_swizzle"}, {"channels", {2, 1, 0, -1}}},
          {{"image", 0}, {"extension", "NV_texture_swizzle"}, {"channels", {4, 5, -1, -1}}, {"layer", 3}}}));
}

}  // namespace
}  // namespace lacquer::test::image_source_test
