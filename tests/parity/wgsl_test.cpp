// The WGSL on WebGPU: Chromium runs it (SwiftShader), and its numbers are held to the bounds of all engines.
#include <gtest/gtest.h>

#include <bit>
#include <optional>

#include "parity/browser.h"
#include "parity/clustered.h"
#include "schedule/schedule.h"
#include "targets/legalize.h"
#include "targets/target.h"

namespace lacquer::parity::wgsl_test {
namespace {

using nlohmann::json;

constexpr const char* kProgram = "checks/wgsl/lacquer-wgsl-colors";

std::string textOf(ir::Module module) {
  targets::legalize(module);
  return targets::printText(module, schedule::schedule(module, ir::Stage::Fragment), Target::Wgsl, {});
}

/// What a Vulkan device would be given, in the words of checks/wgsl/lacquer-wgsl-colors.
json workOf(const Subject& subject) {
  const Result<vulkan::Work> work =
      gpuWork(subject.module, subject.bindings, subject.textures, subject.points, FragmentRoute::Direct);
  EXPECT_TRUE(work) << subject.name;
  if (!work) return {};
  const schedule::Program program = schedule::schedule(subject.module, ir::Stage::Fragment);
  json made = workWords(*work, subject.module);
  made["wgsl"] = textOf(subject.module);
  for (size_t i = 0; i < work->inputs.size(); ++i) {
    made["inputs"].push_back({{"location", subject.module.varyings[program.varyings[i]].location},
                              {"components", work->inputs[i].components},
                              {"values", work->inputs[i].values}});
  }
  for (const vulkan::UniformBlock& block : work->blocks) {
    const targets::WgslBinding at = targets::wgslBinding({block.place.first, block.place.second, 0});
    made["blocks"].push_back({{"group", at.group},
                              {"binding", at.binding},
                              {"perPoint", block.per_point},
                              {"storage", isList(subject.module, block)},
                              {"bytes", base64(block.bytes)}});
  }
  for (const vulkan::Texture& texture : work->textures) {
    const targets::WgslBinding at = targets::wgslBinding({texture.image.first, texture.image.second, 0});
    json made_texture = textureWords(texture);
    made_texture["group"] = at.group;
    made_texture["binding"] = at.binding;
    made_texture["sampler"] = at.sampler;
    made["textures"].push_back(std::move(made_texture));
  }
  for (const auto& [id, bits] : work->constants)
    made["constants"][std::to_string(id)] = std::bit_cast<float>(bits);
  return made;
}

void expectAgreement(const std::vector<Subject>& subjects, size_t least) {
  expectColors(kProgram, subjects, workOf, least);
}

TEST(ParityWgsl, Operations) { expectAgreement(operationSubjects(64), 10000); }

TEST(ParityWgsl, Forward) { expectAgreement(materials({}, 128, 2), 4000); }

TEST(ParityWgsl, ForwardWithAnyLights) {
  MaterialSetting setting;
  setting.lights = {};
  expectAgreement(materials(setting, 64, 4), 1000);
}

TEST(ParityWgsl, ForwardClustered) {
  MaterialSetting setting;
  setting.lights = {};
  setting.template_name = "forward_clustered";
  expectAgreement(materials(setting, 64, 4), 1000);
}

TEST(ParityWgsl, SpecializationConstants) {
  MaterialSetting setting;
  setting.parameters = lower::ParameterMode::Spec;
  expectAgreement(materials(setting, 64, 4), 1000);
}

TEST(ParityWgsl, Surface) {
  MaterialSetting setting;
  setting.template_name = "surface";
  std::vector<Subject> subjects;
  for (Subject& subject : materials(setting, 64, 4)) {
    for (Subject& pass : inPasses(std::move(subject))) subjects.push_back(std::move(pass));
  }
  expectAgreement(subjects, 4000);
}

TEST(ParityWgsl, Bsdf) {
  MaterialSetting setting;
  setting.template_name = "bsdf";
  expectAgreement(materials(setting, 64, 4), 2000);
}

TEST(ParityWgsl, VertexStages) {
  std::vector<Subject> subjects;
  for (const NamedGraph& graph : exampleGraphs({})) subjects.push_back(vertexSubject(graph, {}, 64, 5));
  expectAgreement(subjects, 4000);
}

TEST(ParityWgsl, DimmedLightsInClusters) { expectDimmedLights(kProgram, workOf); }

/// What is compared must be able to differ: a hundredth less light is seen.
TEST(ParityWgsl, AnotherShaderIsOutside) {
  Subject subject = materials({}, 64, 1000)[0];
  const std::optional<json> colors = [&] {
    json works = json::array({workOf(subject)});
    return colorsOf(kProgram, works);
  }();
  if (!colors) GTEST_SKIP() << "NOT TESTED: there is no Chromium with WebGPU, or no node, on this machine";
  std::vector<std::vector<float>> outputs = outputsOf(subject, (*colors)[0], textOf(subject.module));
  for (float& x : outputs[0]) x *= 0.99F;
  Comparison comparison;
  compare(subject, boundsOf(subject), outputs, "the WGSL", comparison);
  EXPECT_GT(comparison.outside, comparison.numbers / 4);
}

}  // namespace
}  // namespace lacquer::parity::wgsl_test
