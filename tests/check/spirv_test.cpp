// The validator, the optimizer and the reflection.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "check/check.h"
#include "check/reflect.h"
#include "check/shaders.h"

namespace lacquer::check {
namespace {

Spirv wordsOf(const std::string& text, Target target, Stage stage) {
  const auto words = compile(text, target, stage, "good");
  EXPECT_TRUE(words) << (words ? "" : format(words.error().front()));
  return words.value_or(Spirv());
}

/// Where the first instruction with this opcode begins.
size_t findOp(const Spirv& words, uint32_t opcode) {
  for (size_t at = 5; at < words.size(); at += std::max(1u, words[at] >> 16)) {
    if ((words[at] & 0xffff) == opcode) return at;
  }
  ADD_FAILURE() << "no opcode " << opcode;
  return 0;
}

constexpr uint32_t kOpFMul = 133;
constexpr uint32_t kOpLoad = 61;
constexpr uint32_t kOpMatrixTimesVector = 145;

std::string blockText(const std::vector<Block>& blocks) {
  std::string text;
  for (const Block& block : blocks) {
    text += block.name + " set " + std::to_string(block.set) + " binding " + std::to_string(block.binding) +
            " size " + std::to_string(block.size) + "\n";
    for (const BlockMember& member : block.members) {
      text +=
          "  " + member.name + " " + std::to_string(member.offset) + "+" + std::to_string(member.size) + "\n";
    }
  }
  return text;
}

TEST(Validate, wrongTypesAreCaught) {
  Spirv words = wordsOf(kVulkanFragment, Target::Glsl, Stage::Fragment);
  ASSERT_TRUE(validate(words, false, "m.spv").empty());
  const size_t at = findOp(words, kOpMatrixTimesVector);
  words[at] = (words[at] & 0xffff0000u) | kOpFMul;
  const Diagnostics found = validate(words, false, "m.spv");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].code, "spirv-val");
  EXPECT_EQ(found[0].place.file, "m.spv");
  EXPECT_NE(found[0].message.find("FMul"), std::string::npos) << found[0].message;
  EXPECT_NE(found[0].excerpt.find("OpFMul"), std::string::npos) << found[0].excerpt;
}

TEST(Validate, brokenModulesAreCaught) {
  EXPECT_EQ(validate({}, false, "m.spv").size(), 1u);
  EXPECT_EQ(validate({1, 2, 3}, false, "m.spv").size(), 1u);
  Spirv words = wordsOf(kVulkanFragment, Target::Glsl, Stage::Fragment);
  words.pop_back();
  EXPECT_TRUE(hasError(validate(words, false, "m.spv")));
}

TEST(Validate, theEnvironmentMatters) {
  const Spirv vulkan = wordsOf(kVulkanFragment, Target::Glsl, Stage::Fragment);
  EXPECT_TRUE(hasError(validate(vulkan, true, "m.spv")));  // SPIR-V 1.3 is too new for OpenGL 4.5
}

TEST(Optimize, keepsTheModuleValidAndMakesItSmaller) {
  const Spirv words = wordsOf(kVulkanFragment, Target::Glsl, Stage::Fragment);
  const auto smaller = optimize(words, "m.spv");
  ASSERT_TRUE(smaller);
  EXPECT_LT(smaller->size(), words.size());
  EXPECT_TRUE(validate(*smaller, false, "m.spv").empty());
}

TEST(Optimize, brokenModulesFail) {
  Spirv words = wordsOf(kVulkanFragment, Target::Glsl, Stage::Fragment);
  words[findOp(words, kOpLoad) + 1] = 0xffff;
  const auto result = optimize(words, "m.spv");
  ASSERT_FALSE(result);
  EXPECT_TRUE(hasError(result.error()));
  EXPECT_EQ(result.error()[0].place.file, "m.spv");
}

TEST(ReflectBlocks, vulkanGlsl) {
  const auto blocks = reflectBlocks(wordsOf(kVulkanFragment, Target::Glsl, Stage::Fragment));
  ASSERT_TRUE(blocks);
  EXPECT_EQ(blockText(*blocks),
            "Material set 0 binding 0 size 224\n"
            "  color 0+16\n"
            "  tint 16+12\n"
            "  ior 28+4\n"
            "  turn 32+48\n"
            "  world 80+64\n"
            "  lights 144+48\n"
            "  weights 192+32\n");
}

TEST(ReflectBlocks, setsAndBindings) {
  const auto blocks = reflectBlocks(wordsOf(kVulkanVertex, Target::Glsl, Stage::Vertex));
  ASSERT_TRUE(blocks);
  EXPECT_EQ(blockText(*blocks), "Frame set 1 binding 2 size 64\n  view 0+64\n");
}

TEST(ReflectBlocks, hlsl) {
  const auto blocks = reflectBlocks(wordsOf(kHlslFragment, Target::Hlsl, Stage::Fragment));
  ASSERT_TRUE(blocks);
  EXPECT_EQ(blockText(*blocks),
            "Material set 0 binding 0 size 80\n"
            "  color 0+16\n"
            "  tint 16+12\n"
            "  ior 28+4\n"
            "  turn 32+48\n"
            "Frame set 0 binding 1 size 64\n"
            "  view 0+64\n");
}

TEST(ReflectBlocks, hlslPacksOtherwiseThanStd140) {
  const Spirv words = wordsOf(
      "cbuffer M : register(b2) { float ior; float3 tint; };\n"
      "float4 main() : SV_Target { return float4(tint, ior); }\n",
      Target::Hlsl, Stage::Fragment);
  const auto blocks = reflectBlocks(words);
  ASSERT_TRUE(blocks);
  EXPECT_EQ(blockText(*blocks), "M set 0 binding 2 size 16\n  ior 0+4\n  tint 4+12\n");
}

TEST(HlslBindings, doNotCollide) {
  const Spirv words = wordsOf(kHlslFragment, Target::Hlsl, Stage::Fragment);
  std::vector<uint32_t> bindings;
  for (size_t at = 5; at < words.size(); at += words[at] >> 16) {
    if ((words[at] & 0xffff) == 71 && words[at + 2] == 33)
      bindings.push_back(words[at + 3]);  // OpDecorate, Binding
  }
  std::sort(bindings.begin(), bindings.end());
  EXPECT_EQ(bindings,
            (std::vector<uint32_t>{kHlslBufferShift, kHlslBufferShift + 1, kHlslTextureShift,
                                   kHlslTextureShift + 1, kHlslSamplerShift, kHlslSamplerShift + 1}));
}

TEST(ReflectBlocks, nestedStructsRowMajorAndArraysOfBlocks) {
  const std::string text = R"(#version 450
struct Light { vec3 color; float range; mat2 turn; };
layout(row_major, set = 0, binding = 4, std140) uniform Lights {
  Light lights[2];
  mat4x3 world;
  int count;
} all[2];
layout(set = 0, binding = 3, std140) buffer Storage { vec4 ignored; } storage;
layout(push_constant) uniform Push { vec4 ignored; } push;
layout(location = 0) out vec4 result;
void main() {
  result = storage.ignored + push.ignored + vec4(all[1].lights[1].color * all[0].world[3], float(all[0].count));
}
)";
  const auto blocks = reflectBlocks(wordsOf(text, Target::Glsl, Stage::Fragment));
  ASSERT_TRUE(blocks);
  EXPECT_EQ(blockText(*blocks),
            "Lights set 0 binding 4 size 148\n  lights 0+96\n  world 96+48\n  count 144+4\n");
}

TEST(ReflectBlocks, namesMayBeMissing) {
  Spirv words = wordsOf(kVulkanVertex, Target::Glsl, Stage::Vertex);
  for (size_t at = 5; at < words.size();) {
    const uint32_t length = words[at] >> 16;
    const uint32_t opcode = words[at] & 0xffff;
    if (opcode == 5 || opcode == 6) {  // OpName, OpMemberName
      words.erase(words.begin() + static_cast<ptrdiff_t>(at),
                  words.begin() + static_cast<ptrdiff_t>(at + length));
    } else {
      at += length;
    }
  }
  const auto blocks = reflectBlocks(words);
  ASSERT_TRUE(blocks);
  EXPECT_EQ(blockText(*blocks), " set 1 binding 2 size 64\n   0+64\n");
}

TEST(ToolVersions, nameBothWithNumbers) {
  const std::string text = toolVersions();
  unsigned major = 0, year = 0;
  EXPECT_EQ(std::sscanf(text.c_str(), "glslang %u.%*u.%*u, SPIRV-Tools v%u.", &major, &year), 2) << text;
  EXPECT_GT(major, 0U);
  EXPECT_GT(year, 2000U);
}

TEST(ReflectBlocks, brokenModulesFail) {
  EXPECT_FALSE(reflectBlocks({}));
  EXPECT_FALSE(reflectBlocks({1, 2, 3}));
  Spirv words = wordsOf(kVulkanVertex, Target::Glsl, Stage::Vertex);
  // Without its offset a member has no place: nothing must be made up.
  for (size_t at = 5; at < words.size(); at += words[at] >> 16) {
    if ((words[at] & 0xffff) != 72 || words[at + 3] != 35) continue;  // OpMemberDecorate ... Offset
    const auto begin = words.begin() + static_cast<ptrdiff_t>(at);
    words.erase(begin, begin + (words[at] >> 16));
    break;
  }
  const auto blocks = reflectBlocks(words);
  ASSERT_FALSE(blocks);
  EXPECT_EQ(format(blocks.error()[0]),
            "error: member 0 ('view') of block 'Frame' has no offset [spirv-reflection]");
}

}  // namespace
}  // namespace lacquer::check
