// What the pipelines are told about a module, and that no words can lead the reader astray.
#include "check/reflect.h"

#include <gtest/gtest.h>

#include <random>

#include "check/check.h"
#include "vulkan/passthrough.h"

namespace lacquer::check {
namespace {

constexpr const char* kFragment = R"(#version 450
layout(set = 0, binding = 1) uniform Lights { vec4 color[4]; } lights;
layout(set = 2, binding = 0) uniform sampler2D images[3];
layout(set = 2, binding = 5) uniform textureCube sky;
layout(set = 2, binding = 6) uniform sampler smooth_sampler;
layout(set = 3, binding = 0, std430) buffer Store { float numbers[]; } store;
layout(set = 3, binding = 1, rgba8) uniform readonly image2D target;
layout(set = 3, binding = 2) uniform samplerBuffer texels;
layout(push_constant) uniform Push { layout(offset = 16) mat3 turn; float last; } push;
layout(location = 0) in vec3 normal;
layout(location = 1) in mat3 frame;
layout(location = 4) flat in int row;
layout(location = 5) in vec2 uv;
layout(location = 0) out vec4 color;
layout(location = 2) out uvec2 id;
void main() {
  color = lights.color[row] + texture(images[1], uv) + texture(samplerCube(sky, smooth_sampler), normal) +
          vec4(frame * push.turn * normal, push.last) + imageLoad(target, ivec2(uv)) + texelFetch(texels, row);
  store.numbers[row] = color.x;
  id = uvec2(uv);
}
)";

check::Spirv compile(const char* text, check::Stage stage) {
  Result<check::Spirv> words = check::compile(text, Target::Glsl, stage, "test");
  if (!words) throw std::runtime_error(format(words.error()[0]));
  return *words;
}

std::string describe(const std::vector<Slot>& slots) {
  std::string text;
  for (const Slot& slot : slots) {
    text += std::to_string(slot.location) + ":" + std::string(1, "fiu"[static_cast<int>(slot.scalar)]) +
            std::to_string(slot.count) + " ";
  }
  return text;
}

TEST(Reflect, ResourcesInputsAndOutputs) {
  const Result<Interface> interface = reflect(compile(kFragment, check::Stage::Fragment), Stage::Fragment);
  ASSERT_TRUE(interface) << format(interface.error()[0]);
  EXPECT_EQ(interface->entry, "main");
  EXPECT_EQ(describe(interface->inputs), "0:f3 1:f3 2:f3 3:f3 4:i1 5:f2 ");
  EXPECT_EQ(describe(interface->outputs), "0:f4 2:u2 ");
  EXPECT_EQ(interface->push_constant_bytes, 16U + 48U + 4U);
  const std::map<std::pair<uint32_t, uint32_t>, Binding> expected = {
      {{0, 1}, {Resource::UniformBuffer, 1}},     {{2, 0}, {Resource::CombinedImageSampler, 3}},
      {{2, 5}, {Resource::SampledImage, 1}},      {{2, 6}, {Resource::Sampler, 1}},
      {{3, 0}, {Resource::StorageBuffer, 1}},     {{3, 1}, {Resource::StorageImage, 1}},
      {{3, 2}, {Resource::UniformTexelBuffer, 1}}};
  EXPECT_EQ(interface->bindings, expected);
}

TEST(Reflect, TheVertexStageOfAFragmentShaderAlone) {
  const Result<Interface> fragment = reflect(compile(kFragment, check::Stage::Fragment), Stage::Fragment);
  ASSERT_TRUE(fragment);
  const Result<check::Spirv> words = passthroughVertex(*fragment);
  ASSERT_TRUE(words) << format(words.error()[0]);
  const Result<Interface> vertex = reflect(*words, Stage::Vertex);
  ASSERT_TRUE(vertex);
  EXPECT_EQ(describe(vertex->inputs), describe(fragment->inputs) + "6:f4 ");
  EXPECT_EQ(describe(vertex->outputs), describe(fragment->inputs));
}

TEST(Reflect, WrongStageAndNoModule) {
  const check::Spirv fragment = compile(kFragment, check::Stage::Fragment);
  const Result<Interface> wrong = reflect(fragment, Stage::Vertex);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error()[0].message, "the module has no entry point of a vertex shader");
  const Result<Interface> none = reflect({1, 2, 3, 4, 5, 6}, Stage::Fragment);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error()[0].message, "not a SPIR-V module");
  EXPECT_EQ(instructionCount({1, 2, 3, 4, 5, 6}), 0U);
}

TEST(Reflect, CountsWhatIsInFunctions) {
  // load, store, return
  const char* text =
      "#version 450\nlayout(location = 0) in vec4 a;\nlayout(location = 0) out vec4 b;\n"
      "void main() { b = a; }\n";
  EXPECT_EQ(instructionCount(compile(text, check::Stage::Fragment)), 3U);
}

TEST(Reflect, DamagedModulesAreReadOrRefused) {
  const check::Spirv good = compile(kFragment, check::Stage::Fragment);
  for (size_t length = 0; length < good.size(); ++length) {
    reflect(check::Spirv(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length)), Stage::Fragment);
  }
  std::mt19937 random(1);
  for (int round = 0; round < 20000; ++round) {
    check::Spirv damaged = good;
    for (int change = 0; change < 3; ++change) {
      const uint32_t value = random() % 2 == 0 ? random() % 64 : random();
      damaged[5 + random() % (good.size() - 5)] = value;
    }
    if (const Result<Interface> interface = reflect(damaged, Stage::Fragment)) {
      EXPECT_LE(interface->inputs.size(), 64U * 8U);
    }
    instructionCount(damaged);
  }
}

}  // namespace
}  // namespace lacquer::check
