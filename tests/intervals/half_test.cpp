// Types of 16 bits: valid in every language that has them, in none of the others, and said in the manifest;
// each form of a module within the bound, and what the chooser says is done.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <spirv/unified1/spirv.hpp>

#include "analysis/relax.h"
#include "lacquer/generate.h"
#include "lower/lower.h"
#include "passes/passes.h"
#include "passes/pipeline.h"
#include "support/cases.h"
#include "support/materials.h"

namespace lacquer::test::half_test {
namespace {

bool has(std::string_view text, std::string_view what) { return text.find(what) != std::string_view::npos; }

/// Whether a module's words have the capability, and a number of 16 bits.
std::pair<bool, bool> halvesOf(const std::vector<uint32_t>& words) {
  bool capable = false, typed = false;
  for (size_t at = 5; at < words.size(); at += words[at] >> spv::WordCountShift) {
    const auto op = static_cast<spv::Op>(words[at] & spv::OpCodeMask);
    capable |= op == spv::OpCapability && words[at + 1] == spv::CapabilityFloat16;
    typed |= op == spv::OpTypeFloat && words[at + 2] == 16;
  }
  return {capable, typed};
}

TEST(Halves, AreValidInEachLanguageAndSaid) {
  Options options;
  options.targets = {Target::Glsl, Target::GlslGl, Target::Essl, Target::Hlsl,
                     Target::Wgsl, Target::Spirv,  Target::Msl};
  options.lights = {Lights::Mode::Fixed, {{"directional", 1}}};
  options.parameters = Parameters::Baked;
  options.relaxed = 0.5;
  options.half = true;
  options.programs_model = true;  // the same on every machine
  size_t halved = 0, plain = 0;
  std::vector<std::filesystem::path> files = findFiles(sourceFolder() / "examples", ".gltf");
  for (const auto& file : findFiles(sourceFolder() / "bench/works", ".gltf")) files.push_back(file);
  for (const auto& file : files) {
    Messages messages;
    const Scene scene = Scene::load(file.string(), options, messages);
    ASSERT_TRUE(scene) << file;
    for (size_t i = 0; i < scene.materialCount(); ++i) {
      Messages said;
      Graph graph = scene.graph(i, kUnusedAttributes, options, said);
      if (!graph) continue;
      const Shader shader = graph.generate(options, said);  // checked by glslang and SPIRV-Tools
      for (const Message& message : said) EXPECT_NE(message.level, Message::Level::Error) << message.text;
      ASSERT_TRUE(shader) << file;
      const bool used = shader.reflection().half && shader.reflection().half->used;
      ++(used ? halved : plain);
      EXPECT_EQ(halvesOf(shader.fragmentSpirv()), std::pair(used, used)) << file;
      EXPECT_EQ(halvesOf(shader.vertexSpirv()), std::pair(false, false)) << file;
      EXPECT_EQ(has(shader.fragmentText(Target::Glsl), "explicit_arithmetic_types_float16"), used) << file;
      EXPECT_EQ(has(shader.fragmentText(Target::Hlsl), "min16float"), used) << file;
      EXPECT_EQ(has(shader.fragmentText(Target::Wgsl), "enable f16;"), used) << file;
      EXPECT_EQ(has(shader.fragmentText(Target::Msl), "half"), used) << file;
      EXPECT_FALSE(has(shader.fragmentText(Target::GlslGl), "f16")) << file;
      EXPECT_FALSE(has(shader.fragmentText(Target::Essl), "f16")) << file;
      EXPECT_EQ(has(shader.interfaceJson(), "\"half\""), shader.reflection().half.has_value()) << file;
    }
  }
  EXPECT_GT(halved, 5U);
  EXPECT_GT(plain, 5U);
}

/// W1 with numbers for parameters and one light, relaxed.
ir::Module relaxedWork(const passes::PipelineOptions& more) {
  const lang::Library library = lang::Library::embedded();
  const Result<material::Document> document =
      readMaterials((sourceFolder() / "bench/works/w1.gltf").string());
  EXPECT_TRUE(document);
  gltf::VertexAttributes attributes;
  attributes.normal = attributes.tangent = true;
  attributes.texCoord = {true, true, false, false};
  Diagnostics warnings;
  const graph::Graph graph = buildGraph(document->materials[0], attributes, {}, warnings);
  lower::LowerOptions options;
  options.parameters = lower::ParameterMode::Baked;
  Result<ir::Module> module = lower::lower(graph, library, options);
  EXPECT_TRUE(module);
  passes::PipelineOptions pipeline = more;
  pipeline.lights = {false, {{"directional", 1}}};
  pipeline.relaxed = 0.05;
  passes::runPipeline(*module, pipeline);
  return std::move(*module);
}

TEST(Halves, FormsKeepToTheBound) {
  const ir::Module module = relaxedWork({});
  ASSERT_TRUE(module.dag.anyRelaxed());
  std::vector<double> gains;
  const std::vector<ir::Module> forms = passes::halves(module, 0.05, gains);
  ASSERT_GT(forms.size(), 2U);
  ASSERT_EQ(gains.size(), forms.size());
  EXPECT_FALSE(forms[0].half);
  for (size_t i = 1; i < forms.size(); ++i) {
    std::vector<ir::ValueId> values;
    for (ir::ValueId id = 0; id < forms[i].dag.size(); ++id) {
      if (!forms[i].dag.relaxed(id)) continue;
      values.push_back(id);
      EXPECT_TRUE(module.dag.relaxed(id));
    }
    EXPECT_LE(analysis::relaxedBound(forms[i], values), 0.05);
    EXPECT_EQ(analysis::relaxedBound(forms[i], values), forms[i].relaxed_bound);
  }
}

TEST(Halves, AreLeftOutWhereTheyAreNotCheaper) {
  passes::PipelineOptions options;
  options.half = true;
  for (const double cycles : {99.0, 100.0, 101.0}) {
    options.choose = [&](std::span<const ir::Module> forms) -> std::optional<passes::Choice> {
      return passes::Choice{forms.size() - 1, "a driver", 100, cycles};
    };
    const ir::Module module = relaxedWork(options);
    ASSERT_TRUE(module.half);
    EXPECT_EQ(module.half->used, cycles < 100);
    EXPECT_EQ(module.half->cycles, std::min(cycles, 100.0));
    EXPECT_EQ(module.half->by, "a driver");
    EXPECT_TRUE(module.dag.anyRelaxed());
  }
}

TEST(Halves, NothingRelaxedIsRefused) {
  Options options;
  options.half = true;
  Messages messages;
  const Scene scene = Scene::load((sourceFolder() / "bench/works/w0.gltf").string(), {}, messages);
  ASSERT_TRUE(scene);
  EXPECT_FALSE(scene.graph(0, kUnusedAttributes, options, messages));
  ASSERT_FALSE(messages.empty());
  EXPECT_EQ(messages.back().code, "no-half");
}

}  // namespace
}  // namespace lacquer::test::half_test
