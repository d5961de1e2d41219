// Matrices as parameters of a graph and as attributes of vertices: in every target, the evaluators and the
// block.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "inputs.h"

namespace lacquer::test {
namespace {

/// `place` moves a constant point by a parameter, `vertex` one by an attribute; both show in the emission.
std::string matrixGraph(const std::string& parameters, const std::string& attribute = "mat3") {
  return R"({"lacquer_graph": 1, "name": "matrices", "template": "forward",
  "parameters": {)" +
         parameters + R"(},
  "nodes": [
    {"id": "moved", "node": "transformmatrix", "inputs": {"in": [0.5, 0.25, 0.125], "mat": {"parameter": "m"}}},
    {"id": "vertex", "node": "transformmatrix", "inputs": {"in": [1, 2, 4], "mat": {"attribute": "_FRAME", "type": ")" +
         attribute + R"("}}},
    {"id": "sum", "node": "add", "inputs": {"in1": {"node": "moved"}, "in2": {"node": "vertex"}}},
    {"id": "light", "node": "max", "inputs": {"in1": {"node": "sum"}, "in2": [0, 0, 0]}}
  ],
  "outputs": {"emission": {"node": "light"}}})";
}

constexpr const char* kMat3 =
    R"("m": {"type": "mat3", "value": [1, 2, 3, 4, 5, 6, 7, 8, 9], "default": [1, 0, 0, 0, 1, 0, 0, 0, 1]})";
/// `m` times the point.
constexpr std::array<double, 3> kMovedPoint = {0.5 + 1 + 0.875, 1 + 1.25 + 1, 1.5 + 1.5 + 1.125};

Graph graphOf(const std::string& text, Messages& messages, const Options& options = quick()) {
  return Graph::fromJson(text, "matrices.json", messages, options);
}

Options everyTarget() {
  Options options;
  options.targets.clear();
  for (const std::string& name : targetNames()) {
    Target target{};
    EXPECT_TRUE(findTarget(name, target));
    options.targets.push_back(target);
  }
  return options;
}

TEST(Matrices, ReachEveryTarget) {
  for (const char* attribute : {"mat3", "mat4"}) {
    const bool four = std::string(attribute) == "mat4";
    const std::string parameters =
        four ? R"("m": {"type": "mat4", "value": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1]})" : kMat3;
    Messages messages;
    Graph graph = graphOf(matrixGraph(parameters, attribute), messages, everyTarget());
    const Shader shader = graph.generate(everyTarget(), messages);
    ASSERT_TRUE(shader) << errorsOf(messages);
    EXPECT_EQ(errorsOf(messages), "");
    std::vector<std::string> inputs;
    for (const ShaderInput& input : shader.reflection().inputs) {
      if (input.name[0] == '_') inputs.push_back(input.name + " " + input.type);
    }
    const std::string type = four ? " vec4" : " vec3";
    std::vector<std::string> expected = {"_FRAME_0" + type, "_FRAME_1" + type, "_FRAME_2" + type};
    if (four) expected.push_back("_FRAME_3" + type);
    EXPECT_EQ(inputs, expected);
  }
}

TEST(Matrices, AreEvaluated) {
  const std::string points =
      R"([{"_FRAME": [1, 0, 0, 0, 1, 0, 0, 0, 1]}, {"_FRAME": [0, 0, 1, 2, 0, 0, 0, 0.5, 0]}, {}])";
  const std::array<std::array<double, 3>, 3> expected = {
      {{kMovedPoint[0] + 1, kMovedPoint[1] + 2, kMovedPoint[2] + 4},
       {kMovedPoint[0] + 4, kMovedPoint[1] + 2, kMovedPoint[2] + 1},
       {kMovedPoint[0], kMovedPoint[1], kMovedPoint[2]}}};
  for (const Engine engine : {Engine::Double, Engine::Float, Engine::Vulkan}) {
    Messages messages;
    const Graph graph = graphOf(matrixGraph(kMat3), messages);
    const auto colors = evaluate(graph, points, engine, {}, quick(), messages);
    if (!colors && errorsOf(messages) == "vulkan-unavailable") {
      std::puts("NOT TESTED: there is no Vulkan device");
      continue;
    }
    ASSERT_TRUE(colors) << errorsOf(messages);
    for (size_t i = 0; i < 3; ++i) {
      for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(colors->rgba[i][c], expected[i][c], 1e-5) << i << c;
    }
  }
}

TEST(Matrices, AreTriedByTheirNames) {
  const Graph graph = [] {
    Messages messages;
    return graphOf(matrixGraph(kMat3), messages);
  }();
  Trial trial;
  trial.parameters = {{"m", {0, 0, 2, 0, 2, 0, 2, 0, 0}}};
  Messages messages;
  const auto colors = evaluate(graph, "[{}]", Engine::Double, {}, quick(), messages, trial);
  ASSERT_TRUE(colors) << errorsOf(messages);
  const std::array<double, 3> expected = {0.25, 0.5, 1};
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(colors->rgba[0][c], expected[c], 1e-12);
  trial.parameters = {{"m", {1, 2, 3}}};
  Messages wrong;
  EXPECT_FALSE(evaluate(graph, "[{}]", Engine::Double, {}, quick(), wrong, trial));
  EXPECT_EQ(errorsOf(wrong), "wrong-count");
}

/// A matrix for each point, and an attribute of floats.
TEST(Matrices, AreArrays) {
  Messages messages;
  const Graph graph = graphOf(matrixGraph(kMat3), messages);
  std::vector<double> matrices(18, 0);
  for (size_t i = 0; i < 3; ++i) {
    matrices[4 * i] = 2;
    matrices[9 + 4 * i] = 4;
  }
  const std::vector<float> frames = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  PointArrays points;
  points.count = 2;
  points.arrays = {{"m", matrices.data(), true, 9, 9 * sizeof(double)},
                   {"_FRAME", frames.data(), false, 9, 9 * sizeof(float)}};
  const auto colors = evaluate(graph, points, Engine::Double, {}, quick(), messages);
  ASSERT_TRUE(colors) << errorsOf(messages);
  EXPECT_NEAR(colors->rgba[0][0], 1 + 1, 1e-12);
  EXPECT_NEAR(colors->rgba[0][2], 0.25 + 4, 1e-12);
  EXPECT_NEAR(colors->rgba[1][0], 2, 1e-12);
  EXPECT_NEAR(colors->rgba[1][2], 0.5, 1e-12);
  points.arrays[1].components = 8;
  Messages wrong;
  EXPECT_FALSE(evaluate(graph, points, Engine::Double, {}, quick(), wrong));
  EXPECT_EQ(errorsOf(wrong), "wrong-type");
}

/// Other numbers are no other program; they reach the block, under the columns' names.
TEST(Matrices, AreNumbersOfTheBlock) {
  Messages messages;
  Graph graph = graphOf(matrixGraph(kMat3), messages);
  const Shader shader = graph.generate(quick(), messages);
  ASSERT_TRUE(shader) << errorsOf(messages);
  const std::vector<Parameter> parameters = graph.parameters();
  ASSERT_EQ(parameters.size(), 1U);
  EXPECT_EQ(parameters[0].type, "mat3");
  EXPECT_EQ(parameters[0].value, (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
  const auto blockOf = [&](const Graph& of) {
    std::vector<std::byte> block(shader.uniformSize());
    EXPECT_TRUE(shader.packGraph(of, block, messages));
    return block;
  };
  const std::vector<std::byte> before = blockOf(graph);
  const std::vector<double> other = {9, 8, 7, 6, 5, 4, 3, 2, 1};
  ASSERT_TRUE(graph.setParameter("m", other, messages)) << errorsOf(messages);
  EXPECT_EQ(graph.changes(), Change::Numbers);
  EXPECT_NE(blockOf(graph), before);
  std::vector<std::byte> by_name(shader.uniformSize());
  ASSERT_TRUE(shader.pack(
      [&](std::string_view name, std::span<double> to) {
        if (!name.starts_with("m_") || to.size() != 3) return false;
        std::copy_n(&other[3 * static_cast<size_t>(name[2] - '0')], 3, to.begin());
        return true;
      },
      by_name, messages));
  EXPECT_EQ(blockOf(graph), by_name);
  Messages wrong;
  EXPECT_FALSE(graph.setParameter("m", {1, 2, 3}, wrong));
  EXPECT_EQ(errorsOf(wrong), "wrong-count");
  // The text has them, and is read again.
  Messages again;
  EXPECT_EQ(graphOf(graph.toJson(), again).toJson(), graph.toJson());
  EXPECT_NE(graph.toJson().find("\"value\": [9, 8, 7, 6, 5, 4, 3, 2, 1]"), std::string::npos);
  EXPECT_NE(graph.toJson().find("\"default\": [1, 0, 0, 0, 1, 0, 0, 0, 1]"), std::string::npos);
}

/// As a group of another graph the matrix is an input for each column, with today's numbers.
TEST(Matrices, AreInputsOfGroups) {
  Messages messages;
  const Graph inner = graphOf(matrixGraph(kMat3), messages);
  Graph outer =
      graphOf(R"({"lacquer_graph": 1, "name": "outer", "template": "forward", "nodes": [], "outputs": {}})",
              messages);
  ASSERT_TRUE(outer.addGroup("inner", inner, messages)) << errorsOf(messages);
  ASSERT_TRUE(outer.addInstance("one", "inner", messages)) << errorsOf(messages);
  ASSERT_TRUE(outer.setOutput("emission", R"({"node": "one", "output": "emission"})", messages))
      << errorsOf(messages);
  const auto colors = evaluate(outer, "[{}]", Engine::Double, {}, quick(), messages);
  ASSERT_TRUE(colors) << errorsOf(messages);
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(colors->rgba[0][c], kMovedPoint[c], 1e-12);
}

/// A node of one's own takes a matrix of the vertices where they have one.
TEST(Matrices, AreTakenByNodes) {
  Options options = quick();
  options.node_texts = {{"carry.node", R"(
/// A point in the frame of the vertex.
/// source: the tests
node carried(vec3 point = vec3(1, 2, 4), mat3 frame = given _FRAME or mat3(2)) -> vec3 {
    return max(frame * point, 0);
}
)"}};
  Messages messages;
  const Graph graph = graphOf(
      R"({"lacquer_graph": 1, "name": "own", "template": "forward", "attributes": ["_FRAME"],
          "nodes": [{"id": "a", "node": "carried"}], "outputs": {"emission": {"node": "a"}}})",
      messages, options);
  const auto colors =
      evaluate(graph, R"([{"_FRAME": [0, 0, 1, 0, 1, 0, 1, 0, 0]}])", Engine::Double, {}, options, messages);
  ASSERT_TRUE(colors) << errorsOf(messages);
  EXPECT_NEAR(colors->rgba[0][0], 4, 1e-12);
  EXPECT_NEAR(colors->rgba[0][2], 1, 1e-12);
}

TEST(Matrices, HaveColumnsWithNamesOfTheirOwn) {
  for (const std::string name : {"m_2", "m_3"}) {
    Messages messages;
    const std::string second = fmt::format(R"(, "{}": {{"type": "float", "value": 1}})", name);
    const Graph graph = graphOf(matrixGraph(kMat3 + second), messages);
    EXPECT_EQ(graph.check(messages, quick()), name == "m_3");
    EXPECT_EQ(errorsOf(messages), name == "m_3" ? "" : "duplicate-name duplicate-name");
  }
}

}  // namespace
}  // namespace lacquer::test
