// What the "ranges" pass removes, and what it must leave.
#include <gtest/gtest.h>

#include "ir/module.h"
#include "passes/passes.h"

namespace lacquer::test::simplify_test {
namespace {

using ir::Op;
using ir::Type;
using ir::ValueId;

class Ranges : public testing::Test {
protected:
  ValueId input(const char* name, ir::Interval range, Type type = Type::Float) {
    return dag().input({ir::InputKind::Parameter, name, type, ir::Rate::Material, range, 0, next_++});
  }
  ir::Dag& dag() { return module_.dag; }
  ValueId number(double x) { return dag().constant(x); }

  /// What is left of a value after the pass, as a dump's lines before the output.
  std::string left(ValueId id) {
    module_.outputs = {{ir::OutputKind::Color, ir::Stage::Fragment, "o", 0, id}};
    passes::simplifyRanges(module_);
    return ir::dump(module_);
  }
  bool leaves(ValueId id, const char* op) {
    return left(id).find(std::string(" ") + op + " ") != std::string::npos;
  }

  void discard(ValueId condition, ValueId color) {
    module_.outputs = {{ir::OutputKind::Color, ir::Stage::Fragment, "o", 0, color},
                       {ir::OutputKind::Discard, ir::Stage::Fragment, "d", 0, condition}};
    passes::simplifyRanges(module_);
  }

  ir::Module module_;
  uint32_t next_ = 0;
};

TEST_F(Ranges, IdleClampGoes) {
  const ValueId x = dag().mul(input("a", {0, 1}), input("b", {0, 1}));
  EXPECT_FALSE(leaves(dag().make(Op::Clamp, {x, number(0), number(1)}), "clamp"));
}

TEST_F(Ranges, ClampOfAPossiblyLargerValueStays) {
  const ValueId x = dag().add(input("a", {0, 1}), input("b", {0, 1e-6}));
  EXPECT_TRUE(leaves(dag().make(Op::Clamp, {x, number(0), number(1)}), "clamp"));
}

TEST_F(Ranges, DotOfDirectionsStaysClamped) {
  const ValueId x = dag().make(Op::Dot, {input("a", {-1, 1}, Type::Vec3), input("b", {-1, 1}, Type::Vec3)});
  EXPECT_TRUE(leaves(dag().make(Op::Min, {dag().make(Op::Abs, {x}), number(1)}), "min"));
}

TEST_F(Ranges, IdleMaximumGoes) {
  const ValueId ior = input("ior", {1, 4});
  EXPECT_FALSE(leaves(dag().make(Op::Max, {dag().mul(ior, ior), number(1)}), "max"));
}

TEST_F(Ranges, MaximumThatIsAlwaysTheOtherGoes) {
  EXPECT_EQ(left(dag().make(Op::Max, {input("a", {-1, 0}), number(0.5)})).find("max"), std::string::npos);
}

TEST_F(Ranges, SquareIsItsAbsoluteValue) {
  const ValueId x = input("x", {-5, 5});
  EXPECT_FALSE(leaves(dag().make(Op::Abs, {dag().mul(x, x)}), "abs"));
}

TEST_F(Ranges, AbsoluteValueOfANegativeIsItsNegation) {
  const std::string text = left(dag().make(Op::Abs, {input("x", {-5, -1})}));
  EXPECT_EQ(text.find("abs"), std::string::npos);
  EXPECT_NE(text.find("neg"), std::string::npos);
}

TEST_F(Ranges, KnownComparisonChooses) {
  const ValueId x = input("x", {0.5, 1});
  const ValueId y = input("y", {2, 3});
  EXPECT_FALSE(leaves(dag().make(Op::Select, {dag().make(Op::Less, {x, y}), x, y}), "select"));
}

TEST_F(Ranges, OpenComparisonStays) {
  const ValueId x = input("x", {0.5, 1});
  const ValueId y = input("y", {1, 3});
  EXPECT_TRUE(leaves(dag().make(Op::Select, {dag().make(Op::Less, {x, y}), x, y}), "select"));
}

TEST_F(Ranges, WhatMayBeNoNumberKeepsItsGuard) {
  // inf - inf: x * x and y * y overflow.
  const ValueId x = input("x", {});
  const ValueId y = input("y", {});
  const ValueId difference = dag().sub(dag().mul(x, x), dag().mul(y, y));
  const ValueId positive = dag().make(Op::Exp2, {difference});
  EXPECT_TRUE(leaves(dag().make(Op::Max, {positive, number(-1)}), "max"));
}

TEST_F(Ranges, SplatWhenTheScalarIsLeft) {
  const ValueId v = input("v", {0, 1}, Type::Vec3);
  const ValueId s = input("s", {2, 3});
  const ValueId most = dag().make(Op::Max, {v, s});
  left(most);
  EXPECT_EQ(module_.dag[module_.outputs[0].value].type, Type::Vec3);
  EXPECT_EQ(module_.dag[module_.outputs[0].value].op, Op::Construct);
}

TEST_F(Ranges, FactsCount) {
  const ValueId x = dag().make(Op::Sin, {input("x", {})});
  dag().assume(x, {0.1, 0.9});
  EXPECT_FALSE(leaves(dag().make(Op::Clamp, {x, number(0), number(1)}), "clamp"));
}

TEST_F(Ranges, FactsMayBePassedByRounding) {
  const ValueId x = dag().make(Op::Sin, {input("x", {})});
  dag().assume(x, {0, 1});
  EXPECT_TRUE(leaves(dag().make(Op::Min, {x, number(1)}), "min"));
}

TEST_F(Ranges, DiscardThatNeverHappensGoes) {
  const ValueId x = input("x", {0.5, 1});
  discard(dag().make(Op::Less, {x, number(0.25)}), x);
  ASSERT_EQ(module_.outputs.size(), 1U);
  EXPECT_EQ(module_.outputs[0].value, x);
}

TEST_F(Ranges, DiscardThatMayHappenStays) {
  const ValueId x = input("x", {0, 1});
  discard(dag().make(Op::Less, {x, number(0.25)}), x);
  ASSERT_EQ(module_.outputs.size(), 2U);
  EXPECT_EQ(module_.outputs[0].value, x);
}

TEST_F(Ranges, WhatIsAlwaysDroppedHasNoColour) {
  const ValueId x = input("x", {0, 0.2});
  discard(dag().make(Op::Less, {x, number(0.25)}), x);
  ASSERT_EQ(module_.outputs.size(), 2U);
  EXPECT_TRUE(dag().isConstant(module_.outputs[0].value, 0));
  EXPECT_TRUE(dag().isConstant(module_.outputs[1].value, 1));
}

}  // namespace
}  // namespace lacquer::test::simplify_test
