// What an animation can change stays, whatever it is today (KHR_animation_pointer).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "support/materials.h"

namespace lacquer::test {
namespace {

/// The graph of one material, `pointers` of which animations change.
graph::Graph animated(const std::string& material, const std::vector<std::string>& pointers,
                      const char* template_name = "forward") {
  std::string channels;
  for (const std::string& pointer : pointers) {
    channels += fmt::format(R"({}{{"target": {{"path": "pointer", "extensions": {{"KHR_animation_pointer":
                              {{"pointer": "/materials/0/{}"}}}}}}}})",
                            channels.empty() ? "" : ", ", pointer);
  }
  const auto document =
      materialsOf(fmt::format(R"({{"asset": {{"version": "2.0"}}, "textures": [{{}}], "materials": [{}],
                                   "animations": [{{"channels": [{}]}}]}})",
                              material, channels),
                  "test.gltf");
  Diagnostics warnings;
  BuildSetup setup;
  setup.template_name = template_name;
  return buildGraph(document->materials.at(0), {true, true, false, {true, true}}, setup, warnings);
}

bool has(const graph::Graph& graph, const std::string& node) {
  return std::any_of(graph.nodes.begin(), graph.nodes.end(),
                     [&](const graph::Node& one) { return one.id == node; });
}

/// "name name!" in the order of the names; an animated one with an exclamation mark.
std::string parameters(const graph::Graph& graph) {
  std::vector<std::string> names;
  for (const ir::Parameter& p : graph.parameters) names.push_back(p.name + (p.animated ? "!" : ""));
  std::sort(names.begin(), names.end());
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " ") + name;
  return text;
}

TEST(Animation, ATermThatStartsNeutralStays) {
  const char* const kClearcoat = R"({"extensions": {"KHR_materials_clearcoat": {}}})";
  EXPECT_FALSE(has(animated(kClearcoat, {}), "coat.fresnel"));
  const graph::Graph graph = animated(kClearcoat, {"extensions/KHR_materials_clearcoat/clearcoatFactor"});
  EXPECT_TRUE(has(graph, "coat.fresnel"));
  EXPECT_EQ(parameters(graph),
            "base_color_factor coat_factor! coat_roughness_factor metallic_factor roughness_factor");
}

/// An extension with what it must stand in or beside, all of them empty objects.
struct Neutral {
  std::vector<std::string> objects;  ///< of the material's extensions
  std::vector<uint16_t> members;     ///< those whose numbers are animated
};

Neutral neutralOf(const material::Schema& schema, uint16_t extension, bool in_glass) {
  const lang::ExtensionDecl& decl = *schema.extensions[extension];
  Neutral result{{}, {extension}};
  std::vector<std::string_view> beside = decl.needs;
  if (in_glass) beside.insert(beside.end(), {"KHR_materials_transmission", "KHR_materials_volume"});
  if (!decl.inside.empty()) beside.push_back(decl.inside);
  for (const std::string_view other : beside) result.members.push_back(*schema.find(other));
  std::sort(result.members.begin(), result.members.end());
  result.members.erase(std::unique(result.members.begin(), result.members.end()), result.members.end());
  for (const uint16_t member : result.members) {
    const std::string_view name = schema.extensions[member]->name;
    // A number without a default is there only where the file says it.
    std::string body = name == "KHR_materials_volume" ? R"("attenuationDistance": 1)" : "";
    if (name == decl.inside) body = fmt::format(R"("extensions": {{"{}": {{}}}})", decl.name);
    if (member != extension || decl.inside.empty())
      result.objects.push_back(fmt::format(R"("{}": {{{}}})", name, body));
  }
  return result;
}

/// The graphs of a material of neutral extensions all of whose numbers an animation changes, but for other
/// spellings of that one.
std::vector<graph::Graph> animatedNeutral(const material::Schema& schema, const material::Property& subject,
                                          const std::vector<const char*>& templates) {
  const auto spelling = [&](const material::Property& p) {
    return &p != &subject && p.extension == subject.extension && p.decl->role == subject.decl->role;
  };
  std::vector<graph::Graph> graphs;
  for (const bool in_glass : {false, true}) {
    const Neutral neutral = neutralOf(schema, subject.extension, in_glass);
    std::vector<std::string> pointers{"emissiveFactor"};
    for (const material::Property& p : schema.properties) {
      const bool wanted = p.decl->kind == material::Kind::Number && !spelling(p) &&
                          std::binary_search(neutral.members.begin(), neutral.members.end(), p.extension);
      if (wanted) pointers.push_back(p.path);
    }
    const std::string text = fmt::format(R"({{"extensions": {{{}}}}})", fmt::join(neutral.objects, ", "));
    for (const char* const name : templates) graphs.push_back(animated(text, pointers, name));
  }
  return graphs;
}

/// Every number of every extension is a parameter of the shader when an animation changes it, though all
/// start where they do nothing.
void expectParameters(const std::vector<const char*>& templates) {
  const material::Schema& schema = builtInSchema();
  for (const material::Property& property : schema.properties) {
    if (property.extension == 0 || property.decl->kind != material::Kind::Number) continue;
    const std::vector<graph::Graph> graphs = animatedNeutral(schema, property, templates);
    const bool found = std::any_of(graphs.begin(), graphs.end(), [&](const graph::Graph& graph) {
      return std::any_of(graph.parameters.begin(), graph.parameters.end(), [&](const ir::Parameter& p) {
        return p.animated && p.pointer == "/materials/0/" + property.path;
      });
    });
    // The scale of a normal texture needs the texture, and so does the factor of heights.
    const bool textured = property.path.ends_with("Texture/scale") || property.decl->name == "bumpFactor";
    EXPECT_TRUE(found || textured) << property.path;
  }
}

TEST(Animation, NoTargetOfAPointerIsLost) { expectParameters({"forward", "bsdf"}); }

/// A G-buffer has a place for every number of every extension.
TEST(Animation, TheSurfaceHasAPortForEveryNumber) { expectParameters({"surface"}); }

TEST(Animation, EmissionAndAlphaStay) {
  EXPECT_FALSE(has(animated("{}", {}), "emission"));
  EXPECT_TRUE(has(animated("{}", {"emissiveFactor"}), "emission"));
  const char* const kDark = R"({"emissiveFactor": [0, 0, 0], "extensions": {"KHR_materials_emissive_strength":
                                {"emissiveStrength": 0}}})";
  // Whatever the factor becomes, nothing times the strength of 0 is light.
  EXPECT_FALSE(has(animated(kDark, {"emissiveFactor"}), "emission"));
}

/// A folded number, of which the shader has the default, is a parameter where an animation changes it.
TEST(Animation, AFoldedNumberIsAParameter) {
  const char* const kIor = R"({"extensions": {"KHR_materials_ior": {}}})";
  EXPECT_EQ(parameters(animated(kIor, {})), "base_color_factor metallic_factor roughness_factor");
  const graph::Graph graph = animated(kIor, {"extensions/KHR_materials_ior/ior"});
  EXPECT_TRUE(has(graph, "base.f0"));
  EXPECT_EQ(parameters(graph), "base_color_factor ior! metallic_factor roughness_factor");
}

/// "Setting IOR to zero permanently switches the material".
TEST(Animation, AnIorOfZeroStaysFixed) {
  const char* const kZero = R"({"extensions": {"KHR_materials_ior": {"ior": 0}}})";
  EXPECT_EQ(animated(kZero, {"extensions/KHR_materials_ior/ior"}).nodes, animated(kZero, {}).nodes);
  EXPECT_EQ(parameters(animated(kZero, {"extensions/KHR_materials_ior/ior"})),
            parameters(animated(kZero, {})));
}

TEST(Animation, AScaleAndATransformAreParameters) {
  const char* const kNormal =
      R"({"normalTexture": {"index": 0, "scale": 0, "extensions": {"KHR_texture_transform": {}}}})";
  EXPECT_FALSE(has(animated(kNormal, {}), "base.normal_map"));
  const graph::Graph scaled = animated(kNormal, {"normalTexture/scale"});
  EXPECT_TRUE(has(scaled, "base.normal_map"));
  EXPECT_NE(parameters(scaled).find("normal_scale!"), std::string::npos) << parameters(scaled);
  EXPECT_FALSE(has(scaled, "normal.uv"));
  const graph::Graph moved =
      animated(kNormal, {"normalTexture/scale", "normalTexture/extensions/KHR_texture_transform/offset"});
  EXPECT_TRUE(has(moved, "normal.uv"));
  EXPECT_NE(parameters(moved).find("normal_uv_offset!"), std::string::npos) << parameters(moved);
  EXPECT_EQ(parameters(moved).find("normal_uv_rotation"), std::string::npos) << parameters(moved);
}

/// Two uses of a texture with one transform are one lookup, unless one of them moves.
TEST(Animation, ATransformThatMovesIsNotShared) {
  const char* const kTwo = R"({"occlusionTexture": {"index": 0, "extensions": {"KHR_texture_transform": {}}},
      "pbrMetallicRoughness": {"metallicRoughnessTexture":
      {"index": 0, "extensions": {"KHR_texture_transform": {}}}}})";
  EXPECT_EQ(animated(kTwo, {}).textures.size(), 1U);
  const std::string tail = "/extensions/KHR_texture_transform/offset";
  const graph::Graph one = animated(kTwo, {"occlusionTexture" + tail});
  EXPECT_EQ(one.textures.size(), 2U);
  EXPECT_NE(parameters(one).find("occlusion_uv_offset!"), std::string::npos) << parameters(one);
  const graph::Graph both =
      animated(kTwo, {"occlusionTexture" + tail, "pbrMetallicRoughness/metallicRoughnessTexture" + tail});
  EXPECT_EQ(both.textures.size(), 2U);
  EXPECT_NE(parameters(both).find("metallic_roughness_uv_offset!"), std::string::npos) << parameters(both);
}

}  // namespace
}  // namespace lacquer::test
