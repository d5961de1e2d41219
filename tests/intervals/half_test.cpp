// Types of 16 bits: valid in every language that has them, in none of the others, and said in the manifest;
// each form of a module within the bound, and what the chooser says is done.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <spirv/unified1/spirv.hpp>

#include "analysis/relax.h"
#include "check/check.h"
#include "lacquer/generate.h"
#include "lower/lower.h"
#include "passes/passes.h"
#include "passes/pipeline.h"
#include "schedule/schedule.h"
#include "support/cases.h"
#include "support/materials.h"
#include "targets/legalize.h"
#include "targets/target.h"

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

/// The materials of a file with numbers for parameters and one light, relaxed.
std::vector<ir::Module> relaxedModules(const std::filesystem::path& file,
                                       const passes::PipelineOptions& more) {
  static const lang::Library library = lang::Library::embedded();
  std::vector<ir::Module> modules;
  const Result<material::Document> document = readMaterials(file.string());
  EXPECT_TRUE(document) << file;
  if (!document) return modules;
  for (const material::Material& material : document->materials) {
    if (hasError(material.diagnostics)) continue;
    gltf::VertexAttributes attributes;
    attributes.normal = attributes.tangent = true;
    attributes.texCoord = {true, true, false, false};
    Diagnostics warnings;
    const graph::Graph graph = buildGraph(material, attributes, {}, warnings);
    lower::LowerOptions options;
    options.parameters = lower::ParameterMode::Baked;
    Result<ir::Module> module = lower::lower(graph, library, options);
    EXPECT_TRUE(module) << file;
    if (!module) continue;
    passes::PipelineOptions pipeline = more;
    pipeline.lights = {false, {{"directional", 1}}};
    pipeline.relaxed = 0.05;
    passes::runPipeline(*module, pipeline);
    modules.push_back(std::move(*module));
  }
  return modules;
}

std::string work(const std::string& name) {
  return (sourceFolder() / "bench/works" / (name + ".gltf")).string();
}

ir::Module relaxedWork(const passes::PipelineOptions& more) { return relaxedModules(work("w1"), more).at(0); }

/// A choice that takes a form, however many there are.
passes::Choose takes(size_t form) {
  return [form](std::span<const ir::Module> forms) -> std::optional<passes::Choice> {
    return passes::Choice{std::min(form, forms.size() - 1), "the test", 1, 0};
  };
}

void expectValid(const ir::Module& module, const std::string& name) {
  const schedule::Program program = schedule::schedule(module, ir::Stage::Fragment);
  const std::vector<uint32_t> words = targets::writeSpirv(module, program, {});
  EXPECT_EQ(halvesOf(words), std::pair(true, true)) << name;
  for (const Diagnostic& wrong : check::validate(words, false, name)) ADD_FAILURE() << wrong.message;
  const auto vertex = targets::writeSpirv(module, schedule::schedule(module, ir::Stage::Vertex), {});
  EXPECT_EQ(halvesOf(vertex), std::pair(false, false)) << name;
  ir::Module legal = module;
  targets::legalize(legal);
  const schedule::Program printed = schedule::schedule(legal, ir::Stage::Fragment);
  const std::pair<Target, std::string_view> types[] = {{Target::Glsl, "float16_t"},
                                                       {Target::Hlsl, "min16float"},
                                                       {Target::Wgsl, "enable f16;"},
                                                       {Target::GlslGl, ""},
                                                       {Target::Essl, ""}};
  for (const auto& [target, type] : types) {
    const std::string text = targets::printText(legal, printed, target, "");
    if (type.empty()) {
      EXPECT_FALSE(has(text, "f16") || has(text, "float16")) << name;
    } else {
      EXPECT_TRUE(has(text, type) || has(text, "f16vec")) << name << " " << targetName(target);
    }
    if (target == Target::Wgsl) {  // glslang has none
      if (!check::haveTint()) continue;
      for (const Diagnostic& wrong : check::compileWithTint(text, name)) ADD_FAILURE() << wrong.message;
      continue;
    }
    const Result<check::Spirv> compiled = check::compile(text, target, check::Stage::Fragment, name);
    EXPECT_TRUE(compiled) << text << (compiled ? "" : compiled.error()[0].message);
    if (compiled && target == Target::Glsl) {
      EXPECT_EQ(halvesOf(*compiled), std::pair(true, true)) << name;
    }
  }
}

TEST(Halves, AreValidInEachLanguage) {
  size_t halved = 0;
  std::vector<std::filesystem::path> files = findFiles(sourceFolder() / "examples", ".gltf");
  for (const auto& file : findFiles(sourceFolder() / "bench/works", ".gltf")) files.push_back(file);
  passes::PipelineOptions options;
  options.half = true;
  for (size_t i = 0; i < files.size(); ++i) {
    options.choose = takes(i % 2 == 0 ? 1 : 3);
    for (const ir::Module& module : relaxedModules(files[i], options)) {
      if (!module.half || !module.half->used) continue;
      ++halved;
      expectValid(module, files[i].filename().string());
    }
  }
  EXPECT_GT(halved, 20U);
}

TEST(Halves, AreSaid) {
  Options options;
  options.targets = {Target::Spirv};
  options.relaxed = 0.05;
  options.half = options.programs_model = true;  // by the model the same on every machine
  options.parameters = Parameters::Baked;
  Messages said;
  const Scene scene = Scene::load((sourceFolder() / "bench/works/w0.gltf").string(), options, said);
  ASSERT_TRUE(scene);
  Graph graph = scene.graph(0, kUnusedAttributes, options, said);
  ASSERT_TRUE(graph);
  const Shader shader = graph.generate(options, said);
  ASSERT_TRUE(shader);
  ASSERT_TRUE(shader.reflection().half);
  EXPECT_EQ(shader.reflection().half->by, "model");
  EXPECT_TRUE(has(shader.interfaceJson(), "\"half\""));
}

TEST(Halves, FormsKeepToTheBound) {
  const ir::Module module = relaxedWork({});
  ASSERT_TRUE(module.dag.anyRelaxed());
  const std::vector<ir::Module> forms = passes::halves(module, 0.05);
  ASSERT_GT(forms.size(), 2U);
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

passes::PipelineOptions searching() {
  passes::PipelineOptions options;
  options.optimize.level = 1;
  options.half = true;
  return options;
}

// The form that is the cheapest at 32 bits has not always the cheapest one of 16 bits.
TEST(Halves, AreCountedOfEachFormOfASearch) {
  const size_t plain_size = relaxedModules(work("c"), {}).at(0).dag.size();
  passes::PipelineOptions options = searching();
  options.choose = [&](std::span<const ir::Module> forms) -> std::optional<passes::Choice> {
    const auto cycles = [&](const ir::Module& form) {
      const bool plain = form.dag.size() == plain_size;
      if (form.half) return plain ? 80.0 : 88.0;
      return plain ? 100.0 : 90.0;
    };
    passes::Choice choice{0, "a driver", cycles(forms[0]), cycles(forms[0])};
    for (size_t i = 1; i < forms.size(); ++i) {
      if (cycles(forms[i]) < choice.cycles) choice.index = i, choice.cycles = cycles(forms[i]);
    }
    return choice;
  };
  const ir::Module module = relaxedModules(work("c"), options).at(0);
  ASSERT_TRUE(module.half && module.optimized);
  EXPECT_TRUE(module.half->used);
  EXPECT_EQ(module.half->cycles, 80);
  EXPECT_EQ(module.half->plain, 90);
  EXPECT_EQ(module.optimized->cycles, 90);
  EXPECT_EQ(module.optimized->plain, 100);
  EXPECT_EQ(module.optimized->growth, 1);  // what is made is the plain form's
}

TEST(Halves, WithASearchAreNeverDearerThanEitherAlone) {
  for (const char* name : {"w0", "a", "c"}) {
    const ir::Module both = relaxedModules(work(name), searching()).at(0);
    passes::PipelineOptions options = searching();
    options.half = false;
    const ir::Module searched = relaxedModules(work(name), options).at(0);
    options = searching();
    options.optimize.level = 0;
    const ir::Module halved = relaxedModules(work(name), options).at(0);
    ASSERT_TRUE(both.half && both.optimized && searched.optimized && halved.half) << name;
    EXPECT_LE(both.half->cycles, searched.optimized->cycles) << name;
    EXPECT_LE(both.half->cycles, halved.half->cycles) << name;
    EXPECT_EQ(both.half->plain, both.optimized->cycles) << name;
  }
}

TEST(Halves, WithoutEffectAreNoted) {
  Options options;
  options.targets = {Target::Spirv};
  options.half = options.programs_model = true;
  for (const double error : {1e-9, 0.05}) {
    options.relaxed = error;
    Messages messages;
    const Scene scene = Scene::load(work("w2"), options, messages);
    Graph graph = scene.graph(0, kUnusedAttributes, options, messages);
    ASSERT_TRUE(graph);
    const Shader shader = graph.generate(options, messages);
    ASSERT_TRUE(shader);
    const bool used = shader.reflection().half && shader.reflection().half->used;
    const bool noted = std::any_of(messages.begin(), messages.end(),
                                   [](const Message& message) { return message.code == "half-unused"; });
    EXPECT_NE(used, noted) << error;
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
