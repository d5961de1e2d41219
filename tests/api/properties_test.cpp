// Which properties of a material change a number, a texture or the shader.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "inputs.h"

namespace lacquer::test {
namespace {

const PropertyUse* find(const std::vector<PropertyUse>& uses, const std::string& pointer) {
  const auto it =
      std::find_if(uses.begin(), uses.end(), [&](const PropertyUse& use) { return use.pointer == pointer; });
  return it == uses.end() ? nullptr : &*it;
}

std::string withRoughness(double roughness) {
  return fmt::format(
      R"({{"asset": {{"version": "2.0"}}, "images": [{{"uri": "a.png"}}], "textures": [{{"source": 0}}],
    "materials": [{{"pbrMetallicRoughness": {{"roughnessFactor": {}, "baseColorTexture": {{"index": 0}}}},
                   "extensions": {{"KHR_materials_coat": {{"coatFactor": 1}}}}}}]}})",
      roughness);
}

TEST(Properties, SayWhatTheirChangeIs) {
  Messages messages;
  const Options options = quick();
  const Scene scene = Scene::fromMemory(withRoughness(0.5), "a.gltf", options, messages);
  const std::vector<PropertyUse> uses = scene.properties(0, kUnusedAttributes, options, messages);
  EXPECT_EQ(errorsOf(messages), "");
  const PropertyUse* roughness = find(uses, "/materials/0/pbrMetallicRoughness/roughnessFactor");
  ASSERT_NE(roughness, nullptr);
  EXPECT_EQ(roughness->change, Change::Numbers);
  EXPECT_EQ(roughness->name, "roughness_factor");
  const PropertyUse* texture = find(uses, "/materials/0/pbrMetallicRoughness/baseColorTexture");
  ASSERT_NE(texture, nullptr);
  EXPECT_EQ(texture->change, Change::Textures);
  const PropertyUse* emission = find(uses, "/materials/0/emissiveFactor");
  ASSERT_NE(emission, nullptr);
  EXPECT_EQ(emission->change, Change::Program);
  EXPECT_TRUE(find(uses, "/materials/0/extensions/KHR_materials_coat/coatFactor"));
  EXPECT_FALSE(find(uses, "/materials/0/extensions/KHR_materials_sheen/sheenColorFactor"));
  // Each once.
  for (const PropertyUse& use : uses)
    EXPECT_EQ(std::count_if(uses.begin(), uses.end(),
                            [&](const auto& other) { return other.pointer == use.pointer; }),
              1)
        << use.pointer;
  // What is a number is one: the same shader, and its block is what changes.
  const Scene other = Scene::fromMemory(withRoughness(0.25), "a.gltf", options, messages);
  Graph a = scene.graph(0, kUnusedAttributes, options, messages);
  Graph b = other.graph(0, kUnusedAttributes, options, messages);
  EXPECT_EQ(a.generate(options, messages).id(), b.generate(options, messages).id());
}

/// A tool that watches a property keeps it editable.
TEST(Properties, ThatAreWatchedAreNumbers) {
  Messages messages;
  Options options = quick();
  const Scene scene = Scene::fromMemory(withRoughness(0.5), "a.gltf", options, messages);
  const std::vector<PropertyUse> before = scene.properties(0, kUnusedAttributes, options, messages);
  size_t watched = 0;
  for (const PropertyUse& use : before) {
    if (use.change != Change::Program || use.live.empty()) continue;
    options.live = use.live;
    const std::vector<PropertyUse> after = scene.properties(0, kUnusedAttributes, options, messages);
    const PropertyUse* now = find(after, use.pointer);
    ASSERT_NE(now, nullptr);
    EXPECT_EQ(now->change, Change::Numbers) << use.pointer;
    ++watched;
  }
  EXPECT_GT(watched, 0u);
  EXPECT_EQ(errorsOf(messages), "");
  EXPECT_TRUE(scene.properties(9, kUnusedAttributes, options, messages).empty());
  EXPECT_EQ(errorsOf(messages), "no-such-material");
}

/// A watch list of pointers keeps a material's own numbers, those that are folded at their defaults among
/// them.
TEST(Properties, ThatAreWatchedByPointerAreNumbers) {
  Messages messages;
  Options options = quick();
  const std::string two = R"({"asset": {"version": "2.0"}, "materials": [
    {"extensions": {"KHR_materials_coat": {"coatFactor": 1}, "KHR_materials_ior": {}}}, {"extensions": {"KHR_materials_coat": {"coatFactor": 1}}}]})";
  const Scene scene = Scene::fromMemory(two, "a.gltf", options, messages);
  const std::string black = "/materials/0/emissiveFactor";
  const std::string white = "/materials/0/extensions/KHR_materials_coat/coatColorFactor";
  for (const std::string& pointer : {black, white}) {
    options.live.clear();
    const std::vector<PropertyUse> before = scene.properties(0, kUnusedAttributes, options, messages);
    ASSERT_TRUE(find(before, pointer));
    EXPECT_EQ(find(before, pointer)->change, Change::Program) << pointer;
    options.live = {pointer};
    const std::vector<PropertyUse> after = scene.properties(0, kUnusedAttributes, options, messages);
    EXPECT_EQ(find(after, pointer)->change, Change::Numbers) << pointer;
  }
  // Of the other material nothing has changed, in a run over both, too.
  options.live = {black, white};
  options.targets = {};
  options.properties = true;
  const Contract made = contract(scene, {}, options, messages);
  ASSERT_EQ(made.materials.size(), 2u);
  const PropertyUse* watched = find(made.materials[0].uses.at(0).properties, black);
  const PropertyUse* plain = find(made.materials[1].uses.at(0).properties, "/materials/1/emissiveFactor");
  ASSERT_TRUE(watched != nullptr && plain != nullptr);
  EXPECT_EQ(watched->change, Change::Numbers);
  EXPECT_EQ(plain->change, Change::Program);
  EXPECT_NE(made.materials[0].uses[0].shader_id, made.materials[1].uses[0].shader_id);
  EXPECT_EQ(errorsOf(messages), "");
  options.live = {"/materials/0/glow"};
  EXPECT_FALSE(scene.graph(0, kUnusedAttributes, options, messages));
  EXPECT_EQ(errorsOf(messages), "unknown-property");
}

/// With the option a manifest says what the scene says, and reads back so.
TEST(Properties, AreInTheManifestWhereTheyAreAskedFor) {
  Messages messages;
  Options options = quick();
  options.targets = {};
  const Scene scene = Scene::fromMemory(withRoughness(0.5), "a.gltf", options, messages);
  EXPECT_EQ(manifestJson(contract(scene, {}, options, messages), "a.gltf").find("\"properties\""),
            std::string::npos);
  options.properties = true;
  const Contract made = contract(scene, {}, options, messages);
  const ContractUse& use = made.materials.at(0).uses.at(0);
  const std::vector<PropertyUse> expected = scene.properties(0, use.attributes, options, messages);
  ASSERT_EQ(use.properties.size(), expected.size());
  for (const PropertyUse& one : use.properties) {
    const PropertyUse* same = find(expected, one.pointer);
    ASSERT_NE(same, nullptr) << one.pointer;
    EXPECT_EQ(one.change, same->change) << one.pointer;
    EXPECT_EQ(one.live, same->live) << one.pointer;
  }
  const std::string text = manifestJson(made, "a.gltf");
  EXPECT_NE(text.find(R"("/materials/0/alphaMode": {"change": "program"})"), std::string::npos) << text;
  EXPECT_NE(text.find(R"("change": "textures")"), std::string::npos);
  EXPECT_EQ(errorsOf(messages), "");
}

}  // namespace
}  // namespace lacquer::test
