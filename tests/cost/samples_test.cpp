// That the direct SPIR-V is not worse than our own GLSL through glslang and spirv-opt -O: for every sample
// material of this tree, for random ones, and for real files where there are some (../shared/assets beside
// the source folder, or the folder in the environment variable LACQUER_ASSETS).
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cstdlib>
#include <map>

#include "check/check.h"
#include "cost/cost.h"
#include "golden/random_material.h"
#include "lacquer.h"
#include "support/cases.h"

namespace lacquer::cost {
namespace {

namespace fs = std::filesystem;

/// Of one shader. The two modules mean the same, but differ in the order of instructions, and of a choice
/// between values one makes a select, the other a branch: the driver's registers come out otherwise.
/// Percent that one shader may cost more: a path tracer's, which were added with the sampling, up to 1.3.
uint64_t percentOf(const std::string& where) { return where.find("(bsdf-") == std::string::npos ? 1 : 2; }

/// Instructions that the SPIR-V of one may have more: a fuzz with textures multiplies one product again.
size_t moreOf(const std::string& where) { return where.find("(forward-fuzz-") == std::string::npos ? 0 : 1; }

/// A distinct shader, written directly, and by way of glslang and spirv-opt.
struct Sample {
  std::string where;  ///< the first material that needs it
  Graph graph;
  Options options;
  Subject direct, optimized;
  std::string problem;
};
using Samples = std::map<std::string, Sample>;  ///< by id

/// What changes the shape of the code; the materials of ours() take all of it, the others kOneLight.
constexpr size_t kOneLight = 0;
std::vector<Options> settings() {
  Options any;
  any.targets = {Target::Spirv};
  any.validate = false;
  any.permissive = true;
  Options one = any;
  one.lights = {Lights::Mode::Fixed, {{"directional", 1}}};
  Options several = any;
  several.lights = {Lights::Mode::Fixed, {{"directional", 1}, {"point", 2}, {"spot", 1}}};
  Options baked = one;
  baked.parameters = Parameters::Baked;
  Options surface = any;
  surface.template_name = "surface";
  Options bsdf = any;
  bsdf.template_name = "bsdf";
  return {one, any, several, baked, surface, bsdf};
}

void addMaterial(const Scene& scene, size_t material, const std::string& name, const Options& options,
                 Samples& samples) {
  std::vector<Attributes> uses = scene.uses(material);
  if (uses.empty()) uses.push_back({true, true, false, {true, true, false, false}});
  for (const Attributes& use : uses) {
    Messages ignored;  // some samples are wrong on purpose, and have no shader
    Graph graph = scene.graph(material, use, options, ignored);
    const Shader shader = graph ? graph.generate(options, ignored) : Shader();
    if (!shader) continue;
    const std::string where =
        fmt::format("{} {} '{}' ({})", name, material, scene.materialName(material), shader.id());
    const Subject direct{where, shader.vertexSpirv(), shader.fragmentSpirv()};
    samples.try_emplace(shader.id(), Sample{where, graph, options, direct, {}, {}});
  }
}

void addScene(const std::string& bytes, const std::string& name, const std::vector<Options>& all,
              Samples& samples) {
  for (const Options& options : all) {
    Messages ignored;
    const Scene scene = Scene::fromMemory(bytes, name, options, ignored);
    for (size_t i = 0; scene && i < scene.materialCount(); ++i) addMaterial(scene, i, name, options, samples);
  }
}

void addFiles(const fs::path& folder, const std::vector<Options>& all, Samples& samples) {
  for (const char* extension : {".gltf", ".glb"}) {
    for (const fs::path& file : test::findFiles(folder, extension))
      addScene(test::readFile(file), file.string(), all, samples);
  }
}

void optimize(Sample& sample) {
  Options options = sample.options;
  options.spirv_route = SpirvRoute::Glslang;
  Messages messages;
  const Shader shader = sample.graph.generate(options, messages);
  sample.optimized = {sample.where, shader.vertexSpirv(), shader.fragmentSpirv()};
  for (Spirv* words : {&sample.optimized.vertex, &sample.optimized.fragment}) {
    if (words->empty()) continue;
    Result<Spirv> optimized = check::optimize(*words, sample.where);
    if (!optimized) sample.problem = format(optimized.error()[0]);
    *words = optimized ? std::move(*optimized) : Spirv();
  }
}

std::vector<Sample> optimizedOf(Samples samples) {
  std::vector<Sample> list;
  for (auto& [id, sample] : samples) list.push_back(std::move(sample));
  tbb::parallel_for(size_t{0}, list.size(), [&](size_t i) { optimize(list[i]); });
  return list;
}

/// Made once: the tree's samples and random ones.
const std::vector<Sample>& ours() {
  static const std::vector<Sample> list = [] {
    Samples samples;
    for (const char* folder : {"examples", "bench/works", "tests/gltf/cases", "tests/physics"})
      addFiles(test::sourceFolder() / folder, settings(), samples);
    constexpr size_t kRandomMaterials = 60;
    addScene(test::RandomMaterial(3).valid(kRandomMaterials).dump(), "random", {settings()[kOneLight]},
             samples);
    return optimizedOf(std::move(samples));
  }();
  return list;
}

fs::path assetsFolder() {
  const char* given = std::getenv("LACQUER_ASSETS");
  if (given != nullptr) return given;  // one that is not there fails
  const fs::path beside = test::sourceFolder() / ".." / "shared" / "assets";
  return fs::is_directory(beside) ? fs::weakly_canonical(beside) : fs::path();
}

const std::vector<Sample>& assets() {
  static const std::vector<Sample> list = [] {
    Samples samples;
    addFiles(assetsFolder(), {settings()[kOneLight]}, samples);
    return optimizedOf(std::move(samples));
  }();
  return list;
}

void expectNoMoreInstructions(const std::vector<Sample>& samples) {
  size_t direct = 0, optimized = 0;
  for (const Sample& sample : samples) {
    ASSERT_EQ(sample.problem, "") << sample.where;
    const std::array<std::pair<const Spirv*, const Spirv*>, 2> stages{
        std::pair(&sample.direct.vertex, &sample.optimized.vertex),
        std::pair(&sample.direct.fragment, &sample.optimized.fragment)};
    for (const auto& [ours, theirs] : stages) {
      ASSERT_EQ(ours->empty(), theirs->empty()) << sample.where;
      EXPECT_LE(spirvInstructions(*ours), spirvInstructions(*theirs) + moreOf(sample.where)) << sample.where;
      direct += spirvInstructions(*ours);
      optimized += spirvInstructions(*theirs);
    }
  }
  EXPECT_GT(direct, 0U) << "no sample was found";
  EXPECT_LE(direct, optimized);
  fmt::print("{} shaders, {} SPIR-V instructions, {} by glslang and spirv-opt\n", samples.size(), direct,
             optimized);
}

struct Totals {
  uint64_t instructions = 0, inverse_throughput = 0;
};

void expectNoMoreCost(const std::vector<Sample>& samples) {
  std::array<std::vector<Subject>, 2> subjects;
  for (const Sample& sample : samples) {
    subjects[0].push_back(sample.direct);
    subjects[1].push_back(sample.optimized);
  }
  std::array<Measurement, 2> measured;
  tbb::parallel_for(size_t{0}, size_t{2},
                    [&](size_t i) { measured[i] = measure(subjects[i], "navi21", false); });
  std::array<Totals, 2> totals;
  for (size_t i = 0; i < samples.size(); ++i) {
    for (size_t way = 0; way < 2; ++way) {
      const Outcome& outcome = measured[way].outcomes[i];
      ASSERT_TRUE(outcome.statistics) << samples[i].where << ": " << outcome.problem;
      totals[way].instructions += outcome.statistics->instructions;
      totals[way].inverse_throughput += outcome.statistics->inverse_throughput;
    }
    const Statistics& ours = *measured[0].outcomes[i].statistics;
    const Statistics& theirs = *measured[1].outcomes[i].statistics;
    const auto bound = [&](uint64_t value) { return value * (100 + percentOf(samples[i].where)) / 100; };
    EXPECT_LE(ours.instructions, bound(theirs.instructions)) << samples[i].where;
    EXPECT_LE(ours.inverse_throughput, bound(theirs.inverse_throughput)) << samples[i].where;
  }
  EXPECT_LE(totals[0].instructions, totals[1].instructions);
  EXPECT_LE(totals[0].inverse_throughput, totals[1].inverse_throughput);
  fmt::print("{} shaders on navi21: {} / {}, by glslang and spirv-opt {} / {}\n", samples.size(),
             totals[0].instructions, totals[0].inverse_throughput, totals[1].instructions,
             totals[1].inverse_throughput);
}

TEST(Samples, DirectSpirvIsNotLongerThanTheOptimized) { expectNoMoreInstructions(ours()); }

TEST(Samples, DirectSpirvCostsNoMoreThanTheOptimized) {
  if (const std::string reason = unavailable(); !reason.empty()) GTEST_SKIP() << reason;
  expectNoMoreCost(ours());
}

TEST(Samples, DirectSpirvOfAssetsIsNotLongerThanTheOptimized) {
  if (assetsFolder().empty())
    GTEST_SKIP() << "no ../shared/assets and no LACQUER_ASSETS: no real glTF file is tried";
  expectNoMoreInstructions(assets());
}

TEST(Samples, DirectSpirvOfAssetsCostsNoMoreThanTheOptimized) {
  if (assetsFolder().empty())
    GTEST_SKIP() << "no ../shared/assets and no LACQUER_ASSETS: no real glTF file is tried";
  if (const std::string reason = unavailable(); !reason.empty()) GTEST_SKIP() << reason;
  expectNoMoreCost(assets());
}

}  // namespace
}  // namespace lacquer::cost
