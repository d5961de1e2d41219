// --binding arrays: a material with more textures than WebGL 2, WebGPU and Direct3D 11 take has few.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "check/check.h"
#include "check/reflect.h"
#include "output.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

/// One material with a texture for nearly everything: linear and sRGB, of which one is looked up otherwise.
constexpr const char* kMany = R"({"asset": {"version": "2.0"}, "images": [{"uri": "a.png"}],
    "samplers": [{}, {"wrapS": 33071, "wrapT": 33071, "magFilter": 9728}],
    "textures": [{"source": 0, "sampler": 1}, {"source": 0}, {"source": 0}, {"source": 0},
      {"source": 0}, {"source": 0}, {"source": 0}, {"source": 0}, {"source": 0}, {"source": 0},
      {"source": 0}, {"source": 0}, {"source": 0}, {"source": 0}, {"source": 0}],
    "extensionsUsed": ["KHR_materials_coat", "KHR_materials_specular", "KHR_materials_sheen",
      "KHR_materials_transmission"],
    "materials": [{"normalTexture": {"index": 1}, "occlusionTexture": {"index": 2},
      "emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0},
      "pbrMetallicRoughness": {"baseColorTexture": {"index": 3}, "metallicRoughnessTexture": {"index": 4}},
      "extensions": {
        "KHR_materials_coat": {"coatFactor": 1, "coatTexture": {"index": 5}, "coatNormalTexture": {"index": 6},
          "coatColorTexture": {"index": 7}, "coatRoughnessTexture": {"index": 8},
          "coatAnisotropyStrength": 0.5, "coatAnisotropyTexture": {"index": 9}},
        "KHR_materials_specular": {"specularTexture": {"index": 10}, "specularColorTexture": {"index": 11}},
        "KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1], "sheenColorTexture": {"index": 12},
          "sheenRoughnessFactor": 0.5, "sheenRoughnessTexture": {"index": 13}},
        "KHR_materials_transmission": {"transmissionFactor": 1, "transmissionTexture": {"index": 14}}}}]})";

struct Made {
  Shader shader;
  Messages messages;
  bool warned() const { return textOf(messages).find("textures; sure to be there") != std::string::npos; }
};

Made manyBy(const Options& options) {
  Made made;
  const Scene scene = Scene::fromMemory(kMany, "many.gltf", options, made.messages);
  EXPECT_TRUE(scene) << textOf(made.messages);
  Graph graph = scene.graph(0, {true, true, true, {true, true, true, true}}, options, made.messages);
  made.shader = graph.generate(options, made.messages);
  EXPECT_TRUE(made.shader) << textOf(made.messages);
  return made;
}

Options forAll(BindingModel binding) {
  Options options;
  options.binding = binding;
  options.targets = {Target::Glsl, Target::GlslGl, Target::Essl, Target::Hlsl, Target::Spirv};
  if (check::haveTint()) options.targets.push_back(Target::Wgsl);
  return options;
}

/// What the fragment stage takes, each once.
std::set<std::string> boundBy(const Shader& shader) {
  std::set<std::string> bound;
  for (const ReflectedTexture& texture : shader.reflection().textures) {
    if (texture.fragment) bound.insert(texture.layered ? texture.array : texture.name);
  }
  return bound;
}

TEST(Arrays, TakeFewPlacesInEveryTarget) {
  const Made plain = manyBy(forAll(BindingModel::Sets)), arrays = manyBy(forAll(BindingModel::Arrays));
  EXPECT_TRUE(plain.warned()) << "the material has too few textures for this test";
  EXPECT_GT(boundBy(plain.shader).size(), 16U);
  EXPECT_EQ(textOf(arrays.messages), "");
  std::set<std::string> bound = boundBy(arrays.shader);
  for (const char* name : {"color_textures", "data_textures", "emissive_texture"})
    EXPECT_EQ(bound.erase(name), 1U) << name;
  for (const std::string& other : bound) EXPECT_EQ(boundBy(plain.shader).count(other), 1U) << other;
  EXPECT_LE(bound.size() + 3, 8U);
  EXPECT_TRUE(arrays.shader.reflection().webgpu_limits.empty() ||
              arrays.shader.reflection().webgpu_limits[0].first != "maxSampledTexturesPerShaderStage");
}

TEST(Arrays, HaveTheLayersInTheMaterialsBlock) {
  for (const Parameters parameters : {Parameters::Uniform, Parameters::Baked}) {
    Options options = forAll(BindingModel::Arrays);
    options.parameters = parameters;
    const Made made = manyBy(options);
    const Reflection& reflection = made.shader.reflection();
    const auto block = std::find_if(reflection.blocks.begin(), reflection.blocks.end(),
                                    [](const UniformBlock& one) { return one.role == BlockRole::Material; });
    ASSERT_NE(block, reflection.blocks.end());
    std::map<uint32_t, std::string> arrays;
    std::set<uint32_t> numbers;
    for (const ReflectedTexture& texture : reflection.textures) {
      if (!texture.layered) continue;
      EXPECT_EQ(texture.array, texture.srgb ? "color_textures" : "data_textures") << texture.slot;
      EXPECT_EQ(texture.type, "sampler2DArray");
      EXPECT_EQ(texture.sampler, texture.array + "_sampler");
      EXPECT_EQ(arrays.emplace(texture.at.binding, texture.array).first->second, texture.array);
      const auto field = std::find_if(block->fields.begin(), block->fields.end(),
                                      [&](const BlockField& one) { return one.offset == texture.number; });
      ASSERT_NE(field, block->fields.end());
      EXPECT_EQ(field->type, "int");
      EXPECT_EQ(field->name, texture.name);
      EXPECT_TRUE(numbers.insert(texture.number).second);
    }
    ASSERT_EQ(arrays.size(), 2U);
    EXPECT_EQ(block->size % 16, 0U);
    EXPECT_GE(block->size, *numbers.rbegin() + 4);
  }
}

/// Of the environment's textures those that lie behind the material's follow the fewer.
TEST(Arrays, LeaveNoHolesAmongTheUnits) {
  const Made made = manyBy(forAll(BindingModel::Arrays));
  std::map<uint32_t, std::string> units;
  for (const ReflectedTexture& texture : made.shader.reflection().textures) {
    const std::string& name = texture.layered ? texture.array : texture.name;
    EXPECT_EQ(units.emplace(texture.at.flat, name).first->second, name);
  }
  EXPECT_LT(units.rbegin()->first, 8U);
}

/// What is bound once stands once among the bindings of WebGPU and Metal.
TEST(Arrays, AreNamedOnceInOtherApis) {
  Options options = forAll(BindingModel::Arrays);
  options.validate = false;
  options.targets = {Target::Wgsl, Target::Msl};
  const Made made = manyBy(options);
  const Json entry = Json::parse(made.shader.interfaceJson());
  for (const auto& [api, name] : {std::pair{"webgpu", "color_textures"},
                                  {"webgpu", "color_textures_sampler"},
                                  {"webgpu", "data_textures"},
                                  {"metal", "color_textures"},
                                  {"metal", "data_textures"}}) {
    size_t rows = 0;
    for (const Json& row : entry[api]["bindings"]) rows += row["name"] == name ? 1 : 0;
    EXPECT_EQ(rows, 1U) << api << " " << name;
  }
  EXPECT_NE(made.shader.fragmentText(Target::Msl).find("texture2d_array<float> color_textures"),
            std::string::npos);
  EXPECT_NE(made.shader.fragmentText(Target::Wgsl).find("var color_textures: texture_2d_array<f32>;"),
            std::string::npos);
}

/// So is the array that holds the textures of all materials.
TEST(Bindless, TexturesAreNamedOnceInOtherApis) {
  for (const bool buffers : {false, true}) {
    Options options = forAll(BindingModel::Bindless);
    options.validate = false;
    options.argument_buffers = buffers;
    options.targets = {Target::Wgsl, Target::Msl};
    const Json entry = Json::parse(manyBy(options).shader.interfaceJson());
    for (const char* api : {"webgpu", "metal"}) {
      std::multiset<std::string> names;
      for (const Json& row : entry[api]["bindings"]) names.insert(row["name"].get<std::string>());
      EXPECT_EQ(names.count("textures"), 1U) << api;
      EXPECT_EQ(names.count("base_color_texture"), 0U) << api;
    }
  }
}

/// With one format there is one array for each sampler.
TEST(Arrays, AreOneWhereTheShaderDecodes) {
  Options options = forAll(BindingModel::Arrays);
  options.decode_srgb = true;
  std::set<std::string> arrays;
  for (const ReflectedTexture& texture : manyBy(options).shader.reflection().textures)
    if (texture.layered) arrays.insert(texture.array);
  EXPECT_EQ(arrays, std::set<std::string>{"data_textures"});
}

/// A texture whose sampler nobody knows may be looked up otherwise than the others.
TEST(Arrays, HaveNoneWhoseSamplerIsNotKnown) {
  Options options = forAll(BindingModel::Arrays);
  Messages messages;
  const Scene scene = Scene::fromMemory(kMany, "many.gltf", {}, messages);
  Graph graph = scene.graph(0, {true, true, true, {true, true, true, true}}, {}, messages);
  const Shader shader = graph.generate(options, messages);
  ASSERT_TRUE(shader);
  for (const ReflectedTexture& texture : shader.reflection().textures) EXPECT_FALSE(texture.layered);
}

}  // namespace
}  // namespace lacquer::test
