// Time, frame, place and attributes by name: in graphs, documents and procedurals of files, by need alone.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "lacquer.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

/// A graph of the template `forward` whose emission is a vec3 of the node `n`, others before it.
Graph graphOf(const std::string& nodes, const std::string& attributes, Messages& messages) {
  return Graph::fromJson(R"({"lacquer_graph": 1, "name": "g", "template": "forward", "attributes": [)" +
                             attributes + R"(], "nodes": [)" + nodes +
                             R"(], "outputs": {"emission": {"node": "n"}}})",
                         "g.json", messages);
}

/// What it emits at a point of these members, with these uniforms.
std::array<double, 4> emitted(const std::string& nodes, const std::string& point,
                              const std::string& uniforms = {}, const std::string& attributes = {}) {
  Messages messages;
  const Graph graph = graphOf(nodes, attributes, messages);
  EXPECT_TRUE(graph) << textOf(messages);
  if (!graph) return {};
  const std::string points = fmt::format(R"({{"points": [{{{}}}], "uniforms": {{{}}}}})", point, uniforms);
  const auto found = evaluate(graph, points, Engine::Double, {}, {}, messages);
  EXPECT_TRUE(found) << textOf(messages);
  return found ? found->rgba[0] : std::array<double, 4>{};
}

Shader shaderOf(const std::string& nodes, const std::string& attributes = {}) {
  Messages messages;
  Graph graph = graphOf(nodes, attributes, messages);
  EXPECT_TRUE(graph) << textOf(messages);
  Options options;
  options.targets = {Target::Glsl,  Target::GlslGl, Target::Essl, Target::Hlsl,
                     Target::Spirv, Target::Wgsl,   Target::Msl};
  Shader shader = graph.generate(options, messages);
  EXPECT_TRUE(shader) << textOf(messages);
  EXPECT_EQ(textOf(messages), "");
  return shader;
}

/// A shader's inputs as "location name", in their order.
Strings inputsOf(const Shader& shader) {
  Strings inputs;
  for (const ShaderInput& input : shader.reflection().inputs)
    inputs.push_back(fmt::format("{} {} {}", input.location, input.type, input.name));
  return inputs;
}

bool hasBlock(const Shader& shader, std::string_view name) {
  const std::vector<UniformBlock>& blocks = shader.reflection().blocks;
  return std::any_of(blocks.begin(), blocks.end(), [&](const UniformBlock& b) { return b.name == name; });
}

const std::string kTime =
    R"({"id": "t", "node": "time"}, {"id": "f", "node": "frame"},
       {"id": "n", "node": "combine3", "inputs": {"in1": {"node": "t"}, "in2": {"node": "f"}}})";
const std::string kWetness =
    R"({"id": "n", "node": "geompropvalue<vec3>", "inputs": {"geomprop": {"attribute": "_WETNESS", "type": "vec3"}}})";

TEST(StandardPlace, TimeAndFrameAreUniforms) {
  EXPECT_EQ(emitted(kTime, "", R"("clock.time": 2.5, "clock.frame": 60)"),
            (std::array<double, 4>{2.5, 60, 0, 1}));
  const Shader shader = shaderOf(kTime);
  EXPECT_TRUE(hasBlock(shader, "Clock"));
}

/// What is drawn of a node at a time: the grey in the middle of its ball, of 255.
int greyAt(double time, double frame) {
  Messages messages;
  const Graph graph = graphOf(
      R"({"id": "t", "node": "time"}, {"id": "f", "node": "frame"},
         {"id": "s", "node": "multiply", "inputs": {"in1": {"node": "t"}, "in2": 0.25}},
         {"id": "p", "node": "multiply", "inputs": {"in1": {"node": "f"}, "in2": 0.01}},
         {"id": "m", "node": "add", "inputs": {"in1": {"node": "s"}, "in2": {"node": "p"}}},
         {"id": "n", "node": "combine3", "inputs": {"in1": {"node": "m"}}})",
      "", messages);
  Trial trial;
  trial.node = "m";
  trial.time = time;
  trial.frame = frame;
  const std::vector<uint8_t> rgb = drawBall(graph, 16, {}, {}, messages, trial, {ValueLook::As::Grey});
  EXPECT_EQ(textOf(messages), "");
  return rgb.size() == size_t{3} * 16 * 16 ? rgb[3 * (16 * 8 + 8)] : -1;
}

TEST(StandardPlace, BallsAreDrawnAtATime) {
  EXPECT_EQ(greyAt(0, 0), 0);
  EXPECT_NEAR(greyAt(2, 0), 0.5 * 255, 1);
  EXPECT_NEAR(greyAt(2, 20), 0.7 * 255, 1);
}

TEST(StandardPlace, ATrialHasATime) {
  Messages messages;
  const Graph graph = graphOf(kTime, "", messages);
  Trial trial;
  trial.time = 2.5;
  trial.frame = 60;
  constexpr const char* kPlain = R"({"points": [{}]})";
  for (const Engine engine : {Engine::Double, Engine::Float}) {
    const auto found = evaluate(graph, kPlain, engine, {}, {}, messages, trial);
    ASSERT_TRUE(found) << textOf(messages);
    EXPECT_EQ(found->rgba[0], (std::array<double, 4>{2.5, 60, 0, 1}));
  }
  // What the points say of the block comes first.
  const auto said = evaluate(graph, R"({"points": [{}], "uniforms": {"clock.time": 7}})", Engine::Double, {},
                             {}, messages, trial);
  ASSERT_TRUE(said) << textOf(messages);
  EXPECT_EQ(said->rgba[0], (std::array<double, 4>{7, 60, 0, 1}));
  for (const double wrong : {-1.0, 16777217.0, std::numeric_limits<double>::quiet_NaN()}) {
    trial.time = wrong;
    Messages bad;
    EXPECT_FALSE(evaluate(graph, kPlain, Engine::Double, {}, {}, bad, trial));
    ASSERT_EQ(bad.size(), 1U);
    EXPECT_EQ(bad[0].code, "out-of-range");
  }
}

/// Integers as they are, a bool where it is not 0; one vertex's, in every target.
const std::string kCounted =
    R"({"id": "i", "node": "geompropvalue", "inputs": {"geomprop": {"attribute": "_ID", "type": "int"}, "default": 3}},
       {"id": "b", "node": "geompropvalue", "inputs": {"geomprop": {"attribute": "_FLAG", "type": "bool"}}},
       {"id": "c", "node": "convert<float, int>", "inputs": {"in": {"node": "i"}}},
       {"id": "s", "node": "ifequal", "inputs": {"value1": {"node": "b"}, "value2": true, "in1": {"node": "c"}, "in2": 0.25}},
       {"id": "n", "node": "combine3", "inputs": {"in1": {"node": "s"}, "in2": {"node": "c"}}})";

TEST(StandardPlace, AttributesAreIntegersAndBools) {
  using Four = std::array<double, 4>;
  EXPECT_EQ(emitted(kCounted, R"("_ID": 7, "_FLAG": 1)"), (Four{7, 7, 0, 1}));
  EXPECT_EQ(emitted(kCounted, R"("_ID": -2, "_FLAG": 0)"), (Four{0.25, -2, 0, 1}));
  EXPECT_EQ(emitted(kCounted, ""), (Four{0.25, 0, 0, 1}));
  const Shader shader = shaderOf(kCounted);
  EXPECT_EQ(inputsOf(shader), (Strings{"0 vec3 POSITION", "8 float _FLAG", "9 int _ID"}));
  const std::string glsl = shader.fragmentText(Target::Glsl);
  size_t flat = 0;
  for (size_t at = glsl.find("flat in int"); at != std::string::npos; at = glsl.find("flat in int", at + 1))
    ++flat;
  EXPECT_EQ(flat, 2U) << glsl;
}

/// A swizzle takes parts of vectors of integers, too, of attributes and of parameters.
TEST(StandardPlace, PartsOfIntegersAreTaken) {
  const std::string nodes =
      R"({"id": "a", "node": "convert<float, int>", "inputs": {"in": {"attribute": "_P", "type": "ivec3", "swizzle": "z"}}},
         {"id": "b", "node": "convert<float, int>", "inputs": {"in": {"parameter": "k", "swizzle": "y"}}},
         {"id": "n", "node": "combine3", "inputs": {"in1": {"node": "a"}, "in2": {"node": "b"}}})";
  const auto graphOfValue = [&](const std::string& value, Messages& messages) {
    return Graph::fromJson(R"({"lacquer_graph": 1, "name": "g", "template": "forward",
      "parameters": {"k": {"type": "ivec2", "value": [3, )" +
                               value + "]}}, \"nodes\": [" + nodes +
                               R"(], "outputs": {"emission": {"node": "n"}}})",
                           "g.json", messages);
  };
  Messages messages;
  Graph graph = graphOfValue("-5", messages);
  ASSERT_TRUE(graph) << textOf(messages);
  for (const Engine engine : {Engine::Double, Engine::Float}) {
    const auto found = evaluate(graph, R"({"points": [{"_P": [1, 2, 7]}]})", engine, {}, {}, messages);
    ASSERT_TRUE(found) << textOf(messages);
    EXPECT_EQ(found->rgba[0], (std::array<double, 4>{7, -5, 0, 1}));
  }
  EXPECT_TRUE(graph.generate({}, messages)) << textOf(messages);
  for (const char* wrong : {"3000000000", "0.5"}) {
    Messages said;
    const Graph bad = graphOfValue(wrong, said);
    if (bad) bad.check(said);
    EXPECT_TRUE(std::any_of(said.begin(), said.end(),
                            [](const Message& m) { return m.level == Message::Level::Error; }))
        << wrong << textOf(said);
  }
}

/// Defaults are those of the definitions, also where they are not 0.
TEST(StandardPlace, DefaultsAreTheDefinitions) {
  const auto equal = [](const std::string& node, const std::string& inputs) {
    return emitted(R"({"id": "e", "node": ")" + node + R"(", "inputs": {)" + inputs + R"(}},
       {"id": "f", "node": "ifequal<float, bool>", "inputs": {"value1": {"node": "e"}, "value2": true, "in1": 1}},
       {"id": "n", "node": "combine3", "inputs": {"in1": {"node": "f"}}})",
                   "")[0];
  };
  for (const char* node : {"ifequal<bool>", "ifequal<bool, int>"}) {
    EXPECT_EQ(equal(node, ""), 0) << node;
    EXPECT_EQ(equal(node, R"("value2": 1)"), 1) << node;
  }
}

TEST(StandardPlace, AttributesHaveTheirNames) {
  EXPECT_EQ(emitted(kWetness, R"("_WETNESS": [0.5, 3, 0.25])"), (std::array<double, 4>{0.5, 3, 0.25, 1}));
  EXPECT_EQ(emitted(kWetness, ""), (std::array<double, 4>{0, 0, 0, 1}));
  const Shader shader = shaderOf(kWetness);
  EXPECT_EQ(inputsOf(shader), (Strings{"0 vec3 POSITION", "8 vec3 _WETNESS"}));
  EXPECT_NE(shader.vertexText(Target::Glsl).find("layout(location = 8) in vec3 in_wetness;"),
            std::string::npos);
}

/// In the order of their names, whatever asks first.
TEST(StandardPlace, OwnAttributesLieBehindTheTemplates) {
  const std::string nodes =
      R"({"id": "n", "node": "add<vec3>", "inputs": {"in1": {"attribute": "_B", "type": "vec3"},
          "in2": {"attribute": "_A", "type": "vec3"}}})";
  EXPECT_EQ(inputsOf(shaderOf(nodes)), (Strings{"0 vec3 POSITION", "8 vec3 _A", "9 vec3 _B"}));
  // Where a skin has its places, these come behind it.
  const Strings skinned = inputsOf(shaderOf(nodes, R"("JOINTS_0", "WEIGHTS_0")"));
  EXPECT_NE(std::find(skinned.begin(), skinned.end(), "10 vec3 _A"), skinned.end());
}

TEST(StandardPlace, WhatIsNotReadIsNotThere) {
  const Shader shader = shaderOf(R"({"id": "n", "node": "constant<vec3>"})", R"("COLOR_1", "_WETNESS")");
  EXPECT_FALSE(hasBlock(shader, "Clock"));
  EXPECT_EQ(inputsOf(shader), (Strings{"0 vec3 POSITION"}));
  EXPECT_EQ(shader.fragmentText(Target::Glsl).find("clock"), std::string::npos);
}

TEST(StandardPlace, ColorsHaveSets) {
  const std::string nodes = R"({"id": "n", "node": "geomcolor<vec3>", "inputs": {"index": 2}})";
  const std::string point = R"("COLOR_2": [0.5, 0.25, 0.125, 1])";
  EXPECT_EQ(emitted(nodes, point, {}, R"("COLOR_2")"), (std::array<double, 4>{0.5, 0.25, 0.125, 1}));
  // A primitive without that set is white, and its shader does not read it.
  EXPECT_EQ(emitted(nodes, point), (std::array<double, 4>{1, 1, 1, 1}));
  EXPECT_EQ(inputsOf(shaderOf(nodes)), (Strings{"0 vec3 POSITION"}));
  EXPECT_EQ(inputsOf(shaderOf(nodes, R"("COLOR_1", "COLOR_2")")),
            (Strings{"0 vec3 POSITION", "8 vec4 COLOR_2"}));
}

/// An object that is turned about z by a quarter, twice as large along x, and moved.
const std::string kObject =
    R"("object.model": [0, 2, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1],
       "object.normal_matrix": [0, 0.5, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])";

std::array<double, 4> moved(const std::string& node, const std::string& in, const std::string& from,
                            const std::string& to) {
  return emitted(
      fmt::format(
          R"({{"id": "n", "node": "{}", "inputs": {{"in": {}, "fromspace": "{}", "tospace": "{}"}}}})", node,
          in, from, to),
      "", kObject);
}

TEST(StandardPlace, SpacesAreTheObjects) {
  using Four = std::array<double, 4>;
  EXPECT_EQ(moved("transformpoint", "[1, 2, 3]", "object", "world"), (Four{3, 8, 10, 1}));
  EXPECT_EQ(moved("transformpoint", "[3, 8, 10]", "world", "model"), (Four{1, 2, 3, 1}));
  EXPECT_EQ(moved("transformpoint", "[3, 8, 10]", "model", "object"), (Four{3, 8, 10, 1}));
  EXPECT_EQ(moved("transformvector", "[1, 2, 3]", "object", "world"), (Four{-2, 2, 3, 1}));
  EXPECT_EQ(moved("transformvector", "[-2, 2, 3]", "world", "object"), (Four{1, 2, 3, 1}));
  EXPECT_EQ(moved("transformnormal", "[1, 0, 0]", "object", "world"), (Four{0, 1, 0, 1}));
  EXPECT_EQ(moved("transformnormal", "[0, 1, 0]", "world", "object"), (Four{1, 0, 0, 1}));
}

/// A document's primitives have what it reads.
TEST(StandardPlace, DocumentsReadAttributes) {
  Messages messages;
  const Scene scene = Scene::fromMemory(
      R"(<materialx version="1.39"><nodegraph name="NG">
         <geompropvalue name="wet" type="color3"><input name="geomprop" type="string" value="wetness"/></geompropvalue>
         <geomcolor name="col" type="color3"><input name="index" type="integer" value="1"/></geomcolor>
         <time name="t" type="float"/>
         <multiply name="m" type="color3"><input name="in1" type="color3" nodename="wet"/><input name="in2" type="color3" nodename="col"/></multiply>
         <multiply name="s" type="color3"><input name="in1" type="color3" nodename="m"/><input name="in2" type="float" nodename="t"/></multiply>
         <output name="out" type="color3" nodename="s"/></nodegraph></materialx>)",
      "a.mtlx", {}, messages);
  ASSERT_TRUE(scene) << textOf(messages);
  const auto found = evaluate(
      scene, 0,
      R"({"points": [{"_wetness": [0.5, 0.5, 1], "COLOR_1": [0.5, 0.25, 0.5]}], "uniforms": {"clock.time": 0.5}})",
      Engine::Double, {}, {}, messages);
  ASSERT_TRUE(found) << textOf(messages);
  EXPECT_EQ(found->rgba[0], (std::array<double, 4>{0.125, 0.0625, 0.25, 1}));
}

/// Texts decide what the graph is: those of constants, and of properties that the document gives, or their
/// defaults.
TEST(StandardPlace, DocumentsHaveTexts) {
  const auto emittedOf = [](const std::string& info) {
    Messages messages;
    const Scene scene = Scene::fromMemory(R"(<materialx version="1.39">)" + info + R"(<nodegraph name="NG">
         <constant name="where" type="string"><input name="value" type="string" value="world"/></constant>
         <dot name="there" type="string"><input name="in" type="string" nodename="where"/></dot>
         <transformpoint name="p" type="vector3"><input name="in" type="vector3" value="1, 2, 3"/>
           <input name="fromspace" type="string" value="object"/><input name="tospace" type="string" nodename="there"/></transformpoint>
         <geompropvalueuniform name="which" type="string"><input name="geomprop" type="string" value="part"/>
           <input name="default" type="string" value="count"/></geompropvalueuniform>
         <geompropvalue name="i" type="integer"><input name="geomprop" type="string" nodename="which"/></geompropvalue>
         <UsdPrimvarReader name="b" type="boolean"><input name="varname" type="string" value="flag"/></UsdPrimvarReader>
         <convert name="f" type="float"><input name="in" type="integer" nodename="i"/></convert>
         <ifequal name="e" type="float"><input name="value1" type="boolean" nodename="b"/>
           <input name="value2" type="boolean" value="true"/><input name="in1" type="float" nodename="f"/></ifequal>
         <separate3 name="s" type="multioutput"><input name="in" type="vector3" nodename="p"/></separate3>
         <combine3 name="c" type="color3"><input name="in1" type="float" nodename="e"/>
           <input name="in2" type="float" nodename="s" output="outx"/></combine3>
         <output name="out" type="color3" nodename="c"/></nodegraph></materialx>)",
                                          "a.mtlx", {}, messages);
    EXPECT_TRUE(scene) << textOf(messages);
    if (!scene) return std::pair(std::array<double, 4>{}, false);
    const auto found = evaluate(
        scene, 0,
        R"({"points": [{"_count": 1, "_other": 0, "_flag": 1}], "uniforms": {"object.model": [1,0,0,0, 0,1,0,0, 0,0,1,0, -0.5,0,0,1]}})",
        Engine::Double, {}, {}, messages);
    EXPECT_TRUE(found) << textOf(messages);
    const bool differ = std::any_of(messages.begin(), messages.end(),
                                    [](const Message& message) { return message.code == "texts-differ"; });
    return std::pair(found ? found->rgba[0] : std::array<double, 4>{}, differ);
  };
  using Four = std::array<double, 4>;
  EXPECT_EQ(emittedOf(""), std::pair(Four{1, 0.5, 0, 1}, false));
  const std::string other =
      R"(<geominfo name="a" geom="/a"><geomprop name="part" type="string" value="other"/></geominfo>)";
  EXPECT_EQ(emittedOf(other), std::pair(Four{0, 0.5, 0, 1}, false));
  const std::string both =
      other +
      R"(<geominfo name="b" geom="/b"><geomprop name="part" type="string" value="count"/></geominfo>)";
  EXPECT_EQ(emittedOf(both), std::pair(Four{1, 0.5, 0, 1}, true));
}

/// A file's procedural on a primitive that has the attribute, in the file's spelling, and on one without.
TEST(StandardPlace, FilesSayWhatPrimitivesHave) {
  for (const bool has : {true, false}) {
    const std::string file =
        R"({"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_texture_procedurals", "EXT_texture_procedurals_mx_1_39"],
            "textures": [{}], "extensions": {"KHR_texture_procedurals": {"procedurals": [{"name": "g", "nodetype": "nodegraph",
            "type": "float", "nodes": [{"name": "w", "nodetype": "geompropvalue", "type": "float",
            "inputs": {"geomprop": {"type": "string", "value": "wetness"}, "default": {"type": "float", "value": 0.25}}}],
            "outputs": {"out": {"type": "float", "node": 0}}}]}},
            "materials": [{"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0, "extensions": {"KHR_texture_procedurals": {"index": 0}}}}],
            "accessors": [{"type": "VEC3", "componentType": 5126, "count": 3}, {"type": "SCALAR", "componentType": 5126, "count": 3}],
            "meshes": [{"primitives": [{"material": 0, "attributes": {"POSITION": 0)" +
        std::string(has ? R"(, "_WETNESS": 1)" : "") +
        R"(}}]}], "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]})";
    Messages messages;
    const Scene scene = Scene::fromMemory(file, "a.gltf", {}, messages);
    ASSERT_TRUE(scene) << textOf(messages);
    Graph graph = scene.graph(0, scene.uses(0)[0], {}, messages);
    ASSERT_TRUE(graph) << textOf(messages);
    const Shader shader = graph.generate({}, messages);
    ASSERT_TRUE(shader) << textOf(messages);
    const Strings inputs = inputsOf(shader);
    EXPECT_EQ(std::find(inputs.begin(), inputs.end(), "8 float _WETNESS") != inputs.end(), has);
    EXPECT_EQ(graph.toJson().find(R"("geomprop": 0.25)") == std::string::npos, has);
  }
}

}  // namespace
}  // namespace lacquer::test
