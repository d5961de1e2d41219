// Verbs that take a graph in a material's place.
#include <gtest/gtest.h>

#include "command.h"

namespace lacquer::test {
namespace {

using Json = nlohmann::json;

constexpr const char* kPoints = R"([{"v": [0, 0.6, 0.8], "l": [0.6, 0, 0.8], "env": [1, 0.5, 0.25]}])";

/// A place with `paint.json`, the graph of a material without textures, and points.
class GraphFiles : public testing::Test {
protected:
  void SetUp() override {
    const auto made = place_.run({"graph", example("coat.gltf"), "--material", "Darkening"});
    ASSERT_EQ(made.status, 0) << made.err;
    place_.write("paint.json", made.out);
    place_.write("points.json", kPoints);
  }

  Workplace place_;
};

TEST_F(GraphFiles, areEvaluated) {
  const auto answer = place_.run({"eval", "paint.json", "--points", "points.json"});
  EXPECT_EQ(answer.status, 0) << answer.err;
  const Json json = Json::parse(answer.out);
  EXPECT_EQ(json["material"], "Darkening");
  EXPECT_EQ(json["rgba"].size(), 1u);
  EXPECT_FALSE(json.contains("profile"));
  const auto built = place_.run({"eval", "paint.json", "--points", "points.json", "--profile", "physical"});
  EXPECT_EQ(built.status, 1);
  EXPECT_NE(built.err.find("[graph-is-built]"), std::string::npos) << built.err;
}

TEST_F(GraphFiles, areDrawnBesideMaterials) {
  const auto drawn = place_.run(
      {"preview", example("film.gltf"), "paint.json", "-o", "balls.png", "--size", "16", "--json"});
  EXPECT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_EQ(Json::parse(drawn.out)["materials"], 3);
  EXPECT_TRUE(std::filesystem::exists(place_ / "balls.png"));
  const auto none = place_.run({"preview", "paint.json", "-o", "no.png", "--material", "Other"});
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.err.find("[no-such-material]"), std::string::npos) << none.err;
  const auto over = place_.run({"preview", "paint.json", "-o", "paint.json"});
  EXPECT_EQ(over.status, 1);
  EXPECT_EQ(place_.run({"graph", "paint.json"}).status, 0) << "the graph is still there";
}

TEST_F(GraphFiles, areProvedAndDumpedAndReadBack) {
  EXPECT_EQ(place_.run({"prove", "paint.json"}).status, 0);
  const auto dump = place_.run({"dump", "paint.json"});
  EXPECT_EQ(dump.status, 0);
  EXPECT_NE(dump.out.find("coat.darkening"), std::string::npos);
  const auto again = place_.run({"graph", "paint.json"});
  EXPECT_EQ(again.status, 0);
  place_.write("again.json", again.out);
  EXPECT_EQ(place_.run({"graph", "again.json"}).out, again.out);
}

TEST_F(GraphFiles, saySomethingWhereTheyAreWrong) {
  place_.write("cut.json", R"({"lacquer_graph": 1,)");
  place_.write("none.json",
               R"({"lacquer_graph": 1, "template": "forward", "nodes": [], "outputs": {"colour": 1}})");
  for (const char* file : {"cut.json", "none.json", "absent.json"}) {
    EXPECT_EQ(place_.run({"eval", file, "--points", "points.json"}).status, 1) << file;
    EXPECT_EQ(place_.run({"preview", file, "-o", "no.png"}).status, 1) << file;
    EXPECT_EQ(place_.run({"prove", file}).status, 1) << file;
    const auto dump = place_.run({"dump", file});
    EXPECT_EQ(dump.status, 1) << file;
    EXPECT_NE(dump.err.find(file), std::string::npos) << dump.err;
  }
}

}  // namespace
}  // namespace lacquer::test
