// `--optimize`: shaders that were searched for give what the plain ones do, on the CPU and on a device, and
// their approximations keep to the error that is proved.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "eval/evaluate.h"
#include "eval/points.h"
#include "optimize/approximate.h"
#include "parity/subject.h"
#include "passes/pipeline.h"
#include "support/cases.h"
#include "support/materials.h"

namespace lacquer::parity::optimized_test {
namespace {

/// Lowers a material and runs all passes.
ir::Module moduleOf(const NamedGraph& graph, const MaterialSetting& setting, const optimize::Settings& how) {
  Result<ir::Module> module = lower::lower(graph.graph, library(), {setting.parameters, true});
  EXPECT_TRUE(module) << graph.name;
  if (!module) return {};
  passes::PipelineOptions options;
  options.lights = setting.lights;
  options.optimize = how;
  passes::runPipeline(*module, options);
  EXPECT_TRUE(ir::verify(*module).empty()) << graph.name;
  return std::move(*module);
}

/// A subject with another form of its module.
Subject withModule(const Subject& plain, ir::Module module) {
  Subject other = plain;
  other.module = std::move(module);
  EXPECT_TRUE(eval::bindMaterialBlock(other.module, other.bindings)) << other.name;
  EXPECT_TRUE(eval::bindVaryings<float>(other.module, other.points, other.bindings)) << other.name;
  return other;
}

/// Bounds twice as wide: so much may rounding errors grow.
std::vector<std::vector<analysis::Range>> doubled(std::vector<std::vector<analysis::Range>> bounds) {
  for (auto& point : bounds) {
    for (analysis::Range& bound : point) {
      const double half = (bound.hi - bound.lo) / 2;
      if (std::isfinite(half)) bound = {bound.lo - half, bound.hi + half, bound.nan};
    }
  }
  return bounds;
}

/// Some of the examples, of all their files.
std::vector<NamedGraph> someGraphs(const MaterialSetting& setting, size_t stride, size_t first) {
  const std::vector<NamedGraph> all = exampleGraphs(setting);
  std::vector<NamedGraph> some;
  for (size_t i = first; i < all.size(); i += stride) some.push_back(all[i]);
  return some;
}

/// Whether all materials are to be tried, which takes an hour: all examples, a thousand random ones, all
/// files.
bool everything() { return std::getenv("LACQUER_OPTIMIZED_ALL") != nullptr; }

/// Searched for forms of materials on the CPU and on all routes to a device, against the plain ones.
void comparePlain(const std::vector<NamedGraph>& graphs, size_t least_changed) {
  const MaterialSetting setting;
  Comparison all;
  size_t changed = 0;
  for (size_t i = 0; i < graphs.size(); ++i) {
    const Subject plain = materialSubject(graphs[i], setting, 512, i);
    const Subject fast = withModule(plain, moduleOf(graphs[i], setting, {1, 0, nullptr}));
    changed += passes::contentDigest(fast.module) == passes::contentDigest(plain.module) ? 0 : 1;
    const auto bounds = doubled(boundsOf(plain));
    compare(fast, bounds, onCpu(fast), "the CPU", all);
    if (device() == nullptr) continue;
    compare(fast, bounds, onDevice(fast, FragmentRoute::Direct), "the direct SPIR-V", all);
    compare(fast, bounds, onDevice(fast, FragmentRoute::Glsl), "the GLSL", all);
  }
  EXPECT_EQ(all.outside, 0U) << all.first;
  EXPECT_GE(changed, least_changed);  // others have no cheaper form that is found
  std::cout << all.numbers << " numbers of " << graphs.size() << " materials, " << all.vague
            << " with a vague bound, " << all.endless << " with none"
            << (device() == nullptr ? "; NOT TESTED on a device: there is none" : "") << "\n";
}

TEST(ParityOptimized, GiveThePlainShadersColours) {
  std::vector<NamedGraph> graphs = someGraphs({}, everything() ? 1 : 5, 0);
  for (NamedGraph& graph : randomGraphs({}, everything() ? 250 : 1)) graphs.push_back(std::move(graph));
  comparePlain(graphs, 2);
}

/// The materials of real files: ../shared/assets beside the source folder, or the folder in LACQUER_ASSETS.
TEST(ParityOptimized, GiveThePlainColoursOfRealFiles) {
  namespace fs = std::filesystem;
  const char* given = std::getenv("LACQUER_ASSETS");
  const fs::path folder =
      given != nullptr ? fs::path(given) : test::sourceFolder() / ".." / "shared" / "assets";
  if (!fs::is_directory(folder)) GTEST_SKIP() << "no " << folder << "; set LACQUER_ASSETS";
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const fs::path extension = entry.path().extension();
    if (extension == ".gltf" || extension == ".glb") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<NamedGraph> graphs;
  constexpr size_t kSome = 8;
  for (size_t i = 0; i < files.size(); i += everything() ? 1 : std::max<size_t>(1, files.size() / kSome)) {
    const Result<material::Document> document = test::readMaterials(files[i].string());
    if (!document) continue;  // the tests of glTF have those
    for (size_t m = 0; m < document->materials.size(); ++m) {
      const material::Material& material = document->materials[m];
      if (hasError(material.diagnostics) || (!everything() && m > 0)) continue;
      test::BuildSetup options;
      Diagnostics warnings;
      const gltf::VertexAttributes attributes{
          true, MaterialSetting().tangents, true, {true, true, true, true}};
      NamedGraph made{fmt::format("{}, {}", files[i].filename().string(), material.name),
                      test::buildGraph(material, attributes, options, warnings)};
      // Patterns have nodes that this library has not read; tests/patterns has such materials.
      if (lower::lower(made.graph, library(), {lower::ParameterMode::Uniform, true}))
        graphs.push_back(std::move(made));
    }
  }
  ASSERT_FALSE(graphs.empty());
  comparePlain(graphs, 0);
}

std::vector<std::vector<double>> exactly(const Subject& subject) {
  const auto values =
      eval::evaluate<double>(subject.module, subject.roots(), subject.bindings, subject.points);
  EXPECT_TRUE(values) << subject.name;
  return values.value_or(std::vector<std::vector<double>>{});
}

/// The largest difference of two colours, as a part of them or of 1.
double difference(const std::vector<std::vector<double>>& a, const std::vector<std::vector<double>>& b) {
  double most = 0;
  for (size_t r = 0; r < a.size(); ++r) {
    for (size_t i = 0; i < a[r].size(); ++i) {
      if (!std::isfinite(a[r][i])) continue;
      const double off = std::abs(a[r][i] - b[r][i]) / std::max(1.0, std::abs(a[r][i]));
      most = std::isnan(off) ? std::numeric_limits<double>::infinity() : std::max(most, off);
    }
  }
  return most;
}

MaterialSetting baked() {
  MaterialSetting setting;
  setting.parameters = lower::ParameterMode::Baked;
  return setting;
}

// With numbers for parameters nothing is rounded but in double: what is equal in real numbers differs by that
// alone.
TEST(ParityOptimized, AreEqualInRealNumbers) {
  for (const NamedGraph& graph : someGraphs(baked(), 6, 1)) {
    const Subject plain = materialSubject(graph, baked(), 2048, 3);
    const Subject fast = withModule(plain, moduleOf(graph, baked(), {1, 0, nullptr}));
    EXPECT_LE(difference(exactly(plain), exactly(fast)), 1e-9) << graph.name;
  }
}

/// Light of at most 1, which is what errors are a part of.
void dim(Subject& subject) {
  for (eval::Columns& light : subject.bindings.lights) {
    for (auto& [name, column] : light) {
      if (name.find("radiance") == std::string::npos && name.find("color") == std::string::npos &&
          name.find("intensity") == std::string::npos) {
        continue;
      }
      for (double& x : column.values) x = std::min(x, 1.0);
    }
  }
  subject.bindings.columns["frame.environment_intensity"] = eval::Column::constant({1});
  for (auto& [name, sampler] : subject.bindings.textures) {
    sampler = [bright = sampler](size_t point, const std::array<double, 3>& at, double lod) {
      std::array<double, 4> texel = bright(point, at, lod);
      for (double& x : texel) x = std::min(x, 1.0);
      return texel;
    };
  }
}

/// `--half`, with types of 16 bits wherever they may be.
TEST(ParityHalf, KeepsToTheBoundOnTheDevice) {
  if (device() == nullptr || !device()->halves()) GTEST_SKIP() << "no device with shaderFloat16";
  size_t halved = 0;
  double closest = 0;
  for (const NamedGraph& graph : someGraphs(baked(), everything() ? 1 : 4, 0)) {
    Result<ir::Module> module = lower::lower(graph.graph, library(), {lower::ParameterMode::Baked, true});
    ASSERT_TRUE(module) << graph.name;
    passes::PipelineOptions options;
    options.lights = baked().lights;
    options.relaxed = 0.05;
    options.half = true;
    options.choose = [](std::span<const ir::Module> forms) -> std::optional<passes::Choice> {
      return passes::Choice{forms.size() - 1, "the test", 1, 0};
    };
    passes::runPipeline(*module, options);
    if (!module->half || !module->half->used) continue;
    ++halved;
    Subject plain = materialSubject(graph, baked(), 1024, halved);
    dim(plain);
    Subject subject = withModule(plain, std::move(*module));
    const auto of = [](const std::vector<std::vector<float>>& outputs) {
      std::vector<std::vector<double>> numbers;
      for (const auto& output : outputs) numbers.emplace_back(output.begin(), output.end());
      return numbers;
    };
    const auto usual = of(onDevice(plain, FragmentRoute::Direct));
    for (const FragmentRoute route : {FragmentRoute::Direct, FragmentRoute::Glsl}) {
      const double off = difference(usual, of(onDevice(subject, route)));
      constexpr double kFloats = 1e-3;  // what else is rounded, on both sides
      EXPECT_LE(off, subject.module.relaxed_bound + kFloats) << graph.name;
      closest = std::max(closest, off / subject.module.relaxed_bound);
    }
  }
  EXPECT_GT(halved, 3U);
  EXPECT_GT(closest, 1e-3);  // else nothing was rounded
}

TEST(ParityOptimized, ApproximationsKeepToTheProvedError) {
  constexpr double kError = 0.02;
  size_t approximated = 0;
  for (const NamedGraph& graph : someGraphs(baked(), 6, 2)) {
    Result<ir::Module> module = lower::lower(graph.graph, library(), {lower::ParameterMode::Baked, true});
    ASSERT_TRUE(module) << graph.name;
    ir::Module before;
    passes::PipelineOptions options;
    options.lights = baked().lights;
    options.after = [&](std::string_view pass, const ir::Module& after) {
      if (pass == "vertex") before = after;
    };
    passes::runPipeline(*module, options);
    std::optional<optimize::Approximated> made =
        optimize::approximate(before, optimize::families()[0], kError);
    if (!made) continue;
    ++approximated;
    EXPECT_LE(made->error, kError) << graph.name;
    options.after = nullptr;
    passes::runPipeline(made->module, options);
    Subject plain = materialSubject(graph, baked(), 2048, 3);
    dim(plain);
    const Subject fast = withModule(plain, std::move(made->module));
    const double off = difference(exactly(plain), exactly(fast));
    EXPECT_LE(off, made->error + 1e-9) << graph.name;
    EXPECT_GT(off, 0) << graph.name;
    std::cout << graph.name << ": " << made->count << " approximations, off by " << off << ", proved "
              << made->error << "\n";
  }
  EXPECT_GT(approximated, 0U);
}

/// Puts a wrong value in the place of a sum: a plan that no right rule gives.
TEST(ParityOptimized, AWrongFormIsFound) {
  const MaterialSetting setting;
  const NamedGraph graph = someGraphs(setting, 100, 4).at(0);
  const Subject plain = materialSubject(graph, setting, 256, 1);
  const auto bounds = doubled(boundsOf(plain));
  size_t found = 0;
  size_t tried = 0;
  optimize::Constants constants;
  const optimize::Plan right = optimize::planOf(plain.module, constants);
  for (size_t at = 0; at < right.nodes.size(); at += 7) {
    const optimize::Node& node = right.nodes[at];
    if (node.op != ir::Op::Mul || node.opaque() || node.rate <= ir::Rate::Material) continue;
    optimize::Plan wrong = right;
    wrong.nodes[at].op = ir::Op::Add;
    Subject subject = plain;
    optimize::replaceFragment(subject.module, wrong, constants);
    Comparison comparison;
    compare(subject, bounds, onCpu(subject), "the CPU", comparison);
    found += comparison.outside > 0 ? 1 : 0;
    ++tried;
  }
  EXPECT_GT(tried, 2U);
  EXPECT_GT(2 * found, tried);  // where a bound is wide, or the sum hardly counts, it may stay hidden
}

}  // namespace
}  // namespace lacquer::parity::optimized_test
