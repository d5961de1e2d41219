// What a template has only where it is used: textures behind the material's, outputs in places of their own.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "inputs.h"

namespace lacquer::test {
namespace {

using nlohmann::json;

/// What the shader of a material with these extensions says of itself.
json interfaceOf(const std::string& extensions, const std::string& template_name) {
  Options options = quick();
  options.template_name = template_name;
  Messages messages;
  const std::string gltf = R"({"asset": {"version": "2.0"}, "textures": [{}, {}], "materials": [
      {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "extensions": )" +
                           extensions + "}]}";
  const Scene scene = Scene::fromMemory(gltf, "optional.gltf", options, messages);
  Graph graph =
      scene ? scene.graph(0, {true, true, false, {true, true, true, true}}, options, messages) : Graph();
  const Shader shader = graph ? graph.generate(options, messages) : Shader();
  EXPECT_TRUE(shader) << (messages.empty() ? "" : messages[0].text);
  return shader ? json::parse(shader.interfaceJson()) : json();
}

std::map<std::string, int> flatOf(const json& interface) {
  std::map<std::string, int> flat;
  for (const json& texture : interface["textures"]) flat[texture["name"]] = texture["flat"];
  return flat;
}

TEST(Optional, ATextureOfTheTemplateLiesBehindTheMaterials) {
  const std::map<std::string, int> without = flatOf(interfaceOf("{}", "forward"));
  const std::map<std::string, int> with = flatOf(interfaceOf(
      R"({"KHR_materials_transmission": {"transmissionFactor": 1, "transmissionTexture": {"index": 1}}})",
      "forward"));
  EXPECT_FALSE(without.contains("scene_behind"));
  ASSERT_TRUE(with.contains("scene_behind") && with.contains("transmission_texture"));
  EXPECT_EQ(without.at("base_color_texture"), with.at("base_color_texture"));
  EXPECT_EQ(with.at("transmission_texture"), with.at("base_color_texture") + 1);
  EXPECT_EQ(with.at("scene_behind"), with.at("base_color_texture") + 2);
}

std::map<std::string, int> locationsOf(const json& interface) {
  std::map<std::string, int> locations;
  for (const json& output : interface["outputs"]) locations[output["name"]] = output.value("location", -1);
  return locations;
}

constexpr const char* kVolume = R"({"KHR_materials_transmission": {"transmissionFactor": 1},
    "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 1, "attenuationColor": [1, 0, 0]}})";

TEST(Optional, AnOutputKeepsItsPlaceWhereAllHaveOne) {
  const auto none = locationsOf(interfaceOf("{}", "bsdf"));
  const auto volume = locationsOf(interfaceOf(kVolume, "bsdf"));
  const auto unlit = locationsOf(interfaceOf(R"({"KHR_materials_unlit": {}})", "bsdf"));
  EXPECT_EQ(none.at("sample"), 2);
  EXPECT_FALSE(none.contains("absorption") || unlit.contains("sample"));
  EXPECT_EQ(volume.at("sample"), 2);
  EXPECT_EQ(volume.at("absorption"), 3);
}

json packedOf(const json& interface) {
  json packed = json::object();
  for (const json& output : interface["outputs"]) {
    if (output.contains("holds")) packed[output["name"].get<std::string>()] = output["holds"];
  }
  return packed;
}

TEST(Optional, OutputsSharePlacesWhereDevicesHaveTooFew) {
  const json none = interfaceOf("{}", "surface");
  EXPECT_EQ(none["outputs"].size(), 6u);
  EXPECT_EQ(packedOf(none), json::object());
  const json specular = interfaceOf(
      R"({"KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1, 0.5, 0]}})",
      "surface");
  EXPECT_EQ(packedOf(specular), json::parse(R"({"packed_0": ["specular_color.x", "specular_color.y",
      "specular_color.z", "specular_weight"]})"));
  EXPECT_EQ(locationsOf(specular).at("packed_0"), 6);
  // What a material leaves at its default is no component.
  EXPECT_EQ(packedOf(interfaceOf(R"({"KHR_materials_specular": {"specularFactor": 0.5}})", "surface")),
            json::parse(R"({"packed_0": ["specular_weight"]})"));
  // What the extension does not have stays away: of transmission_layer and inner_layer one component each.
  EXPECT_EQ(packedOf(interfaceOf(kVolume, "surface")),
            json::parse(R"({"packed_0": ["transmission", "volume_thickness", "medium_absorption.x",
                "medium_absorption.y"], "packed_1": ["medium_absorption.z"]})"));
}

/// The layers of a coat that is not there tell nothing: others lie in their places, from the first on.
TEST(Optional, WhatTellsNothingMakesRoom) {
  const json interface = interfaceOf(R"({
      "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1, 0.5, 0]},
      "KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1], "sheenRoughnessFactor": 0.5},
      "KHR_materials_anisotropy": {"anisotropyStrength": 0.5}})",
                                     "surface");
  const auto locations = locationsOf(interface);
  EXPECT_EQ(locations.size(), 8u);
  EXPECT_EQ(locations.at("emission_metallic"), 2);
  EXPECT_FALSE(locations.contains("coat_layer_0"));
  EXPECT_EQ(locations.at("packed_2"), 3);
  EXPECT_EQ(locations.at("coat_layer_1"), 4);
  EXPECT_EQ(locations.at("packed_0"), 6);
  EXPECT_EQ(locations.at("packed_1"), 7);
}

TEST(Optional, WhatNoDeviceTakesIsRefusedWithWhatToLeaveOut) {
  const std::string gltf = R"({"asset": {"version": "2.0"}, "materials": [{"extensions": {
      "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1, 0.5, 0]},
      "KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1], "sheenRoughnessFactor": 0.5},
      "KHR_materials_anisotropy": {"anisotropyStrength": 0.5},
      "KHR_materials_coat": {"coatFactor": 1, "coatColorFactor": [0.5, 1, 1]}}}]})";
  const auto generated = [&](const std::string& name, Messages& messages) {
    const std::filesystem::path folder = emptyFolder();
    std::ofstream(folder / "thin.node")
        << "/// D.\ntemplate thin extends surface { without output coat_layer_1, anisotropy_layer; }\n";
    Options options = quick();
    options.template_name = name;
    options.node_directories = {folder.string()};
    const Scene scene = Scene::fromMemory(gltf, "full.gltf", options, messages);
    Graph graph = scene.graph(0, {true, true, false, {true, true, true, true}}, options, messages);
    const Shader shader = graph.generate(options, messages);
    return shader ? json::parse(shader.interfaceJson()) : json();
  };
  Messages wrong, right;
  EXPECT_TRUE(generated("surface", wrong).is_null());
  ASSERT_EQ(errorsOf(wrong), "over-limit");
  EXPECT_NE(
      wrong.back().text.find("has 9 colour outputs in the template 'surface': 6 with something of it that "
                             "are always there, and 12 components of others"),
      std::string::npos)
      << wrong.back().text;
  EXPECT_NE(wrong.back().text.find("specular_layer (4), anisotropy_layer (4), sheen_layer (4)"),
            std::string::npos)
      << wrong.back().text;
  const json thin = generated("thin", right);
  EXPECT_EQ(errorsOf(right), "");
  ASSERT_FALSE(thin.is_null());
  EXPECT_EQ(thin["outputs"].size(), 7u);
  EXPECT_FALSE(locationsOf(thin).contains("coat_layer_1"));
}

}  // namespace
}  // namespace lacquer::test
