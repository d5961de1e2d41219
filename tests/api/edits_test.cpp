// Edits of a graph: what fails says why and leaves the graph as it was.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "inputs.h"

namespace lacquer::test {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

TEST(Edits, thatFailSayWhyAndChangeNothing) {
  Graph graph = paintGraph();
  const std::string before = graph.toJson();
  const std::string taken = "base.direct";
  struct Edit {
    const char* code;
    std::function<bool(Messages&)> make;
  };
  const Edit kEdits[] = {
      {"duplicate-name", [&](Messages& m) { return graph.addNode(taken, "occluded", m); }},
      {"no-such-node", [&](Messages& m) { return graph.removeNode("nobody", m); }},
      {"no-such-node", [&](Messages& m) { return graph.connect("nobody", "light", "1", m); }},
      {"unknown-node", [&](Messages& m) { return graph.addNode("fresh", "occludet", m); }},
      {"wrong-name", [&](Messages& m) { return graph.addNode("a b", "occluded", m); }},
      {"no-such-node", [&](Messages& m) { return graph.renameNode("nobody", "body", m); }},
      {"duplicate-name", [&](Messages& m) { return graph.renameNode("base.alpha", taken, m); }},
      {"unknown-input", [&](Messages& m) { return graph.connect(taken, "lihgt", "1", m); }},
      {"wrong-type", [&](Messages& m) { return graph.connect(taken, "metallic", R"({"given": "uv0"})", m); }},
      {"cycle",
       [&](Messages& m) { return graph.connect(taken, "base_color", R"({"node": "base.direct"})", m); }},
      {"not-connected", [&](Messages& m) { return graph.disconnect(taken, "lihgt", m); }},
      {"not-a-group", [&](Messages& m) { return graph.expand(taken, m); }},
      {"unknown-group", [&](Messages& m) { return graph.addInstance("fresh", "worn", m); }},
      {"unknown-port", [&](Messages& m) { return graph.setOutput("emision", "1", m); }},
      {"not-connected", [&](Messages& m) { return graph.removeOutput("emision", m); }},
      {"no-such-node", [&](Messages& m) { return graph.makeGroup({"nobody"}, "worn", "x", m); }},
      {"unknown-edit", [&](Messages& m) { return !graph.edit(R"({"do": "fly"})", m).empty(); }},
      {"out-of-range", [&](Messages& m) { return graph.setParameter("metallic_factor", {1.5}, m); }},
      {"json-syntax", [&](Messages& m) { return graph.connect(taken, "light", "{", m); }},
      {"json-syntax", [&](Messages& m) { return graph.connect(taken, "light", "", m); }},
      {"unknown-key wrong-source",
       [&](Messages& m) { return graph.connect(taken, "light", R"({"nod": "x"})", m); }},
      {"wrong-type", [&](Messages& m) { return graph.setOutput("emission", "\"view\"", m); }},
      {"wrong-count", [&](Messages& m) { return graph.setParameter("fresh", {}, m); }},
      {"wrong-count",
       [&](Messages& m) {
         return graph.setParameter("fresh", {1, 2, 3, 4, 5}, m);
       }},
      {"wrong-count",
       [&](Messages& m) {
         return graph.setParameter("metallic_factor", {1, 2}, m);
       }},
      {"no-such-parameter",
       [&](Messages& m) {
         return graph.setRange("fresh", {0, 1}, m);
       }},
      {"wrong-range",
       [&](Messages& m) {
         return graph.setRange("metallic_factor", {1, 0}, m);
       }},
      {"wrong-range",
       [&](Messages& m) {
         return graph.setRange("metallic_factor", {0, 1, true}, m);
       }},
      {"not-finite", [&](Messages& m) { return graph.setParameter("metallic_factor", {std::nan("")}, m); }},
      {"not-finite",
       [&](Messages& m) {
         return graph.setParameter("fresh", {0, kInfinite}, m);
       }},
      {"out-of-range", [&](Messages& m) { return graph.setParameter("fresh", {1e39}, m); }},
      {"wrong-range",
       [&](Messages& m) {
         return graph.setRange("metallic_factor", {kInfinite, kInfinite}, m);
       }},
      {"wrong-range",
       [&](Messages& m) {
         return graph.setRange("metallic_factor", {-kInfinite, -kInfinite}, m);
       }},
      {"wrong-range",
       [&](Messages& m) {
         return graph.setRange("metallic_factor", {std::nan(""), 1}, m);
       }},
      {"out-of-range",
       [&](Messages& m) {
         return graph.setRange("metallic_factor", {0, 1e39}, m);
       }},
  };
  for (const Edit& edit : kEdits) {
    Messages messages;
    EXPECT_FALSE(edit.make(messages)) << edit.code;
    EXPECT_EQ(errorsOf(messages), edit.code);
    for (const Message& message : messages) EXPECT_EQ(message.file, "paint.gltf");
    EXPECT_EQ(graph.toJson(), before) << edit.code;
  }
}

TEST(Edits, ofParametersAreListed) {
  Graph graph = paintGraph();
  Messages messages;
  const size_t before = graph.parameters().size();
  EXPECT_TRUE(graph.setParameter("my_ior", {1.5}, messages));
  EXPECT_TRUE(graph.setRange("my_ior", {1, 4, true}, messages));
  EXPECT_TRUE(graph.setParameter("my_color", {1, 0, 0}, messages));
  const std::vector<Parameter> all = graph.parameters();
  ASSERT_EQ(all.size(), before + 2);
  EXPECT_EQ(all[before].name, "my_ior");
  EXPECT_EQ(all[before].type, "float");
  EXPECT_EQ(all[before].value, std::vector<double>{1.5});
  EXPECT_EQ(all[before].range, (Range{1, 4, true}));
  EXPECT_EQ(all[before + 1].type, "vec3");
  EXPECT_EQ(all[before + 1].value, (std::vector<double>{1, 0, 0}));
  EXPECT_EQ(all[before + 1].range, Range{});
}

TEST(Edits, ofABoolAreZeroOrOne) {
  Messages messages;
  Graph graph = Graph::fromJson(
      R"({"lacquer_graph": 1, "template": "forward", "parameters": {"on": {"type": "bool", "value": true}},
          "outputs": {}})",
      "bool.json", messages);
  EXPECT_FALSE(graph.setParameter("on", {0.5}, messages));
  EXPECT_EQ(errorsOf(messages), "wrong-type");
  EXPECT_TRUE(graph.setParameter("on", {0}, messages));
  EXPECT_EQ(graph.parameters()[0].value, std::vector<double>{0});
}

/// An index of refraction is 0 or at least 1, in a parameter's range and in the contract of a node.
TEST(Edits, ofAnIndexOfRefractionHaveItsExactRange) {
  for (const double ior : {0.0, 0.5, 1.0, 1.5, -1.0}) {
    const bool good = ior == 0 || ior >= 1;
    const char* const expected = good ? "" : "out-of-range";
    Messages messages;
    Graph graph = paintGraph();
    EXPECT_TRUE(graph.addNode("my.f0", "f0_from_ior", messages));
    EXPECT_EQ(graph.connect("my.f0", "ior", std::to_string(ior), messages), good) << ior;
    EXPECT_EQ(errorsOf(messages), expected) << ior;
    // The same as a parameter: where it goes, and where it is stated.
    messages.clear();
    EXPECT_TRUE(graph.setParameter("my_ior", {ior}, messages));
    EXPECT_EQ(graph.connect("my.f0", "ior", R"({"parameter": "my_ior"})", messages), good) << ior;
    EXPECT_EQ(errorsOf(messages), expected) << ior;
    messages.clear();
    EXPECT_EQ(graph.setRange("my_ior", {1, 1e9, true}, messages), good) << ior;
    EXPECT_EQ(errorsOf(messages), expected) << ior;
    if (!good) {
      EXPECT_NE(messages[0].message.find("[1, 1000000000] or 0"), std::string::npos) << messages[0].message;
      continue;
    }
    EXPECT_TRUE(graph.check(messages));
    EXPECT_TRUE(messages.empty());
    EXPECT_FALSE(graph.setParameter("my_ior", {0.5}, messages));
    EXPECT_EQ(errorsOf(messages), "out-of-range");
  }
}

/// What may leave the range of what it goes to is good, and said.
TEST(Edits, areDoubtedWhereRangesDoNotFit) {
  Messages messages;
  Graph graph = paintGraph();
  EXPECT_TRUE(graph.addNode("my.f0", "f0_from_ior", messages));
  EXPECT_TRUE(graph.setParameter("my_ior", {1.5}, messages));
  EXPECT_TRUE(graph.connect("my.f0", "ior", R"({"parameter": "my_ior"})", messages));
  EXPECT_TRUE(graph.check(messages));
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0].code, "may-leave-range");
  EXPECT_EQ(messages[0].level, Message::Level::Warning);
  messages.clear();
  EXPECT_TRUE(graph.setRange("my_ior", {1, 3}, messages));
  EXPECT_TRUE(graph.check(messages));
  EXPECT_TRUE(messages.empty());
}

/// What a glTF file's coat may have, its graph may have, and nothing else.
TEST(Edits, ofACoatsIndexOfRefraction) {
  Messages messages;
  const Scene scene = Scene::fromMemory(
      R"({"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_coat"], "materials": [
          {"extensions": {"KHR_materials_coat": {"coatFactor": 1, "coatIor": 1.4}}}]})",
      "coat.gltf", {}, messages);
  Graph graph = scene.graph(0, {}, {}, messages);
  EXPECT_TRUE(graph.setParameter("coat_ior", {0}, messages));
  EXPECT_TRUE(graph.check(messages));
  EXPECT_TRUE(messages.empty());
  EXPECT_FALSE(graph.setParameter("coat_ior", {0.5}, messages));
  EXPECT_EQ(errorsOf(messages), "out-of-range");
}

TEST(Blocks, arePackedWhole) {
  Messages messages;
  const Shader shader = paintGraph().generate(quick(), messages);
  const size_t size = shader.uniformSize();
  ASSERT_GT(size, 0U);
  std::vector<std::byte> small(size - 1, std::byte{7});
  EXPECT_FALSE(shader.pack({}, small));
  for (const std::byte b : small) EXPECT_EQ(b, std::byte{7});
  // Unaligned, with bytes before and behind that stay as they are.
  std::vector<std::byte> large(size + 9, std::byte{7});
  EXPECT_TRUE(shader.pack({}, std::span(large).subspan(1)));
  EXPECT_EQ(large[0], std::byte{7});
  for (size_t i = size + 1; i < large.size(); ++i) EXPECT_EQ(large[i], std::byte{7});
  Strings asked;
  const auto values = [&](std::string_view name, std::span<double> components) {
    asked.emplace_back(name);
    EXPECT_GE(components.size(), 1U);
    EXPECT_LE(components.size(), 4U);
    for (double& x : components) x = 0.25;
    return false;  // today's values stay
  };
  std::vector<std::byte> same(size);
  EXPECT_TRUE(shader.pack(values, same));
  EXPECT_FALSE(asked.empty());
  EXPECT_TRUE(std::equal(same.begin(), same.end(), large.begin() + 1));
}

}  // namespace
}  // namespace lacquer::test
