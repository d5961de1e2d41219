// What a shader is bound to, as values of C++ and of C, is what its entry in the manifest says.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <nlohmann/json.hpp>

#include "handle.h"
#include "lacquer.h"
#include "support/cases.h"

namespace lacquer::test::reflection_test {
namespace {

using nlohmann::json;

constexpr const char* kRoles[] = {"frame", "lights", "material", "object", "list"};
constexpr const char* kTextureRoles[] = {"material", "environment", "object"};

json stagesOf(bool vertex, bool fragment) {
  json stages = json::array();
  if (vertex) stages.push_back("vertex");
  if (fragment) stages.push_back("fragment");
  return stages;
}

/// The rows of the entry from values of C++.
json blocksOf(const Reflection& of) {
  json rows = json::array();
  for (const UniformBlock& block : of.blocks) {
    json fields = json::array();
    for (const BlockField& field : block.fields)
      fields.push_back({{"name", field.name}, {"type", field.type}, {"offset", field.offset}});
    rows.push_back({{"block", block.name},
                    {"role", kRoles[static_cast<int>(block.role)]},
                    {"list", block.list},
                    {"set", block.at.set},
                    {"binding", block.at.binding},
                    {"flat", block.at.flat},
                    {"stages", stagesOf(block.vertex, block.fragment)},
                    {"fields", std::move(fields)}});
  }
  return rows;
}

/// The same from values of C.
json blocksOf(const lacquer_shader* shader) {
  json rows = json::array();
  lacquer_block block;
  for (size_t b = 0; lacquer_shader_block(shader, b, &block, sizeof block) != 0; ++b) {
    json fields = json::array();
    lacquer_field field;
    for (size_t f = 0; lacquer_shader_field(shader, b, f, &field, sizeof field) != 0; ++f)
      fields.push_back({{"name", field.name}, {"type", field.type}, {"offset", field.offset}});
    EXPECT_EQ(fields.size(), block.field_count);
    rows.push_back({{"block", block.name},
                    {"role", kRoles[block.role]},
                    {"list", block.list},
                    {"set", block.at.set},
                    {"binding", block.at.binding},
                    {"flat", block.at.flat},
                    {"stages", stagesOf(block.at.vertex != 0, block.at.fragment != 0)},
                    {"fields", std::move(fields)}});
  }
  EXPECT_EQ(rows.size(), lacquer_shader_block_count(shader));
  return rows;
}

/// The rows of the entry, with the members that the others have.
json blocksOf(const json& entry) {
  json rows = json::array();
  for (const json& block : entry["uniforms"]) {
    json fields = json::array();
    for (const json& field : block["fields"])
      fields.push_back({{"name", field["name"]}, {"type", field["type"]}, {"offset", field["offset"]}});
    json row = {{"list", block.value("list", "")}, {"fields", std::move(fields)}};
    for (const char* name : {"block", "role", "set", "binding", "flat", "stages"}) row[name] = block[name];
    rows.push_back(std::move(row));
  }
  return rows;
}

json texturesOf(const lacquer_shader* shader) {
  json rows = json::array();
  lacquer_texture texture;
  for (size_t t = 0; lacquer_shader_texture(shader, t, &texture, sizeof texture) != 0; ++t) {
    json row = {
        {"name", texture.name},       {"type", texture.type},
        {"sampler", texture.sampler}, {"role", kTextureRoles[texture.role]},
        {"set", texture.at.set},      {"binding", texture.at.binding},
        {"flat", texture.at.flat},    {"stages", stagesOf(texture.at.vertex != 0, texture.at.fragment != 0)}};
    if (texture.role == LACQUER_TEXTURE_MATERIAL) row["color_space"] = texture.srgb != 0 ? "srgb" : "linear";
    if (*texture.array != 0) row["array"] = texture.array, row["number"] = texture.number;
    if (texture.layered != 0) row["layered"] = true;
    if (texture.has_static_sampler != 0) {
      constexpr const char* kWraps[] = {"repeat", "clamp", "mirror"};
      constexpr const char* kFilters[] = {"",
                                          "nearest",
                                          "linear",
                                          "nearest-mipmap-nearest",
                                          "linear-mipmap-nearest",
                                          "nearest-mipmap-linear",
                                          "linear-mipmap-linear"};
      row["static_sampler"] = {{"wrap_s", kWraps[texture.wrap_s]},
                               {"wrap_t", kWraps[texture.wrap_t]},
                               {"mag_filter", kFilters[texture.mag_filter]},
                               {"min_filter", kFilters[texture.min_filter]}};
      row["static_register"] = texture.static_register;
    }
    rows.push_back(std::move(row));
  }
  EXPECT_EQ(rows.size(), lacquer_shader_texture_count(shader));
  return rows;
}

using Place = int (*)(const lacquer_shader*, size_t, lacquer_place*, size_t);
json placesOf(const lacquer_shader* shader, Place place) {
  json rows = json::array();
  lacquer_place row;
  for (size_t i = 0; place(shader, i, &row, sizeof row) != 0; ++i)
    rows.push_back({{"name", row.name}, {"type", row.type}, {"location", row.location}});
  return rows;
}

/// Where the WGSL and the MSL of the entry have a name.
json rowOf(const json& list, const std::string& name) {
  for (const json& row : list)
    if (row["name"] == name) return row;
  return {};
}

void expectApis(const lacquer_binding& at, const json& entry, const std::string& name, bool texture) {
  const json webgpu = rowOf(entry["webgpu"]["bindings"], name);
  const json metal = rowOf(entry["metal"]["bindings"], name);
  if (at.vertex == 0 && at.fragment == 0) {
    EXPECT_TRUE(webgpu.is_null()) << name;
    return;
  }
  EXPECT_EQ(webgpu["group"], at.wgsl_group) << name;
  EXPECT_EQ(webgpu["binding"], at.wgsl_binding) << name;
  EXPECT_EQ(metal[texture ? "texture" : "buffer"], at.msl_index) << name;
  EXPECT_EQ(webgpu["visibility"].size(), static_cast<size_t>(at.vertex + at.fragment)) << name;
}

struct Case {
  const char* file;
  const char* template_name = "forward";
};

TEST(Reflection, IsTheEntryOfTheManifest) {
  for (const auto& [file, template_name] :
       {Case{"examples/car_paint.gltf"}, Case{"examples/glass.gltf"}, Case{"examples/cloth.gltf"},
        Case{"examples/coat.gltf", "forward_clustered"}}) {
    SCOPED_TRACE(file);
    const std::string path = (sourceFolder() / file).string();
    Messages messages;
    Options options;
    options.targets = {Target::Wgsl, Target::Msl, Target::Essl};
    options.template_name = template_name;
    options.validate = false;
    Graph graph = Scene::load(path, options, messages).graph(0, kUnusedAttributes, options, messages);
    const Shader shader = graph.generate(options, messages);
    ASSERT_TRUE(shader);
    const json entry = json::parse(shader.interfaceJson());
    EXPECT_EQ(blocksOf(shader.reflection()), blocksOf(entry));

    const CMessages said;
    const json wanted = {
        {"targets", {"wgsl", "msl", "essl"}}, {"template", template_name}, {"validate", false}};
    const COptions of_c = optionsFrom(wanted.dump(), said);
    const CScene scene(lacquer_scene_load(path.c_str(), of_c.get(), said));
    const CGraph graph_of_c(lacquer_scene_graph(scene.get(), 0, LACQUER_UNUSED_ATTRIBUTES, of_c.get(), said));
    const CShader c(lacquer_graph_generate(graph_of_c.get(), of_c.get(), said));
    ASSERT_NE(c, nullptr);
    EXPECT_EQ(blocksOf(c.get()), blocksOf(entry));
    EXPECT_EQ(texturesOf(c.get()), entry["textures"]);
    EXPECT_EQ(placesOf(c.get(), lacquer_shader_input), entry["inputs"]);
    EXPECT_EQ(placesOf(c.get(), lacquer_shader_output).size(), entry["outputs"].size());
    lacquer_block block;
    for (size_t b = 0; lacquer_shader_block(c.get(), b, &block, sizeof block) != 0; ++b)
      expectApis(block.at, entry, block.name, false);
    lacquer_texture texture;
    for (size_t t = 0; lacquer_shader_texture(c.get(), t, &texture, sizeof texture) != 0; ++t)
      expectApis(texture.at, entry, texture.name, true);
  }
}

TEST(Reflection, SaysLayersAndStaticSamplers) {
  const CMessages said;
  const json wanted = {
      {"targets", {"essl", "hlsl"}}, {"binding", "arrays"}, {"static_samplers", true}, {"validate", false}};
  const COptions options = optionsFrom(wanted.dump(), said);
  const std::string path = (sourceFolder() / "examples/car_paint.gltf").string();
  const CScene scene(lacquer_scene_load(path.c_str(), options.get(), said));
  const CGraph graph(lacquer_scene_graph(scene.get(), 0, LACQUER_UNUSED_ATTRIBUTES, options.get(), said));
  const CShader shader(lacquer_graph_generate(graph.get(), options.get(), said));
  ASSERT_NE(shader, nullptr);
  const json entry = json::parse(lacquer_shader_interface(shader.get(), nullptr));
  EXPECT_EQ(texturesOf(shader.get()), entry["textures"]);
  size_t layered = 0;
  for (const json& texture : entry["textures"]) {
    layered += texture.contains("layered") ? 1 : 0;
    EXPECT_EQ(texture.contains("static_sampler"), texture["role"] == "material");
  }
  EXPECT_GT(layered, 1U);
}

/// Without bindings for each, the material is a list and its textures have numbers in it.
TEST(Reflection, SaysWhereTheNumbersOfTexturesLie) {
  const CMessages said;
  const json wanted = {{"targets", {"wgsl", "msl"}}, {"binding", "bindless"}, {"validate", false}};
  const COptions options = optionsFrom(wanted.dump(), said);
  const std::string path = (sourceFolder() / "examples/car_paint.gltf").string();
  const CScene scene(lacquer_scene_load(path.c_str(), options.get(), said));
  const CGraph graph(lacquer_scene_graph(scene.get(), 0, LACQUER_UNUSED_ATTRIBUTES, options.get(), said));
  const CShader shader(lacquer_graph_generate(graph.get(), options.get(), said));
  ASSERT_NE(shader, nullptr);
  const json entry = json::parse(lacquer_shader_interface(shader.get(), nullptr));
  EXPECT_EQ(entry["bindless"], true);
  EXPECT_EQ(entry["metal"]["argument_buffers"], true);
  EXPECT_EQ(blocksOf(shader.get()), blocksOf(entry));
  EXPECT_EQ(texturesOf(shader.get()), entry["textures"]);
  size_t numbered = 0;
  const json materials = rowOf(entry["webgpu"]["bindings"], "Materials");
  EXPECT_EQ(materials["buffer"]["type"], "read-only-storage");
  for (const json& texture : entry["textures"]) {
    if (texture["role"] != "material") continue;
    ++numbered;
    EXPECT_EQ(texture["array"], "textures");
    EXPECT_EQ(texture["sampler"], "textures_sampler");
    for (const json& block : entry["uniforms"]) {
      if (block["role"] != "material") continue;
      EXPECT_EQ(rowOf(block["fields"], texture["name"])["offset"], texture["number"]);
    }
  }
  EXPECT_GT(numbered, 0U);
}

/// The lights of clusters are a storage buffer of any length, whichever role they have.
TEST(Reflection, ListsOfLightsAreStorageBuffers) {
  Messages messages;
  Options options;
  options.targets = {Target::Wgsl};
  options.template_name = "forward_clustered";
  const std::string path = (sourceFolder() / "examples/coat.gltf").string();
  Graph graph = Scene::load(path, options, messages).graph(0, kUnusedAttributes, options, messages);
  const Shader shader = graph.generate(options, messages);
  const std::vector<UniformBlock>& blocks = shader.reflection().blocks;
  const auto lights = std::find_if(blocks.begin(), blocks.end(),
                                   [](const UniformBlock& block) { return block.role == BlockRole::Lights; });
  ASSERT_NE(lights, blocks.end());
  EXPECT_EQ(lights->list, "lights");
  EXPECT_FALSE(lights->fields.empty());
  const json entry = json::parse(shader.interfaceJson());
  const json webgpu = rowOf(entry["webgpu"]["bindings"], lights->name);
  EXPECT_EQ(webgpu["buffer"]["type"], "read-only-storage");
  EXPECT_EQ(webgpu["buffer"]["minBindingSize"], lights->size);
  for (const json& block : entry["uniforms"]) {
    if (block["role"] != "lights") continue;
    EXPECT_EQ(block["stride"], lights->size);
    EXPECT_FALSE(block.contains("size"));
  }
}

/// Each texture that the shader has of the material is one of the graph's, with its index in the file.
TEST(Reflection, TexturesOfTheMaterialLeadToTheFile) {
  Messages messages;
  Options options;
  options.targets = {};
  const std::string path = (sourceFolder() / "examples/car_paint.gltf").string();
  Graph graph = Scene::load(path, options, messages).graph(0, kUnusedAttributes, options, messages);
  const std::vector<TextureUse> textures = graph.textures();
  ASSERT_FALSE(textures.empty());
  size_t found = 0;
  const Shader shader = graph.generate(options, messages);
  for (const ReflectedTexture& texture : shader.reflection().textures) {
    if (texture.role != TextureRole::Material) continue;
    const auto use = std::find_if(textures.begin(), textures.end(),
                                  [&](const TextureUse& one) { return one.name == texture.slot; });
    ASSERT_NE(use, textures.end()) << texture.slot;
    EXPECT_GE(use->texture, 0);
    EXPECT_EQ(use->srgb, texture.srgb);
    EXPECT_NE(use->pointer, "");
    ++found;
  }
  EXPECT_EQ(found, textures.size());
}

/// A fragment's depth, and vertices that are elsewhere.
TEST(Reflection, SaysWhatIsMoved) {
  constexpr const char* kText = R"(/// A surface that is lifted.
template lifted extends mesh {
    port float height = 0;
    output displacement vec3 object_position = object_position + object_normal * height;
    output color vec4 shown = vec4(position, 1);
    output depth float near = height;
}
)";
  const CMessages said;
  const COptions options = optionsFrom(
      json{{"targets", json::array()}, {"validate", false}, {"node_texts", {{"lifted.node", kText}}}}.dump(),
      said);
  const auto shaderOf = [&](double height) {
    const json graph = {{"lacquer_graph", 1},
                        {"name", "lifted"},
                        {"template", "lifted"},
                        {"parameters", json::object()},
                        {"textures", json::object()},
                        {"nodes", json::array()},
                        {"outputs", {{"height", height}}},
                        {"skipped", json::object()}};
    const std::string text = graph.dump();
    const CGraph read(lacquer_graph_read_with(text.data(), text.size(), "lifted.json", options.get(), said));
    return CShader(lacquer_graph_generate(read.get(), options.get(), said));
  };
  const CShader lifted = shaderOf(0.5);
  ASSERT_NE(lifted, nullptr);
  EXPECT_STREQ(lacquer_shader_depth(lifted.get()), "near");
  EXPECT_STREQ(lacquer_shader_displaced(lifted.get(), 0), "object_position");
  EXPECT_EQ(lacquer_shader_displaced(lifted.get(), 1), nullptr);
  const CShader still = shaderOf(0);
  ASSERT_NE(still, nullptr);
  EXPECT_EQ(lacquer_shader_displaced(still.get(), 0), nullptr);
}

TEST(Reflection, AnEarlierCallerIsNotGivenMoreThanItKnows) {
  const CMessages said;
  const std::string path = (sourceFolder() / "examples/coat.gltf").string();
  const COptions options = optionsFrom(R"({"targets": [], "validate": false})", said);
  const CScene scene(lacquer_scene_load(path.c_str(), options.get(), said));
  const CGraph graph(lacquer_scene_graph(scene.get(), 0, LACQUER_UNUSED_ATTRIBUTES, options.get(), said));
  const CShader shader(lacquer_graph_generate(graph.get(), options.get(), said));
  ASSERT_NE(shader, nullptr);
  lacquer_place place;
  std::memset(&place, 0x5A, sizeof place);
  const size_t known = offsetof(lacquer_place, location);
  ASSERT_EQ(lacquer_shader_input(shader.get(), 0, &place, known), 1);
  EXPECT_STRNE(place.name, "");
  EXPECT_EQ(place.location, 0x5A5A5A5AU);
  EXPECT_EQ(lacquer_shader_input(shader.get(), 99, &place, sizeof place), 0);

  ASSERT_GT(lacquer_graph_texture_count(graph.get()), 0u);
  char slot[64];
  int texture = -2;
  EXPECT_EQ(lacquer_graph_texture(graph.get(), 0, slot, sizeof slot, &texture), 1);
  EXPECT_GE(texture, 0);
  EXPECT_EQ(lacquer_graph_texture(graph.get(), 0, slot, std::strlen(slot), &texture), 0);
  EXPECT_EQ(lacquer_graph_texture(graph.get(), 99, slot, sizeof slot, &texture), 0);
}

}  // namespace
}  // namespace lacquer::test::reflection_test
