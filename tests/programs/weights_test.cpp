#include "programs/weights.h"

#include <gtest/gtest.h>

namespace lacquer::programs {
namespace {

TEST(Weights, WithoutAFileAllCountTheSame) {
  Weights weights;
  EXPECT_EQ(weights.of("a.gltf", "Paint", 0), 1);
  EXPECT_TRUE(weights.unused("weights.json").empty());
}

TEST(Weights, GoByNameIndexAndFile) {
  Result<Weights> weights = Weights::read(R"({"weights": [
    {"material": "Paint", "share": 0.5},
    {"file": "b.gltf", "material": "Paint", "share": 0.25},
    {"file": "cars/c.gltf", "material": 2, "share": 3},
    {"material": "Nobody", "share": 1}]})",
                                          "weights.json", {});
  ASSERT_TRUE(weights) << format(weights.error()[0]);
  EXPECT_EQ(weights->of("a.gltf", "Paint", 0), 0.5);
  EXPECT_EQ(weights->of("assets/b.gltf", "Paint", 1), 0.25);
  EXPECT_EQ(weights->of("xb.gltf", "Paint", 1), 0.5);
  EXPECT_EQ(weights->of("x/cars/c.gltf", "Any", 2), 3);
  EXPECT_EQ(weights->of("x/cars/c.gltf", "Any", 1), 0);
  const Diagnostics unused = weights->unused("weights.json");
  ASSERT_EQ(unused.size(), 1U);
  EXPECT_EQ(unused[0].place.pointer, "/weights/3");
  EXPECT_EQ(unused[0].severity, Severity::Warning);
}

Weights weightsOf(const std::string& rows) {
  Result<Weights> weights = Weights::read(R"({"weights": [)" + rows + "]}", "weights.json", {});
  EXPECT_TRUE(weights) << format(weights.error()[0]);
  return weights.value_or(Weights());
}

TEST(Weights, TheLastThatFitsCounts) {
  Weights weights = weightsOf(R"(
    {"material": "Paint", "share": 1},
    {"file": "a/b.gltf", "material": "Paint", "share": 2},
    {"file": "b.gltf", "material": 7, "share": 3},
    {"material": 7, "share": 4},
    {"file": "b.gltf", "material": "Paint", "share": 5},
    {"file": "/b.gltf", "material": "Paint", "share": 6},
    {"file": "b.gltf", "material": "Paint", "share": 7},
    {"material": "Wood", "share": 8})");
  EXPECT_EQ(weights.of("c.gltf", "Paint", 0), 1);
  EXPECT_EQ(weights.of("c.gltf", "Paint", 7), 4);
  EXPECT_EQ(weights.of("b.gltf", "Glass", 7), 4);
  EXPECT_EQ(weights.of("x/a/b.gltf", "Paint", 0), 7);
  EXPECT_EQ(weights.of("x/a//b.gltf", "Wood", 0), 8);
  EXPECT_EQ(weights.of("", "Wood", 1), 8);
  const Diagnostics unused = weights.unused("weights.json");
  ASSERT_EQ(unused.size(), 1U);  // what another outdoes is used all the same
  EXPECT_EQ(unused[0].place.pointer, "/weights/5");
  EXPECT_EQ(weights.of("a//b.gltf", "Paint", 0), 7);
  EXPECT_TRUE(weights.unused("weights.json").empty());
}

/// To compare each of so many with each would take minutes.
TEST(Weights, AreFoundAmongMany) {
  constexpr size_t kCount = 300'000;
  std::string rows;
  for (size_t i = 0; i < kCount; ++i)
    rows +=
        (i == 0 ? "" : ",") + (R"({"material": "m)" + std::to_string(i % (kCount / 2)) + R"(", "share": 1})");
  Weights weights = weightsOf(rows);
  for (size_t i = 0; i < kCount; ++i)
    ASSERT_EQ(weights.of("a.gltf", "m" + std::to_string(i), i), i < kCount / 2 ? 1 : 0);
  EXPECT_TRUE(weights.unused("weights.json").empty());
}

TEST(Weights, SayOnlySoMuch) {
  std::string wrong, rows = R"({"material": "a", "share": 1})";
  for (size_t i = 0; i < 2 * kMostDiagnostics; ++i) {
    wrong += i == 0 ? "0" : ",0";
    rows += R"(,{"material": "a)" + std::to_string(i) + R"(", "share": 1})";
  }
  const Result<Weights> bad = Weights::read(R"({"weights": [)" + wrong + "]}", "weights.json", {});
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().size(), kMostDiagnostics + 1);
  EXPECT_EQ(weightsOf(rows).unused("weights.json").size(), kMostDiagnostics + 1);
}

TEST(Weights, SayWhatIsWrong) {
  const auto code = [](const char* text) {
    const Result<Weights> weights = Weights::read(text, "weights.json", {});
    return weights ? std::string() : weights.error()[0].code;
  };
  EXPECT_EQ(code("[]"), "missing-property");
  EXPECT_EQ(code(R"({"weights": [7]})"), "wrong-type");
  EXPECT_EQ(code(R"({"weights": [{"material": "a"}]})"), "missing-property");
  EXPECT_EQ(code(R"({"weights": [{"material": "a", "share": -1}]})"), "wrong-type");
  EXPECT_EQ(code(R"({"weights": [{"material": "a", "share": "x"}]})"), "wrong-type");
  EXPECT_EQ(code(R"({"weights": [{"material": "a", "share": 3.4e38}]})"), "");
  EXPECT_EQ(code(R"({"weights": [{"material": "a", "share": 1e308}, {"material": "b", "share": 1e308}]})"),
            "wrong-type");
  EXPECT_EQ(code(R"({"weights": [{"material": 18446744073709551615, "share": 1}]})"), "wrong-type");
  EXPECT_EQ(code(R"({"weights": [{"material": 0.5, "share": 1}]})"), "wrong-type");
  EXPECT_EQ(code(R"({"weights": [{"material": "a", "share": 1, "wieght": 1}]})"), "unknown-property");
  EXPECT_EQ(code(R"({"weights": [{"material": "a", "share": 0}]})"), "out-of-range");
  EXPECT_EQ(code("{"), "json-syntax");
}

}  // namespace
}  // namespace lacquer::programs
