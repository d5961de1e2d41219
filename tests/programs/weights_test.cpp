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
