// The list of proofs for a module.
#include "analysis/prove.h"

#include <gtest/gtest.h>

namespace lacquer::test {
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
  bool safe(ValueId id) {
    const analysis::Proofs proofs = of(id);
    return proofs.operations.size() == 1 && proofs.operations[0].safe;
  }

  ir::Module module_;
  uint32_t next_ = 0;
};

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

TEST_F(Prove, OutputsAreReported) {
  const analysis::Proofs proofs = of(dag().mul(input("x", {0, 1}), input("y", {0, 2})));
  ASSERT_EQ(proofs.outputs.size(), 1U);
  EXPECT_EQ(proofs.outputs[0].reached, (analysis::Range{0, 2, false}));
}

}  // namespace
}  // namespace lacquer::test
