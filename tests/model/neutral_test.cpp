// Neutral means gone: each extension at its defaults leaves the graph that is there without it, and with that
// the shader, byte for byte; in every template, every profile, alone and in a stack of all others.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "graph/graph.h"
#include "support/cases.h"
#include "support/materials.h"

namespace lacquer::test {
namespace {

using Json = nlohmann::json;

/// Everything that may stand together, in two stacks: what excludes or overrules another is in the other one.
const char* const kStacks[] = {
    R"({"KHR_materials_specular": {"specularFactor": 0.8, "specularColorFactor": [0.9, 0.8, 1],
          "extensions": {"EXT_materials_specular_edge_color": {"specularEdgeColorEnabled": true}}},
        "KHR_materials_ior": {"ior": 1.45},
        "KHR_materials_sheen": {"sheenColorFactor": [0.3, 0.2, 0.1], "sheenRoughnessFactor": 0.5},
        "KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.1, "extensions": {
          "KHR_materials_clearcoat_ior": {"clearcoatIor": 1.7},
          "KHR_materials_clearcoat_anisotropy": {"clearcoatAnisotropyStrength": 0.6},
          "EXT_materials_clearcoat_color": {"clearcoatColorFactor": [0.9, 0.5, 0.4]},
          "EXT_materials_clearcoat_darkening": {"clearcoatDarkeningFactor": 0.5}}},
        "ADOBE_materials_clearcoat_specular": {"clearcoatSpecularFactor": 0.6},
        "KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyRotation": 0.4, "extensions": {
          "EXT_materials_anisotropy_openpbr": {"openPbrAnisotropyEnabled": true}}},
        "KHR_materials_iridescence": {"iridescenceFactor": 0.5},
        "KHR_materials_transmission": {"transmissionFactor": 0.5},
        "KHR_materials_volume": {"thicknessFactor": 0.9, "attenuationColor": [0.6, 0.8, 0.7], "attenuationDistance": 2},
        "KHR_materials_volume_scatter": {"multiscatterColorFactor": [0.3, 0.6, 0.9]},
        "KHR_materials_dispersion": {"dispersion": 0.4},
        "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.3},
        "KHR_materials_diffuse_roughness": {"diffuseRoughnessFactor": 0.5},
        "KHR_materials_retroreflection": {"retroreflectionFactor": 0.3},
        "LACQUER_materials_specular_haze": {"specularHazeFactor": 0.4},
        "KHR_materials_emissive_strength": {"emissiveStrength": 2}})",
    R"({"KHR_materials_coat": {"coatFactor": 0.7, "coatColorFactor": [0.9, 0.7, 0.5]},
        "KHR_materials_transmission": {"transmissionFactor": 0.5},
        "KHR_materials_scatter": {"scatterStrengthFactor": 0.5},
        "KHR_materials_fuzz": {"fuzzFactor": 0.5},
        "KHR_materials_iridescence": {"iridescenceFactor": 0.5}})",
    R"({"KHR_materials_clearcoat": {"clearcoatFactor": 0.5},
        "ADOBE_materials_clearcoat_tint": {"clearcoatTintFactor": [0.5, 0.6, 0.7]}})"};

constexpr const char* kTemplates[] = {"forward", "surface", "bsdf"};

/// A material of these extensions, as a template sees it.
graph::Graph graphOf(const Json& extensions, const char* template_name, const char* profile = "khr") {
  const Json root = {{"asset", {{"version", "2.0"}}},
                     {"materials", {{{"emissiveFactor", {0.1, 0.2, 0.3}}, {"extensions", extensions}}}}};
  const Result<material::Document> document = materialsOf(root.dump(), "test.gltf");
  for (const Diagnostic& d : document->materials.at(0).diagnostics)
    EXPECT_NE(d.severity, Severity::Error) << format(d);
  BuildSetup setup;
  setup.template_name = template_name;
  setup.profile = profile;
  Diagnostics warnings;
  return buildGraph(document->materials.at(0), {true, true, false, {true, true}}, setup, warnings);
}

/// What becomes of the shader: all but why something is left out.
std::string shaderOf(graph::Graph graph) {
  graph.skipped.clear();
  return toJson(graph);
}

/// The object of an extension with each number at its default.
Json defaultsOf(const lang::ExtensionDecl& decl) {
  Json object = Json::object();
  for (const lang::PropertyDecl& p : decl.properties) {
    if (!p.default_value) continue;
    const std::string name(p.name);
    if (p.kind == material::Kind::Bool) object[name] = (*p.default_value)[0] != 0;
    if (p.kind != material::Kind::Number) continue;
    const int components = ir::componentCount(p.type);
    for (int c = 0; c < components; ++c) {
      const double x = (*p.default_value)[static_cast<size_t>(c)];
      if (components == 1)
        object[name] = x;
      else
        object[name].push_back(x);
    }
  }
  return object;
}

/// Where the extension's object stands among a material's; null where it does not.
Json* placeOf(Json& extensions, const lang::ExtensionDecl& decl) {
  Json* around = &extensions;
  if (!decl.inside.empty()) {
    const auto outer = extensions.find(std::string(decl.inside));
    if (outer == extensions.end() || !outer->contains("extensions")) return nullptr;
    around = &(*outer)["extensions"];
  }
  return around->contains(std::string(decl.name)) ? around : nullptr;
}

/// Whether another extension of the stack must not be without it.
bool needed(const Json& extensions, const lang::ExtensionDecl& decl) {
  for (const lang::ExtensionDecl* other : builtInSchema().extensions) {
    if (!extensions.contains(std::string(other->name))) continue;
    for (const std::string_view name : other->needs) {
      if (name == decl.name) return true;
    }
  }
  return false;
}

/// These say at their defaults already that the material is another, two of them that the one around them is
/// read in other words.
const std::set<std::string_view> kSay = {"KHR_materials_pbrSpecularGlossiness", "KHR_materials_unlit",
                                         "ADOBE_materials_thin_transparency"};

TEST(Neutral, EveryExtensionAtItsDefaultsIsGoneFromEveryTemplate) {
  for (const char* const name : kTemplates) {
    const std::string core = shaderOf(graphOf(Json::object(), name));
    for (const lang::ExtensionDecl* decl : builtInSchema().extensions) {
      if (decl->core || kSay.contains(decl->name)) continue;
      SCOPED_TRACE(fmt::format("{} {}", name, decl->name));
      Json extensions = Json::object();
      Json& object = decl->inside.empty()
                         ? extensions[std::string(decl->name)]
                         : extensions[std::string(decl->inside)]["extensions"][std::string(decl->name)];
      object = defaultsOf(*decl);
      // A coat that has them darkens by default; without one it is not there.
      for (const std::string_view other : decl->needs)
        extensions[std::string(other)] =
            defaultsOf(*builtInSchema().extensions[*builtInSchema().find(other)]);
      EXPECT_EQ(shaderOf(graphOf(extensions, name)), core);
    }
  }
}

TEST(Neutral, AHazeThatIsNotSpreadIsNone) {
  for (const char* const name : kTemplates) {
    const Json haze = {
        {"LACQUER_materials_specular_haze", {{"specularHazeFactor", 0.5}, {"specularHazeSpread", 0}}}};
    EXPECT_EQ(shaderOf(graphOf(haze, name)), shaderOf(graphOf(Json::object(), name))) << name;
  }
}

/// In a stack, an extension at its defaults is as good as none, and with it the shader is another one.
void expectOneTermEach(const Json& stack, const char* template_name, const char* profile) {
  const std::string all = shaderOf(graphOf(stack, template_name, profile));
  for (const lang::ExtensionDecl* decl : builtInSchema().extensions) {
    Json without = stack;
    Json* const around = decl->core ? nullptr : placeOf(without, *decl);
    // What others stand in has no defaults of its own, and what says how it is meant is not neutral.
    if (around == nullptr || decl->name == "EXT_materials_clearcoat_darkening") continue;
    const std::string name(decl->name);
    SCOPED_TRACE(fmt::format("{} {} {}", template_name, profile, name));
    Json neutral = without;
    (*placeOf(neutral, *decl))[name] = defaultsOf(*decl);
    if (needed(stack, *decl))
      (*around)[name] = Json::object();
    else
      around->erase(name);
    const std::string bare = shaderOf(graphOf(without, template_name, profile));
    EXPECT_EQ(shaderOf(graphOf(neutral, template_name, profile)), bare);
    // A medium's scattering is for path tracers and for G-buffers.
    const bool unseen = name == "KHR_materials_volume_scatter" && template_name == std::string("forward");
    EXPECT_EQ(bare == all, unseen);
  }
}

TEST(Neutral, EveryExtensionOfAStackAtItsDefaultsIsGone) {
  for (const char* const stack : kStacks) {
    for (const char* const name : kTemplates) expectOneTermEach(Json::parse(stack), name, "khr");
    for (const char* const profile : {"khr_2025_10_13", "openpbr", "physical"})
      expectOneTermEach(Json::parse(stack), "forward", profile);
  }
}

/// The file whose materials leave out one extension each.
TEST(Neutral, EverythingTogetherDiffersByOneTermEach) {
  const char* set = std::getenv("LACQUER_ASSETS");
  const std::filesystem::path assets = set != nullptr ? set : sourceFolder() / "../shared/assets";
  const std::filesystem::path file = assets / "extensions/EverythingTogether.glb";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file << "; set LACQUER_ASSETS";
  const Result<material::Document> document = readMaterials(file.string());
  ASSERT_TRUE(document);
  const auto& materials = document->materials;
  for (const char* const name : kTemplates) {
    BuildSetup setup;
    setup.template_name = name;
    std::set<std::string> shaders;
    size_t left_out = 0;
    for (const material::Material& m : materials) {
      const bool whole = m.name == "all ratified 0";
      if (!whole && !m.name.starts_with("all but ")) continue;
      Diagnostics warnings;
      const graph::Graph graph = buildGraph(m, {true, true, false, {true, true}}, setup, warnings);
      shaders.insert(shaderOf(graph));
      left_out += whole ? 0 : 1;
    }
    EXPECT_EQ(left_out, 11U);
    EXPECT_EQ(shaders.size(), left_out + 1) << name;
  }
}

}  // namespace
}  // namespace lacquer::test
