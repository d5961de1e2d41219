// The library's contracts: every node is proved for the whole of its declared ranges, and what is not so is
// not proved. (tests/stress attacks the facts that nodes assume.)
#include <gtest/gtest.h>

#include "lang/library.h"
#include "prove/nodes.h"

namespace lacquer::test::nodes_test {
namespace {

const lang::Library& library() {
  static const lang::Library kLibrary = lang::Library::embedded();
  return kLibrary;
}

size_t unproved(const NodeProof& proof, const std::vector<Claim>& claims, std::string_view kind, bool tell) {
  size_t count = 0;
  for (const Claim& claim : claims) {
    if (claim.proved) continue;
    ++count;
    if (!tell) continue;
    ADD_FAILURE() << proof.node << (proof.variant.empty() ? "" : "." + proof.variant) << ", " << kind << " "
                  << claim.what << ": must be " << claim.need << ", may be in [" << claim.reached.low << ", "
                  << claim.reached.high << "]" << (claim.reached.nan ? " or no number" : "");
  }
  return count;
}

size_t unproved(const NodeProof& proof, bool tell) {
  return unproved(proof, proof.operations, "operation", tell) +
         unproved(proof, proof.results, "result", tell) + unproved(proof, proof.calls, "argument", tell);
}

TEST(IntervalNodes, EveryNodeIsProved) {
  ASSERT_TRUE(library().checkAll().empty());
  size_t claims = 0;
  for (const NodeProof& proof : proveNodes(library())) {
    claims += proof.operations.size() + proof.results.size() + proof.calls.size();
    unproved(proof, true);
  }
  EXPECT_GT(claims, 100U);
}

TEST(IntervalNodes, WhatIsNotSoIsNotProved) {
  const char* const kBodies[] = {
      "node a(float x in [-1, 1]) -> float { return sqrt(x); }",
      "node a(float x in [0, 1]) -> float { return 1 / x; }",
      "node a(float x in [0, 1]) -> float { return inversesqrt(x); }",
      "node a(float x in [0, 1]) -> float { return log2(x); }",
      "node a(float x in [0, 1], float y in [0, 1]) -> float { return pow(x, y); }",
      "node a(vec3 x in [-1, 1]) -> vec3 { return normalize(x); }",
      "node a(float x in [-2, 1]) -> float { return acos(x); }",
      "node a(float x in [0, 1]) -> float in [0, 1] { return 2 * x; }",
      "node a(float x in [0, 1]) -> float in [0, 1] { return x * x - 0.001 * x; }",
      "node b(float x in [0, 1]) -> float in [0, 1] { return x; }\n/// D.\n/// source: S\n"
      "node a(float x in [0, 2]) -> float in [0, 2] { return b(x); }",
      "node a(float x in [0, 1], float y in [0, 1]) -> float { return sqrt(x - y); }",
      "node a(float x in [0, 1]) -> float { return uniform(x) ? sqrt(x) : sqrt(x - 0.5); }",
      "node a(float x in [0, 1]) -> float { return uniform(x) ? sqrt(x - 0.5) : sqrt(x); }",
  };
  for (const char* body : kBodies) {
    const auto made = lang::Library::fromFiles({{"t.node", std::string("/// D.\n/// source: S\n") + body}});
    ASSERT_TRUE(made) << body;
    ASSERT_TRUE(made->checkAll().empty()) << body << format(made->checkAll()[0]);
    EXPECT_GT(unproved(proveNode(**made->node("a"), {}), false), 0U) << body;
  }
}

TEST(IntervalNodes, WhatTakesMoreThanOneEvaluationIsProved) {
  const char* const kBodies[] = {
      "node a(float x in [0, 1]) -> float in [0, 0.25] { return x - x * x; }",
      "node a(float x in [0, 1], float y in [0, 1]) -> float in [0, 1] { return x + y - x * y; }",
      "node a(float x in [0, 4]) -> float in [0, 1] { let r = (x - 1) / (x + 1); return r * r; }",
      "node a(float x in [0, 1]) -> float { return sqrt(x * x - x + 0.26); }",
      "node a(vec3 v) -> vec3 in [-1, 1] { return v * inversesqrt(v.x * v.x + (v.y * v.y + (v.z * v.z + "
      "1e-30))); }",
      "node a(vec3 v) -> vec3 in [-1, 1] { return v * inversesqrt(max(dot(v, v), 1e-30)); }",
  };
  for (const char* body : kBodies) {
    const auto made = lang::Library::fromFiles({{"t.node", std::string("/// D.\n/// source: S\n") + body}});
    ASSERT_TRUE(made) << body;
    ASSERT_TRUE(made->checkAll().empty()) << body << format(made->checkAll()[0]);
    EXPECT_EQ(unproved(proveNode(**made->node("a"), {}), true), 0U) << body;
  }
}

}  // namespace
}  // namespace lacquer::test::nodes_test
