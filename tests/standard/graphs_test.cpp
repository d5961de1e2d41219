// The standard nodes in graphs: every form of every file in one graph makes a shader that each target's
// compiler takes, and a node's plain name finds the form that what is connected means.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "lacquer.h"
#include "lang/library.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

using Json = nlohmann::ordered_json;

const lang::Library& embedded() {
  static const lang::Library kLibrary = lang::Library::embedded();
  return kLibrary;
}

/// A graph whose emission is the sum of what nodes give.
class Sum {
public:
  Sum() {
    graph_ = {{"lacquer_graph", 1}, {"name", "sum"}, {"template", "forward"}};
    for (const char* type : {"float", "vec2", "vec3", "vec4"}) {
      Json value = 0.5;
      if (type[0] == 'v') value = Json(std::vector<double>(static_cast<size_t>(type[3] - '0'), 0.5));
      graph_["parameters"][type] = {{"type", type}, {"value", value}};
    }
    graph_["parameters"]["bool"] = {{"type", "bool"}, {"value", true}};
    add("whole", "floor<float, int>", {{"in", {{"parameter", "float"}}}});
    const Json row = {{"parameter", "vec3"}};
    add("small", "creatematrix<mat3>", {{"in1", row}, {"in2", {1, 2, 3}}, {"in3", row}});
    add("large", "creatematrix<vec3, mat4>", {{"in1", row}, {"in2", {1, 2, 3}}, {"in3", row}});
    add("sum", "constant<float>", Json::object());
  }

  /// With what can be edited at each input, or, where that is asked for, with defaults alone. False for a
  /// node that takes textures, or has not all defaults that are asked for.
  bool take(const lang::NodeDecl& node, bool defaults) {
    Json inputs = Json::object();
    for (const lang::Param& param : node.params) {
      if (ir::isTexture(param.type) || param.type == ir::Type::UInt) return false;
      if (defaults && !param.hasDefault()) return false;
      if (!defaults) inputs[std::string(param.name)] = sourceOf(param);
    }
    // No graph has an unsigned integer to give, or takes one on.
    for (const lang::Param& result : node.results) {
      if (ir::partType(result.type) == ir::Type::UInt) return false;
    }
    const std::string id = "n" + std::to_string(count_++);
    add(id, std::string(node.name), inputs);
    for (const lang::Param& result : node.results) {
      Json from = {{"node", id}};
      if (!result.name.empty()) from["output"] = result.name;
      put(numberOf(from, result.type, id + "_" + std::string(result.name)));
    }
    return true;
  }

  std::string text() {
    graph_["outputs"]["emission"] = {{"node", sum_}};
    return graph_.dump();
  }

private:
  static Json sourceOf(const lang::Param& param) {
    switch (param.type) {
      case ir::Type::Int:
        if (param.choices.empty()) return {{"node", "whole"}};
        return Json(std::string(param.choices.back()));
      case ir::Type::Mat3: return {{"node", "small"}};
      case ir::Type::Mat4: return {{"node", "large"}};
      default: return {{"parameter", std::string(ir::typeName(param.type))}};
    }
  }

  Json numberOf(Json from, ir::Type type, const std::string& id) {
    const std::string name(ir::typeName(type));
    if (type == ir::Type::Float) return from;
    if (type == ir::Type::Int || type == ir::Type::Bool)
      add(id, "convert<float, " + name + ">", {{"in", from}});
    else if (ir::isMatrix(type))
      add(id, "extract<" + name + ">", {{"in", from}, {"index", 1}});
    if (!ir::isFloatVector(type)) from = {{"node", id}};
    if (type != ir::Type::Int && type != ir::Type::Bool) from["swizzle"] = "y";
    return from;
  }

  void put(const Json& number) {
    const std::string next = "sum" + std::to_string(count_++);
    add(next, "add<float>", {{"in1", {{"node", sum_}}}, {"in2", number}});
    sum_ = next;
  }

  void add(const std::string& id, const std::string& node, const Json& inputs) {
    graph_["nodes"].push_back({{"id", id}, {"node", node}, {"inputs", inputs}});
  }

  Json graph_;
  std::string sum_ = "sum";
  size_t count_ = 0;
};

std::string textOf(const Messages& messages) {
  std::string text;
  for (const Message& message : messages) {
    if (message.level == Message::Level::Error) text += message.text + "\n";
  }
  return text;
}

std::set<std::string> standardFiles() {
  std::set<std::string> files;
  for (const std::string_view name : embedded().names(lang::DeclKind::Node)) {
    const std::string file((*embedded().node(name))->origin.file);
    if (file.starts_with("nodes/standard/")) files.insert(file);
  }
  return files;
}

class StandardGraphs : public testing::TestWithParam<std::string> {};

void expectShaders(const std::string& file, bool defaults) {
  Sum sum;
  size_t taken = 0;
  for (const std::string_view name : embedded().names(lang::DeclKind::Node)) {
    const lang::NodeDecl& node = **embedded().node(name);
    if (node.origin.file == file) taken += sum.take(node, defaults) ? 1 : 0;
  }
  Messages messages;
  Graph graph = Graph::fromJson(sum.text(), "sum.json", messages);
  ASSERT_TRUE(graph) << textOf(messages);
  Options options;
  options.targets = {Target::Glsl, Target::GlslGl, Target::Essl, Target::Hlsl, Target::Spirv, Target::Wgsl};
  const Shader shader = graph.generate(options, messages);
  EXPECT_TRUE(shader) << taken << " forms\n" << textOf(messages);
  EXPECT_EQ(textOf(messages), "");
}

TEST_P(StandardGraphs, EveryFormIsGoodInEveryTarget) { expectShaders(GetParam(), false); }

/// What the template gives stands in where nothing is connected.
TEST_P(StandardGraphs, EveryFormIsGoodByItsDefaults) { expectShaders(GetParam(), true); }

INSTANTIATE_TEST_SUITE_P(Files, StandardGraphs, testing::ValuesIn(standardFiles()), [](const auto& info) {
  const size_t from = info.param.rfind('/') + 1;
  return info.param.substr(from, info.param.rfind('.') - from);
});

/// What a graph of one node of that plain name with these inputs says.
std::string said(const std::string& node, const std::string& inputs, const std::string& swizzle = {}) {
  const std::string cut = swizzle.empty() ? "" : R"(, "swizzle": ")" + swizzle + "\"";
  const std::string text =
      R"({"lacquer_graph": 1, "template": "forward", "parameters": {"f": {"type": "float", "value": 1}, )"
      R"("v": {"type": "vec3", "value": [1, 2, 3]}, "w": {"type": "vec2", "value": [1, 2]}}, "nodes": [{"id": "a", "node": ")" +
      node + R"(", "inputs": {)" + inputs + R"(}}], "outputs": {"emission": {"node": "a")" + cut + "}}}";
  Messages messages;
  Graph graph = Graph::fromJson(text, "g.json", messages);
  if (graph) graph.check(messages);
  return textOf(messages);
}

TEST(StandardNames, FindTheFormThatIsMeant) {
  EXPECT_EQ(said("add", R"("in1": {"parameter": "v"}, "in2": {"parameter": "v"})"), "");
  EXPECT_EQ(said("add", R"("in1": {"parameter": "v"}, "in2": {"parameter": "f"})"), "");
  EXPECT_EQ(said("add", R"("in1": {"parameter": "v"})"), "");
  EXPECT_EQ(said("mix", R"("fg": {"parameter": "v"}, "bg": [0, 1, 0], "mix": 0.5)"), "");
  EXPECT_EQ(said("floor", R"("in": {"parameter": "f"})"), "");
  EXPECT_EQ(said("ifgreater", R"("value1": {"parameter": "f"}, "in1": {"parameter": "v"})"), "");
  EXPECT_EQ(said("combine3", R"("in1": {"parameter": "f"})"), "");
  EXPECT_EQ(said("in", "", "rgb"), "");
  EXPECT_EQ(said("place2d", R"("texcoord": {"given": "uv0"}, "operationorder": "TRS")", "xyx"), "");
}

TEST(StandardNames, WhatMayBeSeveralFormsMustBeNamed) {
  const std::string several = said("convert", R"("in": {"parameter": "f"})");
  EXPECT_NE(several.find("name one: convert<vec2, float>"), std::string::npos) << several;
  EXPECT_EQ(said("convert<vec3, float>", R"("in": {"parameter": "f"})"), "");
  const std::string none = said("crossproduct", R"("in1": {"parameter": "w"})");
  EXPECT_NE(none.find("wrong-type"), std::string::npos) << none;
}

}  // namespace
}  // namespace lacquer::test
