// What a template has only where it is used: textures behind the material's, outputs in places of their own.
#include <gtest/gtest.h>

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

TEST(Optional, AnOutputKeepsItsPlace) {
  const auto none = locationsOf(interfaceOf("{}", "surface"));
  const auto specular =
      locationsOf(interfaceOf(R"({"KHR_materials_specular": {"specularFactor": 0.5}})", "surface"));
  const auto both = locationsOf(interfaceOf(R"({"KHR_materials_specular": {"specularFactor": 0.5},
                                                "KHR_materials_transmission": {"transmissionFactor": 1}})",
                                            "surface"));
  const auto clear =
      locationsOf(interfaceOf(R"({"KHR_materials_transmission": {"transmissionFactor": 1}})", "surface"));
  EXPECT_FALSE(none.contains("specular_layer") || none.contains("transmission_layer"));
  EXPECT_TRUE(specular.contains("specular_layer") && !specular.contains("transmission_layer"));
  EXPECT_TRUE(!clear.contains("specular_layer") && clear.contains("transmission_layer"));
  EXPECT_EQ(clear.at("transmission_layer"), both.at("transmission_layer"));
  EXPECT_EQ(specular.at("specular_layer"), both.at("specular_layer"));
  EXPECT_NE(both.at("specular_layer"), both.at("transmission_layer"));
}

}  // namespace
}  // namespace lacquer::test
