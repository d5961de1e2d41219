// The WGSL on WebGPU: Chromium runs it (SwiftShader), and its numbers are held to the bounds of all engines.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "parity/subject.h"
#include "schedule/schedule.h"
#include "support/cases.h"
#include "targets/legalize.h"
#include "targets/target.h"

namespace lacquer::parity {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

std::string base64(const std::vector<unsigned char>& bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < bytes.size() ? bytes[i + k] : 0U);
    for (size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

std::string textOf(ir::Module module) {
  targets::legalize(module);
  return targets::printText(module, schedule::schedule(module, ir::Stage::Fragment), Target::Wgsl, {});
}

json textureOf(const vulkan::Texture& texture) {
  constexpr const char* kWraps[] = {"repeat", "clamp", "mirror"};
  const targets::WgslBinding at = targets::wgslBinding({texture.image.first, texture.image.second, 0});
  json texels = json::array();
  for (const vulkan::Texel& texel : *texture.texels) {
    for (const float x : texel) texels.push_back(x);
  }
  return {{"group", at.group},
          {"binding", at.binding},
          {"sampler", at.sampler},
          {"shape", texture.shape == vulkan::Shape::Cube ? "cube" : "2d"},
          {"compares", texture.compares},
          {"width", texture.width},
          {"height", texture.height},
          {"texels", std::move(texels)},
          {"wrap", {kWraps[static_cast<size_t>(texture.s)], kWraps[static_cast<size_t>(texture.t)]}},
          {"nearest", texture.nearest}};
}

/// What a Vulkan device would be given, in the words of checks/wgsl/lacquer-wgsl-colors.
json workOf(const Subject& subject) {
  const Result<vulkan::Work> work =
      gpuWork(subject.module, subject.bindings, subject.textures, subject.points, FragmentRoute::Direct);
  EXPECT_TRUE(work) << subject.name;
  if (!work) return {};
  const schedule::Program program = schedule::schedule(subject.module, ir::Stage::Fragment);
  json made = {{"wgsl", textOf(subject.module)}, {"points", work->points}, {"backFacing", work->back_facing}};
  for (const char* list : {"outputs", "inputs", "blocks", "textures"}) made[list] = json::array();
  made["constants"] = json::object();
  for (const ir::Output& output : subject.module.outputs) {
    if (output.kind == ir::OutputKind::Color) made["outputs"].push_back(output.location);
  }
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
                              {"bytes", base64(block.bytes)}});
  }
  for (const vulkan::Texture& texture : work->textures) made["textures"].push_back(textureOf(texture));
  for (const auto& [id, bits] : work->constants)
    made["constants"][std::to_string(id)] = std::bit_cast<float>(bits);
  return made;
}

double numberOf(const json& spelled) {
  if (spelled.is_number()) return spelled.get<double>();
  return std::strtod(spelled.get<std::string>().c_str(), nullptr);  // NaN, Infinity, -Infinity
}

/// Runs all of them in one browser; nothing where there is none.
std::optional<json> colorsOf(const json& works) {
  const fs::path folder = fs::path(testing::TempDir()) / fmt::format("lacquer-wgsl-{}", getpid());
  fs::create_directories(folder);
  std::ofstream(folder / "works.json") << works;
  const fs::path program = test::sourceFolder() / "checks/wgsl/lacquer-wgsl-colors";
  const std::string command =
      fmt::format("'{}' '{}' '{}'", program.string(), (folder / "works.json").string(),
                  (folder / "colors.json").string());
  const int status = std::system(command.c_str());
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  std::optional<json> colors;
  // 3: no browser; 126 and 127: no node.
  if (code != 3 && code != 126 && code != 127) {
    EXPECT_EQ(code, 0) << command;
    std::ifstream in(folder / "colors.json");
    colors = json::parse(in, nullptr, false);
  }
  fs::remove_all(folder);
  return colors;
}

/// The outputs; of discarded points, and of those alone, what the CPU says.
std::vector<std::vector<float>> outputsOf(const Subject& subject, const json& colors) {
  if (!colors.contains("outputs")) {
    ADD_FAILURE() << subject.name << ": " << colors << "\n" << textOf(subject.module);
    return {};
  }
  std::vector<std::vector<float>> outputs;
  for (const json& rgba : colors["outputs"]) {
    EXPECT_EQ(rgba.size(), 4 * subject.points) << subject.name << ": " << rgba;
    if (rgba.size() != 4 * subject.points) return {};
    outputs.emplace_back();
    for (const json& x : rgba) outputs.back().push_back(static_cast<float>(numberOf(x)));
  }
  const std::vector<std::vector<float>> cpu = onCpu(subject);
  for (size_t i = 0; i < subject.points; ++i) {
    for (size_t o = 0; o < outputs.size() && colors["discarded"][i].get<bool>(); ++o)
      std::copy_n(cpu[o].begin() + static_cast<ptrdiff_t>(4 * i), 4,
                  outputs[o].begin() + static_cast<ptrdiff_t>(4 * i));
  }
  return outputs;
}

void expectAgreement(const std::vector<Subject>& subjects, size_t least) {
  json works = json::array();
  for (const Subject& subject : subjects) works.push_back(workOf(subject));
  const std::optional<json> colors = colorsOf(works);
  if (!colors) GTEST_SKIP() << "NOT TESTED: there is no Chromium with WebGPU, or no node, on this machine";
  ASSERT_EQ(colors->size(), subjects.size());
  Comparison all;
  for (size_t i = 0; i < subjects.size(); ++i) {
    Comparison one;
    compare(subjects[i], boundsOf(subjects[i]), outputsOf(subjects[i], (*colors)[i]), "the WGSL", one);
    EXPECT_EQ(one.outside, 0U) << one.first << "\n" << textOf(subjects[i].module);
    all.numbers += one.numbers;
    all.vague += one.vague;
    all.endless += one.endless;
  }
  std::cout << all.numbers << " numbers, " << all.vague << " with a vague bound, " << all.endless
            << " with none\n";
  EXPECT_GT(all.numbers, least);
  EXPECT_LT(all.vague, all.numbers / 2);
}

std::vector<Subject> materials(const MaterialSetting& setting, size_t points, size_t stride) {
  const std::vector<NamedGraph> graphs = exampleGraphs(setting);
  std::vector<Subject> subjects;
  for (size_t i = 0; i < graphs.size(); i += stride)
    subjects.push_back(materialSubject(graphs[i], setting, points, i));
  return subjects;
}

TEST(ParityWgsl, Operations) { expectAgreement(operationSubjects(64), 10000); }

TEST(ParityWgsl, Forward) { expectAgreement(materials({}, 128, 2), 4000); }

TEST(ParityWgsl, ForwardWithAnyLights) {
  MaterialSetting setting;
  setting.lights = {};
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

/// What is compared must be able to differ: a hundredth less light is seen.
TEST(ParityWgsl, AnotherShaderIsOutside) {
  Subject subject = materials({}, 64, 1000)[0];
  const std::optional<json> colors = [&] {
    json works = json::array({workOf(subject)});
    return colorsOf(works);
  }();
  if (!colors) GTEST_SKIP() << "NOT TESTED: there is no Chromium with WebGPU, or no node, on this machine";
  std::vector<std::vector<float>> outputs = outputsOf(subject, (*colors)[0]);
  for (float& x : outputs[0]) x *= 0.99F;
  Comparison comparison;
  compare(subject, boundsOf(subject), outputs, "the WGSL", comparison);
  EXPECT_GT(comparison.outside, comparison.numbers / 4);
}

}  // namespace
}  // namespace lacquer::parity
