// Materials as MaterialX documents: what is written, that it reads back as the same graph, and that MaterialX
// itself takes it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "exchange/exchange.h"
#include "exchange/procedurals_out.h"
#include "exchange/translation.h"
#include "graph/graph.h"
#include "material/material.h"
#include "mtlx/element.h"
#include "support/cases.h"
#include "support/materials.h"

namespace lacquer::test {
namespace {

namespace fs = std::filesystem;

std::string allOf(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) text += format(diagnostic) + "\n";
  return text;
}

material::Document documentOf(const std::string& text, const std::string& name) {
  auto document = material::readText(text, name, builtInSchema(), {});
  EXPECT_TRUE(document) << (document ? std::string() : allOf(document.error())) << text;
  return document ? std::move(*document) : material::Document();
}

exchange::Written writtenOf(const material::Document& document) {
  std::vector<size_t> all;
  for (size_t i = 0; i < document.materials.size(); ++i) {
    EXPECT_FALSE(hasError(document.materials[i].diagnostics)) << allOf(document.materials[i].diagnostics);
    all.push_back(i);
  }
  return exchange::toMaterialX(document, all, builtInSchema());
}

/// The groups that move a material's vertices.
std::string movedBy(const material::Material& material) {
  graph::Graph moved;
  std::vector<std::string> names{material.displacement};
  for (size_t i = 0; i < names.size() && !names[i].empty(); ++i) {
    for (const graph::Group& group : material.patterns->groups) {
      if (group.name != names[i]) continue;
      moved.groups.push_back(group);
      for (const graph::Node& node : group.nodes) {
        if (node.group) names.push_back(node.type);
      }
    }
  }
  return moved.groups.empty() ? std::string() : graph::toJson(moved);
}

std::string graphOf(const material::Document& document) {
  std::string text;
  for (const material::Material& material : document.materials) {
    Diagnostics warnings;
    const graph::Graph graph =
        buildGraph(material, {true, true, true, {true, true, false, false}}, BuildSetup{}, warnings);
    EXPECT_EQ(allOf(graph::check(graph, builtInLibrary())), "");
    text += graph::toJson(graph) + movedBy(material);
  }
  return text;
}

void runWritten(Case& c, const std::string& name) {
  const material::Document document = documentOf(c.input(), name);
  const exchange::Written first = writtenOf(document);
  c.expect("document", first.text);
  c.expect("said", allOf(first.said));
  const material::Document again = documentOf(first.text, "written.mtlx");
  const exchange::Written second = writtenOf(again);
  EXPECT_EQ(second.text, first.text);
  EXPECT_EQ(allOf(second.said), "");
  // glTF's own images are nodes of the document, and an output of a nodegraph has a surface once written.
  if (!name.ends_with(".mtlx") || c.input().find("surfaceshader") == std::string::npos) return;
  EXPECT_EQ(graphOf(again), graphOf(document));
}

const bool kWritten =
    registerCases("Written", sourceFolder() / "tests/materialx/written", ".case",
                  [](Case& c) { runWritten(c, c.input().starts_with('{') ? "case.gltf" : "case.mtlx"); });

/// OpenPBR has one colour for what passes: where the body absorbs, the base's tint is lost, and said.
TEST(WrittenTransmission, ATintBesideAbsorptionIsSaid) {
  const auto saidOf = [](const std::string& volume) {
    return allOf(writtenOf(documentOf(R"({"asset": {"version": "2.0"}, "materials": [{
        "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.3, 0.1, 1], "metallicFactor": 0},
        "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
                       "KHR_materials_volume": {"thicknessFactor": 1)" +
                                          volume + R"(},
                       "LACQUER_materials_specular_haze": {"specularHazeFactor": 0.5}}}]})",
                                      "case.gltf"))
                     .said);
  };
  EXPECT_EQ(saidOf(""), "");
  EXPECT_NE(
      saidOf(R"(, "attenuationDistance": 2, "attenuationColor": [0.5, 0.9, 0.5])")
          .find("/materials/0/extensions/KHR_materials_transmission: warning: the base's colour tints what "
                "passes through it, and not in OpenPBR [not-said]"),
      std::string::npos);
}

/// What MaterialX says of documents: nothing for those that are valid. Nothing at all where it is not there.
std::optional<std::string> peerSays(const std::map<std::string, std::string>& documents) {
  const char* named = std::getenv("LACQUER_MATERIALX");
  const fs::path folder = named != nullptr ? fs::path(named) : sourceFolder() / "../shared/peers/materialx";
  if (!fs::exists(folder / "JsMaterialXGenShader.mjs") || std::system("node --version > /dev/null 2>&1") != 0)
    return std::nullopt;
  const fs::path files = fs::temp_directory_path() / fmt::format("lacquer_written_{}", getpid());
  fs::create_directories(files);
  std::string command =
      fmt::format("node '{}' '{}'", (sourceFolder() / "tests/materialx/validate.mjs").string(),
                  fs::canonical(folder).string());
  for (const auto& [name, text] : documents) {
    std::ofstream(files / name) << text;
    command += fmt::format(" '{}'", (files / name).string());
  }
  const int status = std::system((command + fmt::format(" > '{}/log' 2>&1", files.string())).c_str());
  std::string log = readFile(files / "log");
  fs::remove_all(files);
  return status == 0 && log.empty() ? std::string() : log + fmt::format("status {}\n", status);
}

/// glTF's factor is what is reflected at grazing angles, OpenPBR's weight counts straight on alone: both say
/// the reflection of 0.8 (at the brightest) whose color straight on is 1.5 times as bright.
TEST(WrittenSpecular, keepsBothReflections) {
  const auto writtenAs = [](const char* metallic, const char* color) {
    return writtenOf(documentOf(fmt::format(R"({{"asset": {{"version": "2.0"}}, "materials": [{{
                      "pbrMetallicRoughness": {{"metallicFactor": {}}}, "extensions": {{
                      "KHR_materials_coat": {{"coatFactor": 1}},
                      "KHR_materials_specular": {{"specularFactor": 0.75, "specularColorFactor": {}}}}}}}]}})",
                                            metallic, color),
                                "specular.gltf"));
  };
  const exchange::Written bright = writtenAs("0", "[0.75, 1.5, 0.375]");
  const auto has = [](const std::string& text, std::string_view part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_TRUE(has(allOf(bright.said), "more at grazing angles")) << allOf(bright.said);
  EXPECT_TRUE(has(bright.text, R"(name="specular_weight" type="float" value="1.125")")) << bright.text;
  EXPECT_TRUE(has(bright.text, R"(name="specular_color" type="color3" value="0.5, 1, 0.25")")) << bright.text;
  const material::Document again = documentOf(bright.text, "specular.mtlx");
  EXPECT_EQ(allOf(writtenOf(again).said), "");
  EXPECT_EQ(writtenOf(again).text, bright.text);

  const exchange::Written metal = writtenAs("1", "[0.75, 1.5, 0.375]");
  EXPECT_FALSE(has(metal.text, "specular_weight") || has(metal.text, "specular_color")) << metal.text;
  EXPECT_EQ(allOf(metal.said), "");
  EXPECT_TRUE(has(allOf(writtenAs("0.5", "[1, 1, 0.5]").said), "change metals, too"));

  // Without a reflection the weight is 0, which takes nothing from the base, and is read as factor 0.
  const exchange::Written none = writtenOf(documentOf(R"({"asset": {"version": "2.0"}, "materials": [{
      "pbrMetallicRoughness": {"metallicFactor": 0}, "extensions": {
      "KHR_materials_coat": {"coatFactor": 1}, "KHR_materials_specular": {"specularFactor": 0}}}]})",
                                                      "none.gltf"));
  EXPECT_TRUE(has(none.text, R"(name="specular_weight" type="float" value="0")")) << none.text;
  EXPECT_FALSE(has(none.text, "specular_color")) << none.text;
  EXPECT_EQ(writtenOf(documentOf(none.text, "none.mtlx")).text, none.text);
}

/// What a boundary reflects straight on is the same, and what lies below has the rest: a weight of 25 with a
/// color of 0.04 would reflect as little as it should, and leave nothing to the base.
TEST(WrittenSpecular, leavesTheBaseItsLight) {
  const auto writtenAs = [](std::string_view inputs, std::string_view category) {
    const material::Document document =
        documentOf(fmt::format(R"(<?xml version="1.0"?><materialx version="1.39">
      <{0} name="s" type="surfaceshader">{1}</{0}><surfacematerial name="m" type="material">
      <input name="surfaceshader" type="surfaceshader" nodename="s"/></surfacematerial></materialx>)",
                               category, inputs),
                   "specular.mtlx");
    return exchange::toMaterialX(document, {0}, builtInSchema(), "open_pbr_surface");
  };
  const auto has = [](const exchange::Written& written, std::string_view input, std::string_view value) {
    return written.text.find(fmt::format(R"(<input name="{}" type="{}" value="{}"/>)", input,
                                         input == "specular_color" ? "color3" : "float", value)) !=
           std::string::npos;
  };
  const auto disney = writtenAs(R"(<input name="baseColor" type="color3" value="0.1, 0.2, 0.8"/>
      <input name="specular" type="float" value="0.25"/>
      <input name="ior" type="float" value="3"/>)",
                                "disney_principled");
  EXPECT_TRUE(has(disney, "specular_color", "0.08, 0.08, 0.08")) << disney.text;
  EXPECT_EQ(disney.text.find("specular_weight"), std::string::npos) << disney.text;
  EXPECT_NE(allOf(disney.said).find("more at grazing angles"), std::string::npos) << allOf(disney.said);
  const auto half = writtenAs(R"(<input name="specular" type="float" value="0.5"/>
      <input name="specular_color" type="color3" value="1, 2, 100"/>
      <input name="ior" type="float" value="3"/><input name="metallic" type="float" value="0"/>)",
                              "gltf_pbr");
  // 0.25 times 100 is more than all light.
  EXPECT_TRUE(has(half, "specular_weight", "2")) << half.text;
  EXPECT_TRUE(has(half, "specular_color", "0.25, 0.5, 1")) << half.text;
}

/// The base has its weight however little passes through.
TEST(WrittenSpecular, leavesTheWeightOfABaseThatLightPasses) {
  const exchange::Written written = writtenOf(documentOf(R"(<?xml version="1.0"?><materialx version="1.39">
      <standard_surface name="s" type="surfaceshader"><input name="base" type="float" value="0.5"/>
      <input name="base_color" type="color3" value="0.8, 0.4, 0.2"/>
      <input name="transmission" type="float" value="0.5"/><input name="transmission_color" type="color3" value="1, 1, 1"/>
      </standard_surface><surfacematerial name="m" type="material">
      <input name="surfaceshader" type="surfaceshader" nodename="s"/></surfacematerial></materialx>)",
                                                         "weight.mtlx"));
  // mix(base * color, transmission_color, transmission^2)
  EXPECT_NE(written.text.find(R"(name="base_color" type="color3" value="0.55, 0.4, 0.325")"),
            std::string::npos)
      << written.text;
}

/// A colour's opacity, where the new surface has a number for it.
TEST(Translated, opacitiesThatAreColoursAreLost) {
  const auto lost = [](std::string_view opacity, std::string_view as) {
    const Result<materialx::Document> document = materialx::readXml(
        fmt::format(R"(<materialx version="1.39"><standard_surface name="s" type="surfaceshader">
<input name="opacity" type="color3" {}/></standard_surface></materialx>)",
                    opacity),
        "opacity.mtlx", Limits{});
    EXPECT_TRUE(document);
    materialx::Element root = document->root;
    Diagnostics said;
    EXPECT_EQ(exchange::translateSurfaces(root, as, said), 1u);
    return allOf(said);
  };
  EXPECT_EQ(lost(R"(value="0.5, 0.5, 0.5")", "open_pbr_surface"), "");
  EXPECT_EQ(
      lost(R"(value="1, 0.5, 0.25")", "open_pbr_surface"),
      "opacity.mtlx:2:2: warning: opacity is a colour, and the new surface's is a number: 1, 0.5, 0.25 is "
      "lost [not-said]\n  help: its red is taken\n");
  EXPECT_NE(lost(R"(value="1, 0.5, 0.25")", "gltf_pbr").find("its luminance is taken"), std::string::npos);
  EXPECT_NE(lost(R"(nodename="image")", "open_pbr_surface").find("what it is connected to is lost"),
            std::string::npos);
}

/// Definitions are read with their file's namespace, and are written without the document's.
TEST(WrittenNamespaces, areSaidOnce) {
  materialx::Element root, own, other;
  root.category = "materialx";
  own.category = other.category = "nodedef";
  for (materialx::Element* one : {&root, &own}) one->set("namespace", "studio");
  other.set("namespace", "included");
  root.children = {own, other};
  EXPECT_EQ(materialx::toXml(root), R"(<?xml version="1.0"?>
<materialx namespace="studio">
  <nodedef/>
  <nodedef namespace="included"/>
</materialx>
)");
}

/// Images of tiles have no texture in glTF: an output that takes one is left to its baked image.
TEST(WrittenProcedurals, areOfWholeOutputsAlone) {
  const material::Document document = documentOf(R"(<materialx version="1.39">
  <nodegraph name="NG">
    <image name="tiles" type="color3">
      <input name="file" type="filename" value="wood_&lt;UDIM&gt;.png"/>
    </image>
    <image name="one" type="float">
      <input name="file" type="filename" value="rough.png"/>
    </image>
    <output name="color" type="color3" nodename="tiles"/>
    <output name="rough" type="float" nodename="one"/>
  </nodegraph>
  <gltf_pbr name="shader" type="surfaceshader">
    <input name="base_color" type="color3" nodegraph="NG" output="color"/>
    <input name="roughness" type="float" nodegraph="NG" output="rough"/>
  </gltf_pbr>
  <surfacematerial name="m" type="material">
    <input name="surfaceshader" type="surfaceshader" nodename="shader"/>
  </surfacematerial>
</materialx>
)",
                                                 "tiles.mtlx");
  const material::Material& material = document.materials.at(0);
  ASSERT_EQ(material.textures.size(), 2U);
  Diagnostics said;
  exchange::ProceduralsOut out(
      builtInSchema(), document, [](const graph::Texture&) { return std::optional<uint64_t>(0); }, said);
  const auto written = out.ofGroup(*material.patterns, material.textures[0].info.group);
  EXPECT_EQ(written.outputs, (std::set<std::string, std::less<>>{"metallicRoughnessTexture"}));
  EXPECT_EQ(allOf(said),
            "tiles.mtlx:4:8: warning: tiles_image has an image for each tile, which glTF has no texture for "
            "[not-said]\n  help: there is no procedural of it: the texture is the baked image\n");
  EXPECT_EQ(out.extension().dump().find("baseColorTexture"), std::string::npos);
}

/// A sixteenth of a bump's scale is what heights rise by over the coordinate. What is read again has no
/// bumps.
TEST(WrittenBump, isANodeOnTheNormalsOfTheMap) {
  const exchange::Written written = writtenOf(documentOf(R"({
    "asset": {"version": "2.0"}, "images": [{"uri": "heights.png"}, {"uri": "normals.png"}],
    "textures": [{"source": 0}, {"source": 1}],
    "materials": [
      {"name": "on a map", "normalTexture": {"index": 1, "scale": 0.5},
       "extensions": {"EXT_materials_bump": {"bumpFactor": 0.05, "bumpTexture": {"index": 0,
         "extensions": {"KHR_texture_transform": {"scale": [2, 2]}}}}}},
      {"name": "turned", "extensions": {"EXT_materials_bump": {"bumpTexture": {"index": 0,
         "extensions": {"KHR_texture_transform": {"rotation": 1}}}}}},
      {"name": "flat", "extensions": {"EXT_materials_bump": {"bumpFactor": 0, "bumpTexture": {"index": 0}}}}]})",
                                                         "case.gltf"));
  EXPECT_NE(written.text.find(R"(  <bump name="bump_2" type="vector3">
    <input name="height" type="float" nodename="bump_r"/>
    <input name="scale" type="float" value="0.4"/>
    <input name="normal" type="vector3" nodename="normal_map"/>
  </bump>
)"),
            std::string::npos)
      << written.text;
  EXPECT_EQ(written.text.find("bump", written.text.find("SR_flat")), std::string::npos) << written.text;
  ASSERT_EQ(written.said.size(), 1U) << allOf(written.said);
  EXPECT_EQ(written.said[0].place.pointer, "/materials/1/extensions/EXT_materials_bump/bumpTexture");
}

constexpr const char* kNoPeer = "NOT TESTED: there is no MaterialX (LACQUER_MATERIALX), or no node.js";

TEST(WrittenPeer, takesTheCases) {
  std::map<std::string, std::string> documents;
  for (const fs::path& file : findFiles(sourceFolder() / "tests/materialx/written", ".case")) {
    const std::string text = Case(file).section("document");
    // Its surface is OpenPBR 1.1, which has none of 1.2's inputs.
    if (text.find("specular_haze") != std::string::npos) continue;
    documents.emplace(file.stem().string() + ".mtlx", text);
  }
  const std::optional<std::string> said = peerSays(documents);
  if (!said) GTEST_SKIP() << kNoPeer;
  EXPECT_EQ(*said, "");
}

/// Each form of each of the library's nodes that are MaterialX's, with numbers for all that it takes.
graph::Graph everyNode() {
  graph::Graph patterns;
  graph::Group& all = patterns.groups.emplace_back();
  all.name = "every";
  for (const std::string_view name : builtInLibrary().names(lang::DeclKind::Node)) {
    const lang::NodeDecl& decl = **builtInLibrary().node(name);
    const bool closure =
        decl.origin.file.starts_with("nodes/materialx/");  // they take and give several values
    if (!decl.source.starts_with("MaterialX") || decl.category.empty() || closure) continue;
    graph::Node& node = all.nodes.emplace_back();
    node.id = fmt::format("n{}", all.nodes.size());
    node.type = name;
    for (const lang::Param& param : decl.params) {
      if (ir::isTexture(param.type) || ir::isMatrix(param.type)) continue;
      const ir::Components value = param.default_value.value_or(ir::Components{1, 1, 1, 1});
      const ir::Type type = param.type == ir::Type::Int ? ir::Type::Float : param.type;
      if (param.name == "geomprop" || param.name == "varname") {
        node.inputs.emplace_back(std::string(param.name),
                                 graph::Source{graph::AttributeRef{"_WETNESS", type}, {}});
        continue;
      }
      node.inputs.emplace_back(std::string(param.name), graph::Source{graph::Literal{type, value}, {}});
    }
    const std::string_view result = decl.results.size() > 1 ? decl.results[0].name : std::string_view();
    all.outputs.emplace_back(node.id, graph::Source{graph::NodeRef{node.id, std::string(result)}, {}});
  }
  graph::Group& body = patterns.groups.emplace_back();
  body.name = "body";
  body.nodes.push_back({"every", "every", {}, {}, true});
  const graph::Source first{graph::NodeRef{"every", "n1"}, {}};
  body.nodes.push_back({"texel", "texel_of<float>", {}, {{"value", first}}});
  body.outputs.emplace_back("texel", graph::Source{graph::NodeRef{"texel", {}}, {}});
  return patterns;
}

TEST(WrittenPeer, takesEveryNode) {
  material::Document document;
  material::Material& material = document.materials.emplace_back();
  material.name = "all";
  const std::vector<material::Property>& properties = builtInSchema().properties;
  for (uint16_t i = 0; i < properties.size(); ++i) {
    if (properties[i].path != "emissiveTexture") continue;
    material::Material::Texture& texture = material.textures.emplace_back();
    texture.property = i;
    texture.info.group = "body";
    texture.info.output = "texel";
    material.numbers.push_back({static_cast<uint16_t>(i + 1), {1, 1, 1}});
  }
  ASSERT_EQ(properties[material.numbers.at(0).property].path, "emissiveFactor");
  material.patterns = std::make_shared<const graph::Graph>(everyNode());
  const exchange::Written written = exchange::toMaterialX(document, {0}, builtInSchema());
  EXPECT_EQ(allOf(written.said), "");
  EXPECT_GT(std::count(written.text.begin(), written.text.end(), '\n'), 2000);
  const std::optional<std::string> said = peerSays({{"every.mtlx", written.text}});
  if (!said) GTEST_SKIP() << kNoPeer;
  EXPECT_EQ(*said, "");
}

/// MaterialX's own examples, as glTF's or OpenPBR's surface: MaterialX takes what is written, and what is
/// read of it is written as the same bytes.
TEST(WrittenPeer, takesTheExamples) {
  const char* set = std::getenv("LACQUER_ASSETS");
  const fs::path folder =
      (set != nullptr ? fs::path(set) : sourceFolder() / "../shared/assets") / "materialx/examples";
  if (!fs::exists(folder)) GTEST_SKIP() << "NOT TESTED: no " << folder << "; set LACQUER_ASSETS";
  std::map<std::string, std::string> documents;
  for (const fs::path& file : findFiles(folder, ".mtlx")) {
    const auto document = readMaterials(file.string());
    if (!document || document->materials.empty() || hasError(document->materials[0].diagnostics)) continue;
    const exchange::Written first = exchange::toMaterialX(*document, {0}, builtInSchema());
    const material::Document again = documentOf(first.text, "written.mtlx");
    ASSERT_EQ(again.materials.size(), 1U) << file;
    EXPECT_FALSE(hasError(again.materials[0].diagnostics)) << file << allOf(again.materials[0].diagnostics);
    const exchange::Written second = exchange::toMaterialX(again, {0}, builtInSchema());
    // What passes through is tinted once more by each translation.
    const bool passes = first.text.find("\"transmission") != std::string::npos;
    EXPECT_TRUE(passes || second.text == first.text) << file << diffLines(first.text, second.text);
    documents.emplace(file.stem().string() + ".mtlx", first.text);
  }
  EXPECT_GT(documents.size(), 20U);
  const std::optional<std::string> said = peerSays(documents);
  if (!said) GTEST_SKIP() << kNoPeer;
  EXPECT_EQ(*said, "");
}

}  // namespace
}  // namespace lacquer::test
