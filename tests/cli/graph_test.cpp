// Verbs that take a graph in a material's place.
#include <gtest/gtest.h>

#include "command.h"
#include "support/cases.h"

namespace lacquer::test::graph_test {
namespace {

using Json = nlohmann::json;

constexpr const char* kPoints = R"([{"v": [0, 0.6, 0.8], "l": [0.6, 0, 0.8], "env": [1, 0.5, 0.25]}])";

/// A place with `paint.json`, the graph of a material without textures, and points.
class GraphFiles : public testing::Test {
protected:
  void SetUp() override {
    const auto made = place_.run({"graph", example("coat.gltf"), "--material", "Darkening"});
    ASSERT_EQ(made.status, 0) << made.err;
    place_.write("paint.json", made.out);
    place_.write("points.json", kPoints);
  }

  Workplace place_;
};

TEST_F(GraphFiles, areEvaluated) {
  const auto answer = place_.run({"eval", "paint.json", "--points", "points.json"});
  EXPECT_EQ(answer.status, 0) << answer.err;
  const Json json = Json::parse(answer.out);
  EXPECT_EQ(json["material"], "Darkening");
  EXPECT_EQ(json["rgba"].size(), 1u);
  EXPECT_FALSE(json.contains("profile"));
  const auto built = place_.run({"eval", "paint.json", "--points", "points.json", "--profile", "physical"});
  EXPECT_EQ(built.status, 1);
  EXPECT_NE(built.err.find("[graph-is-built]"), std::string::npos) << built.err;
}

TEST_F(GraphFiles, areDrawnBesideMaterials) {
  const auto drawn = place_.run(
      {"preview", example("film.gltf"), "paint.json", "-o", "balls.png", "--size", "16", "--json"});
  EXPECT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_EQ(Json::parse(drawn.out)["materials"], 3);
  EXPECT_TRUE(std::filesystem::exists(place_ / "balls.png"));
  const auto none = place_.run({"preview", "paint.json", "-o", "no.png", "--material", "Other"});
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.err.find("[no-such-material]"), std::string::npos) << none.err;
  const auto over = place_.run({"preview", "paint.json", "-o", "paint.json"});
  EXPECT_EQ(over.status, 1);
  EXPECT_EQ(place_.run({"graph", "paint.json"}).status, 0) << "the graph is still there";
}

TEST_F(GraphFiles, areProvedAndDumpedAndReadBack) {
  EXPECT_EQ(place_.run({"prove", "paint.json"}).status, 0);
  const auto dump = place_.run({"dump", "paint.json"});
  EXPECT_EQ(dump.status, 0);
  EXPECT_NE(dump.out.find("coat.darkening"), std::string::npos);
  const auto again = place_.run({"graph", "paint.json"});
  EXPECT_EQ(again.status, 0);
  place_.write("again.json", again.out);
  EXPECT_EQ(place_.run({"graph", "again.json"}).out, again.out);
}

/// The shader that the material of the file gets, whatever stands for it.
TEST_F(GraphFiles, areGeneratedAndPlannedBesideMaterials) {
  const std::vector<std::string> inputs = {"paint.json", example("film.gltf")};
  const auto with = [&](std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(), inputs.begin(), inputs.end());
    words.insert(words.end(), more.begin(), more.end());
    return place_.run(words);
  };
  const auto made = with({"gen"}, {"-o", "made", "--target", "glsl", "--no-validate", "-q"});
  ASSERT_EQ(made.status, 0) << made.err;
  const Json manifest = Json::parse(place_.read("made/manifest.json"));
  ASSERT_EQ(manifest["files"].size(), 2u);
  EXPECT_EQ(manifest["files"][0]["materials"][0]["name"], "Darkening");
  ASSERT_EQ(place_
                .run({"gen", example("coat.gltf"), "--material", "Darkening", "-o", "own", "--target", "glsl",
                      "--no-validate", "-q"})
                .status,
            0);
  const Json own = Json::parse(place_.read("own/manifest.json"));
  EXPECT_EQ(manifest["files"][0]["materials"][0]["uses"][0]["shader"],
            own["files"][0]["materials"][0]["uses"][0]["shader"]);
  const auto planned =
      with({"plan"}, {"--ninja", "build.ninja", "-o", "made", "--target", "glsl", "--no-validate", "-q"});
  EXPECT_EQ(planned.status, 0) << planned.err;
  EXPECT_NE(place_.read("build.ninja").find(manifest["files"][0]["materials"][0]["uses"][0]["shader"]),
            std::string::npos);
}

TEST_F(GraphFiles, areChosenByName) {
  const auto chosen = place_.run({"gen", "paint.json", example("film.gltf"), "--material", "Darkening", "-o",
                                  "chosen", "--target", "glsl", "--no-validate", "-q"});
  EXPECT_EQ(chosen.status, 0) << chosen.err;
  const Json manifest = Json::parse(place_.read("chosen/manifest.json"));
  EXPECT_EQ(manifest["files"][0]["materials"].size(), 1u);
  EXPECT_EQ(manifest["files"][1]["materials"].size(), 0u);
  const auto none = place_.run({"gen", "paint.json", "--material", "Other", "-o", "none", "-q"});
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.err.find("no file has a material named 'Other'"), std::string::npos) << none.err;
}

/// Merged with materials a graph keeps its numbers.
TEST_F(GraphFiles, shareProgramsWithMaterials) {
  const auto made =
      place_.run({"gen", "paint.json", example("coat.gltf"), "-o", "few", "--target", "glsl", "--no-validate",
                  "--programs", "2", "--model-costs", "--programs-report", "curve.md", "-q"});
  ASSERT_EQ(made.status, 0) << made.err;
  const Json manifest = Json::parse(place_.read("few/manifest.json"));
  EXPECT_EQ(manifest["shaders"].size(), 2u);
  const Json& graph = manifest["files"][0]["materials"][0];
  EXPECT_FALSE(graph.contains("profile"));
  const Json& use = graph["uses"][0];
  for (const Json& material : manifest["files"][1]["materials"]) {
    if (material["name"] != "Darkening") continue;
    for (const char* own : {"coat_darkening_factor", "base_color_factor"})
      EXPECT_EQ(use["parameters"][own]["value"], material["uses"][0]["parameters"][own]["value"]);
  }
  EXPECT_NE(place_.read("curve.md").find("| 2 |"), std::string::npos);
}

TEST_F(GraphFiles, haveTheCostOfTheirMaterials) {
  const auto graph = place_.run({"cost", "paint.json", "--json"});
  ASSERT_EQ(graph.status, 0) << graph.err;
  const auto material = place_.run({"cost", example("coat.gltf"), "--material", "Darkening", "--json"});
  EXPECT_EQ(graph.out, material.out);
  const Json json = Json::parse(graph.out);
  ASSERT_EQ(json["shaders"].size(), 1u);
  EXPECT_GT(json["shaders"][0]["spirv_instructions"], 100);
  const auto none = place_.run({"cost", "paint.json", "--material", "Other"});
  EXPECT_EQ(none.status, 1);
}

TEST_F(GraphFiles, areAttackedAsTheirMaterialsAre) {
  const auto graph = place_.run({"stress", "paint.json", "--samples", "2000", "--json"});
  EXPECT_EQ(graph.status, 0) << graph.err;
  Json found = Json::parse(graph.out)["subjects"];
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0]["graph"], "paint.json");
  Json file = Json::parse(readFile(example("coat.gltf")));
  Json only = Json::array();
  for (const Json& material : file["materials"]) {
    if (material["name"] == "Darkening") only.push_back(material);
  }
  place_.write("one.gltf", Json{{"asset", file["asset"]}, {"materials", only}}.dump());
  const auto material = place_.run({"stress", "one.gltf", "--samples", "2000", "--json"});
  const Json subject = Json::parse(material.out)["subjects"][0];
  EXPECT_EQ(subject["energy"], found[0]["energy"]);
  EXPECT_EQ(subject["findings"].size(), found[0]["findings"].size());
  // A finding of a graph is found again.
  ASSERT_FALSE(found[0]["findings"].empty());
  place_.write("case.json", found[0]["findings"][0]["case"].dump());
  const auto again = place_.run({"stress", "case.json", "--json"});
  EXPECT_EQ(again.status, 1) << "it is still there";
  EXPECT_EQ(Json::parse(again.out)["subjects"][0]["findings"][0]["what"], found[0]["findings"][0]["what"]);
  place_.write("case.json", R"({"graph": "../paint.json", "samples": []})");
  EXPECT_NE(place_.run({"stress", "case.json"}).err.find("[case-outside]"), std::string::npos);
  place_.write("case.json", R"({"graph": "points.json", "samples": []})");
  EXPECT_NE(place_.run({"stress", "case.json"}).err.find("[bad-case]"), std::string::npos);
}

constexpr const char* kRusty = R"({"lacquer_graph": 1, "name": "rusty", "template": "forward",
  "parameters": {"rust": {"type": "float", "value": 0.25, "range": [0, 1]}},
  "textures": {"mask": {"type": "sampler2D", "file": "MASK", SAMPLER}},
  "groups": {"worn": {
    "inputs": {"color": {"type": "vec3"}, "amount": {"type": "float", "default": 0.5},
               "image": {"type": "sampler2D", "default": {"texture": "mask"}},
               "uv": {"type": "vec2", "default": {"given": "uv0"}}},
    "nodes": [
      {"id": "texel", "node": "texture_sample", "inputs": {"image": {"input": "image"}, "uv": {"input": "uv"}}},
      {"id": "glow", "node": "emission", "inputs": {"factor": {"input": "color"},
       "strength": {"input": "amount"}, "texel": {"node": "texel", "swizzle": "rgb"}}}],
    "outputs": {"light": {"node": "glow"}, "mask": {"node": "texel", "swizzle": "a"}}}},
  "nodes": [{"id": "iron", "group": "worn", "inputs": {"color": 1, "amount": {"parameter": "rust"}}}],
  "outputs": {"emission": {"node": "iron", "output": "light"}}})";

std::string rusty(const std::string& mask,
                  const std::string& sampler = R"("wrap": "clamp", "filter": "nearest")") {
  std::string text = kRusty;
  text.replace(text.find("SAMPLER"), 7, sampler);
  return text.replace(text.find("MASK"), 4, mask);
}

/// The first point's emission.
Json colorOf(const Outcome& outcome) {
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return outcome.status == 0 ? Json::parse(outcome.out)["rgba"][0] : Json();
}

TEST_F(GraphFiles, haveGroupsAndImagesBesideThem) {
  const std::string checker = (std::filesystem::path(example("")) / "textures/checker.png").string();
  std::filesystem::create_directories(place_ / "maps");
  std::filesystem::copy_file(checker, place_ / "maps/a mask.png");
  place_.write("rusty.json", rusty("maps/a%20mask.png"));
  place_.write("at.json", R"([{"uv0": [0.01, 0.01]}, {"uv0": [7, 0.01]}])");
  const auto by_file = place_.run({"eval", "rusty.json", "--points", "at.json"});
  const Json color = colorOf(by_file);
  EXPECT_NE(color,
            colorOf(place_.run({"eval", "rusty.json", "--points", "at.json", "--texel", "mask=0,0,0,1"})));
  EXPECT_EQ(place_.run({"preview", "rusty.json", "-o", "ball.png", "--size", "16"}).err, "");
  EXPECT_EQ(place_.run({"gen", "rusty.json", "-o", "out", "-q"}).status, 0);
  const Json use = place_.manifest("out")["files"][0]["materials"][0]["uses"][0];
  EXPECT_EQ(use["textures"]["mask"]["file"], "maps/a%20mask.png");
  EXPECT_EQ(use["textures"]["mask"]["sampler"]["wrap_t"], "clamp");
  EXPECT_EQ(use["textures"]["mask"]["sampler"]["mag_filter"], "nearest");
  EXPECT_EQ(schemaErrors({place_ / "out/manifest.json"}).value_or(""), "");
  for (const char* verb : {"dump", "prove", "cost", "graph"})
    EXPECT_EQ(place_.run({verb, "rusty.json"}).status, 0);
  EXPECT_EQ(place_.run({"stress", "rusty.json", "--samples", "500"}).status, 0);
  // A data URI is in the graph itself.
  const auto encoded = place_.shell("base64 -w0 'maps/a mask.png'");
  place_.write("inside.json", rusty("data:image/png;base64," + encoded.out));
  EXPECT_EQ(colorOf(place_.run({"eval", "inside.json", "--points", "at.json"})), color);
}

TEST_F(GraphFiles, readNoImagesElsewhere) {
  place_.write("at.json", R"([{"uv0": [0.01, 0.01]}])");
  std::filesystem::create_directories(place_ / "below");
  std::filesystem::copy_file(std::filesystem::path(example("")) / "textures/checker.png", place_ / "up.png");
  place_.write("below/rusty.json", rusty("../up.png"));
  const auto outside = place_.run({"eval", "below/rusty.json", "--points", "at.json"});
  EXPECT_EQ(outside.status, 1);
  EXPECT_NE(outside.err.find("below/rusty.json:/textures/mask/file: error: mask has no image: \"../up.png\" "
                             "leads out of the file's folder [image-outside]"),
            std::string::npos)
      << outside.err;
  EXPECT_EQ(place_.run({"eval", "below/rusty.json", "--points", "at.json", "--allow", "."}).status, 0);
  place_.write("gone.json", rusty("gone.png"));
  const auto gone = place_.run({"eval", "gone.json", "--points", "at.json"});
  EXPECT_EQ(gone.status, 1);
  EXPECT_NE(gone.err.find("[image-missing]"), std::string::npos) << gone.err;
  // What stands for it is said.
  place_.write("gone.json", rusty("gone.png", R"("default": [0.5, 0.25, 1, 1])"));
  const auto with = place_.run({"eval", "gone.json", "--points", "at.json"});
  EXPECT_EQ(colorOf(with)[0], 0.125);
  EXPECT_NE(with.err.find("warning"), std::string::npos) << with.err;
  EXPECT_NE(with.err.find("its default colour stands for it"), std::string::npos) << with.err;
}

/// What MaterialX has the nodes for is a document, and the rest is named.
TEST_F(GraphFiles, areWrittenAsDocuments) {
  place_.write("stains.json", R"({"lacquer_graph": 1, "name": "stains", "template": "bsdf",
    "parameters": {"much": {"type": "float", "value": 0.75}},
    "nodes": [
      {"id": "grain", "node": "noise2d<float>"},
      {"id": "stain", "node": "remap", "inputs": {"in": {"node": "grain"}, "outhigh": {"parameter": "much"}}},
      {"id": "tone", "node": "mix", "inputs": {"fg": [1, 0.5, 0.25], "bg": [0, 0, 0], "mix": {"node": "stain"}}},
      {"id": "glow", "node": "emission", "inputs": {"factor": {"node": "tone"}, "strength": 1, "texel": 1}},
      {"id": "after", "node": "saturate", "inputs": {"in": {"node": "glow"}}}
    ],
    "outputs": {"emission": {"node": "after"}, "alpha": {"node": "stain"}}})");
  const auto written = place_.run({"graph", "stains.json", "--format", "mtlx"});
  ASSERT_EQ(written.status, 0) << written.err;
  for (const char* part : {"<noise2d name=\"grain\"", "<remap name=\"stain\"", "value=\"0.75\"",
                           "<output name=\"alpha\"", "<output name=\"tone_out\" type=\"color3\""})
    EXPECT_NE(written.out.find(part), std::string::npos) << part << "\n" << written.out;
  EXPECT_EQ(written.out.find("glow"), std::string::npos) << written.out;
  for (const char* part :
       {"\"glow\", emission, is none of MaterialX's", "\"after\" takes a value from \"glow\""})
    EXPECT_NE(written.err.find(part), std::string::npos) << part << "\n" << written.err;
  place_.write("stains.mtlx", written.out);
  const auto again = place_.run({"graph", "stains.mtlx", "--material", "stains/tone_out"});
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_NE(again.out.find("noise2d<float>"), std::string::npos) << again.out;
}

/// Beyond an image's edge is the colour that the node has there, not the texture's.
TEST_F(GraphFiles, areWrittenWithTheColorsBesideImages) {
  const std::string u = "name=\"uaddressmode\" type=\"string\" value=\"constant\"";
  const std::string v = "name=\"vaddressmode\" type=\"string\" value=\"constant\"";
  const std::string of_node = "name=\"default\" type=\"color3\" value=\"0.5, 0.25, 0\"";
  const std::string of_texture = "name=\"default\" type=\"color3\" value=\"0, 0, 1\"";
  struct Written {
    std::string ends;
    std::vector<std::string> parts, others;
    bool tiles = false;
  };
  const Written cases[] = {{R"(, "ends": "both")", {u, v, of_node}, {of_texture}},
                           {R"(, "ends": 3)", {u, v, of_node}, {of_texture}},
                           {R"(, "ends": {"parameter": "along"})", {v, of_node}, {u, of_texture}},
                           {R"(, "ends": 0)", {of_texture}, {u, v, of_node}},
                           {"", {of_node}, {u, v, of_texture}, true}};
  for (const Written& one : cases) {
    const std::string type = one.tiles ? "sampler2DArray" : "sampler2D";
    place_.write("wood.json", R"({"lacquer_graph": 1, "name": "wood", "template": "forward",
      "parameters": {"along": {"type": "int", "value": 2}},
      "textures": {"wood": {"type": ")" +
                                  type + R"(", "default": [0, 0, 1, 1], "file": ")" +
                                  (one.tiles ? "wood.<UDIM>.png" : "wood.png") + R"("}},
      "nodes": [{"id": "wood", "node": "image<vec3)" +
                                  (one.tiles ? ", " + type : "") + R"(>", "inputs": {
        "file": {"texture": "wood"}, "default": [0.5, 0.25, 0])" +
                                  one.ends + R"(}}],
      "outputs": {"emission": {"node": "wood"}}})");
    const auto written = place_.run({"graph", "wood.json", "--format", "mtlx"});
    EXPECT_EQ(written.status, 0) << written.err;
    for (const std::string& part : one.parts)
      EXPECT_NE(written.out.find(part), std::string::npos) << type << one.ends << "\n" << written.out;
    for (const std::string& part : one.others)
      EXPECT_EQ(written.out.find(part), std::string::npos) << type << one.ends << "\n" << written.out;
  }
}

/// A document's node has the path that it has there.
TEST_F(GraphFiles, ofDocumentsNameNodesByTheirPaths) {
  place_.write("stripes.mtlx", R"(<?xml version="1.0"?>
<materialx version="1.39">
  <nodegraph name="NG">
    <noise2d name="grain" type="float"/>
    <remap name="rm" type="float">
      <input name="in" type="float" nodename="grain"/>
      <input name="outhigh" type="float" value="0.5"/>
    </remap>
    <separate2 name="parts" type="multioutput">
      <input name="in" type="vector2" value="0.25, 0.75"/>
    </separate2>
    <add name="sum" type="float">
      <input name="in1" type="float" nodename="rm"/>
      <input name="in2" type="float" nodename="parts" output="outy"/>
    </add>
    <convert name="tone" type="color3"><input name="in" type="float" nodename="sum"/></convert>
    <output name="out" type="color3" nodename="tone"/>
  </nodegraph>
  <gltf_pbr name="SR" type="surfaceshader">
    <input name="base_color" type="color3" nodegraph="NG" output="out"/>
  </gltf_pbr>
  <surfacematerial name="M" type="material">
    <input name="surfaceshader" type="surfaceshader" nodename="SR"/>
  </surfacematerial>
</materialx>)");
  const auto at = [&](const std::string& node) {
    return place_.run({"eval", "stripes.mtlx", "--points", "points.json", "--node", node});
  };
  EXPECT_EQ(at("NG/rm").status, 0) << at("NG/rm").err;
  const auto part = at("NG/parts.outy");
  ASSERT_EQ(part.status, 0) << part.err;
  EXPECT_EQ(Json::parse(part.out)["values"], Json::parse("[[0.75]]"));
  EXPECT_NE(at("NG/nobody").err.find("[no-such-node]"), std::string::npos);
}

/// Octaves whose number is the material's are a loop, through which what a noise is bounds what comes out.
TEST_F(GraphFiles, haveBoundsThroughLoops) {
  for (const char* node : {"fractal2d<vec3>", "fractal3d<vec3>"}) {
    std::string text = R"({"lacquer_graph": 1, "name": "octaves", "template": "forward",
      "parameters": {"n": {"type": "int", "value": 3}},
      "nodes": [{"id": "r", "node": "NODE", "inputs": {"octaves": {"parameter": "n"}}}],
      "outputs": {"emission": {"node": "r"}}})";
    text.replace(text.find("NODE"), 4, node);
    place_.write("octaves.json", text);
    const auto proved = place_.run({"prove", "octaves.json", "--json"});
    ASSERT_EQ(proved.status, 0) << proved.err;
    const Json reached = Json::parse(proved.out)["outputs"][0]["reached"];
    ASSERT_EQ(reached.size(), 2u) << node << reached.dump() << " it may be no number";
    EXPECT_TRUE(reached[0].is_number() && reached[1].is_number()) << node << reached.dump();
  }
}

TEST_F(GraphFiles, haveLevels) {
  place_.write("rusty.json", rusty("gone.png", R"("default": [0.5, 0.25, 1, 1])"));
  const auto made = place_.run({"lod", "rusty.json", "-o", "levels", "--levels", "2", "--size", "16",
                                "--target", "glsl", "--no-validate", "--json", "-q"});
  ASSERT_EQ(made.status, 0) << made.err;
  const Json chain = Json::parse(made.out)["materials"][0];
  EXPECT_EQ(chain["name"], "rusty");
  EXPECT_GT(chain["measured"], 1);
  EXPECT_EQ(place_.manifest("levels")["levels"].size(), 1u);
  const auto built =
      place_.run({"lod", "rusty.json", "-o", "levels", "--profile", "physical", "--size", "16", "-q"});
  EXPECT_EQ(built.status, 1);
  EXPECT_NE(built.err.find("[graph-is-built]"), std::string::npos) << built.err;
}

TEST_F(GraphFiles, areMadeSimplerNodeByNode) {
  const auto gen = [&](const std::string& word, const std::string& out) {
    return place_.run(
        {"gen", "paint.json", "-o", out, "--target", "glsl", "--no-validate", "-q", "--simplify", word});
  };
  ASSERT_EQ(gen("vertex:base.color", "a").status, 0);
  ASSERT_EQ(gen("scale:coat_factor=0.5", "b").status, 0);
  EXPECT_NE(place_.manifest("a")["shaders"].items().begin().key(),
            place_.manifest("b")["shaders"].items().begin().key());
  const auto wrong = gen("without:coat.darkening", "c");
  EXPECT_EQ(wrong.status, 1);
  EXPECT_NE(wrong.err.find("[graph-is-built]"), std::string::npos) << wrong.err;
}

TEST_F(GraphFiles, saySomethingWhereTheyAreWrong) {
  place_.write("cut.json", R"({"lacquer_graph": 1,)");
  place_.write("none.json",
               R"({"lacquer_graph": 1, "template": "forward", "nodes": [], "outputs": {"colour": 1}})");
  for (const char* file : {"cut.json", "none.json", "absent.json"}) {
    EXPECT_EQ(place_.run({"eval", file, "--points", "points.json"}).status, 1) << file;
    EXPECT_EQ(place_.run({"preview", file, "-o", "no.png"}).status, 1) << file;
    EXPECT_EQ(place_.run({"prove", file}).status, 1) << file;
    EXPECT_EQ(place_.run({"cost", file}).status, 1) << file;
    EXPECT_EQ(place_.run({"stress", file, "--samples", "16"}).status, 1) << file;
    EXPECT_EQ(place_.run({"gen", file, "-o", "no", "-q"}).status, 1) << file;
    const auto dump = place_.run({"dump", file});
    EXPECT_EQ(dump.status, 1) << file;
    EXPECT_NE(dump.err.find(file), std::string::npos) << dump.err;
  }
}

TEST_F(GraphFiles, areNoDocuments) {
  const auto written =
      place_.run({"graph", example("coat.gltf"), "--material", "Darkening", "--format", "mtlx"});
  EXPECT_EQ(written.status, 0) << written.err;
  place_.write("darkening.mtlx", written.out);
  const auto read = place_.run({"graph", "darkening.mtlx", "--format", "mtlx"});
  EXPECT_EQ(read.status, 0) << read.err;
  EXPECT_EQ(read.out, written.out);
  const auto graph = place_.run({"graph", "paint.json", "--format", "mtlx"});
  EXPECT_EQ(graph.status, 2);
  EXPECT_NE(graph.err.find("[nothing-said]"), std::string::npos) << graph.err;
  EXPECT_EQ(graph.err.find("[not-said]"), std::string::npos) << graph.err;
}

}  // namespace
}  // namespace lacquer::test::graph_test
