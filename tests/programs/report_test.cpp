// What is said of the curve.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "programs/curve.h"

namespace lacquer::programs {
namespace {

std::vector<Item> items() { return {{"a", 1, {100, {}}, 0}, {"b", 3, {200, {}}, 0}, {"c", 0, {50, {}}, 0}}; }

Curve curve() {
  Merging merging;
  merging.steps = {{0, 2, 110, 0}, {1, 3, 220, 0}};
  Curve curve;
  curve.materials = 4;
  curve.structures = 3;
  curve.made = 2;
  curve.points =
      pointsOf(items(), merging,
               {{{{0}, {1}, {2}}, {100, 200, 50}}, {{{1}, {0, 2}}, {200, 110}}, {{{0, 1, 2}}, {220}}});
  return curve;
}

TEST(Curve, HasCostsAndTheLargestRise) {
  const std::vector<Point> points = curve().points;
  ASSERT_EQ(points.size(), 3U);
  EXPECT_DOUBLE_EQ(points[0].cost, 0.25 * 100 + 0.75 * 200);
  EXPECT_EQ(points[0].largest_rise, 0);
  EXPECT_EQ(points[0].made, "");
  EXPECT_DOUBLE_EQ(points[1].cost, 0.25 * 110 + 0.75 * 200);
  EXPECT_DOUBLE_EQ(points[1].largest_rise, 110.0 / 50 - 1);
  EXPECT_EQ(points[1].worst, "c");
  EXPECT_EQ(points[1].made, "merged-1");
  EXPECT_EQ(points[1].first + "+" + points[1].second, "a+c");
  EXPECT_DOUBLE_EQ(points[2].cost, 220);
  EXPECT_EQ(points[2].second, "merged-1");
}

TEST(Curve, IsJsonATableAndAPicture) {
  const auto json = nlohmann::json::parse(toJson(curve()));
  EXPECT_EQ(json["structures"], 3);
  EXPECT_EQ(json["curve"].size(), 3U);
  EXPECT_EQ(json["curve"][1]["merge"]["made"], "merged-1");
  EXPECT_EQ(json["costs"]["by"], "model");
  const std::string table = toMarkdown(curve());
  EXPECT_NE(table.find("| 1 | 220.0 | 25.7 % | 340.0 % | c | merged-2 = b + merged-1 |"), std::string::npos)
      << table;
  const std::string svg = toSvg(curve());
  EXPECT_TRUE(svg.starts_with("<svg") && svg.ends_with("</svg>\n"));
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(toSvg({}).find("inf"), std::string::npos) << "without materials";
  EXPECT_EQ(toSvg({}).find("nan"), std::string::npos);
}

TEST(Curve, TheModelIsFittedByItsScale) {
  const ModelError exact = fitModel({{10, 20}, {20, 40}, {30, 60}});
  EXPECT_DOUBLE_EQ(exact.scale, 2);
  EXPECT_NEAR(exact.largest, 0, 1e-12);
  EXPECT_EQ(fitModel({}).compared, 0U);
  EXPECT_EQ(fitModel({{10, 20}}).compared, 0U);
}

/// What is stated is the error over programs that the fit has not seen: those are not pulled near.
TEST(Curve, TheErrorIsOfProgramsThatTheFitHasNotSeen) {
  const ModelError off = fitModel({{10, 10, 1}, {10, 20, 7}, {10, 10, 1}, {10, 20, 3}});
  EXPECT_EQ(off.compared, 4U);
  EXPECT_DOUBLE_EQ(off.scale, 3.0 / 2.5);
  // By the first and the third the others are half of what they should be; by those, these are twice that.
  EXPECT_DOUBLE_EQ(off.largest, 1);
  EXPECT_EQ(off.largest_structures, 1U);
  EXPECT_DOUBLE_EQ(off.mean, 0.75);
  Curve fitted = curve();
  fitted.error = off;
  const auto json = nlohmann::json::parse(toJson(fitted));
  EXPECT_EQ(json["costs"]["model"]["compared"], 4);
  EXPECT_EQ(json["costs"]["model"]["largest_error"], 1);
  EXPECT_EQ(json["costs"]["model"]["largest_error_structures"], 1);
  EXPECT_NE(
      toMarkdown(fitted).find("off the driver's by 75.0 % in the mean over 4 programs that its fit has not "
                              "seen, and by 100.0 % at most"),
      std::string::npos)
      << toMarkdown(fitted);
}

}  // namespace
}  // namespace lacquer::programs
