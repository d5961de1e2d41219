// Every language accepts what is right and says where it is wrong.
#include <gtest/gtest.h>

#include <thread>

#include "check/check.h"
#include "check/shaders.h"

namespace lacquer::check {
namespace {

std::string allOf(const Diagnostics& list) {
  std::string text;
  for (const Diagnostic& diagnostic : list) text += format(diagnostic) + "\n";
  return text;
}

struct Good {
  const char* name;
  const std::string& text;
  Target target;
  Stage stage;
};

class GoodShader : public testing::TestWithParam<Good> {};

TEST_P(GoodShader, compilesAndIsValid) {
  const Good& good = GetParam();
  const auto words = compile(good.text, good.target, good.stage, "good");
  ASSERT_TRUE(words) << allOf(words.error());
  if (good.target == Target::Essl) {
    EXPECT_TRUE(words->empty());
    return;
  }
  const bool open_gl = good.target == Target::GlslGl;
  const Diagnostics found = validate(*words, open_gl, "good");
  EXPECT_TRUE(found.empty()) << allOf(found);
  ASSERT_GT(words->size(), 5u);
  EXPECT_EQ((*words)[1], open_gl ? 0x10000u : 0x10300u);
}

INSTANTIATE_TEST_SUITE_P(
    Compile, GoodShader,
    testing::Values(Good{"VulkanFragment", kVulkanFragment, Target::Glsl, Stage::Fragment},
                    Good{"VulkanVertex", kVulkanVertex, Target::Glsl, Stage::Vertex},
                    Good{"OpenGlFragment", kOpenGlFragment, Target::GlslGl, Stage::Fragment},
                    Good{"EsslFragment", kEsslFragment, Target::Essl, Stage::Fragment},
                    Good{"EsslVertex", kEsslVertex, Target::Essl, Stage::Vertex},
                    Good{"HlslFragment", kHlslFragment, Target::Hlsl, Stage::Fragment},
                    Good{"HlslVertex", kHlslVertex, Target::Hlsl, Stage::Vertex}),
    [](const auto& info) { return std::string(info.param.name); });

std::string errorsOf(std::string_view text, Target target, Stage stage = Stage::Fragment) {
  const auto words = compile(text, target, stage, "bad");
  return words ? "compiled" : allOf(words.error());
}

TEST(Compile, vulkanErrorsPointAtTheToken) {
  EXPECT_EQ(errorsOf("#version 450\n"
                     "layout(location = 0) out vec4 result;\n"
                     "void main() {\n"
                     "\tfloat food = 1.0;\n"
                     "\tresult = vec4(food + foo);\n"
                     "}\n",
                     Target::Glsl),
            "bad:5:23: error: 'foo' : undeclared identifier [glslang]\n"
            "  \tresult = vec4(food + foo);\n"
            "  \t                     ^~~\n");
}

TEST(Compile, vulkanWantsBindings) {
  EXPECT_EQ(errorsOf("#version 450\n"
                     "layout(location = 0) out vec4 result;\n"
                     "uniform vec4 color;\n"
                     "void main() { result = color; }\n",
                     Target::Glsl),
            "bad:3:1: error: 'non-opaque uniforms outside a block' : not allowed when using GLSL for Vulkan "
            "[glslang]\n"
            "  uniform vec4 color;\n"
            "  ^~~~~~~~~~~~~~~~~~~\n");
}

TEST(Compile, openGlHasNoDescriptorSets) {
  EXPECT_EQ(errorsOf("#version 450\n"
                     "layout(location = 0) out vec4 result;\n"
                     "layout(set = 1, binding = 0) uniform Material { vec4 color; };\n"
                     "void main() { result = color; }\n",
                     Target::GlslGl),
            "bad:3:1: error: 'descriptor set' : only allowed when using GLSL for Vulkan [glslang]\n"
            "  layout(set = 1, binding = 0) uniform Material { vec4 color; };\n"
            "  ^~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~\n");
}

TEST(Compile, openGlTextHasNoSpecializationConstants) {
  EXPECT_EQ(errorsOf("#version 450\n"
                     "layout(constant_id = 0) const float scale = 1.0;\n"
                     "layout(location = 0) out vec4 result;\n"
                     "void main() { result = vec4(scale); }\n",
                     Target::GlslGl),
            "bad:2:8: error: 'constant_id' : only allowed when generating SPIR-V [glslang]\n"
            "  layout(constant_id = 0) const float scale = 1.0;\n"
            "         ^~~~~~~~~~~\n");
}

TEST(Compile, esslWantsPrecision) {
  EXPECT_EQ(errorsOf("#version 300 es\n"
                     "out vec4 result;\n"
                     "void main() { result = vec4(1.0); }\n",
                     Target::Essl),
            "bad:2:1: error: 'float' : type requires declaration of default precision qualifier [glslang]\n"
            "  out vec4 result;\n"
            "  ^~~~~~~~~~~~~~~~\n");
}

TEST(Compile, esslHasNoBindings) {
  EXPECT_NE(errorsOf("#version 300 es\n"
                     "precision highp float;\n"
                     "layout(binding = 1) uniform sampler2D map;\n"
                     "out vec4 result;\n"
                     "void main() { result = texture(map, vec2(0.0)); }\n",
                     Target::Essl)
                .find("bad:3:8: error: 'binding' : not supported"),
            std::string::npos);
}

TEST(Compile, hlslErrorsHaveALine) {
  EXPECT_EQ(errorsOf("float4 main() : SV_Target {\n"
                     "  float3 z = float3(1, 1, 1) * bar(2);\n"
                     "  return float4(z, 1);\n"
                     "}\n",
                     Target::Hlsl),
            "bad:2:32: error: 'bar' : no matching overloaded function found [glslang]\n"
            "    float3 z = float3(1, 1, 1) * bar(2);\n"
            "                                 ^~~\n"
            "bad:2:3: error: 'declaration' : Expected [glslang]\n"
            "    float3 z = float3(1, 1, 1) * bar(2);\n"
            "    ^~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~\n"
            "bad:2:38: error: HLSL parsing failed. [glslang]\n"
            "    float3 z = float3(1, 1, 1) * bar(2);\n"
            "                                       ^\n");
}

TEST(Compile, linkErrorsHaveNoLine) {
  EXPECT_EQ(
      errorsOf("#version 450\n"
               "float half_of(float x);\n"
               "layout(location = 0) out float y;\n"
               "void main() { y = half_of(1.0); }\n",
               Target::Glsl),
      "bad: error: Linking fragment stage: No function definition (body) found: half_of(f1; [glslang]\n");
}

TEST(Compile, dialectsAreNotMixed) {
  EXPECT_EQ(errorsOf(kEsslFragment, Target::GlslGl),
            "bad:1:1: error: the shader does not start with `#version 450` [glslang]\n"
            "  #version 300 es\n"
            "  ^~~~~~~~~~~~~~~\n");
  EXPECT_EQ(errorsOf("// head\n" + kVulkanFragment, Target::Essl),
            "bad:2:1: error: the shader does not start with `#version 300 es` [glslang]\n"
            "  #version 450\n"
            "  ^~~~~~~~~~~~\n");
  EXPECT_EQ(errorsOf("void main() {}\n", Target::Glsl),
            "bad: error: the shader does not start with `#version 450` [glslang]\n");
  EXPECT_EQ(errorsOf("// head\n" + kVulkanFragment, Target::Glsl), "compiled");
}

TEST(Compile, emptyTextFails) {
  for (const Target target : {Target::Glsl, Target::GlslGl, Target::Essl, Target::Hlsl}) {
    EXPECT_NE(errorsOf("", target), "compiled");
  }
}

TEST(Compile, theTextNeedsNoTerminator) {
  const std::string more = kVulkanFragment + "this is not part of the shader";
  const auto words = compile(std::string_view(more).substr(0, kVulkanFragment.size()), Target::Glsl,
                             Stage::Fragment, "good");
  ASSERT_TRUE(words) << allOf(words.error());
}

TEST(Compile, threadsDoNotDisturbEachOther) {
  const auto fragment = compile(kVulkanFragment, Target::Glsl, Stage::Fragment, "good");
  const auto hlsl = compile(kHlslVertex, Target::Hlsl, Stage::Vertex, "good");
  ASSERT_TRUE(fragment && hlsl);
  constexpr int kThreads = 6;
  std::vector<int> wrong(kThreads, 0);
  std::vector<std::thread> threads;
  threads.reserve(kThreads);
  for (int& count : wrong) {
    threads.emplace_back([&count, &fragment, &hlsl] {
      for (int i = 0; i < 8; ++i) {
        count += compile(kVulkanFragment, Target::Glsl, Stage::Fragment, "good") != fragment;
        count += compile(kHlslVertex, Target::Hlsl, Stage::Vertex, "good") != hlsl;
        count += !compile(kEsslFragment, Target::Essl, Stage::Fragment, "good").has_value();
        count +=
            compile("#version 450\nvoid main() { x; }\n", Target::Glsl, Stage::Vertex, "bad").has_value();
        count += !validate(*fragment, false, "good").empty();
        count += !reflectBlocks(*hlsl).has_value();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const int count : wrong) EXPECT_EQ(count, 0);
}

}  // namespace
}  // namespace lacquer::check
