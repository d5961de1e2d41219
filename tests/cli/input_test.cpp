// Files that are wrong, odd or huge: a diagnostic and an exit status, never a crash, a hang or a file
// elsewhere.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <iostream>

#include "command.h"
#include "support/cases.h"

namespace lacquer::test::input_test {
namespace {

namespace fs = std::filesystem;

std::string withMaterial(const std::string& members) { return gltfOf({"{" + members + "}"}); }

/// A GLB with a JSON chunk alone.
std::string glbOf(std::string json) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto word = [](size_t x) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(x >> (8 * i) & 0xFF);
    return bytes;
  };
  return "glTF" + word(2) + word(20 + json.size()) + word(json.size()) + "JSON" + json;
}

struct Bad {
  const char* name;
  std::string bytes;
  std::vector<std::string> said;
};

const std::vector<Bad>& badFiles() {
  static const std::vector<Bad> kBad = {
      {"empty.gltf", "", {"empty-file"}},
      {"text.gltf", "hello", {":1:1: error:", "not valid JSON"}},
      {"array.gltf", "[]", {"error:"}},
      {"null.gltf", "null", {"error:"}},
      {"zeros.gltf", std::string(1000, '\0'), {"error:"}},
      {"cut.gltf", withMaterial(R"("name": "a")").substr(0, 40), {"error:"}},
      {"cut.glb", glbOf(withMaterial("")).substr(0, 50), {"truncated-glb"}},
      {"header.glb", "glTF", {"error:"}},
      {"nan.gltf", withMaterial(R"("alphaCutoff": NaN)"), {"NaN"}},
      {"infinite.gltf", withMaterial(R"("alphaCutoff": 1e999)"), {"1e999", "json-number-range"}},
      {"deep.gltf", withMaterial("\"extras\": " + std::string(100'000, '[')), {"json-too-deep"}},
      {"utf8.gltf", withMaterial("\"name\": \"\xFF\""), {"UTF-8"}},
      {"number.gltf",
       withMaterial(R"("pbrMetallicRoughness": {"baseColorFactor": 3})"),
       {":/materials/0/pbrMetallicRoughness/baseColorFactor: error:", "array of 4 numbers"}},
      {"texture.gltf",
       withMaterial(R"("normalTexture": {"index": 7})"),
       {":/materials/0/normalTexture/index: error:", "7"}},
      {"range.gltf",
       withMaterial(R"("pbrMetallicRoughness": {"roughnessFactor": 1.5})"),
       {":/materials/0/pbrMetallicRoughness/roughnessFactor: error:", "from 0 to 1"}},
      {"parent.gltf",
       withMaterial(R"("extensions": {"EXT_materials_clearcoat_color": {}})"),
       {":/materials/0/extensions/EXT_materials_clearcoat_color: error:",
        "KHR_materials_clearcoat.extensions"}},
      {"unlit.gltf",
       withMaterial(R"("extensions": {"KHR_materials_coat": {}, "KHR_materials_unlit": {}})"),
       {":/materials/0/extensions/KHR_materials_coat: error:", "KHR_materials_unlit"}},
      {"material.gltf",
       R"({"asset": {"version": "2.0"}, "materials": [{}],
          "meshes": [{"primitives": [{"attributes": {}, "material": 5}]}]})",
       {":/meshes/0/primitives/0/material: error:", "5"}},
  };
  return kBad;
}

TEST(BadInput, isADiagnosticAndOne) {
  const Workplace place;
  for (const Bad& bad : badFiles()) {
    SCOPED_TRACE(bad.name);
    place.write(bad.name, bad.bytes);
    const Outcome outcome = place.run({"gen", bad.name, "-o", "out"});
    EXPECT_EQ(outcome.status, 1) << outcome.all();
    EXPECT_TRUE(outcome.err.starts_with(std::string(bad.name) + ":")) << outcome.err;
    for (const std::string& said : bad.said)
      EXPECT_NE(outcome.err.find(said), std::string::npos) << said << "\n" << outcome.err;
    const auto manifest = place.manifest("out");
    EXPECT_EQ(manifest["files"][0]["source"], std::string("../") + bad.name);
    // Nobody is asked for a graph of it either.
    EXPECT_EQ(place.run({"graph", bad.name}).status, 1);
    EXPECT_EQ(place.run({"dump", bad.name}).status, 1);
    fs::remove_all(place / "out");
  }
}

TEST(BadInput, whatIsNoFile) {
  const Workplace place;
  fs::create_directories(place / "folder.gltf");
  fs::create_symlink("loop.gltf", place / "loop.gltf");
  fs::create_symlink("nowhere", place / "dangling.gltf");
  for (const char* name :
       {"folder.gltf", "missing.gltf", "loop.gltf", "dangling.gltf", "/dev/null", "", "."}) {
    SCOPED_TRACE(name);
    const Outcome outcome = place.run({"gen", name, "-o", "out"});
    EXPECT_EQ(outcome.status, 1) << outcome.all();
    EXPECT_NE(outcome.err.find("error: "), std::string::npos) << outcome.err;
    EXPECT_EQ(place.manifest("out")["shaders"].size(), 0u);
  }
}

/// One bad file or material does not stop the others.
TEST(BadInput, theOthersAreWritten) {
  const Workplace place;
  place.write("bad.gltf", "{");
  place.write("half.gltf",
              gltfOf({R"({"name": "good"})", R"({"name": "bad", "alphaCutoff": -1})", R"({"name": "too"})"}));
  const Outcome outcome =
      place.run({"gen", "half.gltf", "bad.gltf", "missing.gltf", example("clearcoat.gltf"), "-o", "out"});
  EXPECT_EQ(outcome.status, 1) << outcome.all();
  const auto manifest = place.manifest("out");
  ASSERT_EQ(manifest["files"].size(), 4u);
  const auto& half = manifest["files"][0]["materials"];
  ASSERT_EQ(half.size(), 3u);
  EXPECT_EQ(half[0]["uses"].size(), 1u);
  EXPECT_EQ(half[1]["uses"].size(), 0u);
  EXPECT_EQ(half[1]["diagnostics"][0]["severity"], "error");
  EXPECT_EQ(half[1]["diagnostics"][0]["pointer"], "/materials/1/alphaCutoff");
  EXPECT_EQ(half[2]["uses"].size(), 1u);
  for (const auto& material : manifest["files"][3]["materials"]) {
    const std::string id = material["uses"][0]["shader"];
    EXPECT_TRUE(place.has("out/glsl/" + id + ".frag.glsl"));
  }
}

/// Files that are good and yet unusual.
TEST(OddInput, isGood) {
  const Workplace place;
  const std::string text = readFile(example("clearcoat_tint.gltf"));
  place.write("plain.gltf", text);
  place.write("with space \xF0\x9F\x98\x80.gltf", text);
  place.write("no_ending", text);
  place.write("binary.glb", glbOf(text));
  place.write("binary.gltf", glbOf(text));
  place.write("text.glb", text);
  place.write("bom.gltf", "\xEF\xBB\xBF" + text);
  place.write("folder/-o.gltf", text);
  fs::create_symlink("plain.gltf", place / "link.gltf");
  const auto expected = [&] {
    EXPECT_EQ(place.run({"gen", "plain.gltf", "-o", "out"}).status, 0);
    return place.manifest("out")["shaders"];
  }();
  for (const char* name : {"with space \xF0\x9F\x98\x80.gltf", "no_ending", "binary.glb", "binary.gltf",
                           "text.glb", "bom.gltf", "link.gltf", "./folder/../plain.gltf", "folder/-o.gltf"}) {
    SCOPED_TRACE(name);
    const Outcome outcome = place.run({"gen", name, "-o", "again"});
    EXPECT_EQ(outcome.status, 0) << outcome.all();
    EXPECT_EQ(place.manifest("again")["shaders"], expected);
    EXPECT_EQ(place.manifest("again")["files"][0]["source"],
              "../" + fs::path(name).lexically_normal().generic_string());
  }
}

TEST(OddInput, theSameFileTwiceIsTwoEntries) {
  const Workplace place;
  place.write("a.gltf", readFile(example("clearcoat_tint.gltf")));
  const Outcome outcome = place.run({"gen", "a.gltf", "a.gltf", "-o", "out"});
  EXPECT_EQ(outcome.status, 0) << outcome.all();
  const auto manifest = place.manifest("out");
  ASSERT_EQ(manifest["files"].size(), 2u);
  EXPECT_EQ(manifest["files"][0], manifest["files"][1]);
}

TEST(OddInput, noMaterialsIsGood) {
  const Workplace place;
  place.write("none.gltf", gltfOf({}));
  const Outcome outcome = place.run({"gen", "none.gltf", "-o", "out"});
  EXPECT_EQ(outcome.status, 0) << outcome.all();
  EXPECT_EQ(place.manifest("out")["files"][0]["materials"].size(), 0u);
}

/// Names go into the manifest as they are, and nowhere else.
TEST(OddInput, namesAreNoPaths) {
  const Workplace place;
  const std::vector<std::string> kNames = {"a/b",
                                           "../../evil",
                                           "..",
                                           ".",
                                           "a b",
                                           "\xF0\x9F\x98\x80",
                                           "",
                                           "same",
                                           "same",
                                           "/etc/evil",
                                           "C:\\evil",
                                           "con",
                                           "\\",
                                           "%s%n",
                                           "$(touch evil)",
                                           "'; touch evil",
                                           "-o",
                                           std::string(5000, 'x'),
                                           "new\nline",
                                           std::string("nul\0l", 5),
                                           "\x1B[31mred",
                                           "manifest.json",
                                           "glsl"};
  std::vector<std::string> materials;
  for (size_t i = 0; i < kNames.size(); ++i) {
    materials.push_back(
        nlohmann::json{{"name", kNames[i]}, {"alphaMode", i % 2 == 0 ? "OPAQUE" : "BLEND"}}.dump());
  }
  place.write("deep/down/in.gltf", gltfOf(materials));
  const Outcome outcome = place.run({"gen", "deep/down/in.gltf", "-o", "deep/down/out"});
  EXPECT_EQ(outcome.status, 0) << outcome.all();
  const auto manifest = place.manifest("deep/down/out");
  ASSERT_EQ(manifest["files"][0]["materials"].size(), kNames.size());
  for (size_t i = 0; i < kNames.size(); ++i)
    EXPECT_EQ(manifest["files"][0]["materials"][i]["name"], kNames[i]);
  EXPECT_EQ(manifest["shaders"].size(), 2u);
  EXPECT_EQ(place.names("deep/down/out"), (std::set<std::string>{"deep", "deep/down", "deep/down/in.gltf"}));
  EXPECT_FALSE(fs::exists("/etc/evil"));
  EXPECT_FALSE(fs::exists(place / "../evil"));
  // What a terminal would obey is not printed.
  for (const std::string* text : {&outcome.out, &outcome.err}) {
    EXPECT_EQ(text->find('\x1B'), std::string::npos);
    EXPECT_EQ(text->find('\0'), std::string::npos);
  }
  for (const std::string& name :
       {std::string("a/b"), std::string("../../evil"), std::string("same"), std::string("")}) {
    const Outcome one = place.run({"gen", "deep/down/in.gltf", "-o", "one", "--material", name});
    EXPECT_EQ(one.status, 0) << one.all();
    EXPECT_EQ(place.manifest("one")["files"][0]["materials"].size(), name == "same" ? 2u : 1u);
  }
}

TEST(HugeInput, hundredThousandMaterials) {
  const Workplace place;
  constexpr size_t kCount = 100'000;
  std::string list;
  for (size_t i = 0; i < kCount; ++i) {
    list += fmt::format(
        R"({}{{"name": "m{}", "pbrMetallicRoughness": {{"roughnessFactor": {}}}, "extensions": {{)"
        R"("KHR_materials_coat": {{"coatFactor": {}, "coatRoughnessFactor": 0.25}}}}}})",
        i == 0 ? "" : ",", i, static_cast<double>(i) / kCount, static_cast<double>(i % 100 + 1) / 100);
  }
  place.write("many.gltf", R"({"asset": {"version": "2.0"}, "materials": [)" + list + "]}");
  const Outcome outcome = place.run({"gen", "many.gltf", "-o", "out"}, std::chrono::seconds(300));
  EXPECT_EQ(outcome.status, 0) << outcome.err.substr(0, 2000);
  std::cout << kCount << " materials: " << fmt::format("{:.1f}", outcome.seconds) << " s, manifest of "
            << fs::file_size(place / "out/manifest.json") / 1'000'000 << " MB\n";
  EXPECT_LT(outcome.out.size(), 100'000u);  // the table is for people
  const auto manifest = place.manifest("out");
  EXPECT_EQ(manifest["files"][0]["materials"].size(), kCount);
  EXPECT_LE(manifest["shaders"].size(), 4u);
  // Which ones there are is said in a few lines.
  const Outcome none = place.run({"graph", "many.gltf", "--material", "none"});
  EXPECT_EQ(none.status, 1);
  EXPECT_LT(none.err.size(), 2000u);
  EXPECT_EQ(place.run({"dump", "many.gltf", "--material", "m77777"}).status, 0);
}

TEST(BadGraphs, areDiagnosticsAndOne) {
  const Workplace place;
  const std::pair<std::string, std::string> kBad[] = {
      {"", "json-syntax"},
      {"{}", "lacquer_graph"},
      {R"({"lacquer_graph": 2, "template": "forward", "outputs": {}})", "lacquer_graph"},
      {R"({"lacquer_graph": 1, "template": "forwrd", "outputs": {}})", "forwrd"},
      {R"({"lacquer_graph": 1, "template": "forward", "outputs": {"emission": {"node": "x"}}})", "x"},
      {R"({"lacquer_graph": 1, "template": "forward", "outputs": {"emission": "x"}})", "/outputs/emission"},
      {R"({"lacquer_graph": 1, "template": "forward", "outputs": {"emission": 1e999}})", "1e999"},
      {R"({"lacquer_graph": 1, "template": "surface", "outputs": {}})", "surface_normal"},
      {std::string(100'000, '['), "json"},
      {gltfOf({"{}"}), "not-a-graph"},
  };
  for (const auto& [text, said] : kBad) {
    SCOPED_TRACE(text.substr(0, 200));
    place.write("g.json", text);
    const Outcome outcome = place.run({"gen", "--graph", "g.json", "-o", "out"});
    EXPECT_EQ(outcome.status, 1) << outcome.all();
    EXPECT_TRUE(outcome.err.starts_with("g.json:")) << outcome.err;
    EXPECT_NE(outcome.err.find(said), std::string::npos) << outcome.err;
    EXPECT_EQ(place.manifest("out")["shaders"].size(), 0u);
  }
  EXPECT_EQ(place.run({"gen", "--graph", "none.json", "-o", "out"}).status, 1);
}

/// A number that may leave the range of what it goes to makes a shader, and its author is told.
TEST(Inputs, graphsThatMayLeaveARange) {
  const Workplace place;
  const std::string graph =
      R"({"lacquer_graph": 1, "template": "forward", "parameters": {"x": {"type": "float", "value": 1.5RANGE}},
          "nodes": [{"id": "f", "node": "f0_from_ior", "inputs": {"ior": {"parameter": "x"}}}],
          "outputs": {"alpha": {"node": "f"}}})";
  for (const std::string range : {"", R"(, "range": [1, 3])"}) {
    std::string text = graph;
    text.replace(text.find("RANGE"), 5, range);
    place.write("g.json", text);
    const Outcome outcome = place.run({"gen", "--graph", "g.json", "-o", "out", "--target", "glsl"});
    EXPECT_EQ(outcome.status, 0) << outcome.all();
    const bool told = outcome.err.starts_with("g.json:/nodes/0/inputs/ior: warning: ");
    EXPECT_EQ(told, range.empty()) << outcome.err;
  }
}

}  // namespace
}  // namespace lacquer::test::input_test
