// Outputs of a template beside four floats of colour: other types, a fragment's depth, and vertices that are
// elsewhere.
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

#include "inputs.h"

namespace lacquer::test {
namespace {

using Json = nlohmann::json;

constexpr const char* kMoved = R"(/// What a height moves, and outputs of all types.
template moved extends mesh {
    port vec3  displacement = vec3(0);          // object space
    port float nearness in [-1, 2] = 0.5;
    port float roughness = 1;
    output displacement vec3 object_position = object_position + displacement;
    output displacement vec3 object_normal = object_normal + displacement.zxy;
    output color vec4 shown = vec4(position, 1);
    output color float rough = roughness;
    output color vec2 place = uv0;
    output color vec3 facing = normal;
    output color int steps = int(roughness * 8) - 4;
    output color uint bits = uint(roughness * 8);
    output depth float near = nearness;
}

/// What is lifted.
/// source: ACME_lift
extension ACME_lift {
    float liftHeight in [-1, 1] = 0;
}

/// Along the normal.
/// source: ACME_lift
part lift of ACME_lift over coat unless liftHeight == 0 {
surface:
    lift.offset = lifted(object_normal, liftHeight);
    out displacement = lift.offset;
}

/// Along the normal.
/// source: ACME_lift
node lifted(vec3 normal, float height) -> vec3 {
    return normal * height;
}
)";

Options moved() {
  Options options = quick();
  options.node_texts = {{"moved.node", kMoved}};
  return options;
}

/// A graph that delivers these ports.
std::string graphOf(const Json& nodes, const Json& outputs, const char* of = "moved") {
  return Json{{"lacquer_graph", 1},
              {"name", "moved"},
              {"template", of},
              {"parameters", {{"height", {{"type", "float"}, {"value", 0.25}, {"range", {-1, 1}}}}}},
              {"textures", Json::object()},
              {"nodes", nodes},
              {"outputs", outputs},
              {"skipped", Json::object()}}
      .dump();
}

const Json kLifted = {
    {{"id", "lift"},
     {"node", "multiply"},
     {"inputs", {{"in1", {{"given", "object_normal"}}}, {"in2", {{"parameter", "height"}}}}}}};

TEST(Outputs, HaveTheirTypesInEveryTarget) {
  Messages messages;
  Options options = moved();
  options.validate = true;
  options.targets = {Target::Glsl, Target::GlslGl, Target::Essl, Target::Hlsl, Target::Spirv, Target::Wgsl};
  Graph graph = Graph::fromJson(
      graphOf(kLifted, {{"displacement", {{"node", "lift"}}}, {"roughness", {{"parameter", "height"}}}}),
      "moved.json", messages, moved());
  const Shader shader = graph.generate(options, messages);
  ASSERT_TRUE(shader) << errorsOf(messages);
  EXPECT_EQ(errorsOf(messages), "");
  const Reflection& reflection = shader.reflection();
  std::string types;
  for (const ShaderOutput& output : reflection.outputs) types += output.name + ' ' + output.type + ", ";
  EXPECT_EQ(types, "shown vec4, rough float, place vec2, facing vec4, steps int, bits uint, ");
  EXPECT_EQ(reflection.depth, "near");
  EXPECT_EQ(reflection.displaces, (Strings{"object_position", "object_normal"}));
  const Json interface = Json::parse(shader.interfaceJson());
  EXPECT_EQ(interface["outputs"][5]["type"], "uint");
  EXPECT_EQ(interface["depth"], "near");
  EXPECT_EQ(interface["displaces"], (Json{"object_position", "object_normal"}));
  constexpr std::array kWanted = {std::pair{Target::Glsl, "gl_FragDepth = 0.5;"},
                                  std::pair{Target::Essl, "gl_FragDepth = 0.5;"},
                                  std::pair{Target::Hlsl, "out float out_near : SV_Depth"},
                                  std::pair{Target::Wgsl, "@builtin(frag_depth) out_near: f32"}};
  for (const auto& [target, wanted] : kWanted)
    EXPECT_NE(shader.fileText(target, 1).find(wanted), std::string::npos) << shader.fileText(target, 1);
}

TEST(Outputs, ADepthIsKeptWithinItsRange) {
  Messages messages;
  Graph graph =
      Graph::fromJson(graphOf(Json::array(), {{"nearness", {{"given", "normal"}, {"swizzle", "z"}}}}),
                      "near.json", messages, moved());
  Options options = moved();
  options.targets = {Target::Glsl};
  const Shader shader = graph.generate(options, messages);
  ASSERT_TRUE(shader) << errorsOf(messages);
  EXPECT_NE(shader.fileText(Target::Glsl, 1).find("gl_FragDepth = clamp("), std::string::npos)
      << shader.fileText(Target::Glsl, 1);
  const auto proofs = graph.prove(options, messages);
  ASSERT_TRUE(proofs);
  size_t depths = 0;
  for (const OutputProof& output : proofs->outputs) {
    if (output.name != "near") continue;
    ++depths;
    EXPECT_GE(output.reached.low, 0);
    EXPECT_LE(output.reached.high, 1);
  }
  EXPECT_EQ(depths, 1U);
}

constexpr const char* kPoint =
    R"([{"n": [0, 0, 1], "v": [0, 0.6, 0.8], "l": [0.6, 0, 0.8], "uv0": [0.3, 0.7]}])";

std::array<double, 4> shownBy(const Graph& graph, Engine engine, Messages& messages) {
  const auto colors = evaluate(graph, kPoint, engine, {}, moved(), messages);
  return colors ? colors->rgba.at(0) : std::array<double, 4>{};
}

TEST(Outputs, VerticesAreWhereTheGraphSays) {
  Messages messages;
  const Options options = moved();
  const Graph still =
      Graph::fromJson(graphOf(Json::array(), Json::object()), "still.json", messages, options);
  const Graph lifted = Graph::fromJson(graphOf(kLifted, {{"displacement", {{"node", "lift"}}}}),
                                       "lifted.json", messages, options);
  for (const Engine engine : {Engine::Double, Engine::Float}) {
    const auto before = shownBy(still, engine, messages);
    const auto after = shownBy(lifted, engine, messages);
    EXPECT_EQ(errorsOf(messages), "");
    EXPECT_EQ(after[0], before[0]);
    EXPECT_EQ(after[1], before[1]);
    EXPECT_EQ(after[2], before[2] + 0.25);
  }
}

/// A part of a vendor's says it as a graph does.
TEST(Outputs, AMaterialsPartMovesVertices) {
  Messages messages;
  Options options = moved();
  options.template_name = "moved";
  const auto fileOf = [](double height) {
    return Json{{"asset", {{"version", "2.0"}}},
                {"materials", {{{"name", "m"}, {"extensions", {{"ACME_lift", {{"liftHeight", height}}}}}}}}}
        .dump();
  };
  std::array<std::array<double, 4>, 2> shown{};
  for (const size_t lifted : {size_t{0}, size_t{1}}) {
    const Scene scene =
        Scene::fromMemory(fileOf(0.5 * static_cast<double>(lifted)), "lift.gltf", options, messages);
    const Graph graph = scene.graph(
        0, {true, true, false, {true, false, false, false}, {}, false, false, false, {}}, options, messages);
    shown[lifted] = shownBy(graph, Engine::Double, messages);
  }
  EXPECT_EQ(errorsOf(messages), "");
  EXPECT_EQ(shown[1][2], shown[0][2] + 0.5);
}

/// A height may come out of a texture, in every engine of the processor.
TEST(Outputs, ATextureMovesVertices) {
  Messages messages;
  const Json nodes = {{{"id", "texel"},
                       {"node", "texture_sample"},
                       {"inputs", {{"image", {{"texture", "height"}}}, {"uv", {{"given", "uv0"}}}}}}};
  Json text = Json::parse(graphOf(nodes, {{"displacement", {{"node", "texel"}, {"swizzle", "rgb"}}}}));
  text["textures"]["height"] = {{"type", "sampler2D"}, {"srgb", false}};
  const Graph graph = Graph::fromJson(text.dump(), "moved.json", messages, moved());
  ASSERT_TRUE(graph) << errorsOf(messages);
  for (const Engine engine : {Engine::Double, Engine::Float}) {
    const auto colors = evaluate(graph, kPoint, engine, {"height=0.25,0.5,0.125,1"}, moved(), messages);
    ASSERT_TRUE(colors) << errorsOf(messages);
    EXPECT_EQ(colors->rgba.at(0), (std::array<double, 4>{0.25, 0.5, 0.125, 1}));
  }
}

TEST(Outputs, WhatVerticesDoNotKnowMovesNone) {
  Messages messages;
  const Json nodes = {{{"id", "slope"},
                       {"node", "heighttonormal"},
                       {"inputs", {{"in", {{"given", "uv0"}, {"swizzle", "x"}}}}}}};
  Graph graph = Graph::fromJson(graphOf(nodes, {{"displacement", {{"node", "slope"}}}}), "slope.json",
                                messages, moved());
  EXPECT_FALSE(graph.generate(moved(), messages));
  EXPECT_EQ(errorsOf(messages), "wrong-rate");
}

}  // namespace
}  // namespace lacquer::test
