// What the cost model counts of plans.
#include <gtest/gtest.h>

#include "optimize/cost.h"

namespace lacquer::test::count_test {
namespace {

using ir::Op;
using ir::Rate;
using ir::Type;
using optimize::Count;
using optimize::Node;
using optimize::Plan;

// Of the material's part a plan that is tried may have the first nodes alone, without what they are made of.
TEST(Counts, AMaterialsSignIsNoWayToAProduct) {
  Plan plan;
  plan.nodes.push_back({Op::Input, Type::Float, Rate::Fragment, 0, 0, {}, 0});
  plan.nodes.push_back({Op::Mul, Type::Float, Rate::Fragment, 2, 0, {0, 0}, ir::kNoValue});
  plan.nodes.push_back({Op::Neg, Type::Float, Rate::Material, 0, 0, {1}, ir::kNoValue});
  plan.nodes.push_back({Op::Add, Type::Float, Rate::Fragment, 2, 0, {0, 2}, ir::kNoValue});
  plan.roots = {1, 3};
  ir::Module module;
  module.dag.input({ir::InputKind::Varying, "x", Type::Float, Rate::Fragment, {}});
  optimize::Counter counter(module);
  const optimize::Tally tally = counter.count(plan, optimize::Constants());
  EXPECT_EQ(tally[static_cast<size_t>(Count::Sums)], 2);  // the product and the sum: nothing is fused
}

}  // namespace
}  // namespace lacquer::test::count_test
