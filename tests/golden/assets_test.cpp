// Real glTF files: ../shared/assets beside the source folder, or the folder in the environment variable
// LACQUER_ASSETS.
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <set>

#include "check/check.h"
#include "compare.h"
#include "output.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

namespace fs = std::filesystem;

/// Empty when there is none.
fs::path assetsFolder() {
  const char* given = std::getenv("LACQUER_ASSETS");
  if (given != nullptr) return given;  // one that is not there fails
  const fs::path beside = sourceFolder() / ".." / "shared" / "assets";
  return fs::is_directory(beside) ? fs::weakly_canonical(beside) : fs::path();
}

/// The JSON of a .gltf or a .glb, read without the product.
Json jsonOf(const fs::path& file) {
  const std::string bytes = readFile(file);
  if (!bytes.starts_with("glTF")) return Json::parse(bytes);
  uint32_t length = 0;
  for (int i = 3; i >= 0; --i)
    length = length << 8 | static_cast<unsigned char>(bytes.at(12 + static_cast<size_t>(i)));
  return Json::parse(bytes.substr(20, length));
}

/// The materials that primitives name, by themselves or as variants.
std::set<size_t> usedMaterials(const Json& gltf) {
  std::set<size_t> used;
  for (const Json& mesh : gltf.value("meshes", Json::array())) {
    for (const Json& primitive : mesh["primitives"]) {
      if (primitive.contains("material")) used.insert(primitive["material"].get<size_t>());
      const Json::json_pointer mappings("/extensions/KHR_materials_variants/mappings");
      if (!primitive.contains(mappings)) continue;
      for (const Json& mapping : primitive[mappings]) used.insert(mapping["material"].get<size_t>());
    }
  }
  return used;
}

Options everyTarget() {
  Options options;
  options.targets.push_back(Target::Wgsl);
  return options;
}

void expectCompleteShader(const fs::path& folder, const std::string& id, const Json& shader) {
  for (const Target target : everyTarget().targets) {
    const std::string name(targetName(target));
    ASSERT_TRUE(shader["files"].contains(name)) << id << ": no " << name;
    EXPECT_EQ(shader["validated"][name], target != Target::Wgsl || check::haveTint()) << id << ": " << name;
    for (const char* stage : {"vert", "frag"}) {
      const std::string path = shader["files"][name][stage];
      EXPECT_GT(fs::file_size(folder / path), 100u) << path;
    }
  }
}

void everyMaterialGivesEveryTarget(const fs::path& file) {
  const Folder first;
  const Json manifest = generateWell({file.string()}, first.path(), everyTarget());
  const Json gltf = jsonOf(file);
  const Json& entry = manifest["files"][0];
  EXPECT_TRUE(fs::equivalent(first.path() / entry["source"].get<std::string>(), file)) << entry["source"];
  ASSERT_EQ(entry["materials"].size(), gltf.value("materials", Json::array()).size());
  const std::set<size_t> used = usedMaterials(gltf);
  size_t uses = 0;
  for (size_t i = 0; i < entry["materials"].size(); ++i) {
    const Json& material = entry["materials"][i];
    EXPECT_EQ(material["index"], i);
    EXPECT_EQ(material["name"], gltf["materials"][i].value("name", ""));
    EXPECT_EQ(!material["uses"].empty(), used.contains(i) || used.empty()) << material["name"];
    for (const Json& use : material["uses"]) {
      const std::string id = use["shader"];
      ASSERT_TRUE(manifest["shaders"].contains(id)) << id;
      ++uses;
    }
  }
  // A file may have nothing but primitives without a material.
  EXPECT_TRUE(uses > 0 || (entry["materials"].empty() && entry.contains("default_material")));
  for (const auto& [id, shader] : manifest["shaders"].items()) expectCompleteShader(first.path(), id, shader);
  // Again with one thread: the same bytes.
  const Folder second;
  Options alone = everyTarget();
  alone.jobs = 1;
  generateWell({file.string()}, second.path(), alone);
  EXPECT_EQ(outputDifferences(first.path(), second.path()), "");
}

const bool kRegistered = [] {
  const fs::path folder = assetsFolder();
  if (folder.empty()) return false;
  registerFiles("Assets", folder, ".gltf", everyMaterialGivesEveryTarget);
  registerFiles("AssetsBinary", folder, ".glb", everyMaterialGivesEveryTarget);
  return true;
}();

TEST(AssetsFolder, isThere) {
  if (!kRegistered) GTEST_SKIP() << "no ../shared/assets and no LACQUER_ASSETS: no real glTF file is tried";
}

// -- the sweep over the parameters of the coat --

class CoatParameterSweep : public testing::Test {
protected:
  void SetUp() override {
    const fs::path file = assetsFolder() / "CoatParameterSweep" / "CoatParameterSweep.gltf";
    if (!fs::exists(file)) GTEST_SKIP() << "there is no CoatParameterSweep";
    gltf_ = jsonOf(file);
    manifest_ = generateWell({file.string()}, folder_.path(), {});
  }
  const Json& use(size_t material) const {
    return manifest_["files"][0]["materials"][material]["uses"].at(0);
  }

  Folder folder_;
  Json gltf_, manifest_;
};

/// Row 00: a clearcoat, then a coat of the same weight and roughness without darkening, four times.
TEST_F(CoatParameterSweep, clearcoatAndCoatShadeTheSame) {
  size_t pairs = 0;
  for (size_t i = 0; i + 1 < gltf_["materials"].size(); i += 2) {
    const Json& one = gltf_["materials"][i];
    const Json& other = gltf_["materials"][i + 1];
    if (!one["name"].get<std::string>().starts_with("00_")) continue;
    ASSERT_TRUE(one["extensions"].contains("KHR_materials_clearcoat"));
    ASSERT_TRUE(other["extensions"].contains("KHR_materials_coat"));
    EXPECT_EQ(use(i)["shader"], use(i + 1)["shader"]) << one["name"];
    EXPECT_EQ(use(i)["uniforms"], use(i + 1)["uniforms"]) << one["name"];
    EXPECT_EQ(use(i)["textures"].size(), 0u);
    ++pairs;
  }
  EXPECT_EQ(pairs, 4u);
}

/// 56 materials differ in numbers alone, but for the terms that a 0, a 1 or a white takes away.
TEST_F(CoatParameterSweep, fewShadersServeAll) {
  std::set<std::string> shaders;
  for (size_t i = 0; i < gltf_["materials"].size(); ++i) shaders.insert(use(i)["shader"].get<std::string>());
  std::cout << gltf_["materials"].size() << " materials, " << shaders.size() << " distinct shaders\n";
  EXPECT_EQ(shaders.size(), manifest_["shaders"].size());
  EXPECT_LE(shaders.size(), 8u);
  EXPECT_GE(shaders.size(), 2u);
}

}  // namespace
}  // namespace lacquer::test
