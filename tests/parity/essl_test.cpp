// The ESSL on WebGL 2: Chromium runs it (SwiftShader), and its numbers are held to the bounds of all engines.
#include <gtest/gtest.h>

#include "parity/browser.h"
#include "parity/clustered.h"
#include "schedule/schedule.h"
#include "targets/clike.h"
#include "targets/legalize.h"
#include "targets/target.h"

namespace lacquer::parity::essl_test {
namespace {

using nlohmann::json;

constexpr const char* kProgram = "checks/webgl/lacquer-essl-colors";

std::string textOf(ir::Module module) {
  targets::legalize(module);
  return targets::printText(module, schedule::schedule(module, ir::Stage::Fragment), Target::Essl, {});
}

/// What a Vulkan device would be given, by names, in the words of checks/webgl/lacquer-essl-colors.
json workOf(const Subject& subject) {
  const ir::Module& module = subject.module;
  const Result<vulkan::Work> work =
      gpuWork(module, subject.bindings, subject.textures, subject.points, FragmentRoute::Direct);
  EXPECT_TRUE(work) << subject.name;
  if (!work) return {};
  const schedule::Program program = schedule::schedule(module, ir::Stage::Fragment);
  json made = workWords(*work, module);
  made["essl"] = textOf(module);
  for (size_t i = 0; i < work->inputs.size(); ++i) {
    made["inputs"].push_back({{"name", targets::varyingName(module.varyings[program.varyings[i]])},
                              {"components", work->inputs[i].components},
                              {"values", work->inputs[i].values}});
  }
  for (size_t i = 0; i < work->blocks.size(); ++i) {
    const ir::Block& block = module.blocks[program.blocks[i]];
    made[block.list ? "lists" : "blocks"].push_back(
        {{"name", block.list ? block.instance + "s" : targets::blockName(block)},
         {"perPoint", work->blocks[i].per_point},
         {"bytes", base64(work->blocks[i].bytes)}});
  }
  for (size_t i = 0; i < work->textures.size(); ++i) {
    json texture = textureWords(work->textures[i]);
    texture["name"] = module.textures[program.textures[i]].name;
    made["textures"].push_back(std::move(texture));
  }
  return made;
}

void expectAgreement(const std::vector<Subject>& subjects, size_t least) {
  expectColors(kProgram, subjects, workOf, least);
}

TEST(ParityEssl, Operations) { expectAgreement(operationSubjects(64), 10000); }

TEST(ParityEssl, Forward) { expectAgreement(materials({}, 128, 2), 4000); }

TEST(ParityEssl, ForwardWithAnyLights) {
  MaterialSetting setting;
  setting.lights = {};
  expectAgreement(materials(setting, 64, 4), 1000);
}

TEST(ParityEssl, ForwardClustered) {
  MaterialSetting setting;
  setting.lights = {};
  setting.template_name = "forward_clustered";
  expectAgreement(materials(setting, 64, 4), 1000);
}

TEST(ParityEssl, Bsdf) {
  MaterialSetting setting;
  setting.template_name = "bsdf";
  expectAgreement(materials(setting, 64, 4), 2000);
}

/// The lists of a thousand lights are read as they are on the processor.
TEST(ParityEssl, AThousandLightsInClusters) {
  const ClusteredScene scene = thousandLightsInClusters(0);
  json works = json::array({workOf(scene.clustered)});
  const std::optional<json> colors = colorsOf(kProgram, works);
  if (!colors) GTEST_SKIP() << "NOT TESTED: there is no Chromium with WebGL 2, or no node, on this machine";
  const auto outputs = outputsOf(scene.clustered, (*colors)[0], "the clustered shader");
  ASSERT_FALSE(outputs.empty());
  EXPECT_LE(apart(outputs[0], scene.expected(), 2e-3), outputs[0].size() / 500);
}

TEST(ParityEssl, DimmedLightsInClusters) { expectDimmedLights(kProgram, workOf); }

/// What is compared must be able to differ: a hundredth less light is seen.
TEST(ParityEssl, AnotherShaderIsOutside) {
  Subject subject = materials({}, 64, 1000)[0];
  const std::optional<json> colors = colorsOf(kProgram, json::array({workOf(subject)}));
  if (!colors) GTEST_SKIP() << "NOT TESTED: there is no Chromium with WebGL 2, or no node, on this machine";
  std::vector<std::vector<float>> outputs = outputsOf(subject, (*colors)[0], "the shader");
  for (float& x : outputs[0]) x *= 0.99F;
  Comparison comparison;
  compare(subject, boundsOf(subject), outputs, "the ESSL", comparison);
  EXPECT_GT(comparison.outside, comparison.numbers / 4);
}

}  // namespace
}  // namespace lacquer::parity::essl_test
