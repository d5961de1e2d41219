// Every option with every example: all of it compiles and validates.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "check/check.h"
#include "output.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

struct Setting {
  const char* name;
  void (*set)(Options&);
};

void keepAll(Options& o) { o.live = liveTerms(); }

const Setting kSettings[] = {
    {"usual", [](Options&) {}},
    {"baked", [](Options& o) { o.parameters = Parameters::Baked; }},
    {"sceneLights", [](Options& o) { o.lights.mode = Lights::Mode::Scene; }},
    {"noLights",
     [](Options& o) {
       o.lights = {Lights::Mode::Fixed, {}};
     }},
    {"oneDirectional",
     [](Options& o) {
       o.lights = {Lights::Mode::Fixed, {{"directional", 1}}};
     }},
    {"onePoint",
     [](Options& o) {
       o.lights = {Lights::Mode::Fixed, {{"point", 1}}};
     }},
    {"oneSpot",
     [](Options& o) {
       o.lights = {Lights::Mode::Fixed, {{"spot", 1}}};
     }},
    {"sixteenLights",
     [](Options& o) {
       o.lights = {Lights::Mode::Fixed, {{"directional", 4}, {"point", 8}, {"spot", 4}}};
     }},
    {"noIbl", [](Options& o) { o.ibl = false; }},
    {"noMultipleScattering", [](Options& o) { o.multiple_scattering = false; }},
    {"decodeSrgb", [](Options& o) { o.decode_srgb = true; }},
    {"live", keepAll},
    {"specializationConstants",
     [](Options& o) {
       o.parameters = Parameters::Spec;
       o.targets = {Target::Glsl, Target::Spirv, Target::Wgsl};
     }},
    {"bindless",
     [](Options& o) {
       o.binding = BindingModel::Bindless;
       o.targets = {Target::Glsl, Target::Spirv, Target::Hlsl};
     }},
    {"bindlessThroughGlslang",
     [](Options& o) {
       o.binding = BindingModel::Bindless;
       o.spirv_route = SpirvRoute::Glslang;
       o.targets = {Target::Glsl, Target::Spirv};
     }},
    {"bindlessBakedBsdf",
     [](Options& o) {
       o.binding = BindingModel::Bindless;
       o.parameters = Parameters::Baked;
       o.template_name = "bsdf";
       o.targets = {Target::Glsl, Target::Spirv, Target::Hlsl};
     }},
    {"arrays", [](Options& o) { o.binding = BindingModel::Arrays; }},
    {"arraysBakedStaticSamplers",
     [](Options& o) {
       o.binding = BindingModel::Arrays;
       o.parameters = Parameters::Baked;
       o.static_samplers = true;
     }},
    {"staticSamplers", [](Options& o) { o.static_samplers = true; }},
    {"spirvThroughGlslang", [](Options& o) { o.spirv_route = SpirvRoute::Glslang; }},
    {"unused", [](Options& o) { o.unused = true; }},
    {"permissive", [](Options& o) { o.permissive = true; }},
    {"bakedNoIblFixedLightsSrgbLive",
     [](Options& o) {
       o.parameters = Parameters::Baked;
       o.ibl = false;
       o.lights = {Lights::Mode::Fixed, {{"directional", 1}, {"point", 1}, {"spot", 1}}};
       o.decode_srgb = true;
       keepAll(o);
     }},
    {"nothingIsLit",
     [](Options& o) {
       o.ibl = false;
       o.lights = {Lights::Mode::Fixed, {}};
     }},
    {"surface", [](Options& o) { o.template_name = "surface"; }},
    {"surfaceBakedSrgb",
     [](Options& o) {
       o.template_name = "surface";
       o.parameters = Parameters::Baked;
       o.decode_srgb = true;
     }},
    {"surfaceLive",
     [](Options& o) {
       o.template_name = "surface";
       keepAll(o);
     }},
    {"bsdf", [](Options& o) { o.template_name = "bsdf"; }},
    {"bsdfBakedSrgb",
     [](Options& o) {
       o.template_name = "bsdf";
       o.parameters = Parameters::Baked;
       o.decode_srgb = true;
     }},
    {"bsdfLive",
     [](Options& o) {
       o.template_name = "bsdf";
       keepAll(o);
     }},
};

class EveryOption : public testing::TestWithParam<Setting> {};

TEST_P(EveryOption, validatesInAllExamples) {
  const WorkingFolder here(sourceFolder());
  const Folder folder;
  Options options;
  GetParam().set(options);
  if (std::find(options.targets.begin(), options.targets.end(), Target::Wgsl) == options.targets.end())
    options.targets.push_back(Target::Wgsl);
  const Json manifest = generateWell(exampleFiles(), folder.path(), options);
  EXPECT_FALSE(manifest["shaders"].empty());
  const std::string template_name = options.template_name.empty() ? "forward" : options.template_name;
  const bool mesh = template_name != "bsdf";
  for (const auto& [id, shader] : manifest["shaders"].items()) {
    EXPECT_TRUE(id.starts_with(template_name + "-")) << id;
    EXPECT_EQ(shader["template"], template_name);
    EXPECT_EQ(shader["files"].size(), options.targets.size()) << id;
    // Arrays of textures are an extension of wgpu's that Tint does not know.
    const bool arrays = std::ranges::any_of(shader["textures"], [](const Json& texture) {
      return texture.contains("array") && !texture.contains("layered");
    });
    EXPECT_TRUE(!arrays || options.binding == BindingModel::Bindless) << id;
    const bool wgsl_validated = check::haveTint() && !arrays;
    for (const auto& [target, files] : shader["files"].items()) {
      EXPECT_EQ(shader["validated"][target], target != "wgsl" || wgsl_validated) << id << " " << target;
      EXPECT_EQ(files.size(), mesh ? 2u : 1u) << id << " " << target;
    }
    // A record has the numbers of the textures besides.
    if (options.parameters != Parameters::Uniform && options.binding == BindingModel::Sets) {
      for (const Json& block : shader["uniforms"]) EXPECT_NE(block["role"], "material") << id;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Options, EveryOption, testing::ValuesIn(kSettings),
                         [](const auto& info) { return info.param.name; });

/// Live terms are in the shader of a material that does not need them today.
TEST(LiveTerms, coatThatIsOffIsInTheShader) {
  const WorkingFolder here(sourceFolder());
  const Folder folder;
  Options options;
  options.validate = false;
  options.live = {"coat"};
  const Json manifest = generateWell({"examples/clearcoat.gltf"}, folder.path(), options);
  size_t found = 0;
  for (const Json& material : manifest["files"][0]["materials"]) {
    if (material["name"] != "No coat") continue;
    ++found;
    EXPECT_TRUE(material["uses"][0]["shader"].get<std::string>().starts_with("forward-coat-"));
    EXPECT_FALSE(material["skipped"].contains("coat"));
  }
  EXPECT_EQ(found, 1u);
}

TEST(LightOptions, sceneLightsAreThoseOfTheFile) {
  const Folder folder;
  const std::string file = folder / "lights.gltf";
  writeText(file, R"({"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual"],
"extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional"}, {"type": "spot", "spot": {}}]}},
"nodes": [{"extensions": {"KHR_lights_punctual": {"light": 0}}}, {"extensions": {"KHR_lights_punctual": {"light": 1}}}],
"materials": [{"name": "m"}]})");
  Options scene;
  scene.lights.mode = Lights::Mode::Scene;
  Options fixed;
  fixed.lights = {Lights::Mode::Fixed, {{"directional", 1}, {"spot", 1}}};
  const Json one = generateWell({file}, folder.path() / "scene", scene);
  const Json other = generateWell({file}, folder.path() / "fixed", fixed);
  EXPECT_EQ(one["shaders"], other["shaders"]);
  const Json any = generateWell({file}, folder.path() / "any", {});
  EXPECT_NE(one["shaders"].begin().key(), any["shaders"].begin().key());
}

}  // namespace
}  // namespace lacquer::test
