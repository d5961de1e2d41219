// The driver's side: these tests skip, and say why, where RADV is not installed.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <spirv-tools/libspirv.hpp>
#include <string_view>

#include "check/check.h"
#include "cost/cost.h"
#include "lacquer.h"

namespace lacquer::cost {
namespace {

constexpr const char* kVertex = R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec3 v_normal;
void main() { v_normal = normal; gl_Position = position; }
)";
constexpr const char* kShort = R"(#version 450
layout(location = 0) in vec3 v_normal;
layout(location = 0) out vec4 color;
void main() { color = vec4(normalize(v_normal), 1.0); }
)";
constexpr const char* kLong = R"(#version 450
layout(location = 0) in vec3 v_normal;
layout(location = 0) out vec4 color;
layout(set = 1, binding = 3) uniform sampler2D image;
void main() { color = texture(image, v_normal.xy) * pow(length(v_normal), v_normal.z); }
)";

Spirv compile(const char* text, check::Stage stage) {
  Result<Spirv> words = check::compile(text, Target::Glsl, stage, "test");
  if (!words) throw std::runtime_error(format(words.error()[0]));
  return *words;
}

class Driver : public testing::Test {
protected:
  void SetUp() override {
    if (const std::string reason = unavailable(); !reason.empty()) GTEST_SKIP() << reason;
  }
};

TEST_F(Driver, TellsTheSameOnEveryRun) {
  const Subject subject{"long", compile(kVertex, check::Stage::Vertex),
                        compile(kLong, check::Stage::Fragment)};
  for (const std::string& family : kFamilies) {
    const Measurement first = measure({subject}, family, false);
    const Measurement second = measure({subject, subject}, family, true);
    EXPECT_EQ(first.driver.substr(0, 5), "Mesa ");
    ASSERT_TRUE(first.outcomes[0].statistics) << first.outcomes[0].problem;
    EXPECT_GT(first.outcomes[0].statistics->instructions, 10U);
    EXPECT_GT(first.outcomes[0].statistics->latency, first.outcomes[0].statistics->inverse_throughput);
    EXPECT_EQ(first.outcomes[0].disassembly, "");
    for (const Outcome& outcome : second.outcomes) {
      EXPECT_EQ(outcome.statistics, first.outcomes[0].statistics);
      EXPECT_GT(outcome.driver_ms, 0);
      EXPECT_LT(outcome.driver_ms, 10'000);
      EXPECT_NE(outcome.disassembly.find("image_sample"), std::string::npos);
    }
  }
}

TEST_F(Driver, AFragmentShaderAloneCostsWhatItCostsInAPair) {
  const Spirv fragment = compile(kLong, check::Stage::Fragment);
  const Measurement measured = measure(
      {{"pair", compile(kVertex, check::Stage::Vertex), fragment}, {"alone", {}, fragment}}, "navi21", false);
  ASSERT_TRUE(measured.outcomes[0].statistics) << measured.outcomes[0].problem;
  EXPECT_EQ(measured.outcomes[0].statistics, measured.outcomes[1].statistics);
}

/// What others' compilers hand from stage to stage.
TEST_F(Driver, ABlockOfInputsCostsWhatItsMembersCost) {
  const char* block = R"(#version 450
layout(location = 0) in Surface { vec3 normal; vec2 uv; } from;
layout(location = 0) out vec4 color;
void main() { color = vec4(normalize(from.normal), from.uv.x * from.uv.y); }
)";
  const char* apart = R"(#version 450
layout(location = 0) in vec3 normal;
layout(location = 1) in vec2 uv;
layout(location = 0) out vec4 color;
void main() { color = vec4(normalize(normal), uv.x * uv.y); }
)";
  const Measurement measured = measure({{"block", {}, compile(block, check::Stage::Fragment)},
                                        {"apart", {}, compile(apart, check::Stage::Fragment)}},
                                       "navi21", false);
  ASSERT_TRUE(measured.outcomes[0].statistics) << measured.outcomes[0].problem;
  EXPECT_EQ(measured.outcomes[0].statistics, measured.outcomes[1].statistics);
}

/// Both stages in one module, whatever the file is called; the variables of each are its own.
TEST_F(Driver, AProgramMayBeOneModule) {
  constexpr std::string_view kProgram = R"(OpCapability Shader
OpMemoryModel Logical GLSL450
OpEntryPoint Vertex %vertex_main "place" %at %through %position
OpEntryPoint Fragment %fragment_main "shade" %shade %color
OpExecutionMode %fragment_main OriginUpperLeft
OpDecorate %at Location 3
OpDecorate %through Location 0
OpDecorate %position BuiltIn Position
OpDecorate %shade Location 0
OpDecorate %color Location 0
%void = OpTypeVoid
%main = OpTypeFunction %void
%float = OpTypeFloat 32
%vec4 = OpTypeVector %float 4
%in = OpTypePointer Input %vec4
%out = OpTypePointer Output %vec4
%at = OpVariable %in Input
%through = OpVariable %out Output
%position = OpVariable %out Output
%shade = OpVariable %in Input
%color = OpVariable %out Output
%vertex_main = OpFunction %void None %main
%1 = OpLabel
%2 = OpLoad %vec4 %at
OpStore %position %2
OpStore %through %2
OpReturn
OpFunctionEnd
%fragment_main = OpFunction %void None %main
%3 = OpLabel
%4 = OpLoad %vec4 %shade
%5 = OpFMul %vec4 %4 %4
OpStore %color %5
OpReturn
OpFunctionEnd
)";
  Spirv words;
  ASSERT_TRUE(spvtools::SpirvTools(SPV_ENV_VULKAN_1_1).Assemble(kProgram.data(), kProgram.size(), &words));
  const auto folder = std::filesystem::path(testing::TempDir()) / "lacquer_one_module";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  const auto write = [&](const char* name, const Spirv& module) {
    std::ofstream(folder / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(module.data()), static_cast<std::streamsize>(4 * module.size()));
  };
  write("program.spv", words);
  write("lone.vert.spv", compile(kVertex, check::Stage::Vertex));
  write("stage.spv", compile(kVertex, check::Stage::Vertex));
  Messages messages;
  const std::vector<ShaderCost> costs = measureCost({folder.string()}, false, messages);
  for (const Message& message : messages) ADD_FAILURE() << message.text;
  ASSERT_EQ(costs.size(), 1U);
  EXPECT_TRUE(costs[0].name.ends_with("program.spv"));
  ASSERT_FALSE(costs[0].gpus.empty());
  EXPECT_GT(costs[0].gpus[0].instructions, 4U);
  std::filesystem::remove_all(folder);
}

TEST_F(Driver, ABrokenModuleCostsOnlyItsOwnNumbers) {
  const Spirv good = compile(kShort, check::Stage::Fragment);
  const Spirv vertex = compile(kVertex, check::Stage::Vertex);
  Spirv half = good;
  half.resize(half.size() * 3 / 4);
  Spirv odd = good;
  for (size_t i = odd.size() - 12; i < odd.size(); ++i) odd[i] ^= 0x5aU;
  const Measurement measured = measure({{"good", vertex, good},
                                        {"none", vertex, {1, 2, 3}},
                                        {"vertex", vertex, vertex},
                                        {"half", vertex, half},
                                        {"odd", vertex, odd},
                                        {"long", vertex, compile(kLong, check::Stage::Fragment)}},
                                       "navi21", false);
  ASSERT_EQ(measured.outcomes.size(), 6U);
  EXPECT_TRUE(measured.outcomes[0].statistics) << measured.outcomes[0].problem;
  for (size_t i = 1; i < 5; ++i) {
    EXPECT_FALSE(measured.outcomes[i].statistics);
    EXPECT_NE(measured.outcomes[i].problem, "");
  }
  ASSERT_TRUE(measured.outcomes[5].statistics) << measured.outcomes[5].problem;
  EXPECT_GT(measured.outcomes[5].statistics->instructions, measured.outcomes[0].statistics->instructions);
}

/// The process of one is not another's: it goes on behind a module that it dies of, and when others end.
TEST_F(Driver, LivesForManyCalls) {
  const Spirv vertex = compile(kVertex, check::Stage::Vertex);
  const Subject good{"good", vertex, compile(kShort, check::Stage::Fragment)};
  std::vector<Subject> broken(3, good);
  broken[0].fragment = {1, 2, 3};
  broken[1].fragment.resize(good.fragment.size() * 3 / 4);
  for (size_t i = good.fragment.size() - 12; i < good.fragment.size(); ++i) broken[2].fragment[i] ^= 0x5aU;
  cost::Driver one("navi21");
  const Measurement first = one.measure({good}, false);
  ASSERT_TRUE(first.outcomes[0].statistics) << first.outcomes[0].problem;
  {
    cost::Driver other("gfx1100");
    EXPECT_TRUE(other.measure({good}, false).outcomes[0].statistics);
    for (const Subject& bad : broken) {
      EXPECT_FALSE(one.measure({bad}, false).outcomes[0].statistics);
      const Measurement again = one.measure({good, bad, good}, true);
      EXPECT_EQ(again.driver, first.driver);
      EXPECT_EQ(again.outcomes[0].statistics, first.outcomes[0].statistics);
      EXPECT_FALSE(again.outcomes[1].statistics);
      EXPECT_EQ(again.outcomes[2].statistics, first.outcomes[0].statistics);
      EXPECT_NE(again.outcomes[2].disassembly, "");
    }
  }
  EXPECT_TRUE(one.measure({}, false).outcomes.empty());
  EXPECT_EQ(one.measure({good}, false).outcomes[0].statistics, first.outcomes[0].statistics);
}

TEST_F(Driver, AnUnknownFamilyIsAProblem) {
  const Measurement measured =
      measure({{"short", {}, compile(kShort, check::Stage::Fragment)}}, "navi99", false);
  EXPECT_FALSE(measured.outcomes[0].statistics);
  EXPECT_NE(measured.outcomes[0].problem, "");
}

TEST_F(Driver, TheCallersEnvironmentIsLeftAlone) {
  ASSERT_EQ(std::getenv("RADV_FORCE_FAMILY"), nullptr);
  measure({{"short", {}, compile(kShort, check::Stage::Fragment)}}, "navi21", false);
  EXPECT_EQ(std::getenv("RADV_FORCE_FAMILY"), nullptr);
}

class Paths : public testing::Test {
protected:
  void SetUp() override {
    folder_ = testing::TempDir() + "lacquer_cost_paths";
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ + "/" + name, std::ios::binary) << bytes;
    return folder_ + "/" + name;
  }
  /// Of one shader, x, with these files.
  static std::string manifestOf(const std::string& files) {
    return R"({"lacquer": "0.2.0", "schema": 1, "files": [], "shaders": {"x": {"files": {)" + files +
           R"(}, "validated": {}, "template": "forward", "uniforms": [], "parameters": [], "textures": [],
              "inputs": [], "outputs": [], "proofs": {"safe": 0, "unproved": []}}}})";
  }
  std::string write(const std::string& name, const Spirv& words) const {
    return write(name,
                 std::string(reinterpret_cast<const char*>(words.data()), words.size() * sizeof(uint32_t)));
  }
  std::string folder_;
};

TEST_F(Paths, FilesFoldersAndManifests) {
  const std::string fragment = write("a.frag.spv", compile(kShort, check::Stage::Fragment));
  write("a.vert.spv", compile(kVertex, check::Stage::Vertex));
  Messages messages;
  EXPECT_EQ(measureCost({fragment, folder_}, false, messages).size(), 2U);
  std::filesystem::create_directories(folder_ + "/spirv");
  write("spirv/x.frag.spv", compile(kShort, check::Stage::Fragment));
  write("spirv/x.vert.spv", compile(kVertex, check::Stage::Vertex));
  write("manifest.json", manifestOf(R"("spirv": {"vert": "spirv/x.vert.spv", "frag": "spirv/x.frag.spv"})"));
  const std::vector<ShaderCost> costs = measureCost({folder_}, false, messages);
  ASSERT_EQ(costs.size(), 1U);
  EXPECT_EQ(costs[0].name, "x");
  EXPECT_GT(costs[0].spirv_instructions, 3U);
  EXPECT_EQ(costs[0].gpus.size(), unavailable().empty() ? kFamilies.size() : 0U);
  EXPECT_FALSE(hasError(messages));
}

TEST_F(Paths, WhatIsWrongIsSaid) {
  const auto codeOf = [](const std::string& path) {
    Messages messages;
    EXPECT_TRUE(measureCost({path}, false, messages).empty());
    return messages.empty() ? "" : messages[0].code;
  };
  EXPECT_EQ(codeOf(""), "file-unreadable");
  EXPECT_EQ(codeOf(folder_ + "/absent.spv"), "file-unreadable");
  EXPECT_EQ(codeOf(folder_), "no-spirv");
  EXPECT_EQ(codeOf(write("text.spv", std::string("this is text"))), "spirv-unreadable");
  EXPECT_EQ(codeOf(write("empty.spv", std::string())), "spirv-unreadable");
  for (const char* head : {R"("shaders": 1)", R"("lacquer": "0.2.0", "files": [], "shaders": {})",
                           R"("lacquer": "0.2.0", "schema": 2, "files": [], "shaders": {})",
                           R"("lacquer": "0.2.0", "schema": 1e300, "files": [], "shaders": {})",
                           R"("lacquer": "0.1.0", "schema": 1, "files": [], "shaders": {})"}) {
    write("manifest.json", "{" + std::string(head) + "}");
    EXPECT_EQ(codeOf(folder_), "no-manifest") << head;
  }
  write("manifest.json", manifestOf(R"("glsl": {"frag": "glsl/x.frag.glsl"})"));
  EXPECT_EQ(codeOf(folder_), "no-spirv");
  write("manifest.json", manifestOf(R"("spirv": {"frag": "../x.frag.spv"})"));
  EXPECT_EQ(codeOf(folder_), "wrong-path");
}

}  // namespace
}  // namespace lacquer::cost
