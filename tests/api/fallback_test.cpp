// A fallback beside each material's program: bindings, block and vertex inputs are such that an engine
// exchanges the pipeline and nothing else.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <set>

#include "inputs.h"

namespace lacquer::test {
namespace {

/// Unlit and lit, masked, blended and looking through, with textures and without, with a skin and without.
constexpr const char* kMixed = R"({
  "asset": {"version": "2.0"},
  "extensionsUsed": ["KHR_materials_clearcoat", "KHR_materials_unlit", "KHR_materials_transmission",
                     "KHR_materials_sheen", "KHR_texture_transform"],
  "images": [{"uri": "a.png"}, {"uri": "b.png"}], "textures": [{"source": 0}, {"source": 1}],
  "materials": [
    {"name": "plain", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0.125, 1]}},
    {"name": "coated", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
     "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatTexture": {"index": 1}}}},
    {"name": "unlit", "alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorTexture": {"index": 1}},
     "extensions": {"KHR_materials_unlit": {}}},
    {"name": "cloth", "alphaMode": "BLEND", "normalTexture": {"index": 1},
     "extensions": {"KHR_materials_sheen": {"sheenColorFactor": [1, 0.5, 0.25], "sheenRoughnessFactor": 0.5}}},
    {"name": "glass", "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}},
    {"name": "tinted", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
     "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.5}}}],
  "accessors": [{"count": 3, "type": "VEC3", "componentType": 5126}, {"count": 3, "type": "VEC2", "componentType": 5126},
                {"count": 3, "type": "VEC4", "componentType": 5126}, {"count": 3, "type": "VEC4", "componentType": 5121}],
  "meshes": [{"primitives": [
    {"material": 0, "attributes": {"POSITION": 0, "NORMAL": 0}},
    {"material": 1, "attributes": {"POSITION": 0, "NORMAL": 0, "TEXCOORD_0": 1}},
    {"material": 2, "attributes": {"POSITION": 0, "TEXCOORD_0": 1}},
    {"material": 3, "attributes": {"POSITION": 0, "NORMAL": 0, "TEXCOORD_0": 1, "TANGENT": 2}},
    {"material": 4, "attributes": {"POSITION": 0, "NORMAL": 0}},
    {"material": 5, "attributes": {"POSITION": 0, "NORMAL": 0, "TEXCOORD_0": 1}},
    {"material": 0, "attributes": {"POSITION": 0, "NORMAL": 0, "JOINTS_0": 3, "WEIGHTS_0": 2}},
    {"material": 1, "attributes": {"POSITION": 0, "NORMAL": 0, "TEXCOORD_0": 1, "JOINTS_0": 3, "WEIGHTS_0": 2}}]}]
})";

Options withFallback() {
  Options options = quick();
  options.targets = {Target::Spirv};
  options.fallback = true;
  return options;
}

Contract made(const Scene& scene, const Options& options) {
  Messages messages;
  Contract contract = lacquer::contract(scene, {}, options, messages);
  EXPECT_EQ(errorsOf(messages), "");
  return contract;
}

Contract mixed(const Options& options) {
  Messages messages;
  const Scene scene = Scene::fromMemory(kMixed, "mixed", options, messages);
  EXPECT_TRUE(scene) << errorsOf(messages);
  return made(scene, options);
}

using Place = std::array<uint32_t, 3>;
Place placeOf(const BoundResource& of) { return {of.at.set, of.at.binding, of.at.flat}; }

std::vector<std::byte> packed(const Shader& shader, const ContractUse& use) {
  std::vector<std::byte> block(shader.uniformSize());
  shader.pack(numbersOf(use), block);
  return block;
}

/// What one layout says of both must be enough for the material's own shader.
void compareStages(const BoundResource& own, const BoundResource& fallback) {
  EXPECT_TRUE(fallback.vertex || !own.vertex) << own.name;
  EXPECT_TRUE(fallback.fragment || !own.fragment) << own.name;
}

/// All that the material's own shader binds lies where the fallback has it.
void compareBindings(const Reflection& own, const Reflection& fallback) {
  for (const UniformBlock& block : own.blocks) {
    const auto same = std::find_if(fallback.blocks.begin(), fallback.blocks.end(),
                                   [&](const UniformBlock& one) { return one.name == block.name; });
    ASSERT_NE(same, fallback.blocks.end()) << block.name;
    EXPECT_EQ(placeOf(block), placeOf(*same)) << block.name;
    compareStages(block, *same);
    if (block.role != BlockRole::Material) continue;
    // The fallback's bytes, then the material's own.
    ASSERT_FALSE(block.fields.empty());
    EXPECT_EQ(block.fields[0].name, "fallback");
    EXPECT_EQ(block.fields[0].offset, 0U);
    EXPECT_EQ(block.fields[0].array * block.fields[0].stride, same->size);
    for (size_t i = 1; i < block.fields.size(); ++i) EXPECT_GE(block.fields[i].offset, same->size);
  }
  for (const ReflectedTexture& texture : own.textures) {
    const auto same =
        std::find_if(fallback.textures.begin(), fallback.textures.end(),
                     [&](const ReflectedTexture& one) { return placeOf(one) == placeOf(texture); });
    ASSERT_NE(same, fallback.textures.end()) << texture.name;
    compareStages(texture, *same);
    EXPECT_EQ(texture.type, same->type) << texture.name;
    EXPECT_EQ(texture.srgb, same->srgb) << texture.name;
    EXPECT_EQ(texture.slot, same->slot) << texture.name;
  }
  for (const ShaderInput& input : own.inputs) {
    const auto same = std::find_if(fallback.inputs.begin(), fallback.inputs.end(),
                                   [&](const ShaderInput& one) { return one.name == input.name; });
    ASSERT_NE(same, fallback.inputs.end()) << input.name;
    EXPECT_EQ(input.location, same->location) << input.name;
    EXPECT_EQ(input.type, same->type) << input.name;
  }
}

/// One buffer and one set of textures are both shaders'.
void compareUse(const ContractUse& use, const Contract& contract) {
  ASSERT_TRUE(use.fallback);
  const ContractUse& other = *use.fallback;
  if (other.shader_id == use.shader_id) {
    EXPECT_EQ(other.block, use.block);
    EXPECT_EQ(other.shader, use.shader);
    return;
  }
  const Shader& own = contract.shaders.at(use.shader).shader;
  const Shader& fallback = contract.shaders.at(other.shader).shader;
  EXPECT_EQ(fallback.id(), other.shader_id);
  compareBindings(own.reflection(), fallback.reflection());
  ASSERT_EQ(other.block.size(), fallback.uniformSize());
  ASSERT_EQ(use.block.size(), std::max(own.uniformSize(), fallback.uniformSize()));
  EXPECT_TRUE(std::equal(other.block.begin(), other.block.end(), use.block.begin()));
  EXPECT_EQ(packed(fallback, other), other.block);
  std::vector<std::byte> block = packed(own, use);
  block.resize(use.block.size());
  std::copy(other.block.begin(), other.block.end(), block.begin());
  EXPECT_EQ(block, use.block);
  for (const UsedTexture& texture : use.textures) {
    const auto same = std::find_if(other.textures.begin(), other.textures.end(),
                                   [&](const UsedTexture& one) { return one.slot == texture.slot; });
    ASSERT_NE(same, other.textures.end()) << texture.slot;
    EXPECT_EQ(same->texture, texture.texture);
    EXPECT_EQ(same->texcoord, texture.texcoord);
  }
  for (const ReflectedTexture& texture : fallback.reflection().textures) {
    if (texture.role != TextureRole::Material) continue;
    EXPECT_TRUE(std::any_of(other.textures.begin(), other.textures.end(), [&](const UsedTexture& one) {
      return one.slot == texture.name;
    })) << texture.name;
  }
}

/// Materials whose patterns read attributes by name, all of which all primitives have.
std::string readingAttributes(const std::vector<Strings>& names) {
  const std::string out = R"("outputs": {"out": {"nodetype": "output", "type": "color3"}})";
  std::string procedurals, materials, primitives;
  for (size_t i = 0; i < names.size(); ++i) {
    std::string nodes;
    size_t last = 0, count = names[i].size();
    for (const std::string& name : names[i]) {
      nodes += fmt::format(
          R"({}{{"nodetype": "geompropvalue", "type": "color3", {}, "inputs": {{"geomprop": {{"nodetype": "input", "type": "string", "value": "{}"}}}}}})",
          nodes.empty() ? "" : ", ", out, name);
    }
    for (size_t k = 1; k < names[i].size(); ++k, last = count++) {
      nodes += fmt::format(
          R"(, {{"nodetype": "multiply", "type": "color3", {}, "inputs": {{"in1": {{"nodetype": "input", "type": "color3", "node": {}}}, "in2": {{"nodetype": "input", "type": "color3", "node": {}}}}}}})",
          out, k == 1 ? 0 : last, k);
    }
    const char* const comma = i == 0 ? "" : ", ";
    procedurals += fmt::format(
        R"({}{{"name": "p{}", "nodetype": "nodegraph", "type": "color3", "inputs": {{}}, "nodes": [{}], "outputs": {{"out": {{"nodetype": "output", "type": "color3", "node": {}}}}}}})",
        comma, i, nodes, count - 1);
    materials += fmt::format(
        R"({}{{"pbrMetallicRoughness": {{"baseColorTexture": {{"index": 0, "extensions": {{"KHR_texture_procedurals": {{"index": {}, "output": "out"}}}}}}}}}})",
        comma, i);
    primitives += fmt::format(
        R"({}{{"material": {}, "attributes": {{"POSITION": 0, "NORMAL": 0, "_APPLE": 0, "_WETNESS": 0, "COLOR_1": 0, "TEXCOORD_4": 0}}}})",
        comma, i);
  }
  return fmt::format(
      R"({{"asset": {{"version": "2.0"}}, "extensionsUsed": ["KHR_texture_procedurals", "EXT_texture_procedurals_mx_1_39"],
  "images": [{{"uri": "a.png"}}], "textures": [{{"source": 0}}], "materials": [{}],
  "extensions": {{"KHR_texture_procedurals": {{"procedurals": [{}]}}}},
  "accessors": [{{"count": 3, "type": "VEC3", "componentType": 5126}}], "meshes": [{{"primitives": [{}]}}]}})",
      materials, procedurals, primitives);
}

std::set<std::string> fallbacksOf(const Contract& contract) {
  std::set<std::string> ids;
  for (const ContractMaterial& material : contract.materials) {
    for (const ContractUse& use : material.uses) {
      SCOPED_TRACE(material.name);
      compareUse(use, contract);
      if (use.fallback) ids.insert(use.fallback->shader_id);
    }
  }
  return ids;
}

/// One for what is opaque, masked or blended, one for what looks through, one with a skin.
TEST(Fallback, OneForEachStageAndWhatLooksThrough) {
  const Contract contract = mixed(withFallback());
  EXPECT_EQ(fallbacksOf(contract).size(), 3U);
  EXPECT_EQ(contract.shaders.size(), 8U + 3U);
  const Drawn drawn = contract.drawn(0, 0), fallback = contract.fallback(drawn);
  ASSERT_TRUE(fallback);
  EXPECT_EQ(fallback.material, drawn.material);
  EXPECT_EQ(fallback.shader->shader.id(), drawn.use->fallback->shader_id);
  for (const ContractMaterial& material : contract.materials) {
    for (const ContractUse& use : material.uses) {
      const auto& textures = contract.shaders.at(use.fallback->shader).shader.reflection().textures;
      const bool looks = std::any_of(textures.begin(), textures.end(),
                                     [](const auto& texture) { return texture.name == "scene_behind"; });
      EXPECT_EQ(looks, material.state.pass == Pass::LooksThrough) << material.name;
    }
  }
}

/// Attributes by name take free locations, which depend on what a shader reads: each own shader has its
/// fallback's.
TEST(Fallback, AttributesByNameAtOnePlace) {
  const Options options = withFallback();
  Messages messages;
  const std::string text = readingAttributes({{"_APPLE", "_WETNESS"},
                                              {"_WETNESS"},
                                              {"COLOR_1", "_APPLE"},
                                              {"COLOR_1"},
                                              {"_APPLE", "TEXCOORD_4"},
                                              {"TEXCOORD_4"}});
  const Scene scene = Scene::fromMemory(text, "attributes", options, messages);
  ASSERT_TRUE(scene) << errorsOf(messages);
  const Contract contract = made(scene, options);
  EXPECT_EQ(fallbacksOf(contract).size(), 1U);
  EXPECT_EQ(contract.shaders.size(), 7U);
  const auto locations = [&](const std::string& id) {
    std::map<std::string, uint32_t> by_name;
    for (const ContractShader& one : contract.shaders) {
      if (one.shader.id() != id) continue;
      for (const ShaderInput& input : one.shader.reflection().inputs) by_name[input.name] = input.location;
    }
    return by_name;
  };
  using Locations = std::map<std::string, uint32_t>;
  const ContractUse& use = contract.materials.at(1).uses.at(0);
  EXPECT_EQ(locations(use.fallback->shader_id), (Locations{{"POSITION", 0},
                                                           {"NORMAL", 1},
                                                           {"COLOR_1", 8},
                                                           {"TEXCOORD_4", 9},
                                                           {"_APPLE", 10},
                                                           {"_WETNESS", 11}}));
  EXPECT_EQ(locations(use.shader_id), (Locations{{"POSITION", 0}, {"NORMAL", 1}, {"_WETNESS", 11}}));
}

/// Of two materials each moves its own texture transform to the vertices, their fallback chooses between them
/// in the fragments: what is bound must be seen by both stages.
TEST(Fallback, StagesOfAllThatItStandsFor) {
  constexpr const char* kTransforms = R"({
  "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_texture_transform"],
  "images": [{"uri": "a.png"}], "textures": [{"source": 0}],
  "materials": [
    {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"scale": [2, 2]}}}}},
    {"emissiveFactor": [1, 1, 1],
     "emissiveTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"scale": [3, 2]}}}}]})";
  Options options = withFallback();
  options.targets.push_back(Target::Wgsl);
  options.validate = false;
  Messages messages;
  const Scene scene = Scene::fromMemory(kTransforms, "transforms", options, messages);
  ASSERT_TRUE(scene) << errorsOf(messages);
  const Contract contract = made(scene, options);
  EXPECT_EQ(fallbacksOf(contract).size(), 1U);
  for (const ContractMaterial& material : contract.materials) {
    for (const ContractUse* use : {&material.uses.at(0), material.uses.at(0).fallback.get()}) {
      const Reflection& reflection = contract.shaders.at(use->shader).shader.reflection();
      for (const UniformBlock& block : reflection.blocks) {
        if (block.role != BlockRole::Material) continue;
        EXPECT_TRUE(block.vertex && block.fragment) << use->shader_id;
      }
      // No more than is read.
      for (const ReflectedTexture& texture : reflection.textures)
        EXPECT_FALSE(texture.vertex) << texture.name;
    }
  }
  const std::string manifest = manifestJson(contract, "transforms");
  size_t rows = 0;
  const std::string row = R"("name": "Material",)";
  for (size_t at = manifest.find(row); at != std::string::npos; at = manifest.find(row, at + 1)) {
    EXPECT_LT(manifest.find("\"vertex\"", at), manifest.find("\"buffer\"", at)) << at;
    ++rows;
  }
  EXPECT_EQ(rows, contract.shaders.size());
}

TEST(Fallback, EveryExample) {
  Options options = withFallback();
  size_t shared = 0;
  for (const std::string& file : examples()) {
    SCOPED_TRACE(file);
    Messages messages;
    const Scene scene = Scene::load(file, options, messages);
    ASSERT_TRUE(scene);
    const Contract contract = made(scene, options);
    for (const std::string& id : fallbacksOf(contract)) shared += id.empty() ? 0 : 1;
  }
  EXPECT_GT(shared, examples().size() / 2);
}

TEST(Fallback, OfAMaterialAloneItsOwnShader) {
  Options options = withFallback();
  const Contract contract = made(paintScene(), options);
  EXPECT_EQ(contract.shaders.size(), 1U);
  EXPECT_EQ(fallbacksOf(contract), std::set<std::string>{contract.shaders[0].shader.id()});
  options.fallback = false;
  EXPECT_EQ(made(paintScene(), options).shaders[0].shader.id(), contract.shaders[0].shader.id());
}

/// A folder's manifest has the same, reads back, and a second run with a cache writes the same bytes.
TEST(Fallback, TheManifestSaysIt) {
  const std::filesystem::path folder = emptyFolder();
  const std::string file = (folder / "mixed.gltf").string();
  {
    std::FILE* to = std::fopen(file.c_str(), "wb");
    ASSERT_NE(to, nullptr);
    std::fwrite(kMixed, 1, std::strlen(kMixed), to);
    std::fclose(to);
  }
  Options options = withFallback();
  const Contract contract = mixed(options);
  options.cache = (folder / "cache").string();
  options.pipelines = (folder / "pipelines.json").string();
  std::string first;
  for (const char* to : {"a", "b"}) {
    Messages messages;
    const Report report = generate({file}, {}, (folder / to).string(), options, messages);
    EXPECT_TRUE(report.ok);
    const std::string text = readBytes(folder / to / "manifest.json");
    EXPECT_EQ(manifestJson(contract, sourceIn(text)), text);
    if (first.empty()) first = text;
    EXPECT_EQ(text, first);
    const std::optional<Manifest> read = readManifest((folder / to / "manifest.json").string(), {}, messages);
    ASSERT_TRUE(read);
    EXPECT_EQ(manifestJson(*read), text);
    for (size_t i = 0; i < contract.materials.size(); ++i) {
      const ContractUse &a = contract.materials[i].uses.at(0), &b = read->files[0].materials[i].uses.at(0);
      ASSERT_TRUE(b.fallback);
      EXPECT_EQ(a.fallback->shader, b.fallback->shader);
      EXPECT_EQ(a.fallback->uniforms, b.fallback->uniforms);
    }
  }
  // What is drawn with first comes first.
  const std::string pipelines = readBytes(options.pipelines);
  const ContractUse& use = contract.materials[0].uses.at(0);
  EXPECT_NE(pipelines.find(use.shader_id), std::string::npos);
  EXPECT_LT(pipelines.find(use.fallback->shader_id), pipelines.find(use.shader_id));
}

/// A texture of linear colours, as channels in another order are, and one that is decoded are of two
/// programs.
TEST(Fallback, WhatCannotBeOneIsSaid) {
  const std::filesystem::path folder = emptyFolder();
  Messages messages;
  EXPECT_TRUE(generate(examples(), {}, folder.string(), withFallback(), messages).ok);
  size_t said = 0;
  for (const Message& message : messages) {
    if (message.code != "fallbacks") continue;
    ++said;
    EXPECT_EQ(
        message.message,
        "there are 3 fallbacks where 2 would do: the texture 'base_color_texture' has another format in "
        "another material");
  }
  EXPECT_EQ(said, 1U);
}

TEST(Fallback, WrongOptionsAreToldOf) {
  const auto errors = [](const Options& options) {
    Messages messages;
    lacquer::contract(paintScene(), {}, options, messages);
    return errorsOf(messages);
  };
  Options options = withFallback();
  options.programs = 2;
  EXPECT_EQ(errors(options), "fallback-programs");
  options.programs = 0;
  options.parameters = Parameters::Baked;
  EXPECT_EQ(errors(options), "fallback-parameters");
  options.parameters = Parameters::Spec;
  EXPECT_EQ(errors(options), "fallback-parameters");
  const std::filesystem::path folder = emptyFolder();
  Messages messages;
  Plan plan;
  plan.ninja = (folder / "build.ninja").string();
  plan.program = "lacquer";
  EXPECT_FALSE(lacquer::plan(plan, examples(), {}, (folder / "out").string(), withFallback(), messages).ok);
  EXPECT_EQ(errorsOf(messages), "fallback-plan");
}

/// Their numbers are no property's.
TEST(Fallback, SurfacesOfMaterialXHaveOne) {
  constexpr const char* kText = R"(<materialx version="1.39">
  <standard_surface name="a" type="surfaceshader"><input name="base_color" type="color3" value="0.1,0.5,0.3"/></standard_surface>
  <UsdPreviewSurface name="b" type="surfaceshader"><input name="diffuseColor" type="color3" value="0.1,0.2,0.3"/></UsdPreviewSurface>
  <standard_surface name="c" type="surfaceshader"><input name="metalness" type="float" value="0.25"/></standard_surface>
  <surfacematerial name="A" type="material"><input name="surfaceshader" type="surfaceshader" nodename="a"/></surfacematerial>
  <surfacematerial name="B" type="material"><input name="surfaceshader" type="surfaceshader" nodename="b"/></surfacematerial>
  <surfacematerial name="C" type="material"><input name="surfaceshader" type="surfaceshader" nodename="c"/></surfacematerial>
</materialx>)";
  const Options options = withFallback();
  Messages messages;
  const Scene scene = Scene::fromMemory(kText, "three.mtlx", options, messages);
  ASSERT_TRUE(scene) << errorsOf(messages);
  const Contract contract = made(scene, options);
  ASSERT_EQ(contract.materials.size(), 3U);
  EXPECT_LT(fallbacksOf(contract).size(), 3U);
  for (const ContractMaterial& material : contract.materials) EXPECT_FALSE(material.uses.empty());
}

}  // namespace
}  // namespace lacquer::test
