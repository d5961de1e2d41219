// What a material can do without, in words.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "lacquer.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCoat = R"({"asset": {"version": "2.0"}, "textures": [{}, {}],
  "materials": [{"name": "m", "normalTexture": {"index": 0},
    "extensions": {"KHR_materials_coat": {"coatFactor": 0.8, "coatRoughnessFactor": 0.3, "coatColorFactor": [0.9, 0.5, 0.3],
      "coatDarkeningFactor": 1, "coatRoughnessTexture": {"index": 1}}}}]})";

std::string graphOf(const Strings& words, const Strings& folders = {}, Messages* said = nullptr) {
  Options options;
  options.simplify = words;
  options.node_directories = folders;
  Messages messages;
  const Scene scene = Scene::fromMemory(kCoat, "m.gltf", options, messages);
  Attributes attributes;
  attributes.tangent = true;
  attributes.texCoord = {true, false, false, false};
  const std::string json = scene ? scene.graph(0, attributes, options, messages).toJson() : "";
  if (said != nullptr)
    *said = messages;
  else
    EXPECT_FALSE(hasError(messages)) << messages[0].text;
  return json;
}

bool has(const std::string& json, const std::string& text) { return json.find(text) != std::string::npos; }

TEST(Words, ATermIsLeftOut) {
  EXPECT_TRUE(has(graphOf({}), "\"id\": \"coat.absorption\""));
  const std::string json = graphOf({"without:coat.absorption"});
  EXPECT_FALSE(has(json, "\"id\": \"coat.absorption\""));
  EXPECT_TRUE(has(json, "it is left out"));
  EXPECT_FALSE(has(graphOf({"without:coat"}), "\"id\": \"coat."));
}

TEST(Words, ALodStandsInPlaceOfLines) {
  EXPECT_TRUE(has(graphOf({}), "\"id\": \"coat.specular\""));
  EXPECT_FALSE(has(graphOf({"lod:coat_base_lobe"}), "\"id\": \"coat.specular\""));
  EXPECT_TRUE(has(graphOf({"lod:coat_mean_fresnel"}), "\"node\": \"schlick_mean\""));
}

TEST(Words, ATextureGoesOrBecomesOneColor) {
  EXPECT_TRUE(has(graphOf({}), "\"node\": \"smith_visibility\""));
  const std::string json = graphOf({"texel:coatRoughnessTexture=0,0.5,0,1"});
  EXPECT_FALSE(has(json, "coat_roughness_texture"));
  EXPECT_TRUE(has(json, "\"roughness_texel\": 0.5"));
  // With one roughness for all pixels the visibility is a quotient.
  EXPECT_FALSE(has(json, "\"node\": \"smith_visibility\""));
  EXPECT_FALSE(has(graphOf({"drop:normalTexture"}), "\"node\": \"normal_map\""));
}

TEST(Words, NodesAndNumbers) {
  EXPECT_TRUE(has(graphOf({"variant:coat.absorption=quartic"}), "\"variant\": \"quartic\""));
  EXPECT_EQ(graphOf({"variant:coat.absorption=nobody", "variant:nobody=quartic"}), graphOf({}));
  const std::string json = graphOf({"scale:coat_color_factor=0.9,1,0.5"});
  EXPECT_TRUE(has(json, "\"id\": \"coat_color_factor.fitted\""));
  EXPECT_TRUE(has(json, "\"scale\": [0.9, 1, 0.5]"));
  EXPECT_EQ(graphOf({"scale:coat_color_factor=0.9", "scale:nobody=1"}), graphOf({}))
      << "one number for three";
  EXPECT_FALSE(has(graphOf({"switch:ibl=off"}), "\"id\": \"base.indirect\""));
}

/// The vertex and the fragment stage.
std::pair<std::string, std::string> codeOf(const Strings& words) {
  Options options;
  options.simplify = words;
  options.targets = {Target::Glsl};
  options.lights = {Lights::Mode::Fixed, {{"directional", 1}}};
  Messages messages;
  const Scene scene = Scene::fromMemory(kCoat, "m.gltf", options, messages);
  Attributes attributes;
  attributes.normal = attributes.tangent = true;
  attributes.texCoord = {true, false, false, false};
  const Shader shader = scene.graph(0, attributes, options, messages).generate(options, messages);
  EXPECT_FALSE(hasError(messages)) << messages[0].text;
  return {shader.vertexText(Target::Glsl), shader.fragmentText(Target::Glsl)};
}

TEST(Words, ANodeGoesToTheVertices) {
  const auto before = codeOf({});
  const auto after = codeOf({"vertex:coat.fresnel"});
  EXPECT_FALSE(has(before.first, "coat.fresnel"));
  EXPECT_TRUE(has(after.first, "coat.fresnel"));
  EXPECT_FALSE(has(before.second, "in float v_fresnel;"));
  EXPECT_TRUE(has(after.second, "in float v_fresnel;"));
  // A light, a texture without a level and a node that is not there are none of the vertices'.
  for (const char* other : {"vertex:coat.specular", "vertex:coat.surface", "vertex:nobody"})
    EXPECT_TRUE(codeOf({other}) == before) << other;
}

TEST(Words, ALodWhoseLineComesToNothingLeavesTheOther) {
  const fs::path folder = fs::path(testing::TempDir()) / "lacquer_lod_words";
  fs::create_directories(folder);
  std::ofstream(folder / "a.node")
      << "/// Nothing gives it.\nlod of_nothing { coat.roughness = sheen.roughness; }\n"
         "/// A number.\nlod half_rough { coat.roughness = 0.5; }\n";
  EXPECT_EQ(graphOf({"lod:of_nothing"}, {folder.string()}), graphOf({}));
  EXPECT_NE(graphOf({"lod:half_rough"}, {folder.string()}), graphOf({}));
  std::ofstream(folder / "a.node") << "/// Wrong.\nlod wrong { coat.roughness = nobody.knows; }\n";
  Messages messages;
  graphOf({"lod:wrong"}, {folder.string()}, &messages);
  ASSERT_FALSE(messages.empty());
  EXPECT_EQ(messages[0].code, "unknown-name");
  EXPECT_EQ(messages[0].line, 2U);
  fs::remove_all(folder);
}

TEST(Words, WrongOnesAreErrors) {
  for (const auto& [word, code] :
       std::vector<std::pair<std::string, std::string>>{{"coat", "bad-simplification"},
                                                        {"", "bad-simplification"},
                                                        {"without:", "bad-simplification"},
                                                        {"without:x=1", "bad-simplification"},
                                                        {"texel:coatTexture=1,2", "bad-simplification"},
                                                        {"texel:coatTexture=1,2,3,nan", "bad-simplification"},
                                                        {"scale:x=-1", "bad-simplification"},
                                                        {"scale:x=1,1,1,1,1", "bad-simplification"},
                                                        {"switch:ibl=maybe", "bad-simplification"},
                                                        {"without:coat.nobody", "unknown-term"},
                                                        {"lod:nobody", "unknown-lod"},
                                                        {"drop:nobodyTexture", "unknown-texture"},
                                                        {"switch:nobody=on", "unknown-switch"}}) {
    Messages messages;
    graphOf({word}, {}, &messages);
    ASSERT_FALSE(messages.empty()) << word;
    EXPECT_EQ(messages[0].code, code) << word;
  }
}

}  // namespace
}  // namespace lacquer::test
