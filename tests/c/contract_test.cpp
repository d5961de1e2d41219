// A contract as values of C is what manifest.json says.
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "handle.h"

namespace lacquer::test::contract_test {
namespace {

using nlohmann::json;

const char* const kFile = R"({"asset": {"version": "2.0"},
"extensionsUsed": ["KHR_materials_variants", "KHR_texture_transform", "KHR_texture_basisu",
                   "KHR_materials_transmission"],
"extensions": {"KHR_materials_variants": {"variants": [{"name": "day"}, {"name": "night"}]}},
"accessors": [{"componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
  {"componentType": 5120, "normalized": true, "count": 3, "type": "VEC3"},
  {"componentType": 5126, "count": 3, "type": "VEC2"}],
"images": [{"uri": "a.png"}, {"uri": "a.ktx2", "mimeType": "image/ktx2"}, {"uri": "data:image/png;base64,AAAA"}],
"samplers": [{"wrapS": 33071, "minFilter": 9985}],
"textures": [{"source": 0, "sampler": 0, "extensions": {"KHR_texture_basisu": {"source": 1}}},
  {"extensions": {"NV_texture_swizzle": {"options": [{"source": 2, "channels": [2, 0]}]}}}],
"meshes": [{"primitives": [
  {"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "material": 0,
   "extensions": {"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [1]}]}}},
  {"attributes": {"POSITION": 0, "NORMAL": 1}},
  {"attributes": {"POSITION": 0, "NORMAL": 1}, "material": 2}]}],
"materials": [
  {"name": "Leaf", "alphaMode": "MASK", "doubleSided": true, "pbrMetallicRoughness": {"baseColorTexture":
    {"index": 0, "extensions": {"KHR_texture_transform": {"offset": [0.25, 0], "rotation": 1}}}}},
  {"name": "Ghost", "alphaMode": "BLEND"},
  {"name": "Pane", "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}}]})";

CContract contractOf(const char* options_text, lacquer_messages* messages) {
  const COptions options = optionsFrom(options_text, messages);
  const CScene scene(lacquer_scene_read(kFile, std::strlen(kFile), "file.gltf", options.get(), messages));
  return CContract(lacquer_scene_contract(scene.get(), options.get(), messages));
}

json manifestOf(const lacquer_contract* contract) {
  return json::parse(textOf(CText(lacquer_contract_manifest(contract, "file.gltf"))));
}

json numbers(const double* from, size_t count) {
  return count == 1 ? json(*from) : json(std::vector<double>(from, from + count));
}

json textureOf(const lacquer_used_texture& from) {
  json row = {{"texture", from.texture}};
  if (from.texcoord >= 0) row["texcoord"] = from.texcoord;
  if (from.has_transform != 0) {
    row["transform"] = {
        {"offset", numbers(from.offset, 2)}, {"rotation", from.rotation}, {"scale", numbers(from.scale, 2)}};
  }
  constexpr const char* kWraps[] = {"repeat", "clamp", "mirror"};
  if (from.has_sampler != 0)
    row["sampler"] = {{"wrap_s", kWraps[from.wrap_s]},
                      {"wrap_t", kWraps[from.wrap_t]},
                      {"mag_filter", from.mag_filter == 1 ? "nearest" : "linear"}};
  if (std::strlen(from.file) != 0) row["file"] = from.file;
  if (from.stand_in != 0)
    row["stand_in"] = {{"texel", numbers(from.texel, 4)},
                       {"color_space", from.srgb != 0 ? "srgb" : "linear"}};
  return row;
}

json useOf(const lacquer_contract* contract, size_t place, size_t index) {
  lacquer_use use;
  EXPECT_EQ(lacquer_contract_use(contract, place, index, &use, sizeof use), 1);
  const CShader shader(lacquer_contract_shader(contract, use.shader));
  EXPECT_EQ(use.block_size, lacquer_shader_uniform_size(shader.get()));
  EXPECT_EQ(std::strlen(use.structure), 64U);
  json row = {{"shader", lacquer_shader_id(shader.get())},
              {"parameters", json::object()},
              {"textures", json::object()},
              {"stand_in_attributes", json::array()}};
  lacquer_parameter parameter;
  for (size_t i = 0; lacquer_contract_parameter(contract, place, index, i, &parameter, sizeof parameter) != 0;
       ++i) {
    json one = {{"value", numbers(parameter.numbers, parameter.count)}, {"pointer", parameter.pointer}};
    if (parameter.stand_in != 0) one["stand_in"] = true;
    row["parameters"][parameter.name] = one;
  }
  lacquer_used_texture texture;
  for (size_t i = 0; lacquer_contract_used_texture(contract, place, index, i, &texture, sizeof texture) != 0;
       ++i)
    row["textures"][texture.slot] = textureOf(texture);
  for (size_t i = 0; i < use.stand_in_attribute_count; ++i)
    row["stand_in_attributes"].push_back(lacquer_contract_stand_in_attribute(contract, place, index, i));
  return row;
}

/// The manifest's, with the members that the others have.
json useOf(json entry) {
  json row;
  for (const char* name : {"shader", "parameters", "textures"}) row[name] = entry[name];
  for (auto& [slot, texture] : row["textures"].items()) texture.erase("pointer");
  row["stand_in_attributes"] = entry.value("stand_in_attributes", json::array());
  return row;
}

void compareMaterial(const lacquer_contract* contract, size_t place, const json& entry) {
  constexpr const char* kAlpha[] = {"OPAQUE", "MASK", "BLEND"};
  constexpr const char* kPasses[] = {"opaque", "masked", "looks_through", "blended"};
  lacquer_material material;
  ASSERT_EQ(lacquer_contract_material(contract, place, &material, sizeof material), 1);
  EXPECT_EQ(material.name, entry["name"].get<std::string>());
  EXPECT_EQ(material.index, entry["index"]);
  EXPECT_EQ(kAlpha[material.alpha_mode], entry["alpha_mode"]);
  EXPECT_EQ(kPasses[material.pass], entry["pass"]);
  EXPECT_EQ(material.depth_write != 0, entry["depth_write"]);
  EXPECT_EQ(material.double_sided != 0, entry["double_sided"]);
  EXPECT_EQ(material.blends != 0, entry.contains("blend"));
  if (material.blends != 0) {
    EXPECT_EQ(material.source_color, LACQUER_FACTOR_SOURCE_ALPHA);
    EXPECT_EQ(material.destination_alpha, LACQUER_FACTOR_ONE_MINUS_SOURCE_ALPHA);
  }
  ASSERT_EQ(material.use_count, entry["uses"].size());
  for (size_t i = 0; i < material.use_count; ++i)
    EXPECT_EQ(useOf(contract, place, i), useOf(entry["uses"][i]));
}

TEST(CContractValues, AreTheManifests) {
  for (const char* options :
       {R"({"targets": ["glsl"], "validate": false})",
        R"({"targets": ["glsl"], "validate": false, "programs": 1, "programs_model": true})"}) {
    CMessages messages;
    const CContract contract = contractOf(options, messages);
    EXPECT_EQ(lacquer_contract_ok(contract.get()), 1) << messages.takeCodes();
    const json manifest = manifestOf(contract.get());
    const json& file = manifest["files"][0];
    EXPECT_EQ(lacquer_contract_shader_count(contract.get()), manifest["shaders"].size());
    ASSERT_EQ(lacquer_contract_material_count(contract.get()), 4U);
    for (size_t i = 0; i < 3; ++i) compareMaterial(contract.get(), i, file["materials"][i]);
    compareMaterial(contract.get(), 3, file["default_material"]);
    ASSERT_EQ(lacquer_contract_primitive_count(contract.get()), file["primitives"].size());
    for (size_t i = 0; i < file["primitives"].size(); ++i) {
      const json& entry = file["primitives"][i];
      lacquer_primitive primitive;
      ASSERT_EQ(lacquer_contract_primitive(contract.get(), i, &primitive, sizeof primitive), 1);
      EXPECT_EQ(primitive.mesh, entry["mesh"]);
      EXPECT_EQ(primitive.primitive, entry["primitive"]);
      EXPECT_EQ(primitive.material, entry["material"]);
      EXPECT_EQ(primitive.use, entry["use"]);
      lacquer_material material;
      ASSERT_EQ(lacquer_contract_material(contract.get(), primitive.place, &material, sizeof material), 1);
      EXPECT_EQ(material.index, primitive.material);
      lacquer_attribute attribute;
      for (size_t a = 0; lacquer_contract_attribute(contract.get(), i, a, &attribute, sizeof attribute) != 0;
           ++a) {
        const json& stored = entry["attributes"][attribute.semantic];
        EXPECT_EQ(stored["component_type"], attribute.component_type);
        EXPECT_EQ(stored.value("normalized", false), attribute.normalized != 0);
      }
    }
  }
}

TEST(CContractValues, VariantsTexturesImages) {
  CMessages messages;
  const CContract contract = contractOf(R"({"targets": ["glsl"], "validate": false})", messages);
  lacquer_primitive day, night;
  ASSERT_EQ(lacquer_contract_variant_primitive(contract.get(), 0, 0, &day, sizeof day), 1);
  ASSERT_EQ(lacquer_contract_variant_primitive(contract.get(), 0, 1, &night, sizeof night), 1);
  EXPECT_EQ(day.material, 0);
  EXPECT_EQ(night.material, 1);
  EXPECT_EQ(lacquer_contract_variant_count(contract.get()), 2U);
  EXPECT_STREQ(lacquer_contract_variant(contract.get(), 1, nullptr), "night");
  lacquer_file_texture texture;
  ASSERT_EQ(lacquer_contract_texture(contract.get(), 0, &texture, sizeof texture), 1);
  EXPECT_EQ(texture.wrap_s, LACQUER_WRAP_CLAMP);
  EXPECT_EQ(texture.min_filter, LACQUER_FILTER_LINEAR_MIPMAP_NEAREST);
  EXPECT_EQ(texture.mag_filter, LACQUER_FILTER_OPEN);
  const char* extension = nullptr;
  EXPECT_EQ(lacquer_contract_texture_image(contract.get(), 0, 0, &extension), 1U);
  EXPECT_STREQ(extension, "KHR_texture_basisu");
  EXPECT_EQ(lacquer_contract_texture_image(contract.get(), 0, 1, nullptr), 0U);
  EXPECT_EQ(texture.swizzled, 0);
  EXPECT_EQ(lacquer_contract_texture_channels(contract.get(), 0, 0, nullptr, nullptr), 0);
  ASSERT_EQ(lacquer_contract_texture(contract.get(), 1, &texture, sizeof texture), 1);
  EXPECT_EQ(texture.swizzled, 1);
  int channels[4], layer = -1;
  ASSERT_EQ(lacquer_contract_texture_channels(contract.get(), 1, 0, channels, &layer), 1);
  EXPECT_EQ((std::vector<int>(channels, channels + 4)), (std::vector<int>{2, 0, -1, -1}));
  EXPECT_EQ(layer, 0);
  lacquer_image image;
  ASSERT_EQ(lacquer_contract_image(contract.get(), 1, &image, sizeof image), 1);
  EXPECT_STREQ(image.uri, "a.ktx2");
  ASSERT_EQ(lacquer_contract_image(contract.get(), 2, &image, sizeof image), 1);
  EXPECT_EQ(image.data_uri, 1);
}

TEST(CContractValues, LooksAreTheManifests) {
  const char* const kDocument = R"(<materialx version="1.39">
  <surface_unlit name="s" type="surfaceshader"/>
  <surfacematerial name="paint" type="material">
    <input name="surfaceshader" type="surfaceshader" nodename="s"/>
  </surfacematerial>
  <look name="a"><materialassign name="m" material="paint" geom="/x, /y"/></look>
</materialx>)";
  CMessages messages;
  const COptions options = optionsFrom(R"({"targets": ["glsl"], "validate": false})", messages);
  const CScene scene(
      lacquer_scene_read(kDocument, std::strlen(kDocument), "file.mtlx", options.get(), messages));
  const CContract contract(lacquer_scene_contract(scene.get(), options.get(), messages));
  const json looks = json::parse(textOf(CText(lacquer_contract_looks(contract.get()))));
  EXPECT_EQ(looks["looks"], manifestOf(contract.get())["files"][0]["looks"]);
  EXPECT_EQ(looks["looks"][0]["materials"][0]["geometry"], (json{"/x", "/y"}));
  EXPECT_EQ(lacquer_contract_looks(nullptr), nullptr);
}

TEST(CContractValues, WhatDoesNotExistIsEmpty) {
  CMessages messages;
  EXPECT_EQ(lacquer_scene_contract(nullptr, nullptr, messages), nullptr);
  EXPECT_EQ(messages.takeCodes(), "empty-handle");
  lacquer_material material;
  lacquer_use use;
  lacquer_primitive primitive;
  EXPECT_EQ(lacquer_contract_material(nullptr, 0, &material, sizeof material), 0);
  EXPECT_EQ(lacquer_contract_use(nullptr, 0, 0, &use, sizeof use), 0);
  EXPECT_EQ(lacquer_contract_primitive(nullptr, 0, &primitive, sizeof primitive), 0);
  EXPECT_EQ(lacquer_contract_texture_image(nullptr, 0, 0, nullptr), LACQUER_NONE);
  EXPECT_EQ(lacquer_contract_texture_channels(nullptr, 0, 0, nullptr, nullptr), 0);
  EXPECT_EQ(lacquer_contract_shader(nullptr, 0), nullptr);
  EXPECT_EQ(lacquer_contract_manifest(nullptr, "x"), nullptr);
  EXPECT_EQ(lacquer_contract_ok(nullptr), 0);
  const CContract contract = contractOf(R"({"targets": ["glsl"], "validate": false})", messages);
  EXPECT_EQ(lacquer_contract_material(contract.get(), 4, &material, sizeof material), 0);
  EXPECT_EQ(lacquer_contract_material(contract.get(), 0, nullptr, 0), 0);
  EXPECT_STREQ(lacquer_contract_stand_in_attribute(contract.get(), 0, 0, 9), "");
  // An earlier caller knows fewer members.
  std::memset(&material, 0x5a, sizeof material);
  ASSERT_EQ(lacquer_contract_material(contract.get(), 0, &material, sizeof material.name), 1);
  EXPECT_STREQ(material.name, "Leaf");
  EXPECT_EQ(material.pass, 0x5a5a5a5a);
}

TEST(CContractValues, StructuresOfGraphs) {
  CMessages messages;
  const COptions options = optionsFrom(R"({"targets": ["glsl"], "validate": false})");
  const CScene scene(lacquer_scene_read(kFile, std::strlen(kFile), "file.gltf", options.get(), messages));
  const CContract contract(lacquer_scene_contract(scene.get(), options.get(), messages));
  for (size_t i = 0; i < 3; ++i) {
    const CGraph graph(
        lacquer_scene_graph(scene.get(), i, lacquer_scene_use(scene.get(), i, 0), options.get(), messages));
    lacquer_use use;
    ASSERT_EQ(lacquer_contract_use(contract.get(), i, 0, &use, sizeof use), 1);
    EXPECT_EQ(textOf(CText(lacquer_graph_structure(graph.get(), options.get(), messages))), use.structure);
  }
}

}  // namespace
}  // namespace lacquer::test::contract_test
