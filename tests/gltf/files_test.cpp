// read() on files: containers, real assets, what is no file at all.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "gltf/dump.h"
#include "support/cases.h"
#include "support/materials.h"

namespace lacquer::test {
namespace {

namespace fs = std::filesystem;
using material::Document;

const std::string kMinimal = R"({"asset":{"version":"2.0"},"materials":[{"name":"m"}]})";

std::string word(size_t value) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>((value >> (8 * i)) & 0xFF);
  return bytes;
}

std::string header(size_t version, size_t length) {
  std::string bytes = "glTF";
  bytes += word(version);
  return bytes += word(length);
}

std::string glb(const std::string& json, const std::string& binary = {}) {
  std::string chunks = word(json.size()) + "JSON" + json;
  if (!binary.empty()) chunks += word(binary.size()) + std::string("BIN\0", 4) + binary;
  return header(2, 12 + chunks.size()) + chunks;
}

/// The formatted diagnostics of what cannot be read, "read" if it can.
std::string outcome(const Result<Document>& document) {
  if (document) return "read";
  std::string text;
  for (const Diagnostic& one : document.error()) text.append(text.empty() ? "" : "\n").append(format(one));
  return text;
}

std::string outcomeOf(const std::string& bytes) { return outcome(materialsOf(bytes, "x")); }

TEST(GltfContainer, glbIsRead) {
  const auto document = materialsOf(glb(kMinimal, "12345678"), "x.glb");
  ASSERT_TRUE(document) << outcome(document);
  EXPECT_EQ(document->materials.at(0).name, "m");
  EXPECT_EQ(outcomeOf(glb(kMinimal + std::string(3, '\0'))), "read");
  EXPECT_EQ(outcomeOf(glb(kMinimal + "  ")), "read");
  EXPECT_EQ(outcomeOf(glb(kMinimal) + "what follows is not the GLB's"), "read");
}

TEST(GltfContainer, everyTruncationOfAGlbIsAnError) {
  const std::string whole = glb(kMinimal, "12345678");
  for (size_t size = 0; size < whole.size(); ++size) {
    const auto document = materialsOf(whole.substr(0, size), "x.glb");
    ASSERT_FALSE(document) << "the first " << size << " bytes";
    ASSERT_TRUE(hasError(document.error()));
  }
  EXPECT_EQ(outcomeOf(""), "x: error: the file is empty [empty-file]\n  help: a .gltf holds a JSON object");
  EXPECT_EQ(outcomeOf("glTF\2"), "x: error: a GLB's header has 12 bytes, the file only 5 [truncated-glb]");
  EXPECT_EQ(outcomeOf(whole.substr(0, 30)),
            "x: error: the GLB's header claims 90 bytes, the file has 30 [truncated-glb]");
}

TEST(GltfContainer, chunksMustFit) {
  EXPECT_EQ(outcomeOf(header(2, 12)),
            "x: error: the GLB's header claims 12 bytes, too few for a chunk [truncated-glb]");
  EXPECT_EQ(outcomeOf(header(2, 20) + word(0xFFFFFFFF) + "JSON"),
            "x: error: chunk 0 at byte 12 claims 4294967295 bytes, but only 0 follow [truncated-glb]");
  EXPECT_EQ(outcomeOf(header(2, 24) + word(0) + "JSON" + word(0)),
            "x: error: chunk 1 at byte 20 has no complete header [truncated-glb]");
  EXPECT_EQ(
      outcomeOf(header(2, 20) + word(0) + std::string("BIN\0", 4)),
      "x: error: the GLB's first chunk is not JSON [no-json-chunk]\n  help: the JSON chunk must come first");
  EXPECT_EQ(outcomeOf(header(1, 20) + word(0) + word(0)),
            "x: error: this is version 1 of the GLB container [unsupported-version]\n  help: Lacquer reads "
            "versions 2 and 3");
  EXPECT_EQ(
      outcomeOf(glb("{]")),
      "x:1:2: error: not valid JSON: syntax error while parsing object key - unexpected ']'; expected string "
      "literal (in the GLB's JSON chunk) [json-syntax]\n  {]\n   ^");
}

TEST(GltfContainer, whatIsNoFileIsAnError) {
  EXPECT_EQ(outcome(readMaterials("/nonexistent/x.gltf")),
            "/nonexistent/x.gltf: error: there is no such file [file-unreadable]");
  EXPECT_EQ(outcome(readMaterials("")), "error: there is no such file [file-unreadable]");
  const std::string folder = sourceFolder().string();
  EXPECT_EQ(outcome(readMaterials(folder)),
            folder + ": error: this is a folder, not a file [file-unreadable]");
  if (fs::exists("/dev/zero")) {
    EXPECT_EQ(outcome(readMaterials("/dev/zero")),
              "/dev/zero: error: this is no regular file [file-unreadable]");
  }
}

TEST(GltfContainer, byteOrderMarkIsSkipped) {
  EXPECT_EQ(outcomeOf("\xEF\xBB\xBF" + kMinimal), "read");
  EXPECT_EQ(
      outcomeOf("\xEF\xBB\xBF{]"),
      "x:1:5: error: not valid JSON: syntax error while parsing object key - unexpected ']'; expected string "
      "literal [json-syntax]\n  \xEF\xBB\xBF{]\n      ^");
}

void readAsset(const fs::path& file) {
  const auto document = readMaterials(file.string());
  ASSERT_TRUE(document) << outcome(document);
  const std::string diagnostics = formatAll(*document);
  EXPECT_EQ(diagnostics.find(": error: "), std::string::npos) << diagnostics;
  EXPECT_EQ(document->uses.size(), document->materials.size());
  for (size_t i = 0; i < document->materials.size(); ++i) {
    EXPECT_EQ(document->materials[i].index, static_cast<int>(i));
  }
}

fs::path assetFolder() {
  const char* folder = std::getenv("LACQUER_ASSETS");
  return folder != nullptr ? fs::path(folder) : sourceFolder() / "../shared/assets";
}

TEST(GltfAssets, areReadWithoutErrors) {
  size_t count = 0;
  for (const char* extension : {".gltf", ".glb"}) {
    for (const fs::path& file : findFiles(assetFolder(), extension)) {
      SCOPED_TRACE(file.string());
      readAsset(file);
      ++count;
    }
  }
  if (count == 0) GTEST_SKIP() << "skipped: no assets in " << assetFolder();
}

/// The same material, whether it comes as .gltf or as .glb.
TEST(GltfAssets, glbAndGltfAgree) {
  const fs::path folder = assetFolder() / "ClearCoatCarPaint";
  if (!fs::exists(folder)) GTEST_SKIP() << "skipped: no " << folder;
  const auto text = readMaterials((folder / "ClearCoatCarPaint.gltf").string());
  const auto binary = readMaterials((folder / "ClearCoatCarPaint.glb").string());
  ASSERT_TRUE(text && binary);
  const auto withoutImages = [](Document document) {
    document.images.clear();
    return dump(document);
  };
  EXPECT_EQ(withoutImages(*text), withoutImages(*binary));
}

}  // namespace
}  // namespace lacquer::test
