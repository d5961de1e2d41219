// Options, enumerators, numbers and names that are wrong: each is said in a message, and nothing is made.
#include <gtest/gtest.h>

#include <fstream>

#include "inputs.h"

namespace lacquer::test {
namespace {

struct WrongOption {
  const char* name;
  const char* code;
  bool of_targets;  ///< a graph does not depend on it
  void (*set)(Options&);
};

constexpr WrongOption kWrongOptions[] = {
    {"target", "unknown-enumerator", true, [](Options& o) { o.targets = {static_cast<Target>(77)}; }},
    {"target255", "unknown-enumerator", true, [](Options& o) { o.targets = {static_cast<Target>(255)}; }},
    {"targetTwice", "duplicate-target", true,
     [](Options& o) {
       o.targets = {Target::Glsl, Target::Glsl};
     }},
    {"route", "unknown-enumerator", true, [](Options& o) { o.spirv_route = static_cast<SpirvRoute>(2); }},
    {"specOfHlsl", "no-specialization-constants", true,
     [](Options& o) {
       o.parameters = Parameters::Spec;
       o.targets = {Target::Hlsl};
     }},
    {"parameters", "unknown-enumerator", false,
     [](Options& o) { o.parameters = static_cast<Parameters>(3); }},
    {"lights", "unknown-enumerator", false, [](Options& o) { o.lights.mode = static_cast<Lights::Mode>(9); }},
    {"profile", "unknown-profile", false, [](Options& o) { o.profile = "nobody"; }},
    {"simplification", "bad-simplification", false, [](Options& o) { o.simplify = {"coat"}; }},
    {"left_out", "unknown-term", false, [](Options& o) { o.simplify = {"without:coat.absorbtion"}; }},
    {"live", "unknown-term", false, [](Options& o) { o.live = {"coat.darkning"}; }},
};

class WrongOptions : public testing::TestWithParam<WrongOption> {
protected:
  WrongOptions() : folder_(emptyFolder()) {
    GetParam().set(options_);
    std::ofstream(file_) << paintGltf();
  }

  void expectSaid() {
    EXPECT_EQ(errorsOf(messages_), GetParam().code);
    messages_.clear();
  }

  Options options_ = quick();
  std::filesystem::path folder_;
  std::string file_ = (folder_ / "paint.gltf").string();
  std::string out_ = (folder_ / "out").string();
  Messages messages_;
};

TEST_P(WrongOptions, ofAGraph) {
  Graph graph = paintGraph();
  EXPECT_FALSE(graph.generate(options_, messages_));
  expectSaid();
  if (GetParam().of_targets) return;
  EXPECT_FALSE(paintScene().graph(0, {}, options_, messages_));
  expectSaid();
  EXPECT_EQ(graph.dump(options_, "", messages_), "");
  expectSaid();
  EXPECT_FALSE(graph.prove(options_, messages_));
  expectSaid();
}

TEST_P(WrongOptions, ofARun) {
  EXPECT_FALSE(generate({file_}, {}, out_, options_, messages_).ok);
  expectSaid();
  EXPECT_FALSE(plan({(folder_ / "x.ninja").string(), "lacquer", {"lacquer"}, {}}, {file_}, {}, out_, options_,
                    messages_)
                   .ok);
  expectSaid();
  EXPECT_FALSE(std::filesystem::exists(out_));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "x.ninja"));
}

TEST_P(WrongOptions, ofTheTools) {
  if (GetParam().of_targets) return;
  EXPECT_FALSE(evaluate(file_, {}, R"({"points": []})", "points", Engine::Double, {}, options_, messages_));
  expectSaid();
  Preview preview;
  preview.output = (folder_ / "out.png").string();
  EXPECT_FALSE(drawPreview(preview, {file_}, {}, options_, messages_));
  expectSaid();
  EXPECT_FALSE(stressNodes({}, {file_}, options_, messages_));
  expectSaid();
}

INSTANTIATE_TEST_SUITE_P(All, WrongOptions, testing::ValuesIn(kWrongOptions),
                         [](const auto& info) { return info.param.name; });

TEST(Targets, thatDoNotExist) {
  Target target = Target::Hlsl;
  EXPECT_FALSE(findTarget("metal", target));
  EXPECT_EQ(target, Target::Hlsl);
  for (int i = 0; i < 256; ++i) {
    const auto any = static_cast<Target>(i);
    EXPECT_EQ(targetName(any).empty(), any > Target::Msl) << i;
    if (any > Target::Msl) continue;
    EXPECT_TRUE(findTarget(targetName(any), target)) << i;
    EXPECT_EQ(target, any);
  }
  Messages messages;
  Options options = quick();
  options.targets = {Target::Glsl, Target::Spirv, Target::Cpp};
  const Shader shader = paintGraph().generate(options, messages);
  EXPECT_EQ(errorsOf(messages), "");
  for (int i = 1; i < 256; ++i) EXPECT_EQ(shader.fragmentText(static_cast<Target>(i)), "") << i;
  EXPECT_NE(shader.fragmentText(Target::Glsl), "");
}

TEST(LightCounts, moreThanTheArrayHolds) {
  Options options = quick();
  options.lights = {Lights::Mode::Fixed,
                    {{"directional", 4000000000U}, {"point", 4000000000U}, {"spot", 17}}};
  Messages messages;
  Graph graph = paintGraph();
  EXPECT_FALSE(graph.generate(options, messages));
  EXPECT_EQ(graph.dump(options, "", messages), "");
  EXPECT_FALSE(graph.prove(options, messages));
  EXPECT_EQ(errorsOf(messages), "too-many-lights too-many-lights too-many-lights");
  options.lights = {Lights::Mode::Fixed, {{"point", 16}}};
  EXPECT_TRUE(graph.generate(options, messages));
}

TEST(LightCounts, ofASceneWithTooMany) {
  const std::filesystem::path folder = emptyFolder();
  Options options = quick();
  options.lights.mode = Lights::Mode::Scene;
  for (const int lights : {16, 17}) {
    const std::string file = (folder / "lights.gltf").string();
    std::ofstream(file) << paintGltf(lights);
    Messages messages;
    const Report report = generate({file}, {}, (folder / "out").string(), options, messages);
    EXPECT_EQ(report.ok, lights == 16);
    EXPECT_EQ(errorsOf(messages), lights == 16 ? "" : "too-many-lights");
  }
}

TEST(Passes, byName) {
  Graph graph = paintGraph();
  Messages messages;
  std::string last;
  for (const std::string& pass : passNames()) {
    last = graph.dump(quick(), pass, messages);
    EXPECT_NE(last, "") << pass;
  }
  EXPECT_EQ(graph.dump(quick(), "", messages), last);
  EXPECT_TRUE(messages.empty());
  EXPECT_EQ(graph.dump(quick(), "optimise", messages), "");
  EXPECT_EQ(errorsOf(messages), "unknown-pass");
  EXPECT_NE(messages[0].help.find("lower, "), std::string::npos) << messages[0].help;
}

TEST(Engines, thatDoNotExist) {
  Messages messages;
  EXPECT_FALSE(evaluate("x.gltf", {}, "{}", "points", static_cast<Engine>(5), {}, {}, messages));
  Options spec;
  spec.parameters = Parameters::Spec;
  EXPECT_FALSE(evaluate("x.gltf", {}, "{}", "points", Engine::VulkanHlsl, {}, spec, messages));
  EXPECT_EQ(errorsOf(messages), "unknown-enumerator no-specialization-constants");
}

TEST(Previews, numbersOutOfRange) {
  const std::filesystem::path folder = emptyFolder();
  const std::string file = (folder / "paint.gltf").string();
  std::ofstream(file) << paintGltf();
  const auto drawn = [&](void (*change)(Preview&)) {
    Preview preview;
    preview.output = (folder / "out.png").string();
    preview.size = 16;
    change(preview);
    Messages messages;
    const auto answer = drawPreview(preview, {file}, {}, {}, messages);
    EXPECT_EQ(!answer, hasError(messages));
    EXPECT_EQ(std::filesystem::exists(folder / "out.png"), answer.has_value());
    return errorsOf(messages);
  };
  EXPECT_EQ(drawn([](Preview& p) { p.size = 0; }), "out-of-range");
  EXPECT_EQ(drawn([](Preview& p) { p.size = 15; }), "out-of-range");
  EXPECT_EQ(drawn([](Preview& p) { p.size = 2049; }), "out-of-range");
  EXPECT_EQ(drawn([](Preview& p) { p.columns = 101; }), "out-of-range");
  EXPECT_EQ(drawn([](Preview& p) { p.columns = 4294967295U; }), "out-of-range");
  EXPECT_EQ(drawn([](Preview& p) { p.compare = {"float"}; }), "wrong-count");
  EXPECT_EQ(drawn([](Preview& p) { p.compare = {"float", "double", "baked"}; }), "wrong-count");
  EXPECT_EQ(drawn([](Preview& p) { p.output.clear(); }), "no-path");
  EXPECT_EQ(drawn([](Preview& p) { p.columns = 100; }), "");
}

TEST(Attacks, numbersOutOfRange) {
  const auto attacked = [](Stress stress) {
    Messages messages;
    EXPECT_FALSE(stressNodes(stress, {"f0_from_ior"}, {}, messages));
    return errorsOf(messages);
  };
  Stress stress;
  stress.samples = 0;
  EXPECT_EQ(attacked(stress), "out-of-range");
  stress.samples = ~uint64_t{0};
  EXPECT_EQ(attacked(stress), "out-of-range");
  stress.samples = 1;
  stress.total = ~uint64_t{0};
  EXPECT_EQ(attacked(stress), "out-of-range");
}

TEST(Tables, sizesOutOfRange) {
  const std::string path = (emptyFolder() / "table.dds").string();
  Messages messages;
  for (const uint32_t size : {0U, 1U, 1025U, 4294967295U}) {
    EXPECT_TRUE(environmentDfg(size, messages).empty());
    EXPECT_FALSE(writeEnvironmentDfg(path, size, messages));
    EXPECT_EQ(errorsOf(messages), "out-of-range out-of-range");
    messages.clear();
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_FALSE(writeEnvironmentDfg("", 2, messages));
  EXPECT_EQ(errorsOf(messages), "no-path");
  EXPECT_EQ(environmentDfg(2, messages).size(), 8U);
}

TEST(Paths, thatAreEmpty) {
  const std::string file = (emptyFolder() / "paint.gltf").string();
  std::ofstream(file) << paintGltf();
  Messages messages;
  EXPECT_FALSE(generate({file}, {}, "", quick(), messages).ok);
  EXPECT_FALSE(generateGraphs({file}, "", quick(), messages).ok);
  EXPECT_FALSE(merge({}, "", messages));
  EXPECT_FALSE(plan({"x.ninja", "lacquer", {}, {}}, {file}, {}, "", quick(), messages).ok);
  EXPECT_FALSE(plan({"", "lacquer", {}, {}}, {file}, {}, "out", quick(), messages).ok);
  EXPECT_FALSE(plan({"x.ninja", "", {}, {}}, {file}, {}, "out", quick(), messages).ok);
  EXPECT_EQ(errorsOf(messages), "no-path no-path no-path no-path no-path no-path");
  messages.clear();
  EXPECT_FALSE(Scene::load("", {}, messages));
  EXPECT_NE(errorsOf(messages), "");
}

}  // namespace
}  // namespace lacquer::test
