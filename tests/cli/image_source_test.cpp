// Images that extensions give textures: eval and preview look into what they can decode, and say what not.
#include <gtest/gtest.h>

#include "command.h"

namespace lacquer::test {
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

}  // namespace
}  // namespace lacquer::test
