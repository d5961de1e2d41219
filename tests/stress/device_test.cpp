// The same attacks on a Vulkan device: the library and the examples hold there, and a guard that a compiler
// folds away, or that is not there, is found.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "lacquer.h"
#include "lang/library.h"
#include "prove/nodes.h"
#include "stress/on_device.h"
#include "support/answers.h"
#include "support/cases.h"

namespace lacquer::test::device_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const vulkan::Device* device() {
  static const Result<vulkan::Device> kDevice = vulkan::Device::open();
  return kDevice ? &*kDevice : nullptr;
}

#define NEEDS_DEVICE() \
  if (device() == nullptr) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine"

json stressed(const std::vector<std::string>& subjects, uint64_t samples, Engine engine = Engine::Vulkan,
              const std::string& profile = {}) {
  Stress stress;
  stress.samples = samples;
  stress.engine = engine;
  Options options;
  options.profile = profile;
  options.allow = {(sourceFolder() / "examples").string()};
  Messages messages;
  const std::string answer = jsonOf(stressNodes(stress, subjects, options, messages));
  for (const Message& message : messages) EXPECT_NE(message.level, Message::Level::Error) << message.text;
  return answer.empty() ? json() : json::parse(answer);
}

void expectNone(const json& answer) {
  ASSERT_FALSE(answer.is_null());
  for (const json& subject : answer["subjects"]) {
    for (const json& finding : subject["findings"]) ADD_FAILURE() << finding.dump();
  }
}

TEST(StressDevice, TheLibraryHolds) {
  NEEDS_DEVICE();
  const json answer = stressed({}, 512);
  expectNone(answer);
  EXPECT_EQ(answer["device"], device()->name());
  for (const json& subject : answer["subjects"]) {
    // Ten matrices are more inputs than most devices take.
    const bool of_matrices = subject["node"].get<std::string>().starts_with("switch<mat4");
    if (!subject.contains("skipped") || of_matrices) continue;
    EXPECT_EQ(subject["skipped"], "its samples are each other's neighbours") << subject["node"];
  }
}

TEST(StressDevice, TheExamplesHold) {
  NEEDS_DEVICE();
  std::vector<std::string> files;
  for (const char* const name : {"coat.gltf", "clearcoat_color.gltf"})
    files.push_back((sourceFolder() / "examples" / name).string());
  files.push_back((sourceFolder() / "bench/works/w2.gltf").string());
  for (const char* const profile : {"khr", "physical"})
    expectNone(stressed(files, 1024, Engine::Vulkan, profile));
}

/// Frames that come of derivatives are attacked too: steps to the neighbours that span no area among them.
TEST(StressDevice, MaterialsWithoutTangentsAreAmongThem) {
  NEEDS_DEVICE();
  const json answer = stressed({(sourceFolder() / "examples/coat.gltf").string()}, 512);
  expectNone(answer);
  size_t without = 0;
  for (const json& subject : answer["subjects"]) without += subject.contains("tangents") ? 1 : 0;
  EXPECT_GE(without, 2U);
}

TEST(StressDevice, TextsAreAttackedAsTheDirectSpirvIs) {
  NEEDS_DEVICE();
  for (const Engine engine : {Engine::VulkanGlsl, Engine::VulkanHlsl})
    expectNone(stressed({"normal_map", "ggx_distribution", "coat_absorption"}, 1024, engine));
}

/// More numbers than a device puts out at once come in several runs.
TEST(StressDevice, ANodeMayHaveManyResults) {
  NEEDS_DEVICE();
  Stress stress;
  stress.samples = 512;
  stress.engine = Engine::Vulkan;
  Options options;
  options.node_texts = {{"wide.node", R"(
/// Many results, the last of which is wrong.
/// source: the tests
/// category: tests
node wide(vec4 a in [0, 1], int n in [0, 9])
  -> (vec4 b, vec4 c, vec4 d, vec4 e, vec4 f, mat4 g, int h, float last in [0, 1]) {
    return (a, a * 2, a + 1, a * a, -a, mat4(a, a, a, a), n + 1, 2 + a.x);
}
)"}};
  Messages messages;
  const json answer = json::parse(jsonOf(stressNodes(stress, {"wide"}, options, messages)));
  for (const Message& message : messages) ADD_FAILURE() << message.text;
  const json& subject = answer["subjects"][0];
  EXPECT_FALSE(subject.contains("skipped")) << subject;
  ASSERT_EQ(subject["findings"].size(), 1U) << subject;
  EXPECT_EQ(subject["findings"][0]["what"], "last");
}

TEST(StressDevice, SaysWhatItCannotDo) {
  Stress stress;
  stress.engine = Engine::Double;
  Messages messages;
  EXPECT_FALSE(stressNodes(stress, {"schlick"}, Options(), messages));
  ASSERT_FALSE(messages.empty());
  EXPECT_EQ(messages[0].code, "unknown-enumerator");
  stress.engine = Engine::Vulkan;
  stress.mediump = true;
  messages.clear();
  EXPECT_FALSE(stressNodes(stress, {"schlick"}, Options(), messages));
  ASSERT_FALSE(messages.empty());
  EXPECT_EQ(messages[0].code, "contradicting-options");
}

/// A library whose text differs in one place.
lang::Library mutated(const std::string& from, const std::string& to) {
  std::vector<lang::SourceFile> files;
  size_t found = 0;
  for (const char* const folder : {"nodes", "templates"}) {
    for (const fs::path& path : findFiles(sourceFolder() / folder, ".node")) {
      std::string text = readFile(path);
      if (const size_t at = text.find(from); at != std::string::npos) {
        text.replace(at, from.size(), to);
        ++found;
      }
      files.push_back({path.filename().string(), std::move(text)});
    }
  }
  EXPECT_EQ(found, 1U) << from;
  Result<lang::Library> library = lang::Library::fromFiles(std::move(files));
  EXPECT_TRUE(library);
  return library ? std::move(*library) : lang::Library::embedded();
}

std::unique_ptr<stress::Subject> subjectOf(const lang::Library& library, const std::string& name) {
  const Result<const lang::NodeDecl*> node = library.node(name);
  EXPECT_TRUE(node) << name;
  if (!node) return nullptr;
  stress::NodeSource source{name, nodeModule(**node, {}).module, {}};
  for (const lang::Param& result : (*node)->results)
    source.results.emplace_back(result.name.empty() ? "the result" : std::string(result.name), result.range);
  Result<std::unique_ptr<stress::Subject>> subject = stress::nodeSubject(std::move(source));
  EXPECT_TRUE(subject) << name;
  return subject ? std::move(*subject) : nullptr;
}

struct Mutant {
  const char* what;
  const char *node, *from, *to;
  bool on_the_cpu;  ///< found there, too
};

class Mutants : public testing::TestWithParam<Mutant> {};

TEST_P(Mutants, AreFoundOnTheDevice) {
  NEEDS_DEVICE();
  const Mutant& mutant = GetParam();
  const stress::Plan plan{4096, 1, false};
  const std::unique_ptr<stress::Subject> sound = subjectOf(lang::Library::embedded(), mutant.node);
  const std::unique_ptr<stress::Subject> broken = subjectOf(mutated(mutant.from, mutant.to), mutant.node);
  ASSERT_TRUE(sound && broken);
  const auto onDevice = [&](const stress::Subject& subject) {
    const DeviceSubject shown = deviceSubject(subject, *device(), FragmentRoute::Direct);
    EXPECT_EQ(shown.skipped, "");
    const Result<stress::Report> report = stress::attackOnDevice(subject, plan, shown.show);
    EXPECT_TRUE(report) << (report ? "" : format(report.error()[0]));
    return report ? report->findings : std::vector<stress::Finding>();
  };
  EXPECT_TRUE(onDevice(*sound).empty());
  const std::vector<stress::Finding> findings = onDevice(*broken);
  ASSERT_FALSE(findings.empty()) << mutant.what;
  // The input that is shown does it again.
  const DeviceSubject shown = deviceSubject(*broken, *device(), FragmentRoute::Direct);
  const Result<stress::Report> again = stress::replayOnDevice(*broken, findings[0].input, shown.show);
  ASSERT_TRUE(again);
  EXPECT_TRUE(std::any_of(again->findings.begin(), again->findings.end(),
                          [&](const stress::Finding& one) { return one.fault == findings[0].fault; }));
  const std::vector<stress::Finding> cpu = stress::attack(*broken, plan).findings;
  EXPECT_EQ(std::any_of(cpu.begin(), cpu.end(), [](const stress::Finding& one) { return one.known.empty(); }),
            mutant.on_the_cpu);
}

INSTANTIATE_TEST_SUITE_P(Guards, Mutants,
                         testing::Values(
                             // Beside the 1 of the decoding a compiler adds it to that first.
                             Mutant{"a guard that is folded", "normal_map",
                                    "max(texel.z * 2.0 - 1.0, MIN_NORMAL_Z)",
                                    "texel.z * 2.0 - 1.0 + MIN_NORMAL_Z", false},
                             Mutant{"no least alpha", "alpha_from_roughness", "const float ALPHA_MIN = 0.001",
                                    "const float ALPHA_MIN = 0", true},
                             Mutant{"no guard of a lobe", "specular_lobe", "const float MIN_LOBE = 3e-32",
                                    "const float MIN_LOBE = 0", true},
                             Mutant{"no guard of a path", "coat_absorption", "const float MIN_COS2 = 1e-6",
                                    "const float MIN_COS2 = 0", true}),
                         [](const auto& info) { return fmt::format("{}_{}", info.param.node, info.index); });

const bool kRegistered = registerFiles("StressDeviceCases", sourceFolder() / "tests/stress/cases", ".json",
                                       [](const fs::path& file) {
                                         NEEDS_DEVICE();
                                         expectNone(stressed({file.string()}, 1));
                                       });

}  // namespace
}  // namespace lacquer::test::device_test
