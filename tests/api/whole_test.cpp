// Integers and truths as parameters: the same numbers in every way of handing them over, in every target.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "answer/answer.h"
#include "inputs.h"

namespace lacquer::test {
namespace {

struct Kind {
  std::string type, value, number;  ///< of the parameter; what the node makes of it
  double expected = 0;
};

/// Numbers that no float holds among them.
const std::array kKinds = {
    Kind{"int", "16777217", "float(x - 16777200)", 17},
    Kind{"int", "-2147483648", "float(x + 2147483647)", -1},
    Kind{"uint", "4000000001", "float(x - 4000000000u)", 1},
    Kind{"bool", "true", "x ? 3.0 : 4.0", 3},
    Kind{"ivec2", "[16777217, 5]", "float(x.x - 16777200 + x.y)", 22},
    Kind{"ivec4", "[1, -2, 3, 16777219]", "float(x.y + x.w - 16777200)", 17},
    Kind{"uvec3", "[1, 4000000001, 3]", "float(x.y - 4000000000u + x.z)", 4},
    Kind{"bvec2", "[false, true]", "x.y && !x.x ? 1.0 : 2.0", 1},
    Kind{"bvec4", "[true, false, true, false]", "x.z && !x.w ? 5.0 : 2.0", 5},
};

Options optionsOf(const Kind& kind, Parameters parameters) {
  Options options;
  options.targets = {Target::Spirv};
  options.parameters = parameters;
  options.node_texts = {{"kind.node", fmt::format(R"(
/// A number of a parameter.
/// source: the tests
node number_of({} x) -> float {{
    return {};
}}
)",
                                                  kind.type, kind.number)}};
  return options;
}

std::string graphOf(const Kind& kind) {
  return fmt::format(R"({{"lacquer_graph": 1, "name": "whole", "template": "forward",
    "parameters": {{"p": {{"type": "{}", "value": {}}}}},
    "nodes": [{{"id": "n", "node": "number_of", "inputs": {{"x": {{"parameter": "p"}}}}}}],
    "outputs": {{"emission": {{"node": "n", "swizzle": "xxx"}}}}}})",
                     kind.type, kind.value);
}

TEST(Whole, ReachEveryTargetInEveryWay) {
  for (const Kind& kind : kKinds) {
    for (const Parameters parameters : {Parameters::Uniform, Parameters::Baked, Parameters::Spec}) {
      Options options = optionsOf(kind, parameters);
      options.targets.clear();
      for (const std::string& name : targetNames()) {
        Target target{};
        EXPECT_TRUE(findTarget(name, target));
        const bool has_constants = target == Target::Glsl || target == Target::Spirv ||
                                   target == Target::Wgsl || target == Target::Msl;
        if (parameters != Parameters::Spec || has_constants) options.targets.push_back(target);
      }
      Messages messages;
      Graph graph = Graph::fromJson(graphOf(kind), "whole.json", messages, options);
      const Shader shader = graph.generate(options, messages);
      EXPECT_TRUE(shader) << kind.type << static_cast<int>(parameters);
      EXPECT_EQ(errorsOf(messages), "") << kind.type << static_cast<int>(parameters);
      if (parameters != Parameters::Spec || !shader) continue;
      const std::string part = kind.type == "bool" || kind.type[0] == 'b' ? "bool"
                               : kind.type[0] == 'u'                      ? "uint"
                                                                          : "int";
      ASSERT_FALSE(shader.reflection().spec_constants.empty()) << kind.type;
      for (const SpecConstant& constant : shader.reflection().spec_constants) EXPECT_EQ(constant.type, part);
    }
  }
}

TEST(Whole, AreTheSameInEveryEngine) {
  for (const Kind& kind : kKinds) {
    for (const Parameters parameters : {Parameters::Uniform, Parameters::Spec}) {
      for (const Engine engine : {Engine::Double, Engine::Float, Engine::Vulkan, Engine::VulkanGlsl}) {
        const Options options = optionsOf(kind, parameters);
        Messages messages;
        const Graph graph = Graph::fromJson(graphOf(kind), "whole.json", messages, options);
        const auto colors = evaluate(graph, "[{}]", engine, {}, options, messages);
        if (!colors && errorsOf(messages) == "vulkan-unavailable") continue;
        ASSERT_TRUE(colors) << kind.type << errorsOf(messages);
        EXPECT_EQ(colors->rgba[0][0], kind.expected) << kind.type << " " << static_cast<int>(engine);
      }
    }
  }
}

/// What a node gives is looked at as it is, not as a float.
TEST(Whole, OfANodeAreExact) {
  const std::array kLooked = {Kind{"int", "16777217", "ivec4(x, -x, x - 33554433, 5)", 0},
                              Kind{"uint", "4294967295", "uvec2(x, x - 16777216u)", 0}};
  const std::array<std::array<double, 4>, 2> expected = {
      std::array<double, 4>{16777217, -16777217, -16777216, 5},
      std::array<double, 4>{4294967295, 4278190079, 0, 0}};
  for (size_t i = 0; i < kLooked.size(); ++i) {
    const Kind& kind = kLooked[i];
    Options options = optionsOf(kind, Parameters::Uniform);
    std::string& text = options.node_texts[0].second;
    const std::string type = i == 0 ? "ivec4" : "uvec2";
    text.replace(text.find("float {"), 5, type);
    for (const Engine engine : {Engine::Double, Engine::Float, Engine::Vulkan, Engine::VulkanGlsl}) {
      Messages messages;
      std::string graph = graphOf(kind);
      graph.replace(graph.find(R"("outputs")"), std::string::npos, R"("outputs": {"alpha": 1}})");
      const Graph read = Graph::fromJson(graph, "whole.json", messages, options);
      Trial trial;
      trial.node = "n";
      const auto colors = evaluate(read, "[{}]", engine, {}, options, messages, trial);
      if (!colors && errorsOf(messages) == "vulkan-unavailable") continue;
      ASSERT_TRUE(colors) << kind.type << errorsOf(messages);
      EXPECT_EQ(colors->rgba[0], expected[i]) << kind.type << " " << static_cast<int>(engine);
      EXPECT_NE(answerJson(*colors).find(i == 0 ? "[16777217, -16777217, " : "[4294967295, "),
                std::string::npos)
          << answerJson(*colors);
    }
  }
}

/// An attribute of the vertices, too, of which a triangle has one vertex's.
TEST(Whole, OfVerticesAreExact) {
  const Kind kind{"uint", "0", "float(x - 4294967200u)", 0};
  const Options options = optionsOf(kind, Parameters::Uniform);
  for (const Engine engine : {Engine::Double, Engine::Float, Engine::Vulkan}) {
    Messages messages;
    const Graph graph = Graph::fromJson(R"({"lacquer_graph": 1, "name": "whole", "template": "forward",
      "nodes": [{"id": "n", "node": "number_of", "inputs": {"x": {"attribute": "_U", "type": "uint"}}}],
      "outputs": {"emission": {"node": "n", "swizzle": "xxx"}}})",
                                        "whole.json", messages, options);
    const auto colors = evaluate(graph, R"([{"_U": 4294967295}])", engine, {}, options, messages);
    if (!colors && errorsOf(messages) == "vulkan-unavailable") continue;
    ASSERT_TRUE(colors) << errorsOf(messages);
    EXPECT_EQ(colors->rgba[0][0], 95) << static_cast<int>(engine);
  }
}

}  // namespace
}  // namespace lacquer::test
