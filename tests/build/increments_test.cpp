// What a change costs, in shaders and files: one material among 100 000, one node.
#include <gtest/gtest.h>

#include <cstdio>

#include "processes.h"
#include "random_gltf.h"

namespace lacquer::test::increments_test {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// "N shaders made, M from the cache, K files written" of a run with --time.
struct Counts {
  int made = -1, cached = -1, written = -1;
};

Counts counts(const Words& words, const fs::path& folder) {
  std::string output;
  EXPECT_EQ(runProgram(words, folder, &output), 0) << output;
  Counts counts;
  const size_t line = output.find(" shaders made");
  if (line == std::string::npos) return counts;
  std::sscanf(output.c_str() + output.rfind('\n', line) + 1, "%d shaders made, %d from the cache, %d files",
              &counts.made, &counts.cached, &counts.written);
  return counts;
}

TEST(Increments, OneChangedMaterialAmongMany) {
  const fs::path folder = freshFolder("increments");
  RandomGltf random(4);
  // A hundred files of a thousand materials of thirty kinds.
  constexpr size_t kFiles = 100, kMaterials = 1000, kKinds = 30;
  Words words{LACQUER_PROGRAM, "gen"};
  for (size_t i = 0; i < kFiles; ++i) {
    const std::string name = "many" + std::to_string(i) + ".gltf";
    writeText(folder / name, random.text(kMaterials, kKinds));
    words.push_back(name);
  }
  words.insert(words.end(), {"-o", "out", "--cache", "cache", "-q", "--no-validate", "--no-sync", "--target",
                             "glsl", "--time"});
  const Counts first = counts(words, folder);
  EXPECT_GT(first.made, 5);
  // Another number: no shader, the manifest alone.
  std::string text = readText(folder / "many50.gltf");
  const size_t place = text.find("\"metallicFactor\": ");
  ASSERT_NE(place, std::string::npos);
  text[text.find('.', place) + 1] = text[text.find('.', place) + 1] == '5' ? '6' : '5';
  writeText(folder / "many50.gltf", text);
  const Counts number = counts(words, folder);
  EXPECT_EQ(number.made, 0);
  EXPECT_EQ(number.written, 1);
  // Another structure: one shader.
  const std::string kind = "\"KHR_materials_sheen\": {\"sheenColorFactor\": [1, 0, 0]}";
  const size_t first_material = text.find("\"materials\": [{") + std::string("\"materials\": [{").size();
  text.insert(first_material, "\"name\": \"new\", \"extensions\": {" + kind + "}}, {");
  writeText(folder / "many50.gltf", text);
  const Counts structure = counts(words, folder);
  EXPECT_EQ(structure.made, 1);
  EXPECT_EQ(structure.written, 3);  // two stages and the manifest
  fs::remove_all(folder.parent_path());
}

/// A node that one kind of material has: the shaders that hold it are remade, and no other.
TEST(Increments, OneChangedNode) {
  const fs::path folder = freshFolder("node");
  const auto node = [&](const char* factor) {
    writeText(folder / "nodes" / "varnish.node", std::string(R"(
/// Varnish: a layer that tints what is below it.
/// source: EXAMPLE_materials_varnish
extension EXAMPLE_materials_varnish {
    status vendor;
    vec3 varnishColorFactor in [0, 1] = vec3(1);
}
/// A filter.
/// source: EXAMPLE_materials_varnish
part varnish of EXAMPLE_materials_varnish over coat unless varnishColorFactor == vec3(1) {
direct:
    varnish.direct = varnished(below.direct, varnishColorFactor);
    out direct = varnish.direct;
}
/// Light through a filter.
/// source: EXAMPLE_materials_varnish
node varnished(
    vec3 light in [0, inf],
    vec3 color in [0, 1]
) -> vec3 in [0, inf] {
    return light * color * )") + factor + ";\n}\n");
  };
  fs::create_directories(folder / "nodes");
  node("0.5");
  writeText(folder / "a.gltf",
            R"({"asset": {"version": "2.0"}, "extensionsUsed": ["EXAMPLE_materials_varnish"],
"materials": [{}, {"doubleSided": true}, {"alphaMode": "MASK"},
  {"extensions": {"EXAMPLE_materials_varnish": {"varnishColorFactor": [1, 0, 0]}}},
  {"doubleSided": true, "extensions": {"EXAMPLE_materials_varnish": {"varnishColorFactor": [1, 0, 0]}}}]})");
  const Words words{LACQUER_PROGRAM, "gen",       "a.gltf",   "-o",   "out",   "--nodes", "nodes", "-q",
                    "--no-validate", "--no-sync", "--target", "glsl", "--time"};
  EXPECT_EQ(counts(words, folder).made, 5);
  const auto before = filesBelow(folder / "out");
  node("0.25");
  // Files of the others are left alone; those of the two that hold the node are new.
  EXPECT_EQ(counts(words, folder).written, 2 * 2 + 1);
  size_t kept = 0;
  for (const auto& [name, state] : filesBelow(folder / "out")) {
    if (name == "manifest.json") continue;
    const auto it = before.find(name);
    if (it != before.end() && it->second.time == state.time) ++kept;
  }
  EXPECT_EQ(kept, before.size() - 1 - 2 * 2);
  fs::remove_all(folder.parent_path());
}

}  // namespace
}  // namespace lacquer::test::increments_test
