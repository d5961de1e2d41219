// Inputs that are small and ask for much: what they take follows their size, and a limit where it does not.
// Memory is bounded by the system here, and each run by a time that a quiet machine needs a hundredth of.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>

#include "command.h"

namespace lacquer::test::hostile_bounds_test {
namespace {

namespace fs = std::filesystem;

constexpr auto kLong = std::chrono::seconds(60);

std::string repeated(size_t n, const std::function<std::string(size_t)>& item) {
  std::string text;
  for (size_t i = 0; i < n; ++i) text += (i == 0 ? "" : ",") + item(i);
  return text;
}

std::string sceneOf(const std::string& rest) { return R"({"asset": {"version": "2.0"}, )" + rest + "}"; }

/// A message for a person: some lines, however much is wrong.
void expectFewLines(const Outcome& outcome) {
  EXPECT_LT(outcome.err.size(), 1'000'000U);
  EXPECT_EQ(outcome.err.find("not enough memory"), std::string::npos) << outcome.err.substr(0, 1000);
}

TEST(HostileBounds, membersOfOneObjectAreFoundInLogarithmicTime) {
  const Workplace place;
  constexpr size_t kMany = 160'000;
  const auto junk = [](size_t i) { return fmt::format(R"("j{}": 0)", i); };
  place.write(
      "root.gltf",
      sceneOf(repeated(kMany, junk) +
              R"(, "materials": [{}], "accessors": [{"count": 3, "type": "VEC3", "componentType": 5126}],
                          "meshes": [{"primitives": [{"material": 0, "attributes": {)" +
              repeated(kMany, [](size_t i) { return fmt::format(R"("_A{}": 0)", i); }) + "}}]}]"));
  EXPECT_EQ(place.run({"graph", "root.gltf"}, kLong).status, 0);
  place.write("sampler.gltf",
              sceneOf(R"("images": [{"uri": "a.png"}], "samplers": [{)" + repeated(kMany, junk) +
                      R"(}], "textures": [)" +
                      repeated(kMany, [](size_t) { return R"({"source": 0, "sampler": 0})"; }) +
                      R"(], "materials": [{}])"));
  EXPECT_EQ(place.run({"graph", "sampler.gltf"}, kLong).status, 0);
}

TEST(HostileBounds, aNameOfManyPartsIsNoFile) {
  const Workplace place;
  std::string uri;
  for (size_t i = 0; i < 100'000; ++i) uri += "a/";
  place.write("long.gltf", sceneOf(R"("images": [{"uri": ")" + uri + R"(x.png"}], "textures": [{"source": 0}],
                                     "materials": [{"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}}])"));
  place.write("points.json", "[{}]");
  const Outcome outcome = place.run({"eval", "long.gltf", "--points", "points.json"}, kLong);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("a path has at most 4095"), std::string::npos) << outcome.err.substr(0, 1000);
}

TEST(HostileBounds, aPageNamesManyFiles) {
  const Workplace place;
  place.write("page.html", R"(<script type="application/json" id="files">[]</script>)");
  place.write("many.gltf",
              sceneOf(R"("images": [)" +
                      repeated(100'000, [](size_t i) { return fmt::format(R"({{"uri": "data:{}"}})", i); }) +
                      R"(], "materials": [{}])"));
  const Outcome many =
      place.run({"view", "--no-cost", "--page", "page.html", "many.gltf", "-o", "v.html"}, kLong);
  EXPECT_EQ(many.status, 0) << many.all().substr(0, 1000);
  // One file in many spellings is there once.
  place.write("big.bin", std::string(1'000'000, 'x'));
  std::string dots;
  place.write("spelt.gltf", sceneOf(R"("images": [)" +
                                    repeated(100,
                                             [&](size_t) {
                                               dots += "./";
                                               return R"({"uri": ")" + dots + R"(big.bin"})";
                                             }) +
                                    R"(], "materials": [{}])"));
  EXPECT_EQ(
      place.run({"view", "--no-cost", "--page", "page.html", "spelt.gltf", "-o", "s.html"}, kLong).status, 0);
  EXPECT_LT(fs::file_size(place / "s.html"), 2'000'000U);
  const Outcome limited = place.run(
      {"view", "--no-cost", "--page", "page.html", "spelt.gltf", "-o", "l.html", "--limit", "file=1000000"},
      kLong);
  EXPECT_EQ(limited.status, 1);
  EXPECT_NE(limited.err.find("[file-too-large]"), std::string::npos) << limited.err;
}

TEST(HostileBounds, messagesAreAThousandAtMost) {
  const Workplace place;
  const auto zeros = [](size_t n) { return repeated(n, [](size_t) { return "0"; }); };
  place.write("meshes.gltf", sceneOf(R"("materials": [{}], "meshes": [)" + zeros(1'000'000) + "]"));
  const Outcome meshes = place.within(512, "graph meshes.gltf");
  EXPECT_EQ(meshes.status, 1);
  EXPECT_NE(meshes.err.find("[more-diagnostics]"), std::string::npos) << meshes.err.substr(0, 1000);
  expectFewLines(meshes);

  const std::string required = repeated(300'000, [](size_t i) { return fmt::format(R"("EXT_{}")", i); });
  place.write("required.gltf", sceneOf(R"("extensionsRequired": [)" + required + R"(], "materials": [{}])"));
  expectFewLines(place.within(512, "graph required.gltf"));

  place.write("points.json", "[" + zeros(1'000'000) + "]");
  place.write("good.gltf", gltfOf({"{}"}));
  const Outcome points = place.within(512, "eval good.gltf --points points.json");
  EXPECT_EQ(points.status, 1);
  expectFewLines(points);

  const std::string pointers = repeated(100'000, [](size_t i) {
    return fmt::format(
        R"({{"sampler": 0, "target": {{"path": "pointer", "extensions": {{"KHR_animation_pointer":
        {{"pointer": "/materials/0/normalTexture/x{}"}}}}}}}})",
        i);
  });
  place.write(
      "pointers.gltf",
      sceneOf(R"("materials": [{}], "animations": [{"samplers": [{}], "channels": [)" + pointers + "]}]"));
  expectFewLines(place.within(512, "graph pointers.gltf"));
}

TEST(HostileBounds, longNamesStandInNoMessageWhole) {
  const Workplace place;
  const std::string name(300'000, 'a');
  const std::string keys = repeated(20'000, [](size_t i) { return fmt::format(R"("k{}": 0)", i); });
  place.write("parameter.json", R"({"lacquer_graph": 1, "template": "forward", "parameters": {")" + name +
                                    R"(": {)" + keys + R"(}}, "outputs": {}})");
  place.write("inputs.json", R"({"lacquer_graph": 1, "template": "forward", "nodes": [{"id": "x", "node": "y",
      "inputs": {)" + keys + "}}], \"outputs\": {\"" +
                                 name + "\": {\"node\": \"x\"}}}");
  for (const char* file : {"parameter.json", "inputs.json"}) {
    const Outcome outcome = place.within(512, fmt::format("gen --graph {} -o out -q", file));
    EXPECT_EQ(outcome.status, 1);
    expectFewLines(outcome);
  }
  // A name that stands twice, deep below a long one.
  constexpr size_t kDeep = 500;
  place.write("deep.gltf",
              sceneOf("\"" + std::string(3'000'000, 'a') + "\": " + std::string(kDeep, '[') +
                      R"({"a": 1, "a": 2})" + std::string(kDeep, ']') + R"(, "materials": [{}])"));
  const Outcome deep = place.within(256, "graph deep.gltf");
  EXPECT_EQ(deep.status, 0) << deep.err.substr(0, 1000);
  expectFewLines(deep);
}

TEST(HostileBounds, buffersThatAreOneFileAreReadOnce) {
  const Workplace place;
  std::ofstream(place / "big.bin") << "";
  fs::resize_file(place / "big.bin", 64 << 20);
  const auto primitive = [](size_t i) {
    return fmt::format(R"({{"material": 0, "attributes": {{"POSITION": {}}}}})", i);
  };
  constexpr size_t kMany = 40;
  place.write(
      "many.gltf",
      sceneOf(
          R"("materials": [{}], "buffers": [)" +
          repeated(kMany, [](size_t) { return R"({"uri": "big.bin", "byteLength": 67108864})"; }) +
          R"(], "bufferViews": [)" +
          repeated(kMany, [](size_t i) { return fmt::format(R"({{"buffer": {}, "byteLength": 36}})", i); }) +
          R"(], "accessors": [)" +
          repeated(kMany,
                   [](size_t i) {
                     return fmt::format(
                         R"({{"bufferView": {}, "count": 3, "type": "VEC3", "componentType": 5126}})", i);
                   }) +
          R"(], "meshes": [{"primitives": [)" + repeated(kMany, primitive) +
          R"(]}], "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}])"));
  const Outcome outcome =
      place.within(1024, "lod many.gltf -o lod --levels 2 --size 16 -q --no-validate --target glsl");
  EXPECT_EQ(outcome.status, 0) << outcome.all().substr(0, 1000);
}

TEST(HostileBounds, aSheetIsMeasuredBeforeItIsDrawn) {
  const Workplace place;
  place.write("many.gltf", gltfOf(std::vector<std::string>(20'000, "{}")));
  const Outcome outcome = place.run({"preview", "many.gltf", "-o", "p.png", "--size", "160"}, kLong);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("[sheet-too-large]"), std::string::npos) << outcome.err.substr(0, 1000);
}

TEST(HostileBounds, offsetsThatAreNoneAreNotNought) {
  const Workplace place;
  place.write("points.json", "[{}]");
  for (const char* offset : {"-7", "1.5", "1e300", "\"8\""}) {
    place.write("a.gltf",
                sceneOf(fmt::format(R"("buffers": [{{"uri": "data:;base64,iVBORw0KGgo=", "byteLength": 8}}],
        "bufferViews": [{{"buffer": 0, "byteOffset": {}, "byteLength": 8}}],
        "images": [{{"bufferView": 0, "mimeType": "image/png"}}], "textures": [{{"source": 0}}],
        "materials": [{{"emissiveFactor": [1, 1, 1], "emissiveTexture": {{"index": 0}}}}])",
                                    offset)));
    const Outcome outcome = place.run({"eval", "a.gltf", "--points", "points.json"}, kLong);
    EXPECT_EQ(outcome.status, 1) << offset;
    EXPECT_NE(outcome.err.find("lies outside of its buffer"), std::string::npos) << outcome.err;
  }
}

TEST(HostileCase, readsNoFileOutsideOfItsFolder) {
  const Workplace place;
  place.write("secret.txt", "TOPSECRET=1\n");
  place.write("in/good.gltf", gltfOf({"{}"}));
  const std::string absolute = (place / "secret.txt").string();
  for (const std::string& file : std::vector<std::string>{"../secret.txt", "../absent.txt", absolute}) {
    place.write("in/case.json", R"({"file": ")" + file + R"(", "material": 0, "samples": []})");
    const Outcome outcome = place.run({"stress", "in/case.json"}, kLong);
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find("[case-outside]"), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.err.find("TOPSECRET"), std::string::npos) << outcome.err;
  }
  place.write("in/case.json", R"({"file": "good.gltf", "material": 0, "samples": []})");
  EXPECT_NE(place.run({"stress", "in/case.json"}, kLong).err.find("\"samples\" must hold"),
            std::string::npos);
  place.write("in/case.json", R"({"file": "../good.gltf", "material": 0, "samples": []})");
  place.write("good.gltf", gltfOf({"{}"}));
  EXPECT_NE(place.run({"stress", "in/case.json", "--allow", "."}, kLong).err.find("\"samples\" must hold"),
            std::string::npos);
}

TEST(HostileCache, entriesAreNoLargerThanTheySay) {
  const Workplace place;
  place.write("key", std::string(32, 'k'));
  const std::string gen = fmt::format(
      "gen {} -q --no-validate --target glsl -o out --cache c --cache-key key", example("clearcoat.gltf"));
  ASSERT_EQ(place.within(1024, gen).status, 0);
  size_t entries = 0;
  for (const auto& file : fs::recursive_directory_iterator(place / "c")) {
    if (!file.is_regular_file()) continue;
    // The rest takes no room on the disk, and would take a minute to hash.
    fs::resize_file(file.path(), uint64_t{3} << 30);
    ++entries;
  }
  EXPECT_GT(entries, 0U);
  fs::remove_all(place / "out");
  const Outcome again = place.within(1024, gen);
  EXPECT_EQ(again.status, 0) << again.all();
}

TEST(Outputs, leaveNothingBesideThemWhenKilled) {
  const Workplace place;
  const std::string ours = "lacquer-0123456789abcdef-0.tmp";
  place.write("mine.tmp", "");
  place.write(ours, "");
  EXPECT_EQ(place
                .run({"gen", example("coat.gltf"), "-q", "--no-validate", "--target", "glsl", "-o", "out",
                      "--depfile", "deps"})
                .status,
            0);
  EXPECT_TRUE(place.has("mine.tmp"));
  EXPECT_FALSE(place.has(ours));
}

}  // namespace
}  // namespace lacquer::test::hostile_bounds_test
