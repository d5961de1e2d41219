// Node files from memory: what a tool that edits them gives, and is told.
#include <gtest/gtest.h>

#include <fstream>

#include "inputs.h"

namespace lacquer::test {
namespace {

constexpr const char* kMoss = R"(/// Moss.
/// source: ACME_moss
extension ACME_moss {
    float mossFactor in [0, 1] = 0;
}

/// It lies over the coat.
/// source: ACME_moss
part moss of ACME_moss over coat unless mossFactor == 0 {
direct:
    moss.direct = moss_direct(below.direct, mossFactor);
    out direct = moss.direct;
}

/// Dims what lies below.
/// source: ACME_moss
node moss_direct(vec3 below in [0, inf], float cover in [0, 1]) -> vec3 in [0, inf] {
    return below * (1 - cover);
}
)";

std::string shaderOf(const Options& options, Messages& messages) {
  const Scene scene = Scene::fromMemory(
      R"({"asset": {"version": "2.0"}, "materials": [{"extensions": {"ACME_moss": {"mossFactor": 0.5}}}]})",
      "moss.gltf", options, messages);
  if (!scene) return {};
  Graph graph = scene.graph(0, {}, options, messages);
  return graph ? graph.generate(options, messages).id() : std::string();
}

std::string changed(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(NodeTexts, AreAsGoodAsFiles) {
  Messages messages;
  Options folder = quick(), memory = quick();
  const auto place = emptyFolder();
  std::filesystem::create_directories(place);
  std::ofstream(place / "moss.node") << kMoss;
  folder.node_directories = {place.string()};
  memory.node_texts = {{"mine/moss.node", kMoss}};
  const std::string id = shaderOf(memory, messages);
  EXPECT_EQ(errorsOf(messages), "");
  EXPECT_NE(id, "");
  EXPECT_EQ(shaderOf(folder, messages), id);
  EXPECT_NE(shaderOf(quick(), messages), id);
  EXPECT_TRUE(checkNodes(memory, messages));
  EXPECT_EQ(messages.size(), 0u) << messages[0].text;
  // A text that has changed counts at once, and so does the one that comes back.
  Options other = memory;
  other.node_texts[0].second = changed(kMoss, "1 - cover", "1 - 0.5 * cover");
  const std::string second = shaderOf(other, messages);
  EXPECT_NE(second, "");
  EXPECT_NE(second, id);
  EXPECT_EQ(shaderOf(memory, messages), id);
  EXPECT_EQ(errorsOf(messages), "");
}

TEST(NodeTexts, AreRefusedWithLineAndCaret) {
  Messages messages;
  Options options = quick();
  options.node_texts = {{"mine/moss.node", changed(kMoss, "below * (1", "bellow * (1")}};
  EXPECT_FALSE(checkNodes(options, messages));
  ASSERT_FALSE(messages.empty());
  EXPECT_EQ(messages[0].file, "mine/moss.node");
  EXPECT_EQ(messages[0].line, 18u);
  EXPECT_EQ(messages[0].column, 12u);
  EXPECT_NE(messages[0].text.find("^"), std::string::npos) << messages[0].text;
  EXPECT_NE(messages[0].text.find("below"), std::string::npos);
  // Nothing is kept of it.
  messages.clear();
  options.node_texts[0].second = kMoss;
  EXPECT_NE(shaderOf(options, messages), "");
  EXPECT_EQ(errorsOf(messages), "");
  // A name that the library has already is declared twice.
  options.node_texts.emplace_back("mine/again.node", kMoss);
  EXPECT_FALSE(checkNodes(options, messages));
  EXPECT_NE(errorsOf(messages), "");
}

/// A graph is edited against the library that it was read with.
TEST(NodeTexts, AreWhatEditsAreCheckedAgainst) {
  Messages messages;
  Options options = quick();
  options.node_texts = {{"mine/moss.node", kMoss}};
  constexpr const char* kEmpty = R"({"lacquer_graph": 1, "template": "forward", "outputs": {}})";
  Graph own = Graph::fromJson(kEmpty, "own.json", messages, options);
  EXPECT_TRUE(own.addNode("moss", "moss_direct", messages));
  EXPECT_EQ(errorsOf(messages), "");
  Graph plain = Graph::fromJson(kEmpty, "plain.json", messages);
  EXPECT_FALSE(plain.addNode("moss", "moss_direct", messages));
  EXPECT_EQ(errorsOf(messages), "unknown-node");
}

}  // namespace
}  // namespace lacquer::test
