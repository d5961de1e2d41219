// The arithmetic of intervals: every op against float32 on random operands, and the exactness that proofs
// rest on.
#include "analysis/interval_math.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "analysis/intervals.h"
#include "ir/fold.h"

namespace lacquer::test::math_test {
namespace {

using analysis::Arithmetic;
using analysis::Range;
using analysis::RangeMath;
using ir::Op;

const RangeMath kFloat(Arithmetic::Vulkan);
const RangeMath kReal(Arithmetic::Real);

/// An operation of ir/facts.def on three inputs, by the analysis of a module of it alone.
class Applied {
public:
  Applied(Op op, Arithmetic arithmetic, std::array<ir::Type, 2> types = {ir::Type::Float, ir::Type::Float})
      : arithmetic_(arithmetic) {
    for (const char* name : {"a", "b", "c"}) {
      inputs_.push_back(module_.dag.input({ir::InputKind::Parameter,
                                           name,
                                           types[*name == 'b' ? 1 : 0],
                                           ir::Rate::Material,
                                           {},
                                           0,
                                           static_cast<uint32_t>(inputs_.size())}));
    }
    result_ = module_.dag.make(op, std::span(inputs_).first(static_cast<size_t>(ir::info(op).arity)));
  }

  Range operator()(const Range& a, const Range& b, const Range& c) const {
    analysis::Intervals intervals(module_, {arithmetic_});
    const std::array given{a, b, c};
    for (size_t i = 0; i < given.size(); ++i) {
      analysis::Ranges ranges;
      ranges.fill(given[i]);
      intervals.fix(inputs_[i], ranges);
    }
    intervals.run(std::array{inputs_[0], inputs_[1], inputs_[2], result_});
    return intervals.at(result_, 0);
  }

private:
  Arithmetic arithmetic_;
  ir::Module module_;
  std::vector<ir::ValueId> inputs_;
  ir::ValueId result_ = ir::kNoValue;
};

/// Those of floats, component by component.
std::vector<Op> arithmeticOps() {
  std::vector<Op> ops;
  for (const ir::Facts& facts : ir::kFacts) {
    if (ir::info(facts.op).signature == ir::Signature::Map) ops.push_back(facts.op);
  }
  return ops;
}

class Draw {
public:
  float number() {
    switch (random_() % 8) {
      case 0: return 0;
      case 1: return random_() % 2 == 0 ? 1.0F : -1.0F;
      case 2: return std::ldexp(unit(), static_cast<int>(random_() % 250) - 125);
      case 3: return std::numeric_limits<float>::max() * unit();
      default: return 4 * unit();
    }
  }
  Range range() {
    const float a = number();
    const float b = random_() % 4 == 0 ? a : number();
    return {std::min(a, b), std::max(a, b), false};
  }
  float within(const Range& r) {
    const double x = r.lo + (r.hi - r.lo) * std::abs(unit());
    const int edge = static_cast<int>(random_() % 4);
    return edge == 0 ? static_cast<float>(r.lo)
           : edge == 1
               ? static_cast<float>(r.hi)
               : std::clamp(static_cast<float>(x), static_cast<float>(r.lo), static_cast<float>(r.hi));
  }

private:
  float unit() { return static_cast<float>(random_()) / 2147483648.0F - 1; }
  std::mt19937 random_{7};
};

TEST(IntervalMath, HoldsEveryFloatResult) {
  Draw draw;
  for (const Op op : arithmeticOps()) {
    const Applied apply(op, Arithmetic::Vulkan);
    for (int i = 0; i < 40000; ++i) {
      const Range a = draw.range();
      const Range b = draw.range();
      Range c = draw.range();
      if (op == Op::Clamp) c = {std::max(b.hi, c.lo), std::max(b.hi, c.hi), false};
      const Range r = apply(a, b, c);
      for (int k = 0; k < 4; ++k) {
        const float y = ir::foldComponent<float>(op, draw.within(a), draw.within(b), draw.within(c));
        ASSERT_TRUE(std::isnan(y) ? r.nan : r.contains(y))
            << ir::info(op).name << " of [" << a.lo << ", " << a.hi << "] [" << b.lo << ", " << b.hi << "] ["
            << c.lo << ", " << c.hi << "]: " << y << " is not in [" << r.lo << ", " << r.hi << "]";
      }
    }
  }
}

/// An integer, often a small one or one at an end.
double integer(std::mt19937& random, bool without_sign) {
  const auto bits = static_cast<uint32_t>(random());
  const uint32_t small = bits % 40;
  constexpr std::array<uint32_t, 6> kEnds = {0, 1, 0x7fffffff, 0x80000000, 0xfffffffe, 0xffffffff};
  const uint32_t x = random() % 3 == 0   ? bits
                     : random() % 2 == 0 ? small - (without_sign ? 0 : 20)
                                         : kEnds[bits % 6];
  return ir::whole<double>(x);
}

TEST(IntervalMath, HoldsEveryIntegerResult) {
  std::mt19937 random(11);
  for (const ir::Facts& facts : ir::kFacts) {
    const Op op = facts.op;
    if (!ir::ofWholes(ir::info(op).signature)) continue;
    const bool without_sign =
        op == Op::UIntDiv || op == Op::UIntLess || op == Op::UIntShiftRight || random() % 2 == 0;
    const ir::Type type = without_sign && op != Op::IntDiv && op != Op::IntLess && op != Op::IntShiftRight
                              ? ir::Type::UInt
                              : ir::Type::Int;
    const bool shift = ir::info(op).signature == ir::Signature::Shift;
    const Applied apply(op, Arithmetic::Vulkan, {type, shift ? ir::Type::UInt : type});
    for (int i = 0; i < 40000; ++i) {
      const auto range = [&] {
        const double a = integer(random, type == ir::Type::UInt);
        const double b = random() % 4 == 0 ? a : integer(random, type == ir::Type::UInt);
        return Range{std::min(a, b), std::max(a, b), false};
      };
      const Range a = range();
      Range b = range();
      if (shift) b = {static_cast<double>(random() % 16), static_cast<double>(16 + random() % 16), false};
      const Range r = apply(a, b, b);
      for (int k = 0; k < 4; ++k) {
        const auto within = [&](const Range& in) {
          const auto width = static_cast<uint64_t>(in.hi - in.lo) + 1;
          const auto step = k == 0 ? 0 : k == 1 ? width - 1 : random() % width;
          return in.lo + static_cast<double>(step);
        };
        const double x = within(a);
        const double y = within(b);
        const double z = ir::foldComponent<double>(op, x, y, 0);
        const float f =
            ir::foldComponent<float>(op, ir::whole<float>(ir::bits(x)), ir::whole<float>(ir::bits(y)), 0);
        const bool test = ir::info(op).signature == ir::Signature::WholeTest;
        ASSERT_EQ(z, test ? double{f} : ir::int_number<double>(ir::bits(f))) << ir::info(op).name;
        if (y == 0 && facts.domain == ir::Domain::WholeNonZero) continue;
        ASSERT_TRUE(r.contains(z)) << ir::info(op).name << " of " << x << " and " << y << ": " << z
                                   << " is not in [" << r.lo << ", " << r.hi << "]";
      }
    }
  }
}

TEST(IntervalMath, HoldsExactResults) {
  Draw draw;
  for (const Op op : arithmeticOps()) {
    if (op == Op::Fract) continue;
    const Applied apply(op, Arithmetic::Real);
    for (int i = 0; i < 20000; ++i) {
      const Range a = draw.range();
      const Range b = draw.range();
      Range c = draw.range();
      if (op == Op::Clamp) c = {std::max(b.hi, c.lo), std::max(b.hi, c.hi), false};
      const Range r = apply(a, b, c);
      const float u = draw.within(a);
      const float v = draw.within(b);
      const float w = draw.within(c);
      const double y = ir::foldComponent<double>(op, u, v, w);
      if (!std::isfinite(y)) continue;
      // The double's own rounding; a mix may cancel.
      const double terms = op == Op::Mix
                               ? (std::abs(double{u}) + std::abs(double{v})) * (1.0 + std::abs(double{w}))
                               : std::abs(y);
      const double slack = 1e-15 * terms;
      ASSERT_TRUE(r.lo <= y + slack && r.hi >= y - slack) << ir::info(op).name << " " << y;
    }
  }
}

TEST(IntervalMath, ExactResultsStayExact) {
  const Range unit{0, 1, false};
  for (const RangeMath& m : {kFloat, kReal}) {
    EXPECT_EQ(m.sub({1, 1, false}, unit), unit);
    EXPECT_EQ(m.mul(unit, unit), unit);
    EXPECT_EQ(m.square({-1, 1, false}), unit);
    EXPECT_EQ(m.constant(0.5), (Range{0.5, 0.5, false}));
  }
  EXPECT_EQ(kReal.blend(unit, unit, unit), unit);
  EXPECT_EQ(kFloat.blend(unit, unit, unit).lo, 0);
}

TEST(IntervalMath, RoundsOutward) {
  const Range tenth = kFloat.constant(0.1);
  EXPECT_LT(tenth.lo, 0.1);
  EXPECT_GT(tenth.hi, 0.1);
  EXPECT_EQ(tenth.hi, std::nextafter(static_cast<float>(tenth.lo), 1.0F));
  // 1 + 2^-30 is no float32: rounded to nearest or towards zero it is 1, rounded up it is the next.
  const Range sum = kFloat.add({1, 1, false}, {0x1p-30, 0x1p-30, false});
  EXPECT_EQ(sum.lo, 1);
  EXPECT_EQ(sum.hi, 1 + 0x1p-23);
  // A division is only within 2.5 units of the last place, even of 1.
  EXPECT_LT(kFloat.div({3, 3, false}, {3, 3, false}).lo, 1);
  // 1 to a large power, by log2 and exp2.
  EXPECT_GT(kFloat.pow({1, 1, false}, {1000, 1000, false}).hi, 1.0001);
}

TEST(IntervalMath, SubnormalNumbersMayBeFlushed) {
  EXPECT_EQ(kFloat.mul({1e-30, 1, false}, {1e-30, 1, false}).lo, 0);
  EXPECT_GT(kReal.mul({1e-30, 1, false}, {1e-30, 1, false}).lo, 0);
}

TEST(IntervalMath, KnowsWhereNumbersEnd) {
  const double inf = std::numeric_limits<double>::infinity();
  const double most = std::numeric_limits<float>::max();
  EXPECT_EQ(kFloat.mul({0, most, false}, {2, 2, false}).hi, inf);
  EXPECT_TRUE(kFloat.mul({0, inf, false}, {0, 1, false}).nan);
  EXPECT_TRUE(kFloat.add({0, inf, false}, {-inf, 0, false}).nan);
  EXPECT_FALSE(kFloat.square({-inf, inf, false}).nan);
  EXPECT_TRUE(kFloat.sqrt({-1, 1, false}).nan);
  EXPECT_TRUE(kFloat.div({0, 1, false}, {-1, 1, false}).nan);
  // What is no number may pass a maximum, and the maximum may then give the other operand.
  const Range r = kFloat.max({5, 6, true}, {1, 1, false});
  EXPECT_TRUE(r.nan);
  EXPECT_EQ(r.lo, 1);
}

}  // namespace
}  // namespace lacquer::test::math_test
