#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "graph/random_graph.h"
#include "graph/sample.h"

namespace lacquer::test::json_test {
namespace {

using graph::Graph;
using graph::Literal;
using graph::Source;
using ir::Type;

TEST(GraphJson, whatIsWrittenReadsBackTheSame) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 2000; ++round) {
    const Graph graph = randomGraph(random);
    const std::string text = toJson(graph);
    const Result<Graph> read = graph::fromJson(text, "random");
    ASSERT_TRUE(read) << formatAll(read.error()) << text;
    ASSERT_EQ(toJson(*read), text);
    EXPECT_EQ(read->name, graph.name);
    EXPECT_EQ(read->template_name, graph.template_name);
    EXPECT_EQ(read->nodes, graph.nodes) << text;
    EXPECT_EQ(read->outputs, graph.outputs) << text;
    EXPECT_EQ(read->skipped, graph.skipped);
    EXPECT_EQ(read->groups, graph.groups) << text;
    EXPECT_EQ(read->ui, graph.ui);
    ASSERT_EQ(read->parameters.size(), graph.parameters.size());
    for (size_t i = 0; i < graph.parameters.size(); ++i) {
      EXPECT_EQ(read->parameters[i].name, graph.parameters[i].name);
      EXPECT_EQ(read->parameters[i].type, graph.parameters[i].type);
      EXPECT_EQ(read->parameters[i].value, graph.parameters[i].value);
      EXPECT_EQ(read->parameters[i].range, graph.parameters[i].range);
      EXPECT_EQ(read->parameters[i].pointer, graph.parameters[i].pointer);
      EXPECT_EQ(read->parameters[i].animated, graph.parameters[i].animated);
      EXPECT_EQ(read->parameters[i].ui, graph.parameters[i].ui);
    }
    ASSERT_EQ(read->textures.size(), graph.textures.size());
    for (size_t i = 0; i < graph.textures.size(); ++i) {
      EXPECT_EQ(read->textures[i].name, graph.textures[i].name);
      EXPECT_EQ(read->textures[i].type, graph.textures[i].type);
      EXPECT_EQ(read->textures[i].srgb, graph.textures[i].srgb);
      EXPECT_EQ(read->textures[i].texture, graph.textures[i].texture);
      EXPECT_EQ(read->textures[i].pointer, graph.textures[i].pointer);
      EXPECT_EQ(read->textures[i].file, graph.textures[i].file);
      EXPECT_EQ(read->textures[i].own_sampler, graph.textures[i].own_sampler);
      EXPECT_EQ(read->textures[i].wrap, graph.textures[i].wrap);
      EXPECT_EQ(read->textures[i].nearest, graph.textures[i].nearest);
      EXPECT_EQ(read->textures[i].color, graph.textures[i].color);
      EXPECT_EQ(read->textures[i].ui, graph.textures[i].ui);
    }
  }
}

TEST(GraphJson, numbersKeepTheirBits) {
  std::mt19937_64 random(2);
  for (int round = 0; round < 20000; ++round) {
    const double x = randomDouble(random);
    Graph graph;
    graph.outputs.emplace_back("x", number(x));
    const Graph read = graphOf(toJson(graph));
    ASSERT_EQ(read.outputs.size(), 1U);
    const double y = std::get<Literal>(read.outputs[0].second.from).value[0];
    ASSERT_EQ(std::memcmp(&x, &y, sizeof x), 0) << x;
  }
}

TEST(GraphJson, emptyGraph) {
  EXPECT_EQ(toJson(Graph{}),
            "{\n  \"lacquer_graph\": 1,\n  \"name\": \"\",\n  \"template\": \"\",\n  \"parameters\": {},\n"
            "  \"textures\": {},\n  \"nodes\": [],\n  \"outputs\": {},\n  \"skipped\": {}\n}\n");
}

TEST(GraphJson, namesThatAreNotUtf8AreWrittenAllTheSame) {
  Graph graph;
  graph.name = "a\xff";
  EXPECT_EQ(graphOf(toJson(graph)).name, "a\xEF\xBF\xBD");
}

std::string errorsOf(const std::string& text) {
  const Result<Graph> graph = graph::fromJson(text, "g");
  return graph ? "" : formatAll(graph.error());
}

TEST(GraphJson, deepNestingIsAnError) {
  for (const std::string open : {"[", "{\"a\":"}) {
    std::string text = "{\"lacquer_graph\": 1, \"template\": ";
    for (int i = 0; i < 300000; ++i) text += open;
    const Result<Graph> graph = graph::fromJson(text, "deep");
    ASSERT_FALSE(graph);
    ASSERT_EQ(graph.error().size(), 1U);
    EXPECT_EQ(graph.error()[0].code, "json-too-deep");
    EXPECT_EQ(graph.error()[0].help, "a graph needs five levels");
    EXPECT_EQ(graph.error()[0].place.line, 1U);
  }
}

TEST(GraphJson, aFloodOfErrorsIsCut) {
  std::string text = "{\"lacquer_graph\": 1, \"template\": \"t\", \"outputs\": {}, \"nodes\": [0";
  for (int i = 1; i < 1000; ++i) text += ",0";
  const std::string errors = errorsOf(text + "]}");
  EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 2 * 100 + 1) << errors;
  EXPECT_NE(errors.find("g: note: 900 more errors are not shown [more-errors]"), std::string::npos) << errors;
}

TEST(GraphJson, everyBrokenTextIsAnErrorOrAGraph) {
  // No byte that is lost, doubled or changed may do more than that.
  std::mt19937_64 random(3);
  const std::string good = toJson(randomGraph(random));
  for (int round = 0; round < 20000; ++round) {
    std::string text = good;
    for (size_t edits = 1 + random() % 3; edits > 0 && !text.empty(); --edits) {
      const size_t at = random() % text.size();
      switch (random() % 4) {
        case 0: text.erase(at, 1 + random() % 8); break;
        case 1: text.insert(at, text.substr(random() % text.size(), 1 + random() % 20)); break;
        case 2: text[at] = static_cast<char>(random() % 256); break;
        default: text.resize(at); break;
      }
    }
    Result<Graph> graph = graph::fromJson(text, "broken");
    if (graph) {
      graph::check(*graph, sampleLibrary());
      graph::toDot(*graph);
    } else {
      ASSERT_TRUE(hasError(graph.error())) << text;
      for (const Diagnostic& one : graph.error()) {
        for (const unsigned char c : one.message + one.help)
          ASSERT_TRUE(c >= 0x20 && c != 0x7F) << format(one);
      }
    }
  }
}

TEST(GraphJson, sourcesAlone) {
  const auto read = [](std::string_view text) { return graph::sourceFromJson(text).value(); };
  EXPECT_EQ(read(" 0.5 "), number(0.5));
  EXPECT_EQ(read("true"), (Source{Literal{Type::Bool, {1}}, {}}));
  EXPECT_EQ(read("[1, 2]"), (Source{Literal{Type::Vec2, {1, 2}}, {}}));
  EXPECT_EQ(read(R"({"value": [1, 2, 3], "swizzle": "yy"})"), (Source{Literal{Type::Vec3, {1, 2, 3}}, "yy"}));
  EXPECT_EQ(read(R"({"given": "light_sample.L"})"), (Source{graph::GivenRef{"light_sample.L"}, {}}));
  EXPECT_EQ(read(R"({"node": "a", "output": "b", "swizzle": "x"})"), (Source{graph::NodeRef{"a", "b"}, "x"}));
  EXPECT_EQ(read(R"({"parameter": "p"})"), (Source{graph::ParameterRef{"p"}, {}}));
  EXPECT_EQ(read(R"({"texture": "t"})"), (Source{graph::TextureRef{"t"}, {}}));
}

TEST(GraphJson, wrongSourcesAlone) {
  const auto errors = [](std::string_view text) {
    const Result<Source> source = graph::sourceFromJson(text);
    return source ? "" : formatAll(source.error());
  };
  EXPECT_EQ(errors("null"),
            "error: the source is null [wrong-type]\n  help: it must be a number, true, false, the name of a "
            "value, an array of 2 to 4, 9 or 16 numbers or an object such as {\"given\": \"uv0\"}\n");
  EXPECT_EQ(errors(R"({"given": "view", "output": "L"})"),
            "/output: error: a given has no \"output\" [wrong-source]\n"
            "  help: write the result behind a dot: {\"given\": \"light_sample.L\"}\n");
  EXPECT_EQ(errors(R"({"value": {"given": "view"}})"),
            "/value: error: value is an object [wrong-type]\n"
            "  help: it must be a number, true, false or an array of 2 to 4, 9 or 16 numbers\n");
  EXPECT_NE(errors("1e999"), "");
  EXPECT_NE(errors(""), "");
}

}  // namespace
}  // namespace lacquer::test::json_test
