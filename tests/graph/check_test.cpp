// What the JSON form cannot say, but the editing API can; and floods of errors.
#include <gtest/gtest.h>

#include <chrono>
#include <limits>

#include "graph/sample.h"

namespace lacquer::test::check_test {
namespace {

using graph::Graph;
using graph::Literal;
using ir::Type;

Graph litGraph() {
  Graph graph;
  graph.template_name = "lit";
  graph.outputs = {{"alpha", number(1)}};
  return graph;
}

std::string checked(Graph graph) { return formatAll(graph::check(graph, sampleLibrary())); }

TEST(GraphCheck, inputsAndPortsAreConnectedOnce) {
  Graph graph = litGraph();
  graph.add("a", "f0", {{"ior", number(2)}, {"ior", number(9)}});
  graph.outputs.emplace_back("alpha", number(1));
  EXPECT_EQ(checked(graph),
            "/nodes/0/inputs/ior: error: 'ior' of the node 'a' is connected twice [duplicate-name]\n"
            "  help: remove one of the two\n"
            "/outputs/alpha: error: the port 'alpha' is connected twice [duplicate-name]\n"
            "  help: remove one of the two\n");
}

TEST(GraphCheck, literalsAreFiniteFloatsVectorsAndBools) {
  Graph graph = litGraph();
  graph.add("a", "f0", {{"ior", {Literal{Type::Int, {2}}, {}}}});
  graph.add("b", "f0", {{"ior", number(std::numeric_limits<double>::quiet_NaN())}});
  graph.add("c", "f0", {{"ior", {Literal{Type::Mat4, {}}, "x"}}});
  graph.outputs[0].second = number(std::numeric_limits<double>::infinity());
  EXPECT_EQ(checked(graph),
            "/nodes/0/inputs/ior: error: the value written for 'ior' of the node 'a' is an int [wrong-type]\n"
            "  help: floats, vectors, bools and matrices can be written into a graph\n"
            "/nodes/1/inputs/ior: error: the value written for 'ior' of the node 'b' is nan [not-finite]\n"
            "/nodes/2/inputs/ior: error: the matrix written for 'ior' of the node 'c' has no numbers "
            "[wrong-count]\n"
            "  help: a mat4 has 16, column by column\n"
            "/outputs/alpha: error: the value written for the port 'alpha' is inf [not-finite]\n");
}

TEST(GraphCheck, parametersAndTexturesHaveTypesOfAGraph) {
  Graph graph = litGraph();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto parameter = [&](const char* name, Type type, double value) -> graph::Parameter& {
    graph::Parameter& made = graph.parameters.emplace_back();
    made.name = name;
    made.type = type;
    made.value = {value};
    return made;
  };
  parameter("m", Type::Texture2D, 0);
  parameter("m", Type::Float, nan);
  parameter("r", Type::Float, 1).range = {{nan, 1}, 0};
  graph.textures.resize(3);
  graph.textures[0].name = "t";
  graph.textures[1].name = "t";
  graph.textures[1].type = Type::Vec2;
  graph.textures[1].texture = -7;
  graph.textures[2].name = "u";
  graph.textures[2].environment = true;
  graph.add("a", "f0", {{"ior", {graph::ParameterRef{"m"}, {}}}});
  EXPECT_EQ(checked(graph),
            "/parameters/m/type: error: a parameter cannot be a sampler2D [wrong-type]\n"
            "  help: it is a float, an int, a uint, a bool, a vector of them, a mat3 or a mat4\n"
            "/parameters/m: error: there are two parameters 'm' [duplicate-name]\n"
            "/parameters/m/value: error: the value of 'm' is nan [not-finite]\n"
            "/parameters/r/range: error: [nan, 1] is no range [wrong-range]\n"
            "  help: write the lowest value, then the highest\n"
            "/textures/t: error: there are two textures 't' [duplicate-name]\n"
            "/textures/t/type: error: a texture cannot be a vec2 [wrong-type]\n"
            "  help: it is a sampler2D, a samplerCube or a sampler2DArray\n"
            "/textures/t/texture: error: there is no texture -7 [out-of-range]\n"
            "  help: it is the index of a glTF texture, or -1 for none\n"
            "/textures/u: error: 'u' is marked as a texture of the environment [wrong-texture]\n"
            "  help: those are the template's: a source names them without an entry here\n");
}

TEST(GraphCheck, theLibrarysErrorsStandWhereTheyAre) {
  Graph graph = litGraph();
  graph.add("a", "broken", {{"x", number(2)}});
  graph.add("b", "broken", {{"y", number(2)}});
  Diagnostics found = graph::check(graph, sampleLibrary());
  ASSERT_EQ(found.size(), 1U) << formatAll(found);
  EXPECT_EQ(found[0].place.file, "library.node");
  EXPECT_GT(found[0].place.line, 0U);
}

TEST(GraphCheck, aFloodOfErrorsIsCutAndCheap) {
  Graph graph = litGraph();
  for (int i = 0; i < 20000; ++i) {
    graph.add("node_with_a_long_name_" + std::to_string(i), "wieghted",
              {{"color", ref("node_with_a_lnog_name_" + std::to_string(i))}});
  }
  const auto begin = std::chrono::steady_clock::now();
  const Diagnostics found = graph::check(graph, sampleLibrary());
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
  ASSERT_EQ(found.size(), 101U);
  EXPECT_EQ(found[0].code, "unknown-node");
  EXPECT_EQ(found[0].help, "did you mean 'weighted'?");
  EXPECT_EQ(found[1].code, "unknown-source");
  EXPECT_EQ(format(found[100]), "note: 39900 more errors are not shown [more-errors]");
}

}  // namespace
}  // namespace lacquer::test::check_test
