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
  const Result<check::Spirv> words = vulkan::passthroughVertex(*fragment);
  ASSERT_TRUE(words) << format(words.error()[0]);
  const Result<Interface> vertex = reflect(*words, Stage::Vertex);
  ASSERT_TRUE(vertex);
  EXPECT_EQ(describe(vertex->inputs), describe(fragment->inputs) + "6:f4 ");
  EXPECT_EQ(describe(vertex->outputs), describe(fragment->inputs));
}

TEST(Reflect, MembersOfBlocksAreInputs) {
  const char* text = R"(#version 450
layout(location = 1) in Surface { vec3 normal; layout(location = 5) vec2 uv; mat2 frame; flat uvec3 ids[2]; } from;
layout(location = 0) out vec4 color;
void main() { color = vec4(from.normal, 1.0) + vec4(from.frame * from.uv, from.ids[1].xy); }
)";
  const Result<Interface> fragment = reflect(compile(text, check::Stage::Fragment), Stage::Fragment);
  ASSERT_TRUE(fragment) << format(fragment.error()[0]);
  EXPECT_EQ(fragment->odd_input, "");
  EXPECT_EQ(describe(fragment->inputs), "1:f3 5:f2 6:f2 7:f2 8:u3 9:u3 ");
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

/// The message about a shader with this declaration, whose bindings 9 are others, as no compiler has them.
std::string refusal(const std::string& declaration, uint32_t binding = 9) {
  const std::string text = "#version 450\nlayout(location = 0) out vec4 color;\n" + declaration +
                           "\nvoid main() { color = vec4(1.0); }\n";
  check::Spirv words = compile(text.c_str(), check::Stage::Fragment);
  constexpr uint32_t kDecorate = 4U << 16U | 71U;
  constexpr uint32_t kBinding = 33;
  for (size_t i = 0; i + 3 < words.size(); ++i) {
    if (words[i] == kDecorate && words[i + 2] == kBinding && words[i + 3] == 9) words[i + 3] = binding;
  }
  const Result<Interface> read = reflect(words, check::Stage::Fragment);
  return read ? "" : read.error()[0].message;
}

TEST(Reflect, RefusesWhatNoDeviceHas) {
  EXPECT_EQ(refusal("layout(set = 31, binding = 9) uniform sampler2D image;", 65535), "");
  EXPECT_EQ(refusal("layout(set = 0, binding = 0) uniform sampler2D images[256][256];"), "");
  EXPECT_EQ(refusal("layout(set = 32, binding = 7) uniform sampler2D image;"),
            "the resource at set 32, binding 7: there are 32 sets");
  EXPECT_EQ(refusal("layout(set = 1, binding = 9) uniform sampler2D image;", 65536),
            "the resource at set 1, binding 65536: a set has 65536 bindings");
  EXPECT_EQ(refusal("layout(set = 1, binding = 2) uniform sampler2D images[65537];"),
            "the resource at set 1, binding 2 has more than 65536 descriptors");
  EXPECT_EQ(refusal("layout(set = 1, binding = 2) uniform sampler2D images[65536][65536];"),
            "the resource at set 1, binding 2 has more than 65536 descriptors");
  std::string many;
  for (int i = 0; i < 17; ++i) {
    const std::string number = std::to_string(i);
    many += "layout(binding = " + number + ") uniform sampler2D i" + number + "[65536];\n";
  }
  EXPECT_EQ(refusal(many), "the module's resources have more than 1048576 descriptors");
  EXPECT_EQ(refusal("layout(push_constant) uniform P { vec4 numbers[256]; } p;"), "");
  EXPECT_EQ(refusal("layout(push_constant) uniform P { vec4 numbers[257]; } p;"),
            "the push constants take more than 4096 bytes");
}

/// A fragment shader's declarations: uniform variables of one struct.
check::Spirv blocks(uint32_t members, uint32_t variables) {
  check::Spirv words{0x07230203, 0x00010000, 0, 1'000'000, 0};
  const auto add = [&](uint32_t code, const check::Spirv& operands) {
    words.push_back(static_cast<uint32_t>(operands.size() + 1) << 16U | code);
    words.insert(words.end(), operands.begin(), operands.end());
  };
  add(15, {4, 1, 0x6e69616d, 0});
  add(71, {5, 2});
  for (uint32_t i = 0; i < members; ++i) add(72, {5, i, 35, 4 * i});
  for (uint32_t i = 0; i < variables; ++i) add(71, {100 + i, 33, i});
  add(22, {3, 32});
  check::Spirv type(members + 1, 3);
  type[0] = 5;
  add(30, type);
  add(32, {6, 2, 5});
  for (uint32_t i = 0; i < variables; ++i) add(59, {6, 100 + i, 2});
  return words;
}

/// The members of all variables are no part of the words, however few these are.
TEST(Reflect, BlocksHaveABoundedNumberOfMembers) {
  const Result<std::vector<Block>> most = reflectBlocks(blocks(1'024, 64));
  ASSERT_TRUE(most) << format(most.error()[0]);
  EXPECT_EQ(most->size(), 64U);
  EXPECT_EQ(most->back().members.size(), 1'024U);
  for (const check::Spirv& words : {blocks(1'024, 65), blocks(60'000, 2), blocks(0, 65'537)}) {
    const Result<std::vector<Block>> more = reflectBlocks(words);
    ASSERT_FALSE(more);
    EXPECT_EQ(more.error()[0].message, "the uniform blocks have more than 65536 members");
  }
  // An interface holds none of them, nor does a list of places.
  const Result<Interface> interface = reflect(blocks(1'024, 65), check::Stage::Fragment);
  ASSERT_TRUE(interface) << format(interface.error()[0]);
  EXPECT_EQ(interface->bindings.size(), 65U);
  EXPECT_EQ(reflectPlaces(blocks(1'024, 65)).size(), 65U);
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
