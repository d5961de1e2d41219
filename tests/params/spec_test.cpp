// Parameters as specialization constants: one module, and what a pipeline makes of it is what baked
// parameters are.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <spirv-tools/optimizer.hpp>
#include <unordered_map>

#include "../build/processes.h"
#include "../spirv/reference.h"
#include "check/check.h"
#include "graph/graph.h"
#include "lacquer.h"
#include "lower/lower.h"
#include "passes/pipeline.h"
#include "targets/legalize.h"
#include "targets/target.h"

namespace lacquer::test::spec_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Words = std::vector<uint32_t>;

const lang::Library& library() {
  static const lang::Library kLibrary = lang::Library::embedded();
  return kLibrary;
}

ir::Module moduleOf(const graph::Graph& graph, lower::ParameterMode mode) {
  Result<ir::Module> module = lower::lower(graph, library(), {mode});
  EXPECT_TRUE(module);
  if (!module) return {};
  passes::runPipeline(*module, {});
  EXPECT_TRUE(ir::verify(*module).empty());
  return std::move(*module);
}

Words wordsOf(const ir::Module& module, ir::Stage stage) {
  return targets::writeSpirv(module, schedule::schedule(module, stage), {});
}

/// The same by way of the GLSL.
Words wordsOfGlsl(ir::Module module, ir::Stage stage) {
  targets::legalize(module);
  const std::string text =
      targets::printText(module, schedule::schedule(module, stage), Target::Glsl, "spec");
  const auto of = stage == ir::Stage::Vertex ? check::Stage::Vertex : check::Stage::Fragment;
  const Result<check::Spirv> words = check::compile(text, Target::Glsl, of, "spec");
  EXPECT_TRUE(words) << format(words.error().front()) << text;
  return words.value_or(check::Spirv{});
}

/// What a driver does when it makes a pipeline: the constants get values and are constants from then on.
Words specialized(const Words& words, const ir::Module& module, const graph::Graph& values) {
  std::unordered_map<uint32_t, std::string> by_id;
  for (const uint32_t index : ir::usedParameters(module)) {
    const ir::Parameter& p = module.parameters[index];
    for (const ir::Parameter& value : values.parameters) {
      if (value.name != p.name) continue;
      for (int c = 0; c < ir::componentCount(p.type); ++c) {
        const float x = static_cast<float>(value.value[static_cast<size_t>(c)]);
        by_id[static_cast<uint32_t>(p.constant_id + c)] = fmt::format("{:.9g}", x);
      }
    }
  }
  spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_1);
  optimizer.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(by_id));
  optimizer.RegisterPass(spvtools::CreateFreezeSpecConstantValuePass());
  Words result;
  EXPECT_TRUE(optimizer.Run(words.data(), words.size(), &result));
  return result;
}

/// Vertex stage, then fragment stage on what it gave (with no interpolation).
void randomize(graph::Graph& graph, std::mt19937& random) {
  for (ir::Parameter& p : graph.parameters) {
    const double lo = std::max({p.range.lo, -2.0, p.name.ends_with("ior") ? 1.0 : -2.0});
    const double hi = std::min(p.range.hi, 3.0);
    for (int c = 0; c < ir::componentCount(p.type); ++c) {
      p.value[static_cast<size_t>(c)] = std::uniform_real_distribution<double>(lo, hi)(random);
    }
  }
}

std::vector<graph::Graph> graphsOf(const std::string& file) {
  Messages messages;
  const Scene scene = Scene::load(std::string(LACQUER_EXAMPLES) + "/" + file, {}, messages);
  EXPECT_TRUE(scene) << file;
  std::vector<graph::Graph> graphs;
  for (size_t m = 0; m < scene.materialCount(); ++m) {
    const Graph made = scene.graph(m, {true, true, false, {true, true, false, false}}, {}, messages);
    if (!made) continue;
    Result<graph::Graph> graph = graph::fromJson(made.toJson(), "spec");
    EXPECT_TRUE(graph);
    if (!graph || hasError(graph::check(*graph, library()))) continue;
    graphs.push_back(std::move(*graph));
  }
  return graphs;
}

TEST(Spec, ModulesAreValid) {
  for (const char* file : {"car_paint.gltf", "clearcoat.gltf", "coat.gltf", "core.gltf"}) {
    for (graph::Graph& graph : graphsOf(file)) {
      SCOPED_TRACE(fmt::format("{} {}", file, graph.name));
      const ir::Module spec = moduleOf(graph, lower::ParameterMode::Spec);
      for (const ir::Stage stage : {ir::Stage::Vertex, ir::Stage::Fragment}) {
        EXPECT_TRUE(check::validate(wordsOf(spec, stage), false, file).empty());
        EXPECT_TRUE(check::validate(wordsOfGlsl(spec, stage), false, file).empty());
      }
      const Words late = specialized(wordsOf(spec, ir::Stage::Fragment), spec, graph);
      EXPECT_TRUE(check::validate(late, false, file).empty());
    }
  }
}

TEST(Spec, NumbersNeedNoNewModule) {
  std::mt19937 random(5);
  for (graph::Graph& graph : graphsOf("coat.gltf")) {
    const ir::Module before = moduleOf(graph, lower::ParameterMode::Spec);
    const Words words = wordsOf(before, ir::Stage::Fragment);
    randomize(graph, random);
    const ir::Module after = moduleOf(graph, lower::ParameterMode::Spec);
    EXPECT_EQ(passes::contentDigest(before), passes::contentDigest(after));
    EXPECT_EQ(words, wordsOf(after, ir::Stage::Fragment));
    EXPECT_EQ(after.preshader.size(), 0u);
    for (const ir::Block& block : after.blocks) EXPECT_NE(block.role, ir::BlockRole::Material);
  }
}

TEST(Spec, ManifestListsTheConstants) {
  const fs::path folder = freshFolder("manifest");
  std::string said;
  const std::string file = std::string(LACQUER_EXAMPLES) + "/coat.gltf";
  ASSERT_EQ(runProgram({LACQUER_PROGRAM, "gen", file, "-q", "-o", "out", "--params", "spec"}, folder, &said),
            0)
      << said;
  std::ifstream in(folder / "out/manifest.json");
  const Json manifest = Json::parse(in);
  ASSERT_FALSE(manifest["shaders"].empty());
  for (const auto& [id, shader] : manifest["shaders"].items()) {
    EXPECT_EQ(shader["validated"], (Json{{"glsl", true}, {"spirv", true}})) << id;
    const Json& constants = shader["spec_constants"];
    ASSERT_FALSE(constants.empty());
    std::string last;
    for (size_t i = 0; i < constants.size(); ++i) {
      EXPECT_EQ(constants[i]["id"], i);
      EXPECT_GE(constants[i]["name"].get<std::string>(), last);
      last = constants[i]["name"].get<std::string>();
      if (last == "coat_ior") {
        EXPECT_EQ(constants[i]["default"], 1.5);
      }
    }
    for (const Json& block : shader["uniforms"]) EXPECT_NE(block["role"], "material");
  }
  fs::remove_all(folder.parent_path());
}

TEST(Spec, OtherTargetsHaveNone) {
  const fs::path folder = freshFolder("targets");
  const std::string file = std::string(LACQUER_EXAMPLES) + "/coat.gltf";
  for (const char* target : {"hlsl", "essl", "glsl-gl", "cpp", "js"}) {
    std::string said;
    EXPECT_EQ(runProgram({LACQUER_PROGRAM, "gen", file, "-o", "out", "--params", "spec", "--target", target},
                         folder, &said),
              2);
    EXPECT_EQ(
        said,
        fmt::format(
            "--target: {} has no specialization constants; --params spec is for glsl, spirv, wgsl, msl\n",
            target));
    EXPECT_FALSE(fs::exists(folder / "out"));
  }
  Messages messages;
  Options options;
  options.parameters = Parameters::Spec;
  options.targets = {Target::Spirv, Target::Hlsl};
  const Report report = generate({file}, {}, (folder / "out").string(), options, messages);
  EXPECT_FALSE(report.ok);
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0].code, "no-specialization-constants");
  EXPECT_EQ(messages[0].message, "the target hlsl has no specialization constants");
  fs::remove_all(folder.parent_path());
}

}  // namespace
}  // namespace lacquer::test::spec_test
