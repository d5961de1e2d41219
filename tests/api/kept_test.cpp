// MaterialX documents whose surfaces have MaterialX's formulas: written as they were read.
#include <fmt/format.h>

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <string_view>

#include "lacquer.h"
#include "lacquer/exchange.h"

namespace lacquer::test {
namespace {

constexpr const char* kKept = R"(<materialx version="1.38" fileprefix="maps/">
  <xi:include href="parts.mtlx"/>
  <nodegraph name="NG">
    <mix name="half" type="color3">
      <input name="fg" type="color3" value="0.5, 0.25, 0.125" colorspace="srgb_texture"/>
      <input name="bg" type="color3" value="1, 1, 1"/>
      <input name="mix" type="float" value="0.5"/>
    </mix>
    <output name="out" type="color3" nodename="half"/>
  </nodegraph>
  <nodegraph name="unused">
    <constant name="one" type="float"><input name="value" type="float" value="1"/></constant>
    <output name="out" type="float" nodename="one"/>
  </nodegraph>
  <standard_surface name="paint" type="surfaceshader">
    <input name="base_color" type="color3" nodegraph="NG" output="out"/>
    <input name="specular_roughness" type="float" value="0.5"/>
    <input name="thin_film_thickness" type="float" value="0.4" unit="micron" unittype="distance"/>
    <input name="specular_color" type="color3" value="0.5, 0.5, 0.5"/>
  </standard_surface>
  <surfacematerial name="Paint" type="material">
    <input name="surfaceshader" type="surfaceshader" nodename="paint"/>
  </surfacematerial>
  <look name="all"><materialassign name="m" material="Paint" geom="*"/></look>
  <variantset name="wetness">
    <variant name="wet"><input name="specular_roughness" type="float" value="0.125"/></variant>
  </variantset>
</materialx>
)";

constexpr const char* kParts = R"(<materialx version="1.39">
  <gltf_pbr name="metal" type="surfaceshader">
    <input name="metallic" type="float" value="1"/>
  </gltf_pbr>
  <surfacematerial name="m_1" type="material" uiname="Metal">
    <input name="surfaceshader" type="surfaceshader" nodename="metal"/>
  </surfacematerial>
</materialx>
)";

class Kept : public ::testing::Test {
protected:
  Scene read(const std::string& text) {
    Options options;
    options.document_texts = {{"parts.mtlx", kParts}};
    return Scene::fromMemory(text, "paint.mtlx", options, messages_);
  }
  std::string written(const Scene& scene, const Strings& materials = {}, const std::string& surface = {}) {
    return toMaterialX(scene, materials, surface, {}, {}, messages_);
  }
  static bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  }
  std::string said() const {
    std::string all;
    for (const Message& one : messages_) all += one.code + ": " + one.text + "\n";
    return all;
  }
  Messages messages_;
};

TEST_F(Kept, ColourSpacesAreThoseOfTheElementsAround) {
  const Scene scene = read(R"(<materialx version="1.39" colorspace="lin_rec709">
  <nodegraph name="NG" colorspace="srgb_texture">
    <constant name="own" type="color3"><input name="value" type="color3" value="0.5, 0.25, 0.5" colorspace="lin_rec709"/></constant>
    <constant name="as" type="color3"><input name="value" type="color3" value="0.5, 0.25, 0.5"/></constant>
    <constant name="of" type="color3" colorspace=""><input name="value" type="color3" value="0.25, 0.25, 0.5"/></constant>
    <output name="out" type="color3" nodename="own"/>
  </nodegraph>
</materialx>)");
  ASSERT_TRUE(scene);
  const std::string text = written(scene);
  const std::string value = "<input name=\"value\" type=\"color3\" value=\"0.5, 0.25, 0.5\"";
  EXPECT_TRUE(has(text, value + " colorspace=\"lin_rec709\"/>")) << text;
  EXPECT_TRUE(has(text, value + "/>")) << text;
  EXPECT_TRUE(has(text, "<constant name=\"of\" type=\"color3\" colorspace=\"\">")) << text;
}

TEST_F(Kept, AnIncludedFileHasNoColourSpaceOfTheDocument) {
  Options options;
  options.document_texts = {{"in.mtlx", R"(<materialx version="1.39" colorspace="">
  <nodegraph name="NG">
    <constant name="c" type="color3"><input name="value" type="color3" value="0.5, 0.25, 0.5"/></constant>
    <output name="out" type="color3" nodename="c"/>
  </nodegraph>
</materialx>)"}};
  const Scene scene = Scene::fromMemory(R"(<materialx version="1.39" colorspace="srgb_texture"
  xmlns:xi="http://www.w3.org/2001/XInclude"><xi:include href="in.mtlx"/></materialx>)",
                                        "paint.mtlx", options, messages_);
  ASSERT_TRUE(scene) << said();
  EXPECT_TRUE(has(written(scene), "<constant name=\"c\" type=\"color3\" colorspace=\"\">")) << written(scene);
}

TEST_F(Kept, DocumentsAreWrittenAsTheyWereRead) {
  const Scene scene = read(kKept);
  ASSERT_TRUE(scene);
  const std::string text = written(scene);
  // 1.38, brought to what is written today.
  EXPECT_TRUE(has(text, "<materialx version=\"1.39\"")) << text;
  EXPECT_TRUE(has(text, "<standard_surface name=\"paint\"")) << text;
  EXPECT_TRUE(has(text, "<gltf_pbr name=\"metal\"")) << text;
  EXPECT_TRUE(has(text, "colorspace=\"srgb_texture\"")) << text;
  EXPECT_TRUE(has(text, "<variant name=\"wet\"")) << text;
  EXPECT_FALSE(has(text, "xi:include")) << text;
  EXPECT_FALSE(has(text, "of_variant")) << text;
  const Scene again = Scene::fromMemory(text, "paint.mtlx", {}, messages_);
  EXPECT_EQ(again.materialCount(), scene.materialCount());
  EXPECT_EQ(written(again), text);
  EXPECT_EQ(said(), "");
}

TEST_F(Kept, SomeMaterialsAreWrittenWithWhatTheyTake) {
  const Scene scene = read(kKept);
  ASSERT_TRUE(scene);
  const std::string metal = written(scene, {"Metal"});
  EXPECT_TRUE(has(metal, "<gltf_pbr name=\"metal\"")) << metal;
  EXPECT_FALSE(has(metal, "paint")) << metal;
  EXPECT_FALSE(has(metal, "nodegraph")) << metal;
  EXPECT_FALSE(has(metal, "look")) << metal;
  const std::string wet = written(scene, {"Paint/wetness/wet"});
  EXPECT_TRUE(has(wet, "uiname=\"Paint/wetness/wet\"")) << wet;
  EXPECT_TRUE(has(wet, "value=\"0.125\"")) << wet;
  EXPECT_TRUE(has(wet, "<nodegraph name=\"NG\"")) << wet;
  EXPECT_FALSE(has(wet, "unused")) << wet;
  EXPECT_FALSE(has(wet, "of_variant")) << wet;
  const Scene again = Scene::fromMemory(wet, "wet.mtlx", {}, messages_);
  ASSERT_EQ(again.materialCount(), 1U);
  EXPECT_EQ(again.materialName(0), "Paint/wetness/wet");
  EXPECT_EQ(said(), "");
}

TEST_F(Kept, PatternsAloneKeepTheirTypes) {
  const std::string text = R"(<?xml version="1.0"?>
<materialx version="1.39">
  <nodegraph name="Heights">
    <combine4 name="four" type="vector4">
      <input name="in1" type="float" value="0.5"/>
    </combine4>
    <output name="out" type="vector4" nodename="four"/>
  </nodegraph>
</materialx>
)";
  const Scene scene = Scene::fromMemory(text, "patterns.mtlx", {}, messages_);
  EXPECT_EQ(written(scene), text);
  EXPECT_TRUE(messages_.empty());
}

/// What a material needs beside nodes: bodies that an implementation names, properties and tokens of the
/// geometry, outputs of the document.
TEST_F(Kept, WhatStandsBesideTheNodesIsTaken) {
  const std::string text = R"(<materialx version="1.39">
  <geompropdef name="second" type="vector2" geomprop="texcoord" index="1"/>
  <tokendefault name="id" type="string" value="oak"/>
  <nodedef name="ND_two" node="two">
    <input name="in" type="vector2" defaultgeomprop="second"/>
    <output name="out" type="vector2"/>
  </nodedef>
  <nodegraph name="NG_two">
    <dot name="d" type="vector2"><input name="in" type="vector2" interfacename="in"/></dot>
    <output name="out" type="vector2" nodename="d"/>
  </nodegraph>
  <implementation name="IM_two" nodedef="ND_two" nodegraph="NG_two"/>
  <two name="at" type="vector2"/>
  <image name="map" type="color3">
    <input name="file" type="filename" value="&lt;id&gt;.png"/>
    <input name="texcoord" type="vector2" nodename="at"/>
  </image>
  <constant name="unused" type="float"><input name="value" type="float" value="1"/></constant>
  <output name="mapped" type="color3" nodename="map"/>
  <surface_unlit name="s" type="surfaceshader">
    <input name="emission_color" type="color3" output="mapped"/>
  </surface_unlit>
  <surfacematerial name="Map" type="material">
    <input name="surfaceshader" type="surfaceshader" nodename="s"/>
  </surfacematerial>
</materialx>
)";
  const Scene scene = Scene::fromMemory(text, "map.mtlx", {}, messages_);
  std::string expected = written(scene);
  const std::string one = written(scene, {"Map"});
  const size_t unused = expected.find("  <constant");
  expected.erase(unused, expected.find("  <output", unused) - unused);
  EXPECT_EQ(one, expected);
  EXPECT_TRUE(messages_.empty()) << messages_[0].text;
  const Scene again = Scene::fromMemory(one, "map.mtlx", {}, messages_);
  EXPECT_EQ(again.graph(0, kUnusedAttributes, {}, messages_).toJson(),
            scene.graph(0, kUnusedAttributes, {}, messages_).toJson());
}

/// A nodegraph with several outputs, of which each is a pattern of its own.
TEST_F(Kept, APatternOfSeveralIsTaken) {
  const Scene scene = Scene::fromMemory(R"(<materialx version="1.39">
  <nodegraph name="G">
    <constant name="c" type="color3"/>
    <output name="a" type="color3" nodename="c"/>
    <output name="b" type="color3" nodename="c"/>
  </nodegraph>
  <nodegraph name="H"><constant name="c" type="color3"/><output name="a" type="color3" nodename="c"/></nodegraph>
</materialx>)",
                                        "patterns.mtlx", {}, messages_);
  const std::string one = written(scene, {"G/b"});
  EXPECT_NE(one.find("<nodegraph name=\"G\">"), std::string::npos) << one;
  EXPECT_EQ(one.find("\"H\""), std::string::npos) << one;
}

TEST_F(Kept, EditedNumbersAreWritten) {
  const Scene scene = read(kKept);
  ASSERT_TRUE(scene);
  Graph graph = scene.graph(1, kUnusedAttributes, {}, messages_);
  ASSERT_TRUE(graph);
  EXPECT_TRUE(graph.setParameter("NG_half_fg", {0.75, 0.5, 0.25}, messages_));
  EXPECT_TRUE(graph.setParameter("specular_roughness", {0.625}, messages_));
  EXPECT_TRUE(graph.setParameter("specular_color", {0.25, 0.5, 0.75}, messages_));
  EXPECT_EQ(said(), "");
  const std::string text = toMaterialX(scene, {}, {}, {{1, &graph}}, {}, messages_);
  EXPECT_TRUE(has(text, "value=\"0.75, 0.5, 0.25\" colorspace=\"lin_rec709\"") ||
              has(text, "colorspace=\"lin_rec709\" value=\"0.75, 0.5, 0.25\""))
      << text;
  EXPECT_TRUE(has(text, "name=\"specular_roughness\" type=\"float\" value=\"0.625\"")) << text;
  EXPECT_TRUE(has(text, "name=\"specular_color\" type=\"color3\"")) << text;
  EXPECT_TRUE(has(text, "value=\"0.25, 0.5, 0.75\"")) << text;
  EXPECT_TRUE(has(text, "value=\"0.4\" unit=\"micron\"")) << text;  // nobody edited it
  ASSERT_EQ(messages_.size(), 1U) << said();
  EXPECT_EQ(messages_[0].code, "not-said");
  const Scene again = Scene::fromMemory(text, "paint.mtlx", {}, messages_);
  const Graph edited = again.graph(1, kUnusedAttributes, {}, messages_);
  for (const Parameter& parameter : graph.parameters()) {
    for (const Parameter& other : edited.parameters()) {
      if (other.name != parameter.name) continue;
      EXPECT_EQ(other.value, parameter.value) << other.name;
    }
  }
}

TEST_F(Kept, AnotherSurfaceIsTranslated) {
  const Scene scene = read(kKept);
  ASSERT_TRUE(scene);
  const std::string text = written(scene, {"Paint"}, "gltf_pbr");
  EXPECT_TRUE(has(text, "<gltf_pbr")) << text;
  EXPECT_FALSE(has(text, "<standard_surface")) << text;
  EXPECT_TRUE(has(toGltf(scene, {}, 4, {}, messages_), "\"metallicFactor\"") ||
              has(toGltf(scene, {}, 4, {}, messages_), "roughnessFactor"));
  EXPECT_EQ(written(scene, {"nothing"}), "");
}

TEST_F(Kept, AnEvaluationNamesTheFormulas) {
  const Scene own = read(kKept);
  constexpr const char* kPoint = R"([{"v": [0, 0.6, 0.8], "l": [0.6, 0, 0.8], "uv0": [0, 0]}])";
  const auto by_own = evaluate(own, 1, kPoint, Engine::Double, {}, {}, messages_);
  ASSERT_TRUE(by_own) << said();
  EXPECT_EQ(by_own->profile, "materialx");
  Options options;
  options.as = "gltf";
  options.document_texts = {{"parts.mtlx", kParts}};
  const Scene translated = Scene::fromMemory(kKept, "paint.mtlx", options, messages_);
  const auto by_gltf = evaluate(translated, 1, kPoint, Engine::Double, {}, options, messages_);
  ASSERT_TRUE(by_gltf) << said();
  EXPECT_NE(by_gltf->profile, "materialx");
}

/// A chain of additions that is longer than a graph may be without being asked.
/// Of a file's materials those that glTF and other surfaces have no word for are left out, with an error
/// each.
TEST(MaterialsOfClosures, AreLeftOutAlone) {
  Messages messages;
  const Scene scene = Scene::fromMemory(R"(<materialx version="1.39">
  <nodegraph name="NG">
    <ramplr name="r" type="color3"/>
    <output name="out" type="color3" nodename="r"/>
  </nodegraph>
  <gltf_pbr name="a" type="surfaceshader">
    <input name="base_color" type="color3" nodegraph="NG" output="out"/>
  </gltf_pbr>
  <surfacematerial name="A" type="material"><input name="surfaceshader" type="surfaceshader" nodename="a"/></surfacematerial>
  <sheen_bsdf name="f" type="BSDF"/>
  <surface name="b" type="surfaceshader"><input name="bsdf" type="BSDF" nodename="f"/></surface>
  <surfacematerial name="B" type="material"><input name="surfaceshader" type="surfaceshader" nodename="b"/></surfacematerial>
</materialx>)",
                                        "both.mtlx", {}, messages);
  ASSERT_TRUE(messages.empty()) << messages[0].text;
  const std::string document = toMaterialX(scene, {}, "open_pbr_surface", {}, {}, messages);
  EXPECT_NE(document.find("surfacematerial name=\"A\""), std::string::npos) << document;
  EXPECT_EQ(document.find("surfacematerial name=\"B\""), std::string::npos) << document;
  const std::string gltf = toGltf(scene, {}, 4, {}, messages);
  EXPECT_NE(gltf.find(R"("name": "A")"), std::string::npos) << gltf;
  EXPECT_EQ(gltf.find(R"("name": "B")"), std::string::npos) << gltf;
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_EQ(messages[0].code, "closures-not-written");
  EXPECT_EQ(messages[1].code, "closures-not-baked");
  EXPECT_EQ(toGltf(scene, {"B"}, 4, {}, messages), "");
}

/// An unlit surface is its own formula: beyond 1, and transparent by its transmission.
TEST(UnlitSurfaces, AreWhatTheirFormulaSays) {
  Messages messages;
  const Scene scene = Scene::fromMemory(R"(<materialx version="1.39">
  <surface_unlit name="s" type="surfaceshader">
    <input name="emission" type="float" value="5"/>
    <input name="emission_color" type="color3" value="2, 3, 4"/>
    <input name="transmission" type="float" value="0.25"/>
  </surface_unlit>
  <surfacematerial name="M" type="material"><input name="surfaceshader" type="surfaceshader" nodename="s"/></surfacematerial>
</materialx>)",
                                        "unlit.mtlx", {}, messages);
  const auto color = evaluate(scene, 0, "[{}]", Engine::Double, {}, {}, messages);
  ASSERT_TRUE(color) << (messages.empty() ? "" : messages[0].text);
  EXPECT_TRUE(messages.empty());
  EXPECT_EQ(color->profile, "materialx");
  const std::array<double, 4> expected = {10, 15, 20, 0.75};
  for (size_t c = 0; c < 4; ++c) EXPECT_NEAR(color->rgba[0][c], expected[c], 1e-12);
}

/// A variant's inputs that an unlit surface lacks are other surfaces'.
TEST(UnlitSurfaces, TakeVariants) {
  Messages messages;
  const Scene scene = Scene::fromMemory(R"(<materialx version="1.39">
  <surface_unlit name="s" type="surfaceshader">
    <input name="emission_color" type="color3" value="2, 3, 4"/>
  </surface_unlit>
  <surfacematerial name="M" type="material"><input name="surfaceshader" type="surfaceshader" nodename="s"/></surfacematerial>
  <variantset name="paint">
    <variant name="red">
      <input name="emission_color" type="color3" value="1, 0, 0"/>
      <input name="base_color" type="color3" value="1, 0, 0"/>
    </variant>
  </variantset>
</materialx>)",
                                        "unlit.mtlx", {}, messages);
  ASSERT_TRUE(messages.empty()) << messages[0].text;
  ASSERT_EQ(scene.materialCount(), 2U);
  const auto color = evaluate(scene, 1, "[{}]", Engine::Double, {}, {}, messages);
  ASSERT_TRUE(color) << (messages.empty() ? "" : messages[0].text);
  const std::array<double, 4> expected = {1, 0, 0, 1};
  for (size_t c = 0; c < 4; ++c) EXPECT_NEAR(color->rgba[0][c], expected[c], 1e-12);
}

/// A material whose surface is a definition of its own, which is a surface_unlit.
std::string unlitByDefinition(std::string_view attributes, std::string_view node, std::string_view tint) {
  return fmt::format(R"(<materialx version="1.39"{0}>
  <nodedef name="ND_srf" node="srf">
    <input name="tint" type="color3" value="1, 1, 1"/>
    <output name="out" type="surfaceshader"/>
  </nodedef>
  <nodegraph name="NG_srf" nodedef="ND_srf">
    <surface_unlit name="s" type="surfaceshader">
      <input name="emission_color" type="color3" interfacename="tint"/>
    </surface_unlit>
    <output name="out" type="surfaceshader" nodename="s"/>
  </nodegraph>
  <{1} name="s" type="surfaceshader"><input name="tint" type="color3" value="{2}"/></{1}>
  <surfacematerial name="M" type="material"><input name="surfaceshader" type="surfaceshader" nodename="s"/></surfacematerial>
</materialx>)",
                     attributes, node, tint);
}

/// A surface of a definition may stand behind its namespace.
TEST(UnlitSurfaces, StandInNamespaces) {
  Messages messages;
  const Scene scene = Scene::fromMemory(unlitByDefinition(" namespace=\"q\"", "q:srf", "2, 3, 4"),
                                        "unlit.mtlx", {}, messages);
  ASSERT_TRUE(messages.empty()) << messages[0].text;
  const auto color = evaluate(scene, 0, "[{}]", Engine::Double, {}, {}, messages);
  ASSERT_TRUE(color) << (messages.empty() ? "" : messages[0].text);
  const std::array<double, 3> expected = {2, 3, 4};
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(color->rgba[0][c], expected[c], 1e-12);
}

/// A definition that is a surface_unlit is no closure for glTF.
TEST(UnlitSurfaces, AreWrittenToGltfByTheirDefinition) {
  Messages messages;
  const Scene scene =
      Scene::fromMemory(unlitByDefinition("", "srf", "0.25, 0.5, 0.75"), "unlit.mtlx", {}, messages);
  const std::string gltf = toGltf(scene, {}, 4, {}, messages);
  EXPECT_TRUE(messages.empty()) << messages[0].text;
  EXPECT_NE(gltf.find("KHR_materials_unlit"), std::string::npos);
  const Scene again = Scene::fromMemory(gltf, "unlit.gltf", {}, messages);
  const auto color = evaluate(again, 0, "[{}]", Engine::Double, {}, {}, messages);
  ASSERT_TRUE(color) << (messages.empty() ? "" : messages[0].text);
  const std::array<double, 4> expected = {0.25, 0.5, 0.75, 1};
  for (size_t c = 0; c < 4; ++c) EXPECT_NEAR(color->rgba[0][c], expected[c], 1e-12);
}

/// Definitions that each use the one before twice: a few kilobytes that are 2^40 nodes.
TEST(Doubling, IsRefusedBeforeItIsWrittenOut) {
  std::string text = R"(<materialx version="1.39">
<nodedef name="D0" node="f0"><input name="x" type="color3" value="1,1,1"/><output name="out" type="color3"/></nodedef>
<nodegraph name="G0" nodedef="D0"><add name="a" type="color3"><input name="in1" type="color3" interfacename="x"/>
<input name="in2" type="color3" value="0,0,1"/></add><output name="out" type="color3" nodename="a"/></nodegraph>)";
  constexpr int kLevels = 40;
  for (int i = 1; i <= kLevels; ++i) {
    text += fmt::format(R"(
<nodedef name="D{0}" node="f{0}"><input name="x" type="color3" value="1,1,1"/><output name="out" type="color3"/></nodedef>
<nodegraph name="G{0}" nodedef="D{0}"><f{1} name="a" type="color3"><input name="x" type="color3" interfacename="x"/></f{1}>
<f{1} name="b" type="color3"><input name="x" type="color3" nodename="a"/></f{1}><output name="out" type="color3" nodename="b"/></nodegraph>)",
                        i, i - 1);
  }
  text += fmt::format(R"(
<f{} name="q" type="color3"/>
<surface_unlit name="s" type="surfaceshader"><input name="emission_color" type="color3" nodename="q"/></surface_unlit>
<surfacematerial name="M" type="material"><input name="surfaceshader" type="surfaceshader" nodename="s"/></surfacematerial>
</materialx>)",
                      kLevels);
  Messages messages;
  const Scene scene = Scene::fromMemory(text, "doubling.mtlx", {}, messages);
  // Without the material, which is wrong.
  EXPECT_LT(toGltf(scene, {}, 4, {}, messages).size(), 200u);
  ASSERT_FALSE(messages.empty());
  EXPECT_EQ(messages[0].code, "graph-too-large");
}

/// What is wrong with an image is told where its name stands.
TEST(ImagesOfDocuments, AreMissedAtTheirPlace) {
  Messages messages;
  const Scene scene = Scene::fromMemory(R"(<materialx version="1.39">
  <image name="i" type="color3">
    <input name="file" type="filename" value="none.png"/>
  </image>
  <surface_unlit name="s" type="surfaceshader"><input name="emission_color" type="color3" nodename="i"/></surface_unlit>
  <surfacematerial name="M" type="material"><input name="surfaceshader" type="surfaceshader" nodename="s"/></surfacematerial>
</materialx>)",
                                        "image.mtlx", {}, messages);
  ASSERT_TRUE(evaluate(scene, 0, "[{}]", Engine::Double, {}, {}, messages));
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0].code, "image-missing");
  EXPECT_EQ(messages[0].line, 3U);
  EXPECT_EQ(messages[0].column, 6U);
}

/// A node of a nodegraph without a material is called as the document calls it.
TEST(PatternsAlone, AreLookedInto) {
  Messages messages;
  const Scene scene = Scene::fromMemory(R"(<materialx version="1.39">
  <nodegraph name="NG">
    <constant name="x" type="color3"><input name="value" type="color3" value="0.25, 0.5, 0.75"/></constant>
    <multiply name="m" type="color3">
      <input name="in1" type="color3" nodename="x"/>
      <input name="in2" type="color3" value="0.5, 0.5, 0.5"/>
    </multiply>
    <output name="out" type="color3" nodename="m"/>
  </nodegraph>
</materialx>)",
                                        "alone.mtlx", {}, messages);
  Trial trial;
  trial.node = "NG/x";
  const auto color = evaluate(scene, 0, "[{}]", Engine::Double, {}, {}, messages, trial);
  ASSERT_TRUE(color) << (messages.empty() ? "" : messages[0].text);
  const std::array<double, 3> expected = {0.25, 0.5, 0.75};
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(color->rgba[0][c], expected[c], 1e-12);
}

/// A procedural's output is a node's: of a nodegraph's own number there is one.
TEST(Procedurals, HaveNodesOfNumbersAlone) {
  Messages messages;
  const Scene scene = Scene::fromMemory(R"(<materialx version="1.39">
  <nodegraph name="NG">
    <input name="a" type="color3" value="0.2, 0.4, 0.6"/>
    <output name="out" type="color3" interfacename="a"/>
  </nodegraph>
  <gltf_pbr name="s" type="surfaceshader">
    <input name="base_color" type="color3" nodegraph="NG" output="out"/>
  </gltf_pbr>
  <surfacematerial name="M" type="material"><input name="surfaceshader" type="surfaceshader" nodename="s"/></surfacematerial>
</materialx>)",
                                        "number.mtlx", {}, messages);
  const Scene again = Scene::fromMemory(toGltf(scene, {}, 4, {}, messages), "number.gltf", {}, messages);
  EXPECT_TRUE(messages.empty()) << messages[0].text;
  const auto color = evaluate(again, 0, "[{}]", Engine::Double, {}, {}, messages);
  Options as;
  as.as = "gltf";
  const Scene translated =
      Scene::fromMemory(toMaterialX(scene, {}, "", {}, {}, messages), "number.mtlx", as, messages);
  const auto expected = evaluate(translated, 0, "[{}]", Engine::Double, {}, as, messages);
  ASSERT_TRUE(color && expected) << (messages.empty() ? "" : messages[0].text);
  EXPECT_EQ(color->rgba, expected->rgba);
}

TEST(NodesOfDocuments, AreAsManyAsTheLimitSays) {
  std::string text =
      "<materialx version=\"1.39\"><nodegraph name=\"NG\"><constant name=\"n0\" type=\"color3\"/>";
  constexpr int kNodes = 10100;
  for (int i = 1; i < kNodes; ++i) {
    const std::string name = "n" + std::to_string(i);
    text += "<add name=\"" + name + "\" type=\"color3\"><input name=\"in1\" type=\"color3\" nodename=\"n" +
            std::to_string(i - 1) + "\"/></add>";
  }
  text += "<output name=\"out\" type=\"color3\" nodename=\"n" + std::to_string(kNodes - 1) +
          "\"/></nodegraph></materialx>";
  for (const char* limit : {"nodes=10000", "nodes=20000"}) {
    Options options;
    options.limits = {limit};
    Messages messages;
    const Scene scene = Scene::fromMemory(text, "chain.mtlx", options, messages);
    const Graph graph = scene ? scene.graph(0, kUnusedAttributes, options, messages) : Graph();
    const bool good = graph && graph.check(messages, options) && !hasError(messages);
    EXPECT_EQ(good, limit == std::string("nodes=20000")) << limit;
  }
}

}  // namespace
}  // namespace lacquer::test
