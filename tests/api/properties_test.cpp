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

}  // namespace
}  // namespace lacquer::test
