// What the built-in parts make of materials, as properties.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "support/cases.h"
#include "support/materials.h"

namespace lacquer::test {
namespace {

graph::Graph graphOf(const std::string& extensions, const BuildSetup& setup = {}) {
  const auto document = materialsOf(
      R"({"asset": {"version": "2.0"}, "materials": [{"extensions": )" + extensions + "}]}", "test.gltf");
  Diagnostics warnings;
  return buildGraph(document->materials.at(0), {true, true, false, {}}, setup, warnings);
}

std::vector<graph::Node> nodesOf(const std::string& extensions, const BuildSetup& setup = {}) {
  return graphOf(extensions, setup).nodes;
}

bool skips(const graph::Graph& graph, const std::string& term) {
  for (const graph::Skipped& skipped : graph.skipped) {
    if (skipped.term == term) return true;
  }
  return false;
}

TEST(Materials, NeutralIsGone) {
  const std::vector<graph::Node> core = nodesOf("{}");
  EXPECT_EQ(nodesOf(R"({"KHR_materials_clearcoat": {}})"), core);
  EXPECT_EQ(nodesOf(R"({"KHR_materials_coat": {"coatRoughnessFactor": 0.5}})"), core);
  EXPECT_EQ(nodesOf(R"({"KHR_materials_ior": {"ior": 1.5}})"), core);
  EXPECT_NE(nodesOf(R"({"KHR_materials_coat": {"coatFactor": 0.1}})"), core);
}

/// An extension's object without properties, with what it stands in and needs.
nlohmann::json emptyExtension(const lang::ExtensionDecl& decl) {
  nlohmann::json extensions = nlohmann::json::object();
  const std::string name(decl.name);
  if (decl.inside.empty())
    extensions[name] = nlohmann::json::object();
  else
    extensions[std::string(decl.inside)]["extensions"][name] = nlohmann::json::object();
  for (const std::string_view other : decl.needs) extensions[std::string(other)] = nlohmann::json::object();
  return extensions;
}

TEST(Materials, EveryExtensionAtItsDefaultsIsGone) {
  // These two say at their defaults already that the material is another, and one what share goes through.
  const std::set<std::string_view> say = {"KHR_materials_pbrSpecularGlossiness", "KHR_materials_unlit",
                                          "ADOBE_materials_thin_transparency"};
  const graph::Graph core = graphOf("{}");
  size_t tried = 0;
  for (const lang::ExtensionDecl* decl : builtInSchema().extensions) {
    if (decl->core || say.contains(decl->name)) continue;
    SCOPED_TRACE(std::string(decl->name));
    const graph::Graph graph = graphOf(emptyExtension(*decl).dump());
    EXPECT_EQ(graph.nodes, core.nodes);
    EXPECT_EQ(graph.outputs, core.outputs);
    EXPECT_EQ(graph.textures.size(), core.textures.size());
    EXPECT_EQ(graph.parameters.size(), core.parameters.size());
    ++tried;
  }
  EXPECT_GE(tried, 25U);
  EXPECT_NE(graphOf(R"({"KHR_materials_unlit": {}})").nodes, core.nodes);
}

TEST(Materials, BothWordsForACoatAreOneMaterial) {
  EXPECT_EQ(nodesOf(R"({"KHR_materials_clearcoat": {"clearcoatFactor": 0.5}})"),
            nodesOf(R"({"KHR_materials_coat": {"coatFactor": 0.5, "coatDarkeningFactor": 0}})"));
}

TEST(Materials, EveryTermStaysWhereItIsAskedTo) {
  const model::Model& khr = **builtInModels().of("khr");
  ASSERT_FALSE(khr.liveTerms().empty());
  for (const std::string_view term : khr.liveTerms()) {
    BuildSetup setup;
    setup.live = {std::string(term), "coat"};
    const bool textured = term.ends_with("normal_map") || term == "occlusion";
    const bool tint = term == "coat.tint";
    const graph::Graph graph =
        graphOf(tint ? R"({"KHR_materials_clearcoat": {}, "ADOBE_materials_clearcoat_tint": {}})"
                     : R"({"KHR_materials_coat": {"coatDarkeningFactor": 0}})",
                setup);
    // A texture that is not there cannot be kept.
    if (!textured) {
      EXPECT_FALSE(skips(graph, std::string(term))) << term;
    }
  }
}

/// Two parts have a term `occlusion`; an unlit material takes neither.
TEST(Materials, ATermIsSkippedOnce) {
  const auto document = materialsOf(
      R"({"asset": {"version": "2.0"}, "textures": [{}], "materials": [
          {"occlusionTexture": {"index": 0}, "extensions": {"KHR_materials_unlit": {}}}]})",
      "test.gltf");
  Diagnostics warnings;
  const graph::Graph graph = buildGraph(document->materials.at(0), {true, true, false, {}}, {}, warnings);
  ASSERT_TRUE(skips(graph, "occlusion"));
  std::set<std::string> names;
  for (const graph::Skipped& skipped : graph.skipped)
    EXPECT_TRUE(names.insert(skipped.term).second) << skipped.term;
  EXPECT_TRUE(graph::fromJson(toJson(graph), "again.json"));
}

/// A template that takes none of what a material has is told so, and gets none of it.
TEST(Materials, WhatNoPortTakesIsSaid) {
  BuildSetup setup;
  setup.template_name = "surface";
  const graph::Graph graph = graphOf("{}", setup);
  EXPECT_TRUE(skips(graph, "base.indirect"));
  EXPECT_FALSE(graph.find("base.indirect"));
  setup.template_name = "forward";
  EXPECT_FALSE(skips(graphOf("{}", setup), "base.indirect"));
}

/// Ports decide, not names: a copy of a template under another name is given the same.
TEST(Materials, ACopyOfATemplateIsGivenTheSame) {
  lang::Library library = lang::Library::embedded();
  std::string text = readFile(sourceFolder() / "templates/forward.node");
  const std::string name = "template forward ";
  text.replace(text.find(name), name.size(), "template elsewhere ");
  const std::string standing = "default;";
  if (const size_t at = text.find(standing); at != std::string::npos) text.erase(at, standing.size());
  ASSERT_TRUE(library.add({{"elsewhere.node", text}}));
  const model::Models models(library);
  const auto document = material::readText(
      R"({"asset": {"version": "2.0"}, "materials": [{"extensions": {"KHR_materials_coat": {"coatFactor": 1}}}]})",
      "x", **models.schema(), {});
  std::vector<graph::Graph> graphs;
  for (const char* of : {"forward", "elsewhere"}) {
    Diagnostics warnings;
    model::BuildOptions options;
    options.template_name = of;
    graphs.push_back(*model::build(**models.of("khr"), **library.template_(of), document->materials[0],
                                   {true, true, false, {}}, options, warnings));
  }
  EXPECT_EQ(graphs[0].nodes, graphs[1].nodes);
  EXPECT_EQ(graphs[0].outputs, graphs[1].outputs);
}

}  // namespace
}  // namespace lacquer::test
