// Positions are the same, bit for bit, in every template: the instructions that make them are, and each
// language is told that they must stay so.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "lacquer.h"

namespace lacquer::test::invariant_test {
namespace {

using Json = nlohmann::json;

/// The instructions behind what is stored to gl_Position, as one expression. Variables are named by where
/// they are bound.
class PositionOf {
public:
  explicit PositionOf(const std::vector<uint32_t>& words) {
    for (size_t at = 5; at < words.size(); at += words[at] >> 16U) {
      const uint32_t op = words[at] & 0xFFFFU, count = words[at] >> 16U;
      const std::vector<uint32_t> rest(words.begin() + static_cast<ptrdiff_t>(at + 1),
                                       words.begin() + static_cast<ptrdiff_t>(at + count));
      if (op == kDecorate && rest[1] == kBuiltIn && rest[2] == 0) position_ = rest[0];
      if (op == kDecorate && rest[1] == kInvariant) invariant_ = rest[0];
      if (op == kDecorate) decorations_[rest[0]] += " " + join(rest, 1);
      if (op == kStore && rest[0] == position_) stored_ = rest[1];
      if (hasResult(op)) made_[rest[1]] = {op, rest};
    }
  }
  bool invariant() const { return position_ != 0 && invariant_ == position_; }
  std::string text() { return expression(stored_); }

private:
  static constexpr uint32_t kDecorate = 71, kStore = 62, kVariable = 59, kLoad = 61, kAccessChain = 65,
                            kConstant = 43, kConstantComposite = 44, kExtInst = 12, kExtract = 81,
                            kShuffle = 79, kSampleLod = 88, kBuiltIn = 11, kInvariant = 18;
  static bool hasResult(uint32_t op) {
    return op == kVariable || op == kLoad || op == kAccessChain || op == kExtInst || (op >= 41 && op <= 46) ||
           (op >= 79 && op <= 97) || (op >= 109 && op <= 199);
  }
  static std::string join(const std::vector<uint32_t>& words, size_t from) {
    std::ostringstream text;
    for (size_t i = from; i < words.size(); ++i) text << words[i] << ' ';
    return text.str();
  }
  std::string expression(uint32_t id) {
    const auto it = made_.find(id);
    if (it == made_.end()) return "?" + std::to_string(id);
    const auto& [op, rest] = it->second;
    if (op == kVariable) return "[" + decorations_[id] + "]";
    if (op == kConstant) return "=" + join(rest, 2);
    std::string text = std::to_string(op) + "(";
    // Of these the last operands are numbers, not instructions.
    const size_t operands = op == kExtract ? 3 : op == kShuffle ? 4 : rest.size();
    size_t first = 2;
    if (op == kExtInst) text += join({rest[3]}, 0), first = 4;
    for (size_t i = first; i < operands; ++i) {
      const bool mask = op == kSampleLod && i == 4;
      text += (mask ? join({rest[i]}, 0) : expression(rest[i])) + " ";
    }
    return text + join(rest, operands) + ")";
  }

  uint32_t position_ = 0, invariant_ = 0, stored_ = 0;
  std::map<uint32_t, std::string> decorations_;
  std::map<uint32_t, std::pair<uint32_t, std::vector<uint32_t>>> made_;
};

struct Kind {
  const char* name;
  bool skin, eight, morph, instances, quantized;
};
constexpr Kind kKinds[] = {
    {"still", false, false, false, false, false},
    {"skinned", true, false, false, false, false},
    {"eight joints", true, true, false, false, false},
    {"morphed", false, false, true, false, false},
    {"instanced", false, false, false, true, false},
    {"quantized", false, false, false, false, true},
    {"all", true, false, true, true, true},
    {"skinned and morphed", true, false, true, false, false},
};

/// Materials whose vertex stages compute most: a normal map, texture transforms, each alpha mode.
const char* const kFile = R"({"asset": {"version": "2.0"}, "images": [{"uri": "n.png"}],
"extensionsUsed": ["KHR_texture_transform", "KHR_materials_transmission", "KHR_materials_volume"],
"textures": [{"source": 0}], "materials": [
{"normalTexture": {"index": 0}},
{"alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0,
  "extensions": {"KHR_texture_transform": {"scale": [2, 3], "rotation": 0.5}}}}},
{"alphaMode": "BLEND", "doubleSided": true},
{"extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
                "KHR_materials_volume": {"thicknessFactor": 1}}}]})";

std::string at(const Kind& kind, size_t material, const std::string& template_name, Shader& shader,
               const Options& with = {}) {
  Options options = with;
  options.template_name = template_name;
  options.targets = {Target::Glsl, Target::GlslGl, Target::Essl, Target::Hlsl, Target::Spirv, Target::Wgsl};
  options.validate = false;
  Messages messages;
  const Scene scene = Scene::fromMemory(kFile, "file.gltf", options, messages);
  Attributes attributes;
  attributes.tangent = attributes.color0 = true;
  attributes.texCoord[0] = true;
  attributes.skin = {kind.skin, kind.eight};
  attributes.morph = kind.morph;
  attributes.instances = kind.instances;
  attributes.quantized = kind.quantized;
  shader = scene.graph(material, attributes, options, messages).generate(options, messages);
  EXPECT_TRUE(shader);
  PositionOf position(shader.vertexSpirv());
  EXPECT_TRUE(position.invariant());
  return position.text();
}

TEST(Invariant, PositionsAreMadeByTheSameInstructionsInEveryTemplate) {
  for (const Kind& kind : kKinds) {
    SCOPED_TRACE(kind.name);
    Shader shader;
    const std::string expected = at(kind, 0, "depth", shader);
    EXPECT_EQ(expected.find('?'), std::string::npos) << expected;
    EXPECT_GT(expected.size(), 20U);
    for (size_t material = 0; material < 4; ++material) {
      for (const char* name : {"forward", "forward_clustered", "surface", "depth", "shadow", "motion", "id"})
        EXPECT_EQ(at(kind, material, name, shader), expected) << name << ", material " << material;
    }
  }
}

/// A product that something else reads must not change how the sum is rounded that it is in.
TEST(Invariant, WhatElseIsComputedChangesNothing) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "lacquer_invariant";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "waves.node") << R"(
/// Positions with sums of products.
template waves extends depth {
    given float wave = POSITION.x * NORMAL.x + POSITION.y * NORMAL.y;
    replace output position vec4 position_clip = frame.view_projection * (world + vec4(wave, 0, 0, 0));
}
/// The same, and one of the products by itself.
template waves_seen extends waves {
    given float seen = interpolate(POSITION.x * NORMAL.x);
    output color vec4 color = vec4(seen);
}
)";
  Options options;
  options.node_directories = {folder.string()};
  Shader shader;
  EXPECT_EQ(at(kKinds[0], 0, "waves", shader, options), at(kKinds[0], 0, "waves_seen", shader, options));
  std::filesystem::remove_all(folder);
}

TEST(Invariant, EveryTargetIsTold) {
  Shader shader;
  (void)at(kKinds[0], 0, "forward", shader);
  for (const Target target : {Target::Glsl, Target::GlslGl, Target::Essl})
    EXPECT_NE(shader.vertexText(target).find("invariant gl_Position;"), std::string::npos);
  EXPECT_NE(shader.vertexText(Target::Hlsl).find("out precise float4 out_position : SV_Position"),
            std::string::npos);
  EXPECT_NE(shader.vertexText(Target::Wgsl).find("@builtin(position) @invariant position: vec4f"),
            std::string::npos);
  for (const Target target : {Target::Glsl, Target::GlslGl, Target::Essl, Target::Hlsl, Target::Wgsl})
    EXPECT_EQ(shader.fragmentText(target).find("nvariant"), std::string::npos);
}

}  // namespace
}  // namespace lacquer::test::invariant_test
