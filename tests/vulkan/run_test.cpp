// The runner by itself: what goes in reaches the shader, what the shader writes comes back, and what cannot
// be run is said. Without a Vulkan driver these tests are skipped.
#include "vulkan/run.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "check/check.h"

namespace lacquer::vulkan {
namespace {

/// One for the whole program. Null, and a loud skip, where there is none.
const Device* device() {
  static const Result<Device> kDevice = Device::open();
  return kDevice ? &*kDevice : nullptr;
}

#define NEEDS_DEVICE() \
  if (device() == nullptr) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine"

std::vector<uint32_t> compiled(const std::string& body) {
  const auto words = check::compile("#version 450\n" + body, Target::Glsl, check::Stage::Fragment, "test");
  EXPECT_TRUE(words) << body << (words ? "" : format(words.error()[0]));
  return words.value_or(check::Spirv{});
}

std::shared_ptr<const std::vector<Texel>> texels(std::vector<Texel> list) {
  return std::make_shared<const std::vector<Texel>>(std::move(list));
}

Outcome ran(const Work& work) {
  Result<Outcome> outcome = device()->run(work);
  EXPECT_TRUE(outcome) << (outcome ? "" : format(outcome.error()[0]));
  return outcome.value_or(Outcome{});
}

std::string errorOf(const Work& work) {
  const Result<Outcome> outcome = device()->run(work);
  return outcome ? "" : format(outcome.error()[0]);
}

/// A thousand numbers of all sizes.
std::vector<float> numbers(size_t count) {
  std::vector<float> list;
  for (size_t i = 0; i < count; ++i) {
    list.push_back(std::ldexp(1 + static_cast<float>(i % 97) / 97, static_cast<int>(i % 61) - 30));
    if (i % 3 == 0) list.back() = -list.back();
  }
  return list;
}

TEST(VulkanRun, InputsComeBackUnchanged) {
  NEEDS_DEVICE();
  Work work;
  work.fragment = compiled(
      "layout(location = 0) in vec3 a;\nlayout(location = 2) in float b;\n"
      "layout(location = 0) out vec4 c;\nlayout(location = 1) out vec4 d;\n"
      "void main() { c = vec4(a, b); d = vec4(dFdx(a) + dFdy(a), b + b); }\n");
  work.points = 10000;  // more than one submission
  work.inputs = {{3, numbers(30000)}, {1, numbers(10000)}};
  const Outcome outcome = ran(work);
  ASSERT_EQ(outcome.outputs.size(), 2U);
  for (size_t i = 0; i < work.points; ++i) {
    for (size_t c = 0; c < 3; ++c) {
      ASSERT_EQ(outcome.outputs[0][4 * i + c], work.inputs[0].values[3 * i + c]) << i;
      ASSERT_EQ(outcome.outputs[1][4 * i + c], 0) << i;
    }
    ASSERT_EQ(outcome.outputs[0][4 * i + 3], work.inputs[1].values[i]) << i;
    ASSERT_EQ(outcome.outputs[1][4 * i + 3], 2 * work.inputs[1].values[i]) << i;
    ASSERT_FALSE(outcome.discarded[i]) << i;
  }
}

/// Integers stay what they are, also where a float would not hold them.
TEST(VulkanRun, IntegersComeBackUnchanged) {
  NEEDS_DEVICE();
  Work work;
  work.fragment = compiled(
      "layout(location = 0) in float a;\nlayout(location = 1) flat in int b;\n"
      "layout(location = 3) flat in uvec2 c;\nlayout(location = 0) out vec4 d;\n"
      "void main() { d = vec4(a, b, c.x & 0xffffu, c.y >> 16u); }\n");
  work.points = 3;
  work.inputs = {{1, {0.5F, 1, 2}, {}},
                 {1, {}, {7, std::bit_cast<uint32_t>(-3), std::bit_cast<uint32_t>(-65536)}},
                 {2, {}, {16777217, 0x70000, 3, 0xffffffff, 5, 0}}};
  for (const bool quads : {false, true}) {
    if (quads) {
      work.quads = true;
      work.points = 4;
      work.inputs[0].values.push_back(0);
      work.inputs[1].whole.push_back(9);
      work.inputs[2].whole.insert(work.inputs[2].whole.end(), 2, 1);
    }
    const Outcome outcome = ran(work);
    for (size_t i = 0; i < work.points; ++i) {
      const size_t from = quads ? 0 : i;  // flat
      ASSERT_EQ(outcome.outputs[0][4 * i + 1], static_cast<int32_t>(work.inputs[1].whole[from])) << i;
      ASSERT_EQ(outcome.outputs[0][4 * i + 2], work.inputs[2].whole[2 * from] & 0xffffU) << i;
      ASSERT_EQ(outcome.outputs[0][4 * i + 3], work.inputs[2].whole[2 * from + 1] >> 16U) << i;
    }
  }
  work.inputs[1] = {1, {1, 2, 3, 4}, {}};
  EXPECT_EQ(errorOf(work), "error: the input at location 1 has another type [vulkan-interface]");
}

TEST(VulkanRun, QuadsHaveDerivatives) {
  NEEDS_DEVICE();
  Work work;
  work.fragment = compiled(
      "layout(location = 0) in vec2 a;\nlayout(location = 0) out vec4 c;\nlayout(location = 1) out vec4 d;\n"
      "void main() { c = vec4(a, dFdx(a.x), dFdy(a.x)); d = vec4(dFdx(a.y), dFdy(a.y), gl_FrontFacing, 0); "
      "}\n");
  work.points = 8000;
  work.quads = true;
  Varying input{2, {}};
  for (size_t i = 0; i < work.points; ++i) {
    const auto quad = static_cast<float>(i / 4);
    const auto x = static_cast<float>(i % 2);
    const auto y = static_cast<float>(i / 2 % 2);
    input.values.push_back(quad + 3 * x - 5 * y);
    input.values.push_back(2 * quad - 0.25F * x + (quad / 4) * y);
    work.back_facing.push_back(i / 4 % 3 == 0);
  }
  work.inputs = {input};
  const Outcome outcome = ran(work);
  for (size_t i = 0; i < work.points; ++i) {
    const auto quad = static_cast<float>(i / 4);
    const float near = 1e-5F * (quad + 1);
    for (size_t c = 0; c < 2; ++c)
      ASSERT_NEAR(outcome.outputs[0][4 * i + c], input.values[2 * i + c], near) << i;
    ASSERT_NEAR(outcome.outputs[0][4 * i + 2], 3, near) << i;
    ASSERT_NEAR(outcome.outputs[0][4 * i + 3], -5, near) << i;
    ASSERT_NEAR(outcome.outputs[1][4 * i], -0.25, near) << i;
    ASSERT_NEAR(outcome.outputs[1][4 * i + 1], quad / 4, near) << i;
    ASSERT_EQ(outcome.outputs[1][4 * i + 2], i / 4 % 3 == 0 ? 0 : 1) << i;
    ASSERT_FALSE(outcome.discarded[i]) << i;
  }
}

TEST(VulkanRun, SidesAndDroppedFragments) {
  NEEDS_DEVICE();
  Work work;
  work.fragment = compiled(
      "layout(location = 0) in float a;\nlayout(location = 0) out vec4 c;\n"
      "void main() { if (a < 0) discard; c = vec4(gl_FrontFacing ? 1 : 2, a, 0, 0); }\n");
  work.points = 500;
  work.inputs = {{1, numbers(500)}};
  for (size_t i = 0; i < 500; ++i) work.back_facing.push_back(i % 7 < 3);
  const Outcome outcome = ran(work);
  for (size_t i = 0; i < work.points; ++i) {
    ASSERT_EQ(outcome.discarded[i], work.inputs[0].values[i] < 0) << i;
    if (!outcome.discarded[i]) {
      ASSERT_EQ(outcome.outputs[0][4 * i], i % 7 < 3 ? 2 : 1) << i;
    }
  }
}

TEST(VulkanRun, BlocksOfAllAndOfEachPoint) {
  NEEDS_DEVICE();
  Work work;
  work.fragment = compiled(
      "layout(set = 0, binding = 3) uniform A { float x; int n; } a;\n"
      "layout(set = 2, binding = 0) uniform B { vec4 y[2]; } b;\nlayout(location = 0) out vec4 c;\n"
      "void main() { c = vec4(a.x, a.n, b.y[1].zw); }\n");
  work.points = 5000;
  UniformBlock a{{0, 3}, true, {}};
  UniformBlock b{{2, 0}, false, std::vector<unsigned char>(32)};
  for (size_t i = 0; i < work.points; ++i) {
    // Some neighbours have the same, and share a draw.
    const auto words = std::bit_cast<std::array<unsigned char, 8>>(std::array<uint32_t, 2>{
        std::bit_cast<uint32_t>(static_cast<float>(i / 3)), static_cast<uint32_t>(i / 5)});
    a.bytes.insert(a.bytes.end(), words.begin(), words.end());
  }
  const auto last = std::bit_cast<std::array<unsigned char, 8>>(std::array<float, 2>{7.5F, -2});
  std::copy(last.begin(), last.end(), b.bytes.begin() + 24);
  work.blocks = {b, a};
  const Outcome outcome = ran(work);
  for (size_t i = 0; i < work.points; ++i) {
    ASSERT_EQ(outcome.outputs[0][4 * i], static_cast<float>(i / 3));
    ASSERT_EQ(outcome.outputs[0][4 * i + 1], static_cast<float>(i / 5));
    ASSERT_EQ(outcome.outputs[0][4 * i + 2], 7.5F);
    ASSERT_EQ(outcome.outputs[0][4 * i + 3], -2);
  }
}

TEST(VulkanRun, CubeMapsOfOneColorEach) {
  NEEDS_DEVICE();
  Work work;
  work.fragment = compiled(
      "layout(set = 0, binding = 2) uniform samplerCube sky;\nlayout(location = 0) in vec3 d;\n"
      "layout(location = 0) out vec4 c;\nvoid main() { c = textureLod(sky, d, d.x) + texture(sky, -d); }\n");
  work.points = 700;  // more colours than a submission holds
  work.inputs = {{3, numbers(2100)}};
  std::vector<Texel> colors;
  for (size_t i = 0; i < work.points; ++i) colors.push_back({static_cast<float>(i), 1, 0.25F, 60000});
  Texture sky{{0, 2}, {0, 2}, Shape::Cube, false, 1, 1, texels(colors), {}, {}, false};
  work.textures = {sky};
  const Outcome outcome = ran(work);
  for (size_t i = 0; i < work.points; ++i) {
    for (size_t c = 0; c < 4; ++c) ASSERT_EQ(outcome.outputs[0][4 * i + c], 2 * colors[i][c]) << i;
  }
}

TEST(VulkanRun, WrapModesAndRows) {
  NEEDS_DEVICE();
  Work work;
  work.fragment = compiled(
      "layout(set = 1, binding = 1) uniform sampler2D image;\nlayout(location = 0) in vec2 uv;\n"
      "layout(location = 0) out vec4 c;\nvoid main() { c = texture(image, uv); }\n");
  // 3 by 2 texels, numbered along the rows from the top.
  std::vector<Texel> rows;
  for (int i = 0; i < 6; ++i) rows.push_back({static_cast<float>(i), 0, 0, 1});
  const auto at = [](float x, float y) { return std::pair{(x + 0.5F) / 3, (y + 0.5F) / 2}; };
  std::vector<float> uv;
  for (const auto& [u, v] : {at(0, 0), at(2, 0), at(1, 1), at(3, 0), at(-1, 0), at(0, 2), at(0, -1)}) {
    uv.push_back(u);
    uv.push_back(v);
  }
  work.points = 7;
  work.inputs = {{2, uv}};
  const auto reds = [&](Wrap s, Wrap t, bool nearest) {
    work.textures = {{{1, 1}, {1, 1}, Shape::Plane, false, 3, 2, texels(rows), s, t, nearest}};
    const Outcome outcome = ran(work);
    std::vector<int> result;
    for (size_t i = 0; i < work.points; ++i) {
      result.push_back(static_cast<int>(std::lround(100 * outcome.outputs[0][4 * i])));
    }
    return result;
  };
  using Reds = std::vector<int>;
  for (const bool nearest : {true, false}) {
    EXPECT_EQ(reds(Wrap::Repeat, Wrap::Repeat, nearest), (Reds{0, 200, 400, 0, 200, 0, 300}));
    EXPECT_EQ(reds(Wrap::Clamp, Wrap::Repeat, nearest), (Reds{0, 200, 400, 200, 0, 0, 300}));
    EXPECT_EQ(reds(Wrap::Mirror, Wrap::Clamp, nearest), (Reds{0, 200, 400, 200, 0, 300, 0}));
    EXPECT_EQ(reds(Wrap::Repeat, Wrap::Mirror, nearest), (Reds{0, 200, 400, 0, 200, 300, 0}));
  }
  // Between two texels.
  work.points = 1;
  work.inputs = {{2, {1.0F / 3, 0.25F}}};
  EXPECT_EQ(reds(Wrap::Repeat, Wrap::Repeat, false), Reds{50});
}

TEST(VulkanRun, SpecializationConstants) {
  NEEDS_DEVICE();
  Work work;
  work.fragment = compiled(
      "layout(constant_id = 4) const float a = 3;\nlayout(constant_id = 5) const float b = 4;\n"
      "layout(location = 0) out vec4 c;\nvoid main() { c = vec4(a, b, 0, 0); }\n");
  work.points = 1;
  work.constants = {{5, std::bit_cast<uint32_t>(0.125F)}, {9, 1}};
  const Outcome outcome = ran(work);
  EXPECT_EQ(outcome.outputs[0][0], 3);
  EXPECT_EQ(outcome.outputs[0][1], 0.125F);
}

TEST(VulkanRun, WhatCannotRunIsSaid) {
  NEEDS_DEVICE();
  Work work;
  work.points = 1;
  EXPECT_EQ(errorOf(work), "error: not a SPIR-V module [spirv-reflection]");
  work.fragment = compiled(
      "layout(location = 1) in vec2 a;\nlayout(location = 0) out vec4 c;\n"
      "void main() { c = a.xxyy; }\n");
  EXPECT_EQ(errorOf(work), "error: the shader reads 1 inputs, 0 are given [vulkan-interface]");
  work.inputs = {{3, {1, 2, 3}}};
  EXPECT_EQ(errorOf(work), "error: the input at location 1 has another type [vulkan-interface]");
  work.inputs = {{2, {1, 2}}};
  EXPECT_EQ(errorOf(work), "");
  work.inputs.clear();
  work.fragment = compiled(
      "layout(set = 3, binding = 1) uniform sampler2D a;\nlayout(location = 0) out vec4 c;\n"
      "void main() { c = texture(a, vec2(0)); }\n");
  EXPECT_EQ(errorOf(work), "error: nothing is given for set 3, binding 1 [vulkan-interface]");
  work.textures = {{{3, 1}, {3, 1}, Shape::Plane, false, 1U << 20U, 1, texels({{}}), {}, {}, true}};
  EXPECT_NE(errorOf(work).find("one has 1048576 by 1 [vulkan-unsupported]"), std::string::npos);
}

/// How long is for nobody to say; that it is a time, and that a wrong shader is refused, is.
TEST(VulkanRun, Times) {
  NEEDS_DEVICE();
  Sweep sweep;
  sweep.fragment = compiled(
      "layout(location = 0) in vec2 a;\nlayout(location = 0) out vec4 c;\nvoid main() { c = sin(a.xyxy); "
      "}\n");
  sweep.inputs = {{2, {0, 0, 1, 0, 0, 1}}};
  const Result<std::vector<double>> times = device()->time({sweep, sweep}, 2);
  if (!times && times.error()[0].code == "vulkan-unsupported")
    GTEST_SKIP() << "NOT TESTED: " << device()->name() << " is no processor";
  ASSERT_TRUE(times) << format(times.error()[0]);
  ASSERT_EQ(times->size(), 2U);
  for (const double nanoseconds : *times) EXPECT_TRUE(nanoseconds > 0 && nanoseconds < 1e6) << nanoseconds;
  sweep.inputs[0].values.pop_back();
  const Result<std::vector<double>> wrong = device()->time({sweep}, 1);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error()[0].code, "vulkan-interface");
}

/// A shader with blocks and textures of its own is timed, and with them all alone.
TEST(VulkanRun, TimesWithDescriptors) {
  NEEDS_DEVICE();
  Sweep sweep;
  sweep.fragment = compiled(
      "layout(set = 0, binding = 1) uniform Count { int count; };\n"
      "layout(set = 2, binding = 0) uniform sampler2D plane;\nlayout(set = 2, binding = 3) uniform "
      "samplerCube cube;\n"
      "layout(set = 0, binding = 0) uniform sampler3D volume;\n"
      "layout(location = 0) in vec2 a;\nlayout(location = 0) out vec4 c;\n"
      "void main() {\n  c = texture(plane, a) + texture(cube, a.xyy) + texture(volume, a.xyy);\n"
      "  for (int i = 0; i < count; ++i) c = sin(c + a.xyxy);\n}\n");
  sweep.inputs = {{2, {0, 0, 1, 0, 0, 1}}};
  const auto one = texels({{0.5F, 0.5F, 0.5F, 1}});
  sweep.textures = {{{2, 0}, {2, 0}, Shape::Plane, false, 1, 1, one},
                    {{2, 3}, {2, 3}, Shape::Cube, false, 1, 1, one},
                    {{0, 0}, {0, 0}, Shape::Volume, false, 1, 1, one}};
  Sweep many = sweep;
  sweep.blocks = {{{0, 1}, false, {0, 0, 0, 0}}};
  many.blocks = {{{0, 1}, false, {200, 0, 0, 0}}};
  const Result<std::vector<double>> times = device()->time({sweep, many}, 2);
  if (!times && times.error()[0].code == "vulkan-unsupported")
    GTEST_SKIP() << "NOT TESTED: " << device()->name() << " is no processor";
  ASSERT_TRUE(times) << format(times.error()[0]);
  // The count arrives: two hundred sines of four numbers each are not nothing.
  EXPECT_GT((*times)[1], 2 * (*times)[0]);
  sweep.textures.pop_back();
  const Result<std::vector<double>> wrong = device()->time({sweep}, 1);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(format(wrong.error()[0]), "error: nothing is given for set 0, binding 0 [vulkan-interface]");
}

TEST(VulkanRun, NoPointsNoWork) {
  NEEDS_DEVICE();
  Work work;
  work.fragment = compiled("layout(location = 0) out vec4 c;\nvoid main() { c = vec4(1); }\n");
  const Outcome outcome = ran(work);
  ASSERT_EQ(outcome.outputs.size(), 1U);
  EXPECT_TRUE(outcome.outputs[0].empty());
}

}  // namespace
}  // namespace lacquer::vulkan
