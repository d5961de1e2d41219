// manifest.json is the contract with engines: fields may be added, these stay.
#include <gtest/gtest.h>

#include "command.h"
#include "lacquer.h"
#include "support/cases.h"

namespace lacquer::test::manifest_test {
namespace {

using nlohmann::json;

const char* const kFile = R"({"asset": {"version": "2.0"},
"extensionsUsed": ["KHR_materials_coat", "EXAMPLE_materials_moss", "KHR_materials_ior"],
"accessors": [{"componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
  {"componentType": 5126, "count": 3, "type": "VEC4"}, {"componentType": 5126, "count": 3, "type": "VEC2"}],
"images": [{"uri": "a.png"}], "textures": [{"source": 0}],
"meshes": [{"primitives": [
  {"attributes": {"POSITION": 0, "NORMAL": 0, "TANGENT": 1, "TEXCOORD_0": 2}, "material": 0},
  {"attributes": {"POSITION": 0, "NORMAL": 0, "TEXCOORD_0": 2}, "material": 0},
  {"attributes": {"POSITION": 0, "NORMAL": 0}, "material": 1},
  {"attributes": {"POSITION": 0, "NORMAL": 0}, "material": 2}]}],
"materials": [
  {"name": "Paint", "normalTexture": {"index": 0},
   "extensions": {"EXAMPLE_materials_moss": {}, "KHR_materials_coat": {"coatFactor": 0.9, "coatDarkeningFactor": 0,
     "coatColorFactor": [1, 0.5, 0.25], "coatColorTexture": {"index": 0}}}},
  {"name": "Warned", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}},
  {"name": "Wrong", "pbrMetallicRoughness": {"metallicFactor": 2}},
  {"name": "Unused"}]}
)";

class Manifest : public testing::Test {
protected:
  void SetUp() override {
    place_.write("car.gltf", kFile);
    const Outcome outcome = place_.run({"gen", "car.gltf", "-o", "out"});
    EXPECT_EQ(outcome.status, 1) << outcome.all();
    manifest_ = place_.manifest("out");
  }
  const json& material(size_t i) const { return manifest_["files"][0]["materials"][i]; }

  Workplace place_;
  json manifest_;
};

TEST_F(Manifest, namesTheProfile) {
  place_.run({"gen", "car.gltf", "-o", "other", "--profile", "openpbr", "--target", "glsl"});
  const json other = place_.manifest("other");
  const json& coated = other["files"][0]["materials"][0];
  EXPECT_EQ(coated["profile"], "openpbr");
  EXPECT_NE(coated["uses"][0]["shader"], material(0)["uses"][0]["shader"]);
  const Outcome wrong = place_.run({"gen", "car.gltf", "-o", "wrong", "--profile", "pbr"});
  EXPECT_EQ(wrong.status, 2) << wrong.all();
  EXPECT_NE(wrong.err.find("there are khr, khr_2025_10_13, openpbr, physical"), std::string::npos)
      << wrong.err;
  EXPECT_FALSE(place_.has("wrong"));
}

/// --debug adds where values come from, and changes nothing else: the shader is the same.
TEST_F(Manifest, debugNamesTheNodesFiles) {
  const std::string id = material(0)["uses"][0]["shader"];
  EXPECT_EQ(place_.run({"gen", "car.gltf", "-o", "debug", "--debug", "--target", "spirv"}).status, 1);
  EXPECT_EQ(place_.manifest("debug")["files"][0]["materials"][0]["uses"][0]["shader"], id);
  const std::string debug = place_.read("debug/spirv/" + id + ".frag.spv");
  EXPECT_NE(debug.find("nodes/coat.node"), std::string::npos);
  EXPECT_EQ(place_.read("out/spirv/" + id + ".frag.spv").find("nodes/"), std::string::npos);
}

TEST_F(Manifest, hasTheFieldsOfTheContract) {
  EXPECT_EQ(manifest_["lacquer"], version());
  ASSERT_EQ(manifest_["files"].size(), 1u);
  EXPECT_EQ(manifest_["files"][0]["source"], "../car.gltf");
  ASSERT_EQ(manifest_["files"][0]["materials"].size(), 4u);
  for (size_t i = 0; i < 4; ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(material(i)["index"], i);
    EXPECT_TRUE(material(i)["name"].is_string());
    EXPECT_EQ(material(i)["profile"], "khr");
    EXPECT_TRUE(material(i)["uses"].is_array());
    EXPECT_TRUE(material(i)["terms"].is_array());
    EXPECT_TRUE(material(i)["skipped"].is_object());
    EXPECT_TRUE(material(i)["ignored"].is_array());
    EXPECT_TRUE(material(i)["diagnostics"].is_array());
  }
}

// Open proposals are told from what is ratified; what has no effect is not listed.
TEST_F(Manifest, extensionsHaveTheirStatus) {
  EXPECT_EQ(material(0)["extensions"], json({{"KHR_materials_coat", "draft"}}));
  EXPECT_FALSE(material(1).contains("extensions"));
  place_.write("stack.gltf", R"({"asset": {"version": "2.0"}, "materials": [{"extensions": {
      "KHR_materials_sheen": {"sheenColorFactor": [1, 0, 0]}, "KHR_materials_fuzz": {"fuzzFactor": 0.5},
      "KHR_materials_transmission": {"transmissionFactor": 0.5}, "ADOBE_materials_thin_transparency": {},
      "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.5},
      "KHR_materials_specular": {"extensions": {"EXT_materials_specular_edge_color": {}}}}},
      {"extensions": {"KHR_materials_pbrSpecularGlossiness": {}}},
      {"extensions": {"ADOBE_materials_thin_transparency": {}}}]})");
  ASSERT_EQ(place_.run({"gen", "-q", "stack.gltf", "-o", "stack", "--target", "glsl"}).status, 0);
  const json materials = place_.manifest("stack")["files"][0]["materials"];
  EXPECT_EQ(materials[0]["extensions"], json({{"EXT_materials_specular_edge_color", "draft"},
                                              {"KHR_materials_diffuse_transmission", "candidate"},
                                              {"KHR_materials_fuzz", "draft"},
                                              {"KHR_materials_specular", "ratified"},
                                              {"KHR_materials_transmission", "ratified"}}));
  EXPECT_EQ(materials[1]["extensions"], json({{"KHR_materials_pbrSpecularGlossiness", "archived"}}));
  EXPECT_EQ(materials[2]["extensions"], json({{"ADOBE_materials_thin_transparency", "vendor"}}));
}

TEST_F(Manifest, materialWithTwoKindsOfPrimitives) {
  const json& paint = material(0);
  EXPECT_EQ(paint["name"], "Paint");
  ASSERT_EQ(paint["uses"].size(), 2u);
  EXPECT_EQ(paint["uses"][0]["attributes"], json::array({"NORMAL", "TEXCOORD_0"}));
  EXPECT_EQ(paint["uses"][1]["attributes"], json::array({"NORMAL", "TANGENT", "TEXCOORD_0"}));
  EXPECT_NE(paint["uses"][0]["shader"], paint["uses"][1]["shader"]);
  for (const char* term : {"coat.fresnel", "coat.absorption"}) {
    EXPECT_NE(std::find(paint["terms"].begin(), paint["terms"].end(), term), paint["terms"].end()) << term;
  }
  EXPECT_EQ(paint["skipped"]["coat.darkening"], "coatDarkeningFactor is 0");
  EXPECT_EQ(paint["ignored"], json::array({"/materials/0/extensions/EXAMPLE_materials_moss"}));
  EXPECT_TRUE(paint["diagnostics"].empty()) << paint["diagnostics"];
}

TEST_F(Manifest, diagnosticsHaveTheirPlace) {
  ASSERT_GE(material(1)["diagnostics"].size(), 1u);
  const json& warning = material(1)["diagnostics"][0];
  EXPECT_EQ(warning["severity"], "warning");
  EXPECT_TRUE(warning["pointer"].get<std::string>().starts_with(
      "/materials/1/pbrMetallicRoughness/baseColorTexture"));
  EXPECT_FALSE(warning["code"].get<std::string>().empty());
  EXPECT_NE(warning["message"].get<std::string>().find("TEXCOORD_0"), std::string::npos) << warning;
  EXPECT_EQ(material(1)["uses"].size(), 1u);

  ASSERT_EQ(material(2)["diagnostics"].size(), 1u);
  const json& error = material(2)["diagnostics"][0];
  EXPECT_EQ(error["severity"], "error");
  EXPECT_EQ(error["pointer"], "/materials/2/pbrMetallicRoughness/metallicFactor");
  EXPECT_TRUE(material(2)["uses"].empty());

  EXPECT_TRUE(material(3)["uses"].empty());
  EXPECT_EQ(material(3)["diagnostics"][0]["code"], "unused-material");
}

TEST_F(Manifest, shadersAreDescribed) {
  std::set<std::string> used;
  for (const json& one : manifest_["files"][0]["materials"]) {
    for (const json& use : one["uses"]) used.insert(use["shader"].get<std::string>());
  }
  std::set<std::string> described;
  for (const auto& [id, shader] : manifest_["shaders"].items()) {
    SCOPED_TRACE(id);
    described.insert(id);
    EXPECT_EQ(shader["files"]["spirv"]["vert"], "spirv/" + id + ".vert.spv");
    EXPECT_EQ(shader["files"]["spirv"]["frag"], "spirv/" + id + ".frag.spv");
    EXPECT_EQ(shader["files"].size(), 5u);
    EXPECT_EQ(shader["validated"].size(), 5u);
    for (const auto& [target, validated] : shader["validated"].items()) EXPECT_EQ(validated, true) << target;
    for (const char* list : {"uniforms", "textures", "inputs"}) EXPECT_TRUE(shader[list].is_array()) << list;
    EXPECT_FALSE(shader["uniforms"].empty());
    EXPECT_FALSE(shader["inputs"].empty());
  }
  EXPECT_EQ(used, described);
}

/// Everything that an engine needs to fill the uniforms and textures of a use lies in the shader's entry.
TEST_F(Manifest, usesFillWhatTheShaderWants) {
  for (const json& one : manifest_["files"][0]["materials"]) {
    for (const json& use : one["uses"]) {
      const json& shader = manifest_["shaders"][use["shader"].get<std::string>()];
      std::set<std::string> fields;
      std::set<std::string> textures;
      for (const json& block : shader["uniforms"]) {
        if (block["role"] != "material") continue;
        for (const json& field : block["fields"]) fields.insert(field["name"].get<std::string>());
      }
      for (const json& texture : shader["textures"]) {
        if (texture["role"] == "material") textures.insert(texture["name"].get<std::string>());
      }
      std::set<std::string> values;
      std::set<std::string> images;
      for (const auto& [name, value] : use["uniforms"].items()) values.insert(name);
      for (const auto& [name, texture] : use["textures"].items()) images.insert(name);
      EXPECT_EQ(values, fields) << one["name"];
      EXPECT_EQ(images, textures) << one["name"];
      const std::set<std::string> given(use["attributes"].begin(), use["attributes"].end());
      for (const json& input : shader["inputs"]) {
        const std::string name = input["name"];
        EXPECT_TRUE(name == "POSITION" || given.contains(name) || !one["diagnostics"].empty())
            << one["name"] << ": " << name;
      }
    }
  }
}

/// A command line run and a call of the library write the same bytes.
TEST(ManifestBytes, libraryWritesWhatTheProgramWrites) {
  const Workplace place;
  const std::string file = example("car_paint.gltf");
  EXPECT_EQ(place.run({"gen", file, "-o", "program"}).status, 0);
  Messages messages;
  EXPECT_TRUE(generate({file}, {}, (place / "library").string(), {}, messages).ok);
  const std::set<std::string> names = place.names();
  size_t compared = 0;
  for (const std::string& name : names) {
    if (!name.starts_with("program/") || !std::filesystem::is_regular_file(place / name)) continue;
    EXPECT_EQ(place.read(name), place.read("library" + name.substr(7))) << name;
    ++compared;
  }
  EXPECT_EQ(compared * 2,
            static_cast<size_t>(std::count_if(names.begin(), names.end(), [&](const std::string& name) {
              return std::filesystem::is_regular_file(place / name);
            })));
  EXPECT_GT(compared, 10u);
}

}  // namespace
}  // namespace lacquer::test::manifest_test
