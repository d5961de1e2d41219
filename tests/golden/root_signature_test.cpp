// One root signature for all shaders of a template, which binds all that they read. What Direct3D makes of
// its text is dxc's to say, where there is one (check/dxc.cpp); here its grammar is read by hand.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <regex>
#include <set>

#include "check/check.h"
#include "check/reflect.h"
#include "output.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

/// The parts of the macro, joined as a preprocessor joins them.
std::string definedIn(const std::string& text) {
  size_t at = text.find("#define LACQUER_ROOT_SIGNATURE \\\n");
  std::string joined;
  for (bool more = at != std::string::npos; more;) {
    at = text.find('\n', at) + 1;
    const std::string line = text.substr(at, text.find('\n', at) - at);
    more = line.ends_with('\\');
    const size_t begin = line.find('"') + 1;
    joined += line.substr(begin, line.rfind('"') - begin);
  }
  return joined;
}

/// The registers that the signature binds, as "b0 space1"; what is bound from a register on without end has
/// a +. The cost in words is at most Direct3D's.
std::set<std::string> boundBy(const std::string& signature) {
  const std::regex part(
      R"(RootFlags\(ALLOW_INPUT_ASSEMBLER_INPUT_LAYOUT\)|RootConstants\(num32BitConstants=1, b0, space=(\d+)\)|)"
      R"(CBV\(b(\d+), space=(\d+)\)|DescriptorTable\(CBV\(b0, space=(\d+), numDescriptors=(\d+), flags=DESCRIPTORS_VOLATILE\)\)|)"
      R"(DescriptorTable\((SRV\(t|Sampler\(s)0, space=(\d+), numDescriptors=unbounded, flags=DESCRIPTORS_VOLATILE\)\))");
  std::set<std::string> bound;
  std::string rest = signature;
  size_t words = 0;
  for (std::smatch found; std::regex_search(rest, found, part); rest = found.suffix()) {
    EXPECT_TRUE(found.prefix() == "" || found.prefix() == ", ") << signature;
    words += found[1].matched || found[4].matched || found[6].matched ? 1 : found[2].matched ? 2 : 0;
    if (found[1].matched) bound.insert(fmt::format("b0 space{}", found[1].str()));
    if (found[2].matched) bound.insert(fmt::format("b{} space{}", found[2].str(), found[3].str()));
    for (int i = 0; found[4].matched && i < std::stoi(found[5]); ++i)
      bound.insert(fmt::format("b{} space{}", i, found[4].str()));
    if (found[6].matched) bound.insert(fmt::format("{}+ space{}", found[6].str().back(), found[7].str()));
  }
  EXPECT_EQ(rest, "") << signature;
  EXPECT_LE(words, 64U) << signature;
  return bound;
}

void expectBound(const Shader& shader, const std::set<std::string>& bound) {
  const Reflection& of = shader.reflection();
  for (const UniformBlock& block : of.blocks) {
    const std::string place = block.list.empty() ? fmt::format("b{}", block.at.binding) : "t+";
    EXPECT_TRUE(bound.contains(fmt::format("{} space{}", place, block.at.set))) << block.name;
  }
  for (const ReflectedTexture& texture : of.textures) {
    for (const char* place : {"t+", "s+"})
      EXPECT_TRUE(bound.contains(fmt::format("{} space{}", place, texture.at.set))) << texture.name;
  }
}

/// The parameters of the signature, each by its kind, space and binding.
std::string rowsOf(const std::vector<RootParameter>& parameters) {
  std::string text;
  for (const RootParameter& p : parameters)
    text += fmt::format("{} {} {} {}\n", static_cast<int>(p.kind), p.space, p.binding, p.count);
  return text;
}

/// The lengths of the elements of all arrays (OpDecorate, ArrayStride).
std::set<uint32_t> stridesOf(const check::Spirv& words) {
  std::set<uint32_t> strides;
  for (size_t at = 5; at < words.size(); at += std::max(words[at] >> 16, 1U)) {
    if ((words[at] & 0xFFFF) == 71 && words[at + 2] == 6) strides.insert(words[at + 3]);
  }
  return strides;
}

/// The shaders of the examples by a template.
std::vector<Shader> shadersBy(const std::string& template_name, const Options& more) {
  Options options = more;
  options.template_name = template_name;
  options.targets = {Target::Hlsl};
  const WorkingFolder here(sourceFolder());
  std::vector<Shader> made;
  std::set<std::string> ids;
  for (const std::string& file : exampleFiles()) {
    Messages messages;
    const Scene scene = Scene::load(file, options, messages);
    EXPECT_TRUE(scene) << textOf(messages);
    for (size_t i = 0; scene && i < scene.materialCount(); ++i) {
      for (const Attributes& attributes : scene.uses(i)) {
        Graph graph = scene.graph(i, attributes, options, messages);
        EXPECT_TRUE(graph) << textOf(messages);
        if (!graph) continue;
        Shader shader = graph.generate(options, messages);
        EXPECT_TRUE(shader) << textOf(messages);
        if (shader && ids.insert(shader.id()).second) made.push_back(std::move(shader));
      }
    }
  }
  return made;
}

class RootSignature : public testing::TestWithParam<const char*> {};

TEST_P(RootSignature, IsTheTemplatesAndBindsWhatShadersRead) {
  Options options;  // validated: where there is a dxc, by it too
  if (!check::haveDxc()) std::cout << "NOT TESTED: nothing here compiles HLSL for Direct3D 12 (dxc)\n";
  const std::vector<Shader> made = shadersBy(GetParam(), options);
  ASSERT_FALSE(made.empty());
  const Reflection& first = made[0].reflection();
  const std::set<std::string> bound = boundBy(first.root_signature);
  EXPECT_TRUE(bound.contains("b0 space3")) << first.root_signature;
  for (const Shader& shader : made) {
    EXPECT_EQ(shader.reflection().root_signature, first.root_signature) << shader.id();
    EXPECT_EQ(rowsOf(shader.reflection().root_parameters), rowsOf(first.root_parameters));
    expectBound(shader, bound);
    for (const std::string& text : {shader.vertexText(Target::Hlsl), shader.fragmentText(Target::Hlsl)}) {
      if (text.find("LACQUER_AT") == std::string::npos) continue;
      EXPECT_EQ(definedIn(text), first.root_signature) << text;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Templates, RootSignature,
                         testing::Values("forward", "forward_area", "forward_clustered", "surface", "bsdf",
                                         "depth", "motion", "id"));

/// With LACQUER_OBJECTS an object's block is an element of a buffer, of the same bytes.
TEST_P(RootSignature, ObjectsAreElementsOfTheSameBytes) {
  Options options;
  options.validate = false;
  size_t found = 0;
  for (const Shader& shader : shadersBy(GetParam(), options)) {
    if (!shader.hasVertexStage()) continue;
    const auto words = check::compile("#define LACQUER_OBJECTS 1\n" + shader.vertexText(Target::Hlsl),
                                      Target::Hlsl, check::Stage::Vertex, "objects.hlsl");
    ASSERT_TRUE(words) << format(words.error()[0]);
    EXPECT_TRUE(check::validate(*words, false, "objects.hlsl").empty());
    for (const UniformBlock& block : shader.reflection().blocks) {
      if (block.role != BlockRole::Object || !block.vertex) continue;
      EXPECT_TRUE(stridesOf(*words).contains(block.size)) << block.name;
      const std::vector<check::Taken> places = check::reflectPlaces(*words);
      found += static_cast<size_t>(std::count_if(places.begin(), places.end(), [&](const auto& place) {
        return place.storage && place.set == block.at.set &&
               place.binding == block.at.binding + check::kHlslTextureShift;
      }));
    }
  }
  EXPECT_EQ(found > 0, std::string(GetParam()) != "bsdf");
}

/// HLSL packs the elements of a buffer tighter than constant buffers: a block of two floats has 16 bytes.
TEST(Objects, HaveTheBytesOfTheirBlocks) {
  const Folder folder;
  writeText(folder.path() / "skinned.gltf", R"({"asset": {"version": "2.0"}, "materials": [{}],
    "meshes": [{"primitives": [{"material": 0,
      "attributes": {"POSITION": 0, "NORMAL": 1, "JOINTS_0": 2, "WEIGHTS_0": 3}}]}],
    "accessors": [{"componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
      {"componentType": 5126, "count": 3, "type": "VEC3"}, {"componentType": 5123, "count": 3, "type": "VEC4"},
      {"componentType": 5126, "count": 3, "type": "VEC4"}]})");
  Options options;
  options.targets = {Target::Hlsl};
  Messages messages;
  const Scene scene = Scene::load(folder / "skinned.gltf", options, messages);
  ASSERT_TRUE(scene) << textOf(messages);
  Graph graph = scene.graph(0, scene.uses(0).at(0), options, messages);
  ASSERT_TRUE(graph) << textOf(messages);
  const Shader shader = graph.generate(options, messages);
  ASSERT_TRUE(shader) << textOf(messages);
  const auto words = check::compile("#define LACQUER_OBJECTS 1\n" + shader.vertexText(Target::Hlsl),
                                    Target::Hlsl, check::Stage::Vertex, "skinned.hlsl");
  ASSERT_TRUE(words) << format(words.error()[0]);
  EXPECT_EQ(stridesOf(*words), (std::set<uint32_t>{16, 128}));
}

/// The material's textures share the sampler of the first.
TEST(SharedSamplers, AreOneByDefines) {
  Options options;
  options.validate = false;
  size_t most = 0;
  for (const Shader& shader : shadersBy("forward", options)) {
    std::string defines, first;
    size_t textures = 0;
    for (const ReflectedTexture& texture : shader.reflection().textures) {
      if (texture.role != TextureRole::Material || !texture.fragment) continue;
      if (textures++ == 0)
        first = texture.sampler;
      else
        defines += fmt::format("#define {} {}\n", texture.sampler, first);
    }
    most = std::max(most, textures);
    const auto words = check::compile(defines + shader.fragmentText(Target::Hlsl), Target::Hlsl,
                                      check::Stage::Fragment, "shared.hlsl");
    ASSERT_TRUE(words) << format(words.error()[0]);
    const std::vector<check::Taken> places = check::reflectPlaces(*words);
    const auto samplers = std::count_if(places.begin(), places.end(), [](const check::Taken& place) {
      return place.set == 1 && place.binding >= check::kHlslSamplerShift;
    });
    EXPECT_EQ(samplers, textures == 0 ? 0 : 1) << shader.id();
  }
  EXPECT_GT(most, 1U);
}

/// Two materials of one structure, of which the second looks a texture up otherwise.
constexpr const char* kSamplers = R"({"asset": {"version": "2.0"}, "images": [{"uri": "a.png"}],
    "samplers": [{}, {"wrapS": 33071, "wrapT": 33648, "magFilter": 9728, "minFilter": 9984}],
    "textures": [{"source": 0}, {"source": 0, "sampler": 0}, {"source": 0, "sampler": 1}],
    "accessors": [{"componentType": 5126, "type": "VEC3", "count": 3},
      {"componentType": 5126, "type": "VEC2", "count": 3}],
    "nodes": [{"mesh": 0}], "meshes": [{"primitives": [
      {"material": 0, "attributes": {"POSITION": 0, "NORMAL": 0, "TEXCOORD_0": 1}},
      {"material": 1, "attributes": {"POSITION": 0, "NORMAL": 0, "TEXCOORD_0": 1}}]}],
    "materials": [
      {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 1}},
       "emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 2}},
      {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 2}},
       "emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 2}}]})";

Contract samplersBy(const Options& options) {
  Messages messages;
  const Scene scene = Scene::fromMemory(kSamplers, "samplers.gltf", options, messages);
  EXPECT_TRUE(scene) << textOf(messages);
  Contract made = contract(scene, {}, options, messages);
  EXPECT_TRUE(made.ok) << textOf(messages);
  return made;
}

/// What the fragment stage binds of samplers, as "sREGISTER spaceSET".
std::set<std::string> samplersOf(const Shader& shader, const std::string& defines) {
  const auto words = check::compile(defines + shader.fragmentText(Target::Hlsl), Target::Hlsl,
                                    check::Stage::Fragment, "static.hlsl");
  EXPECT_TRUE(words) << format(words.error()[0]);
  std::set<std::string> found;
  for (const check::Taken& place : check::reflectPlaces(words.value_or(check::Spirv()))) {
    if (place.binding >= check::kHlslSamplerShift)
      found.insert(fmt::format("s{} space{}", place.binding - check::kHlslSamplerShift, place.set));
  }
  return found;
}

constexpr const char* kRepeat =
    "StaticSampler(s180, space=4, filter=FILTER_MIN_MAG_MIP_LINEAR, addressU=TEXTURE_ADDRESS_WRAP, "
    "addressV=TEXTURE_ADDRESS_WRAP, addressW=TEXTURE_ADDRESS_CLAMP)";
constexpr const char* kClamp =
    "StaticSampler(s97, space=4, filter=FILTER_MIN_MAG_MIP_POINT, addressU=TEXTURE_ADDRESS_CLAMP, "
    "addressV=TEXTURE_ADDRESS_MIRROR, addressW=TEXTURE_ADDRESS_CLAMP)";

TEST(StaticSamplers, AreTheFilesInTheRootSignature) {
  Options options;
  options.targets = {Target::Hlsl};
  const Contract plain = samplersBy(options);
  options.static_samplers = true;
  const Contract made = samplersBy(options);
  ASSERT_EQ(plain.shaders.size(), 1U);
  ASSERT_EQ(made.shaders.size(), 2U) << "one for each way of looking textures up";
  const std::string signature =
      fmt::format("{}, {}, {}", plain.shaders[0].shader.reflection().root_signature, kClamp, kRepeat);
  for (const ContractShader& one : made.shaders) {
    EXPECT_EQ(one.shader.reflection().root_signature, signature);
    EXPECT_EQ(definedIn(one.shader.fragmentText(Target::Hlsl)), signature);
    const std::set<std::string> bound = samplersOf(one.shader, "");
    EXPECT_TRUE(bound.contains("s180 space4") && bound.contains("s97 space4"));
    EXPECT_TRUE(
        std::none_of(bound.begin(), bound.end(), [](const auto& at) { return at.ends_with("space1"); }));
    // Where there are no spaces they are bound, each once.
    const size_t frames = bound.size() - 2;
    EXPECT_EQ(samplersOf(one.shader, "#define LACQUER_SPACES 0\n").size(), frames + 2);
  }
}

TEST(StaticSamplers, AreReflected) {
  Options options;
  options.static_samplers = true;
  const Contract made = samplersBy(options);
  const TextureSampler repeat{Wrap::Repeat, Wrap::Repeat, Filter::Linear, Filter::LinearMipmapLinear};
  const TextureSampler clamp{Wrap::Clamp, Wrap::Mirror, Filter::Nearest, Filter::NearestMipmapNearest};
  for (const ContractMaterial& material : made.materials) {
    const Reflection& reflection = made.shaders.at(material.uses.at(0).shader).shader.reflection();
    for (const UsedTexture& used : material.uses[0].textures) {
      const auto slot = std::find_if(reflection.textures.begin(), reflection.textures.end(),
                                     [&](const ReflectedTexture& one) { return one.slot == used.slot; });
      ASSERT_NE(slot, reflection.textures.end());
      EXPECT_EQ(slot->static_sampler, used.texture == 2 ? clamp : repeat) << used.slot;
      EXPECT_EQ(slot->static_register, used.texture == 2 ? 97U : 180U) << used.slot;
    }
    for (const ReflectedTexture& texture : reflection.textures)
      EXPECT_EQ(texture.static_sampler.has_value(), texture.role == TextureRole::Material) << texture.name;
  }
}

/// What an engine makes shaders by before there are any.
TEST(StaticSamplers, TellStructuresApart) {
  for (const bool fixed : {false, true}) {
    Options options;
    options.static_samplers = fixed;
    Messages messages;
    const Scene scene = Scene::fromMemory(kSamplers, "samplers.gltf", options, messages);
    std::set<std::string> structures;
    for (size_t i = 0; i < 2; ++i)
      structures.insert(scene.graph(i, {true}, options, messages).structure(options, messages));
    EXPECT_EQ(structures.size(), fixed ? 2U : 1U);
    EXPECT_FALSE(structures.contains("")) << textOf(messages);
  }
}

/// A graph that is written and read makes the same shader.
TEST(StaticSamplers, AreInTheGraphsText) {
  Options options;
  options.static_samplers = true;
  options.validate = false;
  options.targets = {Target::Hlsl};
  Messages messages;
  const Scene scene = Scene::fromMemory(kSamplers, "samplers.gltf", options, messages);
  Graph graph = scene.graph(0, {true}, options, messages);
  ASSERT_TRUE(graph) << textOf(messages);
  const std::string text = graph.toJson();
  EXPECT_NE(text.find(R"("sampler": ["clamp", "mirror", "nearest", "nearest-mipmap-nearest"])"),
            std::string::npos)
      << text;
  Graph again = Graph::fromJson(text, "samplers.json", messages);
  ASSERT_TRUE(again) << textOf(messages);
  EXPECT_EQ(again.toJson(), text);
  EXPECT_EQ(again.generate(options, messages).id(), graph.generate(options, messages).id());
}

TEST(StaticSamplers, AreNotOfProgramsThatMaterialsShare) {
  for (const bool fallback : {false, true}) {
    Options options;
    options.static_samplers = true;
    options.fallback = fallback;
    options.programs = fallback ? 0 : 1;
    Messages messages;
    const Scene scene = Scene::fromMemory(kSamplers, "samplers.gltf", {}, messages);
    EXPECT_FALSE(contract(scene, {}, options, messages).ok);
    EXPECT_NE(textOf(messages).find("shared-samplers"), std::string::npos) << textOf(messages);
  }
}

}  // namespace
}  // namespace lacquer::test
