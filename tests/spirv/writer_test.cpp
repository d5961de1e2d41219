// What the words are: whole disassemblies (LACQUER_BLESS=1 renews them), and the properties that a validator
// does not see.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <spirv-tools/libspirv.hpp>
#include <spirv/unified1/spirv.hpp>

#include "check/check.h"
#include "support/cases.h"
#include "targets/legalize.h"
#include "targets/samples.h"

namespace lacquer::spirv_test {

using ir::Op;
using ir::Rate;
using ir::Stage;
using ir::Type;
using ir::ValueId;
using targets::Builder;

namespace {

std::string disassembly(const check::Spirv& words) {
  std::string text;
  const spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_1);
  tools.Disassemble(words, &text,
                    SPV_BINARY_TO_TEXT_OPTION_NO_HEADER | SPV_BINARY_TO_TEXT_OPTION_INDENT |
                        SPV_BINARY_TO_TEXT_OPTION_FRIENDLY_NAMES);
  return text;
}

/// Writes a stage; fails the test when it is not valid.
check::Spirv write(ir::Module module, Stage stage, bool debug = false) {
  const std::vector<std::string> broken = ir::verify(module);
  EXPECT_TRUE(broken.empty()) << broken.front();
  const check::Spirv words = targets::writeSpirv(module, schedule::schedule(module, stage), {debug});
  const Diagnostics wrong = check::validate(words, false, "shader");
  EXPECT_TRUE(wrong.empty()) << format(wrong.front()) << "\n" << disassembly(words);
  return words;
}

void expectText(const std::string& name, const ir::Module& module, Stage stage, bool debug = false) {
  const check::Spirv words = write(module, stage, debug);
  const char* extension = stage == Stage::Vertex ? "vert" : "frag";
  const std::string file = fmt::format("tests/spirv/expected/{}.{}.spvasm", name, extension);
  test::expectFile(test::sourceFolder() / file, disassembly(words));
}

/// The opcodes of a module's function.
std::vector<uint32_t> opcodes(const check::Spirv& words) {
  std::vector<uint32_t> list;
  for (size_t at = 5; at < words.size(); at += words[at] >> spv::WordCountShift) {
    const uint32_t op = words[at] & spv::OpCodeMask;
    if (op == spv::OpFunction || !list.empty()) list.push_back(op);
  }
  return list;
}

ptrdiff_t count(const check::Spirv& words, spv::Op op) {
  const std::vector<uint32_t> list = opcodes(words);
  return std::count(list.begin(), list.end(), uint32_t{op});
}

ptrdiff_t position(const check::Spirv& words, spv::Op op) {
  const std::vector<uint32_t> list = opcodes(words);
  return std::find(list.begin(), list.end(), uint32_t{op}) - list.begin();
}

/// A builder with a frame, four lights and a vec3 that varies.
struct Lit : Builder {
  Lit() {
    block(ir::BlockRole::Frame, "Frame", "frame", {{"eye", Type::Vec3}, {"light_count", Type::Int}});
    block(ir::BlockRole::Lights, "Light", "light", {{"direction", Type::Vec3}, {"power", Type::Float}}, 4);
    module.light_groups = {{0, -1}};
    v = varying("v", attribute("NORMAL", Type::Vec3));
    module.outputs.clear();
  }
  ValueId sum(ValueId each, uint32_t group = 0) { return dag().make(Op::SumOverLights, {each}, group); }
  void show(ValueId vec3) { color("color", dag().construct(Type::Vec4, {vec3, dag().constant(1)})); }
  ValueId v;
};

}  // namespace

TEST(Writer, LitFragment) { expectText("lit", targets::litSample({}), Stage::Fragment); }
TEST(Writer, LitVertex) { expectText("lit", targets::litSample({}), Stage::Vertex); }
TEST(Writer, FixedFragment) { expectText("fixed", targets::fixedSample(), Stage::Fragment); }
TEST(Writer, Lookups) { expectText("lookups", targets::lookupsSample(), Stage::Fragment); }
TEST(Writer, EveryOp) { expectText("every_op", targets::everyOpSample(), Stage::Fragment); }
TEST(Writer, DebugFragment) { expectText("lit_debug", targets::litSample({3, 2}), Stage::Fragment, true); }

TEST(Writer, WhatDoesNotChangeWithTheLightIsBeforeTheLoop) {
  Lit b;
  ir::Dag& dag = b.dag();
  // One value for the loop alone, one for what follows it too, and a splat that only the loop needs.
  const ValueId root = dag.make(Op::Sqrt, {dag.component(b.v, 0)});
  const ValueId unit = dag.make(Op::Normalize, {b.v});
  const ValueId each = dag.add(dag.make(Op::Min, {b.field("light.direction"), root}), unit);
  b.show(dag.add(b.sum(each), unit));
  const check::Spirv words = write(b.module, Stage::Fragment);
  const std::vector<uint32_t> list = opcodes(words);
  const auto merge = std::find(list.begin(), list.end(), uint32_t{spv::OpLoopMerge});
  const auto tail = [&](spv::Op op) { return std::count(merge, list.end(), uint32_t{op}); };
  EXPECT_EQ(tail(spv::OpExtInst), 1) << "min; sqrt and normalize are outside\n" << disassembly(words);
  // The one after the loop makes the output.
  EXPECT_EQ(tail(spv::OpCompositeConstruct), 1) << disassembly(words);
  EXPECT_EQ(count(words, spv::OpExtInst), 3);
}

TEST(Writer, LoopsOverOneGroupDoNotShareTheirBodies) {
  Lit b;
  ir::Dag& dag = b.dag();
  const ValueId facing = dag.make(Op::Dot, {b.v, b.field("light.direction")});
  const ValueId first = b.sum(facing);
  const ValueId second = b.sum(dag.mul(facing, first));
  b.show(dag.construct(Type::Vec3, {second}));
  const check::Spirv words = write(b.module, Stage::Fragment);
  EXPECT_EQ(count(words, spv::OpLoopMerge), 2);
  EXPECT_EQ(count(words, spv::OpDot), 2);
}

TEST(Writer, SumsOfOneGroupShareALoop) {
  Lit b;
  b.module.light_groups = {{0, 2}, {2, 2}};
  ir::Dag& dag = b.dag();
  const auto field = [&](uint32_t index, Type type, int32_t group) {
    return dag.input({ir::InputKind::BlockField, "light.x", type, Rate::Light, {}, 1, index, -1, group});
  };
  const ValueId a = b.sum(dag.mul(field(0, Type::Vec3, 0), b.v));
  const ValueId c = b.sum(dag.mul(field(1, Type::Float, 0), dag.component(b.v, 1)));
  const ValueId d = b.sum(dag.mul(field(0, Type::Vec3, 1), b.v), 1);
  const ValueId e = b.sum(dag.component(b.v, 2), 1);
  b.show(dag.add(dag.mul(a, c), dag.mul(d, e)));
  const check::Spirv words = write(b.module, Stage::Fragment);
  EXPECT_EQ(count(words, spv::OpLoopMerge), 2);
  EXPECT_EQ(count(words, spv::OpPhi), 6);
  EXPECT_EQ(count(words, spv::OpVariable), 0) << "sums live in registers";
}

TEST(Writer, DerivativesComeBeforeADiscard) {
  Builder b;
  ir::Dag& dag = b.dag();
  const ValueId uv = b.varying("uv", b.attribute("TEXCOORD_0", Type::Vec2));
  b.module.outputs.clear();
  b.discard(dag.make(Op::Less, {dag.component(uv, 0), dag.constant(0.5)}));
  // Used once, so that it has no variable.
  const ValueId texel = dag.make(Op::Texture, {b.texture("map", Type::Texture2D), uv});
  b.color("color", dag.add(texel, dag.swizzle(dag.make(Op::DFdx, {uv}), {{0, 1, 0, 1}})));
  const check::Spirv words = write(b.module, Stage::Fragment);
  EXPECT_LT(position(words, spv::OpImageSampleImplicitLod), position(words, spv::OpKill))
      << disassembly(words);
  EXPECT_LT(position(words, spv::OpDPdx), position(words, spv::OpKill)) << disassembly(words);
  EXPECT_GT(position(words, spv::OpFAdd), position(words, spv::OpKill)) << disassembly(words);
}

TEST(Writer, NothingComesAfterADiscardThatAlwaysHappens) {
  Builder b;
  b.discard(b.dag().boolean(true));
  b.color("color", b.dag().constant(Type::Vec4, {}));
  const check::Spirv words = write(b.module, Stage::Fragment);
  EXPECT_EQ(opcodes(words),
            (std::vector<uint32_t>{spv::OpFunction, spv::OpLabel, spv::OpKill, spv::OpFunctionEnd}))
      << disassembly(words);
}

TEST(Writer, AFieldIsLoadedOnce) {
  Lit b;
  ir::Dag& dag = b.dag();
  const ValueId eye = b.field("frame.eye");
  b.show(dag.add(dag.mul(eye, b.v), dag.make(Op::Normalize, {eye})));
  EXPECT_EQ(count(write(b.module, Stage::Fragment), spv::OpAccessChain), 1);
}

TEST(Writer, ALoneComponentIsLoadedAlone) {
  Lit b;
  b.show(b.dag().mul(b.v, b.dag().component(b.field("frame.eye"), 1)));
  const check::Spirv words = write(b.module, Stage::Fragment);
  EXPECT_EQ(count(words, spv::OpAccessChain), 1);
  EXPECT_EQ(count(words, spv::OpCompositeExtract), 0) << disassembly(words);
  EXPECT_EQ(count(words, spv::OpVectorTimesScalar), 1) << disassembly(words);
}

TEST(Writer, VerticesSampleTheFirstLevel) {
  Builder b;
  const ValueId map = b.texture("height", Type::Texture2D);
  b.position(b.dag().make(Op::Texture, {map, b.attribute("TEXCOORD_0", Type::Vec2)}));
  EXPECT_EQ(count(write(b.module, Stage::Vertex), spv::OpImageSampleExplicitLod), 1);
}

TEST(Writer, ADotOfFloatsIsAProduct) {
  Lit b;
  ir::Dag& dag = b.dag();
  const ValueId x = dag.component(b.v, 0);
  b.show(dag.construct(Type::Vec3, {dag.make(Op::Dot, {x, dag.component(b.v, 1)})}));
  const check::Spirv words = write(b.module, Stage::Fragment);
  EXPECT_EQ(count(words, spv::OpDot), 0);
  EXPECT_EQ(count(words, spv::OpFMul), 1) << disassembly(words);
}

TEST(Writer, NumbersBeyondFloatAreTheLargestFloat) {
  Lit b;
  b.show(b.dag().mul(b.v, b.dag().constant(1e300)));
  EXPECT_NE(disassembly(write(b.module, Stage::Fragment)).find("%float_3_40282347e_38"), std::string::npos);
}

TEST(Writer, NoDebugNoNamesOfValues) {
  const check::Spirv lean = write(targets::litSample({}), Stage::Fragment);
  const std::string text = disassembly(lean);
  EXPECT_EQ(text.find("OpLine"), std::string::npos);
  EXPECT_EQ(text.find("\"base_color\""), text.rfind("\"base_color\"")) << "the field's, not the value's";
  EXPECT_NE(text.find("OpName %base_color_texture \"base_color_texture\""), std::string::npos) << text;
}

}  // namespace lacquer::spirv_test
