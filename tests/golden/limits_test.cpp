// No shader of the library has more than the platforms take: every template with every profile, switch and
// way of parameters.
#include <gtest/gtest.h>
#include <lacquer.h>

#include <nlohmann/json.hpp>

#include "lang/library.h"
#include "targets/target.h"

namespace lacquer::test {
namespace {

using nlohmann::json;

/// All extensions that one material may have, few at a time, with a texture where there can be one.
constexpr const char* kMaterials = R"({"asset": {"version": "2.0"}, "textures": [{}], "materials": [
    {"normalTexture": {"index": 0}, "occlusionTexture": {"index": 0}, "emissiveTexture": {"index": 0},
     "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 0}},
     "extensions": {"KHR_materials_coat": {"coatFactor": 1, "coatTexture": {"index": 0},
         "coatNormalTexture": {"index": 0}, "coatColorTexture": {"index": 0},
         "coatRoughnessTexture": {"index": 0}, "coatAnisotropyStrength": 0.5,
         "coatAnisotropyTexture": {"index": 0}}}},
    {"normalTexture": {"index": 0}, "extensions": {
         "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatNormalTexture": {"index": 0}},
         "KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyTexture": {"index": 0}},
         "KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1], "sheenColorTexture": {"index": 0}}}},
    {"extensions": {"KHR_materials_transmission": {"transmissionFactor": 1, "transmissionTexture": {"index": 0}},
         "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 1, "attenuationColor": [1, 0, 0]},
         "KHR_materials_dispersion": {"dispersion": 0.5}, "KHR_materials_ior": {"ior": 1.7}}},
    {"extensions": {"KHR_materials_iridescence": {"iridescenceFactor": 1, "iridescenceTexture": {"index": 0}},
         "KHR_materials_specular": {"specularFactor": 0.5, "specularTexture": {"index": 0}}}},
    {"extensions": {"KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.5}}},
    {"extensions": {"KHR_materials_unlit": {}}}]})";

/// What the shader says of itself against the row: what is over is said, and nothing that no device takes.
void expectWithin(const json& interface, const std::string& said, const std::string& of) {
  for (const json& output : interface["outputs"]) EXPECT_LT(output["location"], 8) << of;
  size_t blocks = 0;
  for (const json& block : interface["uniforms"]) {
    if (block.contains("list")) continue;
    ++blocks;
    EXPECT_LE(block["size"], 16384) << of;
  }
  EXPECT_LE(blocks, 12u) << of;
  EXPECT_EQ(interface["textures"].size() > 16, said.find("textures; sure to be there") != std::string::npos)
      << of << "\n"
      << said;
}

void generateAll(const Options& options, const std::string& of) {
  Messages messages;
  const Scene scene = Scene::fromMemory(kMaterials, "limits.gltf", options, messages);
  ASSERT_TRUE(scene) << of;
  for (size_t i = 0; i < scene.materialCount(); ++i) {
    Messages found;
    Graph graph = scene.graph(i, {true, true, true, {true, true, true, true}}, options, found);
    const Shader shader = graph.generate(options, found);
    std::string said;
    for (const Message& message : found) said += message.text + "\n";
    ASSERT_TRUE(shader) << of << " " << i << "\n" << said;
    expectWithin(json::parse(shader.interfaceJson()), said, of + " " + std::to_string(i));
  }
}

TEST(Limits, EveryTemplateStaysWithinThem) {
  const lang::Library library = lang::Library::embedded();
  Options options;
  options.validate = false;
  for (const std::string_view name : library.names(lang::DeclKind::Template)) {
    if (name == "mesh") continue;  // what others extend: nothing to see
    options.template_name = name;
    for (const Parameters parameters : {Parameters::Uniform, Parameters::Baked, Parameters::Spec}) {
      options.parameters = parameters;
      options.targets = parameters == Parameters::Spec ? std::vector<Target>{Target::Glsl, Target::Wgsl}
                                                       : std::vector<Target>{Target::Essl, Target::Hlsl};
      for (const std::string& profile : profiles(options)) {
        options.profile = profile;
        generateAll(options, std::string(name) + " " + profile);
      }
      options.profile.clear();
    }
    for (const std::string_view one : library.names(lang::DeclKind::Switch)) {
      for (const bool on : {false, true}) {
        options.switches = {{std::string(one), on}};
        generateAll(options, std::string(name) + " " + std::string(one));
      }
    }
    options.switches.clear();
  }
}

TEST(Limits, EachTargetOfAShaderHasItsOwn) {
  for (const targets::Row& row : targets::rows()) {
    EXPECT_EQ(row.limits != nullptr, row.id != Target::Cpp && row.id != Target::Js) << row.name;
    if (row.limits == nullptr) continue;
    for (const targets::Bound& bound : {row.limits->outputs, row.limits->blocks, row.limits->block_bytes,
                                        row.limits->textures, row.limits->varyings}) {
      EXPECT_GT(bound.sure, 0u) << row.name;
      EXPECT_LE(bound.sure, bound.most) << row.name;
    }
    EXPECT_EQ(row.limits->outputs.most, 8u) << row.name;
  }
}

}  // namespace
}  // namespace lacquer::test
