// The preshader as the manifest has it: values in order, each over parameters and the values before it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "check/check.h"
#include "lacquer.h"
#include "support/answers.h"

namespace lacquer::test::expressions_test {
namespace {

using Json = nlohmann::json;

/// Each node's result goes into the next one, which uses it more than once: written out, the last one's text
/// would have many times more characters than there are atoms.
Graph chain(size_t length) {
  Json json = {{"lacquer_graph", 1}, {"name", "chain"}, {"template", "bsdf"}};
  json["parameters"]["p"] = {{"type", "float"}, {"value", 0.5}, {"range", {0, 1}}};
  json["nodes"] = Json::array();
  Json from = {{"parameter", "p"}};
  for (size_t i = 0; i < length; ++i) {
    const std::string id = fmt::format("n{}", i);
    const Json f0 = i == 0 ? from : Json(0.04);
    json["nodes"].push_back({{"id", id}, {"node", "schlick"}, {"inputs", {{"F0", f0}, {"cosine", from}}}});
    from = {{"node", id}};
  }
  json["outputs"]["alpha"] = from;
  Messages messages;
  Graph graph = Graph::fromJson(json.dump(), "chain.json", messages);
  EXPECT_TRUE(graph) << messages[0].text;
  return graph;
}

struct Lengths {
  size_t interface, header, module, proofs;
};

Lengths lengthsOf(size_t length) {
  Options options;
  options.targets = {Target::Cpp, Target::Js};
  Messages messages;
  Graph graph = chain(length);
  const Shader shader = graph.generate(options, messages);
  EXPECT_TRUE(shader);
  return {shader.interfaceJson().size(), shader.headerText().size(), shader.moduleText().size(),
          jsonOf(graph.prove(options, messages)).size()};
}

TEST(Expressions, GrowWithTheNumberOfOperations) {
  const Lengths some = lengthsOf(100);
  const Lengths twice = lengthsOf(200);
  EXPECT_LT(twice.interface, some.interface * 21 / 10);
  EXPECT_LT(twice.header, some.header * 21 / 10);
  EXPECT_LT(twice.module, some.module * 21 / 10);
  EXPECT_LT(twice.proofs, some.proofs * 21 / 10);
  EXPECT_LT(twice.interface, 200 * 500U);
}

/// A shader that computes the fields from the parameters.
std::string shaderOf(const Json& parameters, const Json& block) {
  std::string text =
      "#version 450\nlayout(location = 0) out vec4 test_sum;\nvoid main() {\n  test_sum = vec4(0.0);\n";
  const auto add = [&](const std::string& type, const std::string& name, const std::string& value) {
    text += fmt::format("  {} {} = {};\n", type, name, value);
  };
  for (const auto& [name, parameter] : parameters.items()) {
    const Json& value = parameter["value"];
    const bool vector = value.is_array();
    const std::string type = value.is_boolean() ? "bool"
                             : vector           ? fmt::format("vec{}", value.size())
                                                : "float";
    add(type, name, type + "(0.5)");
  }
  if (block.contains("values")) {
    for (const Json& value : block["values"]) add(value["type"], value["name"], value["expression"]);
  }
  for (const Json& field : block["fields"]) {
    const std::string type = field["type"];
    const std::string vector = type == "vec4"   ? ""
                               : type == "vec3" ? ", 0.0"
                               : type == "vec2" ? ", 0.0, 0.0"
                                                : "";
    text += fmt::format("  test_sum += vec4({}{});\n", field["expression"].get<std::string>(), vector);
  }
  return text + "}\n";
}

TEST(Expressions, OfTheExamplesAreGlsl) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "lacquer_expressions";
  std::filesystem::remove_all(folder);
  Strings files;
  for (const auto& entry : std::filesystem::directory_iterator(LACQUER_EXAMPLES)) {
    if (entry.path().extension() == ".gltf") files.push_back(entry.path().string());
  }
  Options options;
  options.targets = {Target::Glsl};
  options.validate = false;
  Messages messages;
  ASSERT_TRUE(generate(files, {}, folder.string(), options, messages).ok);
  std::ifstream file(folder / "manifest.json");
  const Json manifest = Json::parse(file);
  std::set<std::string> seen;
  size_t values = 0;
  for (const Json& source : manifest["files"]) {
    for (const Json& material : source["materials"]) {
      for (const Json& use : material["uses"]) {
        const std::string id = use["shader"];
        if (!seen.insert(id).second) continue;
        for (const Json& block : manifest["shaders"][id]["uniforms"]) {
          if (block["role"] != "material") continue;
          values += block.contains("values") ? block["values"].size() : 0;
          const std::string text = shaderOf(use["parameters"], block);
          const auto made = check::compile(text, Target::Glsl, check::Stage::Fragment, "expressions");
          EXPECT_TRUE(made) << format(made.error().front()) << text;
        }
      }
    }
  }
  EXPECT_GT(values, 50U);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace lacquer::test::expressions_test
