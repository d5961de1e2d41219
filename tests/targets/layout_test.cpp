// A block's declaration means the same bytes in GLSL (std140) and in HLSL, by reflection of what glslang made
// of it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>

#include "targets/samples.h"

namespace lacquer::targets {

using ir::Stage;
using ir::Type;
using ir::ValueId;

namespace {

struct Layouts {
  std::map<std::string, std::map<std::string, uint32_t>> offsets;  ///< struct, member -> offset
  std::map<uint32_t, std::string> names;
  std::vector<uint32_t> strides;  ///< of arrays
};

/// Reads a SPIR-V literal string that begins at a word.
std::string literal(const check::Spirv& words, size_t at) {
  std::string text;
  for (size_t k = 0;; ++k) {
    const char c = static_cast<char>(words[at + k / 4] >> (8 * (k % 4)) & 0xffU);
    if (c == 0) return text;
    text += c;
  }
}

/// The declared offsets, straight from the decorations; nested structs included.
Layouts reflect(const check::Spirv& words) {
  constexpr uint32_t kName = 5, kMemberName = 6, kDecorate = 71, kMemberDecorate = 72;
  constexpr uint32_t kArrayStride = 6, kOffset = 35;
  Layouts result;
  std::map<std::pair<uint32_t, uint32_t>, std::string> members;
  for (size_t at = 5; at < words.size(); at += words[at] >> 16) {
    const uint32_t op = words[at] & 0xffffU;
    if (op == kName) result.names[words[at + 1]] = literal(words, at + 2);
    if (op == kMemberName) members[{words[at + 1], words[at + 2]}] = literal(words, at + 3);
    if (op == kDecorate && words[at + 2] == kArrayStride) result.strides.push_back(words[at + 3]);
    if (op == kMemberDecorate && words[at + 3] == kOffset) {
      result.offsets[result.names[words[at + 1]]][members[{words[at + 1], words[at + 2]}]] = words[at + 4];
    }
  }
  return result;
}

/// A fragment shader that reads one field of each block.
ir::Module reader(Builder& b) {
  const ValueId v = b.varying("v", b.attribute("COLOR_0", Type::Vec4));
  b.module.outputs.clear();
  ValueId total = v;
  for (const ir::Block& block : b.module.blocks) {
    const std::string& field = block.fields[0].name;
    const ValueId read = b.field(fmt::format("{}.{}", block.instance, field), block.array != 0 ? 1 : -1);
    total = b.dag().add(total, b.dag().construct(Type::Vec4, {b.dag().component(read, 0)}));
  }
  b.color("color", total);
  return b.module;
}

void expectOffsets(const ir::Module& module) {
  for (const Target target : {Target::Glsl, Target::GlslGl, Target::Hlsl}) {
    const std::string text = print(module, Stage::Fragment, target);
    SCOPED_TRACE(text);
    const Layouts layouts = reflect(expectCompiles(text, Stage::Fragment, target));
    for (const ir::Block& block : module.blocks) {
      const std::string structure =
          target == Target::Hlsl && block.array == 0 ? block.name + "Block" : block.name;
      ASSERT_TRUE(layouts.offsets.contains(structure)) << structure;
      const auto& members = layouts.offsets.at(structure);
      for (const ir::BlockField& field : block.fields) {
        ASSERT_TRUE(members.contains(field.name)) << field.name;
        EXPECT_EQ(members.at(field.name), field.offset) << field.name;
      }
      if (block.array == 0) continue;
      ASSERT_FALSE(layouts.strides.empty());
      for (const uint32_t stride : layouts.strides) EXPECT_EQ(stride, block.size);
    }
  }
  // ESSL has no reflection here; its text declares the members in the same words.
  expectCompiles(print(module, Stage::Fragment, Target::Essl), Stage::Fragment, Target::Essl);
}

}  // namespace

TEST(Layout, HolesAreTheSameInBoth) {
  Builder b;
  b.block(ir::BlockRole::Frame, "Frame", "frame",
          {{"a", Type::Float},
           {"b", Type::Vec2},
           {"c", Type::Float},
           {"d", Type::Vec3},
           {"e", Type::Float},
           {"f", Type::Vec3},
           {"g", Type::Vec2},
           {"h", Type::Mat4},
           {"i", Type::Int},
           {"j", Type::Vec4},
           {"k", Type::Float}});
  expectOffsets(reader(b));
}

TEST(Layout, EveryPairOfTypes) {
  for (const Type first : {Type::Float, Type::Int, Type::Vec2, Type::Vec3, Type::Vec4}) {
    for (const Type second : {Type::Float, Type::Vec2, Type::Vec3, Type::Vec4, Type::Mat4}) {
      Builder b;
      b.block(ir::BlockRole::Material, "Material", "material",
              {{"z", Type::Vec4}, {"a", first}, {"b", second}, {"c", first}, {"d", second}});
      expectOffsets(reader(b));
    }
  }
}

TEST(Layout, LightArray) {
  Builder b;
  b.block(ir::BlockRole::Lights, "Light", "light",
          {{"position", Type::Vec3},
           {"cone", Type::Vec2},
           {"color", Type::Vec3},
           {"type", Type::Int},
           {"range", Type::Float}},
          8);
  expectOffsets(reader(b));
}

TEST(Layout, AnElementMayBeLargerThanItsFields) {
  Builder b;
  b.block(ir::BlockRole::Lights, "Light", "light",
          {{"color", Type::Vec3}, {"range", Type::Float}, {"x", Type::Int}}, 4);
  b.module.blocks[0].size = 64;
  const ir::Module module = reader(b);
  expectOffsets(module);
  EXPECT_NE(print(module, Stage::Fragment, Target::Glsl).find("lacquer_padding_"), std::string::npos);
}

TEST(Layout, NoPaddingWithoutNeed) {
  Builder b;
  b.block(ir::BlockRole::Frame, "Frame", "frame",
          {{"h", Type::Vec3},
           {"a", Type::Float},
           {"b", Type::Vec2},
           {"c", Type::Vec2},
           {"d", Type::Vec3},
           {"e", Type::Vec4}});
  EXPECT_EQ(print(reader(b), Stage::Fragment, Target::Hlsl).find("lacquer_padding_"), std::string::npos);
}

}  // namespace lacquer::targets
