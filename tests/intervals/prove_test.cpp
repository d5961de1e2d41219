// The list of proofs for a module.
#include "analysis/prove.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "lang/builtins.h"

namespace lacquer::test::prove_test {
namespace {

using ir::Op;
using ir::Type;
using ir::ValueId;

class Prove : public testing::Test {
protected:
  ValueId input(const char* name, ir::Interval range, Type type = Type::Float) {
    return dag().input({ir::InputKind::Parameter, name, type, ir::Rate::Material, range, 0, next_++});
  }
  ir::Dag& dag() { return module_.dag; }
  analysis::Proofs of(ValueId id) {
    module_.outputs = {{ir::OutputKind::Color, ir::Stage::Fragment, "o", 0, id}};
    return analysis::prove(module_);
  }
  bool safe(ValueId id, analysis::Arithmetic arithmetic = analysis::Arithmetic::Vulkan) {
    of(id);
    const analysis::Proofs proofs = analysis::prove(module_, {arithmetic, analysis::kSceneLimit});
    return proofs.operations.size() == 1 && proofs.operations[0].safe;
  }

  ir::Module module_;
  uint32_t next_ = 0;
};

/// By 0 it is 0: nothing is left to be shown of what the language makes of `a / b`.
TEST_F(Prove, IntegerDivisionAsTheLanguageHasItAsksNothing) {
  for (const Type type : {Type::Int, Type::UInt}) {
    SCOPED_TRACE(ir::typeName(type));
    const ValueId a = input("a", {0, 9}, type);
    const ValueId b = input("b", {0, 9}, type);
    const lang::Builtin* divide = lang::findOperator("/", 2);
    ASSERT_NE(divide, nullptr);
    EXPECT_TRUE(of(divide->make(*divide, dag(), std::array{a, b})).operations.empty());
    const Op op = type == Type::Int ? Op::IntDiv : Op::UIntDiv;
    EXPECT_FALSE(safe(dag().make(op, {a, b}))) << "without the guard";
  }
}

TEST_F(Prove, SafeWhereTheOperandCannotLeaveTheDomain) {
  EXPECT_TRUE(safe(dag().make(Op::Sqrt, {input("a", {0, 1})})));
  EXPECT_TRUE(safe(dag().div(input("b", {}), input("c", {0.5, 1}))));
  EXPECT_TRUE(safe(dag().make(Op::Pow, {input("d", {0, 1}), input("e", {1, 4})})));
  EXPECT_TRUE(safe(dag().make(Op::Pow, {input("f", {0.1, 1}), input("g", {-4, 4})})));
}

TEST_F(Prove, TheOperandAndWhatItReachesAreNamed) {
  const ValueId x = input("x", {-1, 1});
  const analysis::Proofs proofs = of(dag().make(Op::Sqrt, {x}));
  ASSERT_EQ(proofs.operations.size(), 1U);
  EXPECT_FALSE(proofs.operations[0].safe);
  EXPECT_EQ(proofs.operations[0].operand, x);
  EXPECT_EQ(proofs.operations[0].need, ">= 0");
  EXPECT_EQ(proofs.operations[0].reached, (analysis::Range{-1, 1, false}));
}

TEST_F(Prove, OneComponentOfAVectorIsEnoughToFail) {
  const ValueId v =
      dag().construct(Type::Vec3, {input("a", {0, 1}), input("b", {0, 1}), input("c", {-0.1, 1})});
  EXPECT_FALSE(safe(dag().make(Op::Sqrt, {v})));
}

TEST_F(Prove, AnEnvironmentMapMayHoldAnything) {
  ir::TextureSlot slot;
  slot.type = Type::TextureCube;
  slot.environment = true;
  module_.textures.push_back(slot);
  const ValueId map =
      dag().input({ir::InputKind::Texture, "e", Type::TextureCube, ir::Rate::Frame, {0, 1}, 0, 0});
  const ValueId texel = dag().make(Op::Texture, {map, input("d", {}, Type::Vec3)});
  const ValueId root = dag().make(Op::Sqrt, {dag().make(Op::Max, {texel, dag().constant(0)})});
  EXPECT_FALSE(safe(root)) << "a maximum need not hide what is no number";
  dag().assume(texel, {0, 65504});
  EXPECT_TRUE(safe(root));
}

TEST_F(Prove, AFirstLevelHasTexels) {
  ir::TextureSlot slot;
  slot.type = Type::Texture2D;
  module_.textures.push_back(slot);
  const ValueId map =
      dag().input({ir::InputKind::Texture, "t", Type::Texture2D, ir::Rate::Frame, {0, 1}, 0, 0});
  const auto texel = [&](ValueId level) {
    const ValueId size = dag().make(Op::TextureSize, {map, level}, 1);
    return dag().div(dag().constant(1), dag().make(Op::FromInt, {size}));
  };
  EXPECT_TRUE(safe(texel(dag().integer(0))));
  EXPECT_FALSE(safe(texel(dag().integer(1)))) << "of a level that is not there a target may say 0";
}

/// A compiler may add the guard to the constant before it, and nothing of it is left.
TEST_F(Prove, AGuardThatMeetsAConstantIsNone) {
  const ValueId x = input("x", {0.5, 1});
  const ValueId decoded = dag().sub(dag().mul(x, dag().constant(2)), dag().constant(1));
  const auto divided = [&](ValueId by) { return dag().div(dag().constant(1), by); };
  const ValueId added = divided(dag().add(decoded, dag().constant(1e-14)));
  EXPECT_FALSE(safe(added)) << "Vulkan";
  EXPECT_TRUE(safe(added, analysis::Arithmetic::Ieee));
  const ValueId large = divided(dag().add(decoded, dag().constant(1e-3)));
  EXPECT_TRUE(safe(large)) << "it is more than the constant's last place";
  const ValueId bounded = divided(dag().make(Op::Max, {decoded, dag().constant(1e-14)}));
  EXPECT_TRUE(safe(bounded)) << "a bound stays one";
}

/// Between them lies a value that may be told apart: (c + x) + (y - c), and a factor that underflows.
TEST_F(Prove, ConstantsMeetThroughSumsAndProducts) {
  const ValueId x = input("x", {0, 1});
  const ValueId y = input("y", {0, 1});
  const ValueId far = dag().add(dag().add(x, dag().constant(1e-9)), dag().sub(y, dag().constant(-1)));
  EXPECT_TRUE(safe(dag().div(x, far)));
  const ValueId taken =
      dag().add(dag().add(y, dag().constant(-1)),
                dag().sub(dag().constant(1e-9), dag().make(Op::Neg, {dag().add(x, dag().constant(1))})));
  EXPECT_FALSE(safe(dag().div(x, taken)));
  const ValueId z = input("z", {1, 2});
  const ValueId small = dag().mul(dag().mul(dag().mul(z, dag().constant(1e-20)), y), dag().constant(1e-20));
  (void)of(small);
  const ValueId least = dag().mul(dag().mul(dag().mul(input("w", {1e30, 1e31}), dag().constant(1e-25)), z),
                                  dag().constant(1e-25));
  EXPECT_TRUE(safe(dag().div(x, least), analysis::Arithmetic::Ieee));
  EXPECT_FALSE(safe(dag().div(x, least))) << "1e-50 is 0";
}

TEST_F(Prove, MediumpHasTenBits) {
  const ValueId x = input("x", {0, 1});
  const ValueId guarded = dag().div(x, dag().make(Op::Max, {x, dag().constant(1e-6)}));
  EXPECT_TRUE(safe(guarded));
  EXPECT_FALSE(safe(guarded, analysis::Arithmetic::Mediump)) << "flushed below 2^-14";
  const ValueId larger = dag().div(x, dag().make(Op::Max, {x, dag().constant(1e-3)}));
  EXPECT_TRUE(safe(larger, analysis::Arithmetic::Mediump));
  const ValueId square = dag().mul(input("y", {0, 200}), input("z", {0, 200}));
  module_.outputs = {{ir::OutputKind::Color, ir::Stage::Fragment, "o", 0, square}};
  const analysis::Proofs proofs = analysis::prove(module_, {analysis::Arithmetic::Mediump});
  EXPECT_EQ(proofs.outputs[0].reached.hi, std::numeric_limits<double>::infinity()) << "beyond 2^14";
}

/// As the node language's smoothstep is made.
TEST_F(Prove, SmoothstepIsBetweenItsEnds) {
  const ValueId width = dag().sub(input("high", {2, 3}), input("low", {0, 1}));
  const ValueId x = dag().div(dag().sub(input("x", {-5, 5}), input("low", {0, 1})), width);
  const ValueId t = dag().make(Op::Clamp, {x, dag().constant(0), dag().constant(1)});
  const ValueId slope = dag().sub(dag().constant(3), dag().mul(dag().constant(2), t));
  const analysis::Proofs proofs = of(dag().mul(dag().mul(t, t), slope));
  EXPECT_EQ(proofs.outputs[0].reached.lo, 0);
  EXPECT_NEAR(proofs.outputs[0].reached.hi, 1, 1e-5);
}

TEST_F(Prove, OutputsAreReported) {
  const analysis::Proofs proofs = of(dag().mul(input("x", {0, 1}), input("y", {0, 2})));
  ASSERT_EQ(proofs.outputs.size(), 1U);
  EXPECT_EQ(proofs.outputs[0].reached, (analysis::Range{0, 2, false}));
}

}  // namespace
}  // namespace lacquer::test::prove_test
