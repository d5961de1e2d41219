// A uniform block has one layout: std140 of the GLSL, the cbuffer of the HLSL, the decorations of the SPIR-V
// and the manifest say the same of every byte. Proved by reflection over what glslang makes of the text.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>
#include <spirv-tools/libspirv.hpp>

#include "check/check.h"
#include "check/reflect.h"
#include "ir/module.h"
#include "output.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

using check::Spirv;
using check::Stage;

// The numbers of the SPIR-V specification that matter here (3.42 and 3.20).
enum Op : uint32_t {
  kName = 5,
  kMemberName = 6,
  kTypeInt = 21,
  kTypeFloat = 22,
  kTypeVector = 23,
  kTypeMatrix = 24,
  kTypeArray = 28,
  kTypeStruct = 30,
  kConstant = 43,
  kDecorate = 71,
  kMemberDecorate = 72,
};
enum Decoration : uint32_t {
  kRowMajor = 4,
  kColMajor = 5,
  kArrayStride = 6,
  kMatrixStride = 7,
  kOffset = 35
};

/// A number, vector or matrix somewhere in a block.
struct Leaf {
  std::string name;
  uint32_t offset = 0;         ///< from the block's start; in an array, of the first element
  uint32_t size = 0;           ///< in bytes
  uint32_t matrix_stride = 0;  ///< 0 for what is no matrix
  uint32_t array = 0, stride = 0;
  bool operator==(const Leaf&) const = default;
};

std::string written(const std::vector<Leaf>& leaves) {
  std::string text;
  for (const Leaf& leaf : leaves) {
    text += fmt::format("{:4} {:3} {}", leaf.offset, leaf.size, leaf.name);
    if (leaf.matrix_stride != 0) text += fmt::format(" matrix of stride {}", leaf.matrix_stride);
    if (leaf.array != 0) text += fmt::format(" in {} of stride {}", leaf.array, leaf.stride);
    text += "\n";
  }
  return text;
}

/// The leaves of structures, structures in structures opened. HLSL has one around each block.
class Layout {
public:
  explicit Layout(const Spirv& words) {
    for (size_t at = 5; at < words.size(); at += words[at] >> 16) instruction(words.data() + at);
  }

  /// Of the structure with this name.
  std::vector<Leaf> leaves(const std::string& name) const {
    std::vector<Leaf> all;
    for (const auto& [id, found] : names_) {
      if (found == name && types_.contains(id)) {
        open(id, {}, all);
        return all;
      }
    }
    return all;
  }
  bool has(Decoration decoration) const {
    return std::any_of(members_.begin(), members_.end(),
                       [&](const auto& m) { return m.second.contains(decoration); });
  }

private:
  using Words = std::vector<uint32_t>;
  using Member = std::pair<uint32_t, uint32_t>;

  void instruction(const uint32_t* w) {
    const uint32_t count = w[0] >> 16;
    const uint32_t op = w[0] & 0xFFFF;
    switch (op) {
      case kName: names_[w[1]] = reinterpret_cast<const char*>(w + 2); break;
      case kMemberName: member_names_[{w[1], w[2]}] = reinterpret_cast<const char*>(w + 3); break;
      case kDecorate: decorations_[w[1]][w[2]] = count > 3 ? w[3] : 0; break;
      case kMemberDecorate: members_[{w[1], w[2]}][w[3]] = count > 4 ? w[4] : 0; break;
      case kConstant: constants_[w[2]] = w[3]; break;
      case kTypeInt:
      case kTypeFloat:
      case kTypeVector:
      case kTypeMatrix:
      case kTypeArray:
      case kTypeStruct:
        types_[w[1]] = Words(w, w + count);
        types_[w[1]][0] = op;
        break;
      default: break;  // nothing that a layout depends on
    }
  }

  uint32_t sizeOf(uint32_t type) const {
    const Words& w = types_.at(type);
    return w[0] == kTypeVector || w[0] == kTypeMatrix ? sizeOf(w[2]) * w[3] : w[2] / 8;
  }
  uint32_t get(const Member& member, Decoration decoration) const {
    const auto found = members_.find(member);
    return found == members_.end() || !found->second.contains(decoration) ? 0 : found->second.at(decoration);
  }

  void open(uint32_t structure, const Leaf& around, std::vector<Leaf>& all) const {
    const Words& w = types_.at(structure);
    for (uint32_t i = 0; i + 2 < w.size(); ++i) {
      const Member member(structure, i);
      Leaf leaf = around;
      leaf.offset += get(member, kOffset);
      uint32_t type = w[i + 2];
      if (types_.at(type)[0] == kTypeArray) {
        leaf.array = constants_.at(types_.at(type)[3]);
        leaf.stride = decorations_.at(type).at(kArrayStride);
        type = types_.at(type)[2];
      }
      if (types_.at(type)[0] == kTypeStruct) {
        open(type, leaf, all);
        continue;
      }
      leaf.name = member_names_.at(member);
      leaf.size = sizeOf(type);
      leaf.matrix_stride = get(member, kMatrixStride);
      all.push_back(leaf);
    }
  }

  std::map<uint32_t, std::string> names_;
  std::map<Member, std::string> member_names_;
  std::map<uint32_t, std::map<uint32_t, uint32_t>> decorations_;
  std::map<Member, std::map<uint32_t, uint32_t>> members_;
  std::map<uint32_t, uint32_t> constants_;
  std::map<uint32_t, Words> types_;
};

/// What the manifest says of a block, in the same form.
std::vector<Leaf> manifestLeaves(const Json& block) {
  static const std::map<std::string, uint32_t> kSizes = {{"float", 4}, {"int", 4},   {"bool", 4}, {"vec2", 8},
                                                         {"vec3", 12}, {"vec4", 16}, {"mat4", 64}};
  std::vector<Leaf> leaves;
  for (const Json& field : block["fields"]) {
    Leaf leaf;
    leaf.name = field["name"];
    leaf.offset = field["offset"];
    leaf.size = kSizes.at(field["type"]);
    leaf.matrix_stride = field["type"] == "mat4" ? 16 : 0;
    if (block.contains("array")) leaf.array = block["array"], leaf.stride = block["stride"];
    leaves.push_back(leaf);
  }
  return leaves;
}

Spirv compiled(const std::string& text, Target target, Stage stage) {
  const Result<Spirv> words = check::compile(text, target, stage, "text");
  if (words) return *words;
  ADD_FAILURE() << format(words.error()[0]) << "\n" << text;
  return {};
}

std::map<std::string, check::Block> blocksOf(const Spirv& words) {
  std::map<std::string, check::Block> blocks;
  const Result<std::vector<check::Block>> found = check::reflectBlocks(words);
  if (!found) {
    ADD_FAILURE() << format(found.error()[0]);
    return blocks;
  }
  for (const check::Block& block : *found) blocks[block.name] = block;
  return blocks;
}

struct Compiled {
  const char* name;
  Spirv words;
  bool flat;  ///< bound by the flat numbers
};

void expectOneLayout(const Shader& shader, Stage stage, std::set<std::string>& seen) {
  const auto text = [&](Target target) {
    return stage == Stage::Vertex ? shader.vertexText(target) : shader.fragmentText(target);
  };
  const Compiled all[] = {
      {"GLSL for Vulkan", compiled(text(Target::Glsl), Target::Glsl, stage), false},
      {"GLSL for OpenGL", compiled(text(Target::GlslGl), Target::GlslGl, stage), true},
      {"HLSL", compiled(text(Target::Hlsl), Target::Hlsl, stage), false},
      {"HLSL without spaces",
       compiled("#define LACQUER_SPACES 0\n" + text(Target::Hlsl), Target::Hlsl, stage), true},
      {"SPIR-V", stage == Stage::Vertex ? shader.vertexSpirv() : shader.fragmentSpirv(), false},
  };
  const Json uniforms = Json::parse(shader.interfaceJson())["uniforms"];
  const size_t count = blocksOf(all[0].words).size();
  for (const Compiled& one : all) {
    SCOPED_TRACE(one.name);
    const Layout layout(one.words);
    EXPECT_FALSE(layout.has(std::string_view(one.name).starts_with("HLSL") ? kColMajor : kRowMajor));
    const std::map<std::string, check::Block> blocks = blocksOf(one.words);
    EXPECT_EQ(blocks.size(), count);
    for (const auto& [name, block] : blocks) {
      const auto described = std::find_if(uniforms.begin(), uniforms.end(),
                                          [&, &n = name](const Json& u) { return u["block"] == n; });
      ASSERT_NE(described, uniforms.end()) << name << " is not in the manifest";
      EXPECT_EQ(written(layout.leaves(name)), written(manifestLeaves(*described))) << name;
      EXPECT_EQ(block.binding, (*described)[one.flat ? "flat" : "binding"]) << name;
      EXPECT_EQ(block.set, one.flat ? 0u : (*described)["set"].get<uint32_t>()) << name;
      EXPECT_LE(block.size, (*described)["size"].get<uint32_t>()) << name;
      EXPECT_GT(block.size + 16, (*described)["size"].get<uint32_t>()) << name;
      seen.insert((*described)["role"]);
    }
  }
}

/// Every distinct shader of the examples.
void forEachShader(const Options& options, const std::function<void(const Shader&)>& body) {
  const WorkingFolder here(sourceFolder());
  std::set<std::string> ids;
  for (const std::string& file : exampleFiles()) {
    Messages messages;
    const Scene scene = Scene::load(file, options, messages);
    ASSERT_TRUE(scene) << textOf(messages);
    for (size_t i = 0; i < scene.materialCount(); ++i) {
      for (const Attributes& attributes : scene.uses(i)) {
        Graph graph = scene.graph(i, attributes, options, messages);
        ASSERT_TRUE(graph) << textOf(messages);
        const Shader shader = graph.generate(options, messages);
        ASSERT_TRUE(shader) << textOf(messages);
        SCOPED_TRACE(scene.materialName(i));
        if (ids.insert(shader.id()).second) body(shader);
      }
    }
  }
  EXPECT_GT(ids.size(), 10u);
}

void expectLayouts(const std::string& template_name, const std::set<std::string>& roles) {
  Options options;
  options.template_name = template_name;
  options.validate = false;
  std::set<std::string> seen;
  forEachShader(options, [&](const Shader& shader) {
    if (shader.hasVertexStage()) expectOneLayout(shader, Stage::Vertex, seen);
    expectOneLayout(shader, Stage::Fragment, seen);
  });
  EXPECT_EQ(seen, roles);
}

TEST(Layout, forward) { expectLayouts("forward", {"frame", "lights", "material", "object"}); }
TEST(Layout, surface) { expectLayouts("surface", {"frame", "material", "object"}); }
TEST(Layout, bsdf) { expectLayouts("bsdf", {"material"}); }

/// An engine binds what the frame and an object have once for all shaders of a template.
TEST(Layout, registersOfTheFrameAreTheSameInAllShaders) {
  Options options;
  options.validate = false;
  options.targets = {Target::Hlsl};
  std::map<std::string, std::set<std::pair<uint32_t, uint32_t>>> places;
  forEachShader(options, [&](const Shader& shader) {
    for (const Stage stage : {Stage::Vertex, Stage::Fragment}) {
      const std::string text =
          stage == Stage::Vertex ? shader.vertexText(Target::Hlsl) : shader.fragmentText(Target::Hlsl);
      if (text.empty()) continue;
      const Spirv words = compiled(text, Target::Hlsl, stage);
      for (const auto& [name, block] : blocksOf(words)) places[name].emplace(block.set, block.binding);
      for (const check::Taken& one : check::reflectPlaces(words)) {
        if (!one.block && one.set != ir::kMaterialBinding.set) places[one.name].emplace(one.set, one.binding);
      }
    }
  });
  for (const auto& [name, seen] : places) EXPECT_EQ(seen.size(), 1U) << name;
  for (const char* name : {"environment_dfg", "environment_dfg_sampler", "scene_behind", "Frame", "Object"})
    EXPECT_EQ(places.count(name), 1U) << name;
}

/// The comparison sees a member that has moved.
TEST(Layout, differencesAreSeen) {
  const auto leaves = [](const std::string& members, Target target) {
    const bool glsl = target == Target::Glsl;
    const std::string text =
        glsl ? "#version 450\nlayout(std140, set = 0, binding = 0) uniform B {" + members +
                   "};\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(a); }\n"
             : "cbuffer B : register(b0) {" + members + "};\nfloat4 main() : SV_Target0 { return a.xxxx; }\n";
    return written(Layout(compiled(text, target, Stage::Fragment)).leaves("B"));
  };
  EXPECT_EQ(leaves("float a; vec3 b; float c;", Target::Glsl), "   0   4 a\n  16  12 b\n  28   4 c\n");
  // HLSL fills the first register.
  EXPECT_EQ(leaves("float a; float3 b; float c;", Target::Hlsl), "   0   4 a\n   4  12 b\n  16   4 c\n");
}

/// pack() fills the block that the manifest describes.
TEST(Layout, packedBytesLieWhereTheManifestSays) {
  Options options;
  options.validate = false;
  options.targets = {Target::Glsl};
  forEachShader(options, [&](const Shader& shader) {
    std::vector<float> packed(shader.uniformSize() / 4, -77.0f);
    EXPECT_TRUE(shader.pack({}, std::as_writable_bytes(std::span(packed))));
    const Json interface = Json::parse(shader.interfaceJson());
    for (const Json& block : interface["uniforms"]) {
      if (block["role"] != "material") continue;
      EXPECT_EQ(block["size"], shader.uniformSize());
      for (const Json& field : block["fields"]) EXPECT_LT(field["offset"], shader.uniformSize());
    }
    for (const float x : packed) EXPECT_NE(x, -77.0f);  // nothing is left as it was
  });
}

}  // namespace
}  // namespace lacquer::test
