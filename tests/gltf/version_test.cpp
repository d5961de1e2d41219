// What the draft of glTF 2.1 adds: version 3 of the GLB container, buffers in chunks that they name, what was
// an extension, and other files' scenes.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "gltf/container.h"
#include "gltf/texture_source.h"
#include "support/materials.h"

namespace lacquer::gltf {
namespace version_test {

std::string number(uint64_t value, size_t bytes) {
  std::string made;
  for (size_t i = 0; i < bytes; ++i) made += static_cast<char>((value >> (8 * i)) & 0xFF);
  return made;
}

using Chunks = std::vector<std::pair<std::string, std::string>>;  ///< types and bytes

/// Chunks begin at multiples of eight bytes; behind the last one nothing need follow.
std::string glb3(const Chunks& chunks, uint32_t encoding = 0) {
  std::string all;
  for (const auto& [type, data] : chunks) {
    all.resize((all.size() + 7) / 8 * 8);
    all += type + number(encoding, 4) + number(data.size(), 8) + data;
  }
  return "glTF" + number(3, 4) + number(16 + all.size(), 8) + all;
}

const std::string kBin("BIN\0", 4), kOther = "mine";

std::string said(const Diagnostics& all) {
  std::string text;
  for (const Diagnostic& one : all) text.append(text.empty() ? "" : "\n").append(format(one));
  return text;
}

std::string outcomeOf(const std::string& bytes) {
  const Result<std::string_view> text = jsonText(bytes, "x");
  return text ? std::string(*text) : said(text.error());
}

TEST(Gltf21, ChunksOfVersionThree) {
  EXPECT_EQ(outcomeOf(glb3({{"JSON", "{}"}})), "{}");
  EXPECT_EQ(outcomeOf(glb3({{"JSON", "{} "}, {kBin, "123"}}) + "what follows"), "{} ");
  EXPECT_EQ(outcomeOf(glb3({{kOther, "123"}, {kBin, "12345"}, {"JSON", "{}"}, {"JSON", "[]"}})), "{}");
  EXPECT_EQ(outcomeOf(glb3({{kBin, "1234"}})),
            "x: error: the GLB has no chunk of JSON [no-json-chunk]\n  help: it must have one");
  EXPECT_EQ(outcomeOf(glb3({{"JSON", "{}"}}, 7)),
            "x: error: the GLB's chunk of JSON has the encoding 7 [unsupported-version]\n"
            "  help: glTF 2.1 defines 0 alone, for bytes as they are");
}

TEST(Gltf21, EveryTruncationIsAnError) {
  const std::string whole = glb3({{"JSON", "{}"}, {kBin, "12345678"}});
  for (size_t size = 4; size < whole.size(); ++size)
    ASSERT_FALSE(jsonText(std::string_view(whole).substr(0, size), "x")) << size << " bytes";
  EXPECT_EQ(outcomeOf("glTF" + number(3, 4) + number(0, 4)),
            "x: error: the header of a GLB of version 3 has 16 bytes, the file only 12 [truncated-glb]");
  EXPECT_EQ(
      outcomeOf("glTF" + number(3, 4) + number(32, 8) + "JSON" + number(0, 4) + number(~uint64_t{0}, 8)),
      "x: error: chunk 0 at byte 16 claims 18446744073709551615 bytes, but only 0 follow "
      "[truncated-glb]");
  EXPECT_EQ(outcomeOf("glTF" + number(3, 4) + number(~uint64_t{0}, 8)),
            "x: error: the GLB's header claims 18446744073709551615 bytes, the file has 16 [truncated-glb]");
}

/// What the file's image holds.
std::string imageOf(const std::string& buffers, const Chunks& behind, const std::string& image_of = "1") {
  Chunks chunks{{"JSON", R"({"asset":{"version":"2.1"},"textures":[{"source":0}],"images":[{"bufferView":0,
      "mimeType":"image/png"}],"bufferViews":[{"buffer":)" +
                             image_of + R"(,"byteOffset":1,"byteLength":2}],"buffers":[)" + buffers + "]}"}};
  chunks.insert(chunks.end(), behind.begin(), behind.end());
  const Result<TextureFile> file = TextureFile::fromMemory(glb3(chunks), "x", {});
  if (!file) return said(file.error());
  const Result<std::string> bytes = file->image(*file->texture(0));
  return bytes ? *bytes : said(bytes.error());
}

TEST(Gltf21, BuffersNameTheirChunks) {
  const Chunks two{{kBin, "abcd"}, {kOther, "other"}, {kBin, "efgh"}};
  EXPECT_EQ(imageOf(R"({"byteLength":4,"chunk":1},{"byteLength":4,"chunk":3})", two), "fg");
  EXPECT_EQ(imageOf(R"({"byteLength":4},{"byteLength":4,"chunk":1})", two), "bc");
  // What goes without saying: the first buffer is chunk 1.
  EXPECT_EQ(imageOf(R"({"byteLength":4})", two, "0"), "bc");
  EXPECT_NE(
      imageOf(R"({"byteLength":4})", {{kOther, "abcd"}, {kBin, "efgh"}}, "0").find("outside of its buffer"),
      std::string::npos);
  EXPECT_NE(imageOf(R"({"byteLength":4},{"byteLength":4})", two).find("outside of its buffer"),
            std::string::npos);
  for (const char* wrong : {"2", "0", "9", "-1", "1.5", "\"1\""}) {
    EXPECT_EQ(imageOf(std::string(R"({"byteLength":4},{"byteLength":4,"chunk":)") + wrong + "}", two),
              "x:/images/0: error: buffer 1 names a chunk that is no binary one of the file [image-missing]\n"
              "  help: the GLB has 4 chunks, and the first has the number 0")
        << wrong;
  }
}

/// What is said of a whole file.
std::string saidOf(const std::string& json) {
  const auto document = test::materialsOf(json, "x");
  return said(document ? document->diagnostics : document.error());
}

TEST(Gltf21, QuantizedVerticesNeedNoExtension) {
  const auto with = [](const std::string& version) {
    return saidOf(R"({"asset":{"version":")" + version +
                  R"("},"accessors":[{"componentType":5122,"type":"VEC3","count":3}],
      "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]})");
  };
  EXPECT_EQ(with("2.1"), "");
  EXPECT_EQ(with("2.2"), "");
  EXPECT_NE(with("2.0").find("[attribute-format]"), std::string::npos);
}

TEST(Gltf21, OtherFilesScenesAreSaid) {
  const std::string rest = R"(,"files":[{"uri":"car.glb","mimeType":"model/gltf-binary"},{"bufferView":0}],
    "externalAssets":[{"file":0},{"file":1},{"file":2},{}],"nodes":[{"externalAsset":0},{"externalAsset":7},
    {"externalAsset":"car"}]})";
  EXPECT_EQ(saidOf(R"({"asset":{"version":"2.1","minVersion":"2.1"})" + rest),
            "x:/externalAssets/0/file: note: nodes show what \"car.glb\" holds [external-asset]\n"
            "  help: shaders for its materials are generated from that file\n"
            "x:/externalAssets/1/file: note: nodes show what file 1 holds [external-asset]\n"
            "  help: shaders for its materials are generated from that file\n"
            "x:/externalAssets/2/file: error: file 2 is out of range [index-out-of-range]\n"
            "  help: the file has 2 files: an index goes from 0 to 1\n"
            "x:/externalAssets/3: error: the external asset has no \"file\" [missing-property]\n"
            "  help: it must name a file\n"
            "x:/nodes/1/externalAsset: error: external asset 7 is out of range [index-out-of-range]\n"
            "  help: the file has 4 external assets: an index goes from 0 to 3\n"
            "x:/nodes/2/externalAsset: error: external asset is a string [wrong-type]\n"
            "  help: it must be a whole number, an index into the file's external assets");
  EXPECT_EQ(saidOf(R"({"asset":{"version":"2.0"})" + rest), "");
}

}  // namespace version_test
}  // namespace lacquer::gltf
