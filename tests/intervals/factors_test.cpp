// What the passes "reciprocals" and "scales" make of single products and quotients.
#include <gtest/gtest.h>

#include "ir/module.h"
#include "passes/passes.h"

namespace lacquer::test::factors_test {
namespace {

using ir::Op;
using ir::Type;
using ir::ValueId;

class Factors : public testing::Test {
protected:
  ValueId input(const char* name, ir::Rate rate, Type type = Type::Float) {
    return dag().input({ir::InputKind::Parameter, name, type, rate, {0.5, 2}, 0, next_++});
  }
  ir::Dag& dag() { return module_.dag; }

  /// What is left of values after a pass, as a dump.
  std::string left(void (*pass)(ir::Module&), std::vector<ValueId> ids) {
    module_.outputs.clear();
    for (const ValueId id : ids)
      module_.outputs.push_back({ir::OutputKind::Color, ir::Stage::Fragment, "o", 0, id});
    pass(module_);
    return ir::dump(module_);
  }

  ir::Module module_;
  uint32_t next_ = 0;
};

TEST_F(Factors, APixelIsMultipliedByTheMaterialsReciprocal) {
  const ValueId x = input("x", ir::Rate::Fragment, Type::Vec3);
  const ValueId m = input("m", ir::Rate::Material);
  const std::string text = left(passes::takeReciprocals, {dag().make(Op::Div, {x, m})});
  EXPECT_NE(text.find("float div 1 m"), std::string::npos) << text;
  EXPECT_NE(text.find("vec3 mul x"), std::string::npos) << text;
}

TEST_F(Factors, ADivisionOfTheMaterialsOwnStays) {
  const ValueId m = input("m", ir::Rate::Material);
  const ValueId n = input("n", ir::Rate::Material);
  EXPECT_NE(left(passes::takeReciprocals, {dag().make(Op::Div, {m, n})}).find("float div m n"),
            std::string::npos);
}

TEST_F(Factors, ADivisionByAPixelStays) {
  const ValueId x = input("x", ir::Rate::Fragment);
  const ValueId m = input("m", ir::Rate::Material);
  EXPECT_NE(left(passes::takeReciprocals, {dag().make(Op::Div, {m, x})}).find("float div m x"),
            std::string::npos);
}

TEST_F(Factors, SpecializedMaterialsDivide) {
  // A reciprocal would be an instruction more there: nothing is computed before.
  module_.spec_constants = true;
  const ValueId x = input("x", ir::Rate::Fragment);
  const ValueId m = input("m", ir::Rate::Material);
  EXPECT_NE(left(passes::takeReciprocals, {dag().make(Op::Div, {x, m})}).find("float div x m"),
            std::string::npos);
}

TEST_F(Factors, TheMagnitudeIsTakenBeforeALength) {
  const ValueId x = input("x", ir::Rate::Fragment);
  const ValueId scale = dag().make(Op::InverseSqrt, {input("y", ir::Rate::Fragment)});
  const ValueId product = dag().mul(x, scale);
  const ValueId sum = dag().add(product, input("z", ir::Rate::Fragment));
  const std::string text = left(passes::placeScales, {dag().make(Op::Abs, {product}), sum});
  EXPECT_NE(text.find("abs x"), std::string::npos) << text;
}

TEST_F(Factors, TheMagnitudeOfAProductThatIsThereAnywayStays) {
  const ValueId x = input("x", ir::Rate::Fragment);
  const ValueId scale = dag().make(Op::InverseSqrt, {input("y", ir::Rate::Fragment)});
  const ValueId product = dag().mul(x, scale);
  const ValueId other = dag().make(Op::Sqrt, {product});
  const std::string text = left(passes::placeScales, {dag().make(Op::Abs, {product}), other});
  EXPECT_EQ(text.find("abs x"), std::string::npos) << text;
}

}  // namespace
}  // namespace lacquer::test::factors_test
