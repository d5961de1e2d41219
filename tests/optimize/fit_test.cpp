// Polynomials and quotients for functions of one number keep to the error that is proved of them, held to
// exact arithmetic.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "optimize/exact.h"
#include "optimize/fit.h"

namespace lacquer::test::fit_test {
namespace {

using ir::Op;
using ir::Type;
using optimize::Node;
using optimize::Ref;

/// A plan of one number, node 0.
struct Function {
  optimize::Plan plan;
  optimize::Constants constants;

  Function() { push({Op::Input, Type::Float, ir::Rate::Fragment, 0, 0, {}, 0}); }
  Ref push(const Node& node) {
    plan.nodes.push_back(node);
    return static_cast<Ref>(plan.nodes.size() - 1);
  }
  Ref number(double x) {
    return push({Op::Constant,
                 Type::Float,
                 ir::Rate::Constant,
                 0,
                 constants.place(Type::Float, {x, x, x, x}),
                 {},
                 ir::kNoValue});
  }
  Ref make(Op op, std::initializer_list<Ref> args) {
    Node node{op, Type::Float, ir::Rate::Fragment, static_cast<uint8_t>(args.size()), 0, {}, ir::kNoValue};
    std::copy(args.begin(), args.end(), node.args.begin());
    return push(node);
  }
  /// Those that depend on node 0, which are all but the constants.
  std::vector<Ref> curve() const {
    std::vector<Ref> nodes;
    for (Ref at = 1; at < plan.nodes.size(); ++at) {
      if (plan.nodes[at].op != Op::Constant) nodes.push_back(at);
    }
    return nodes;
  }
  /// In exact arithmetic.
  double at(double x) const {
    std::vector<ExactVector> values(plan.nodes.size());
    values[0][0] = Exact(x);
    for (Ref at = 1; at < plan.nodes.size(); ++at) {
      std::vector<const ExactVector*> operands;
      std::vector<Type> types;
      for (const Ref operand : plan.nodes[at].operands()) {
        operands.push_back(&values[operand]);
        types.push_back(Type::Float);
      }
      values[at] = evaluate(plan.nodes[at], operands, types, constants);
    }
    return values.back()[0].rounded();
  }
};

struct Subject {
  const char* name;
  analysis::Range domain;
  void (*build)(Function&);
};

const Subject kSubjects[] = {
    {"a path through a coat",
     {0, 1, false},
     [](Function& f) {
       const Ref scaled = f.make(Op::Mul, {f.make(Op::Mul, {0, 0}), f.number(0.4444)});
       f.make(Op::InverseSqrt, {f.make(Op::Add, {scaled, f.number(0.5556)})});
     }},
    {"a fifth power",
     {0, 1, false},
     [](Function& f) {
       const Ref rest = f.make(Op::Add, {f.make(Op::Neg, {0}), f.number(1)});
       const Ref square = f.make(Op::Mul, {rest, rest});
       f.make(Op::Mul, {f.make(Op::Mul, {square, square}), rest});
     }},
    {"an exponential", {-3, 2, false}, [](Function& f) { f.make(Op::Exp2, {0}); }},
    {"a root that begins steeply", {0, 1, false}, [](Function& f) { f.make(Op::Sqrt, {0}); }},
    {"a kink", {-1, 1, false}, [](Function& f) { f.make(Op::Abs, {0}); }},
    {"a quotient",
     {0.25, 4, false},
     [](Function& f) {
       f.make(Op::Div, {f.make(Op::Log2, {f.make(Op::Add, {0, f.number(2)})})});
     }},
    {"a clamp",
     {-2, 2, false},
     [](Function& f) {
       f.make(Op::Clamp, {0, f.number(0), f.number(1)});
     }},
};

float horner(const std::vector<ir::Components>& powers, float x) {
  float sum = 0;
  for (size_t k = powers.size(); k-- > 0;) {
    const float product = sum * x;
    sum = product + static_cast<float>(powers[k][0]);
  }
  return sum;
}

/// By Horner in float32, through a reciprocal.
double valueOf(const optimize::Form& form, float x) {
  const float sum = horner(form.coefficients, x);
  if (form.divisor.empty()) return static_cast<double>(sum);
  const float reciprocal = 1 / horner(form.divisor, x);
  const float ratio = horner(form.dividend, x) * reciprocal;
  return static_cast<double>(ratio + sum);
}

TEST(Fits, KeepToTheirErrors) {
  std::mt19937_64 random(5);
  for (const Subject& subject : kSubjects) {
    Function function;
    subject.build(function);
    optimize::Curve curve(function.plan, function.constants, 0, function.curve());
    for (const size_t degree : {1U, 2U, 3U, 5U}) {
      const auto fit = optimize::fit(curve, subject.domain, {degree + 1, 0, 0}, 10, std::nullopt);
      ASSERT_TRUE(fit) << subject.name << " " << degree;
      double most = 0;
      for (int i = 0; i < 2000; ++i) {
        const double u = static_cast<double>(random() >> 11U) * 0x1p-53;
        const double end = i == 0 ? 0 : i == 1 ? 1 : u;
        const auto x = static_cast<float>(subject.domain.lo + (subject.domain.hi - subject.domain.lo) * end);
        const double y = valueOf(*fit, x);
        most = std::max(most, std::abs(y - function.at(static_cast<double>(x))));
        EXPECT_GE(y, fit->reached.lo - fit->rounding) << subject.name;
        EXPECT_LE(y, fit->reached.hi + fit->rounding) << subject.name;
      }
      EXPECT_LE(most, fit->error) << subject.name << " " << degree;
      EXPECT_GT(most, (fit->error - 1.3 * fit->rounding) / 2)
          << subject.name << " " << degree;  // else the bound says little
      // Less than it is off is not proved.
      analysis::Range reached{};
      EXPECT_FALSE(optimize::prove(curve, subject.domain, *fit, 0.8 * (most - 2 * fit->rounding), reached))
          << subject.name;
    }
  }
}

constexpr optimize::Shape kQuotients[] = {{0, 0, 1}, {0, 0, 2}, {1, 0, 1}, {2, 0, 1}, {0, 1, 2}, {1, 1, 2}};

TEST(Fits, QuotientsKeepToTheirErrors) {
  std::mt19937_64 random(6);
  int made = 0;
  int better = 0;
  int found = 0;
  for (const Subject& subject : kSubjects) {
    Function function;
    subject.build(function);
    optimize::Curve curve(function.plan, function.constants, 0, function.curve());
    for (const optimize::Shape& shape : kQuotients) {
      const auto fit = optimize::fit(curve, subject.domain, shape, 0.1, std::nullopt);
      // Of some functions a quotient is none: what it would be has a pole, or stays far from them.
      if (!fit) continue;
      ++made;
      double most = 0;
      for (int i = 0; i < 4000; ++i) {
        const double u = static_cast<double>(random() >> 11U) * 0x1p-53;
        const double at = i == 0 ? 0 : i == 1 ? 1 : i % 2 == 0 ? u : u * u * u * u;
        const auto x = static_cast<float>(subject.domain.lo + (subject.domain.hi - subject.domain.lo) * at);
        const double y = valueOf(*fit, x);
        most = std::max(most, std::abs(y - function.at(static_cast<double>(x))));
        EXPECT_GE(y, fit->reached.lo - fit->rounding) << subject.name;
        EXPECT_LE(y, fit->reached.hi + fit->rounding) << subject.name;
        const auto divisor = static_cast<double>(horner(fit->divisor, x));
        EXPECT_TRUE(fit->divided.contains(divisor)) << subject.name << " " << divisor;
      }
      EXPECT_LE(most, fit->error) << subject.name;
      EXPECT_GT(most, (fit->error - 1.3 * fit->rounding) / 2) << subject.name;
      // Less than it is off is not proved, nor are numbers that are wrong by little more than it is off.
      analysis::Range reached{};
      EXPECT_FALSE(optimize::prove(curve, subject.domain, *fit, 0.8 * (most - 2 * fit->rounding), reached))
          << subject.name;
      optimize::Form wrong = *fit;
      wrong.divisor[0][0] *= 1.02;
      const double mid = (subject.domain.lo + subject.domain.hi) / 2;
      const double moved = std::abs(valueOf(wrong, static_cast<float>(mid)) - function.at(mid));
      if (moved > 1.5 * fit->error) {
        ++found;
        EXPECT_FALSE(optimize::prove(curve, subject.domain, wrong, fit->error, reached)) << subject.name;
      }
      // A polynomial of as many numbers.
      const size_t numbers = shape.terms + shape.dividend + shape.divisor + 1;
      const auto power = optimize::fit(curve, subject.domain, {numbers, 0, 0}, 10, std::nullopt);
      better += power && power->error > 2 * fit->error;
    }
  }
  EXPECT_GT(made, 20);
  EXPECT_GT(better, 8);
  EXPECT_GT(found, 6);
}

/// A quotient of that shape finds itself again.
TEST(Fits, QuotientsFindWhatIsOne) {
  Function function;
  const Ref below =
      function.make(Op::Add, {function.make(Op::Mul, {0, function.number(3)}), function.number(0.5)});
  function.make(Op::Add, {function.make(Op::Div, {below}), function.number(0.25)});
  optimize::Curve curve(function.plan, function.constants, 0, function.curve());
  const auto fit = optimize::fit(curve, {0, 1, false}, {1, 0, 1}, 1, std::nullopt);
  ASSERT_TRUE(fit);
  EXPECT_LT(fit->error, 8 * 0x1p-20);  // of values up to 2.25, most of it rounding
  EXPECT_NEAR(fit->divisor[0][0], 0.5, 1e-6);
  EXPECT_NEAR(fit->divisor[1][0], 3, 1e-5);
}

TEST(Fits, RefuseDivisorsThatReachZero) {
  Function function;
  function.make(Op::Mul, {0, function.number(1)});
  optimize::Curve curve(function.plan, function.constants, 0, function.curve());
  analysis::Range reached{};
  // 1 / (x - 0.3), and what is hardly more than 0.
  for (const double least : {-0.3, 0.0}) {
    optimize::Form pole{{}, {{1, 1, 1, 1}}, {{least, least, least, least}, {1, 1, 1, 1}}};
    EXPECT_FALSE(optimize::prove(curve, {0, 1, false}, pole, 1e30, reached)) << least;
  }
  // 1 / x by itself, where x comes near 0.
  Function reciprocal;
  reciprocal.make(Op::Div, {0});
  optimize::Curve steep(reciprocal.plan, reciprocal.constants, 0, reciprocal.curve());
  for (const optimize::Shape& shape : kQuotients) {
    EXPECT_FALSE(optimize::fit(steep, {-1, 1, false}, shape, 1e30, std::nullopt));
    EXPECT_FALSE(optimize::fit(steep, {0, 1, false}, shape, 1e30, std::nullopt));
  }
}

TEST(Fits, StayAboveWhatTheyMustNotPass) {
  Function function;
  kSubjects[1].build(function);
  optimize::Curve curve(function.plan, function.constants, 0, function.curve());
  const auto free = optimize::fit(curve, {0, 1, false}, {3, 0, 0}, 1, std::nullopt);
  const auto held = optimize::fit(curve, {0, 1, false}, {3, 0, 0}, 1, 0);
  ASSERT_TRUE(free && held);
  EXPECT_LT(free->reached.lo, 0);
  EXPECT_GE(held->reached.lo - held->rounding, 0);
  for (int i = 0; i <= 1000; ++i) {
    const float x = static_cast<float>(i) / 1000.0F;
    EXPECT_GE(valueOf(*held, x), 0);
    EXPECT_LE(std::abs(valueOf(*held, x) - function.at(static_cast<double>(x))), held->error);
  }
}

TEST(Fits, AreTheSameEachTime) {
  for (const Subject& subject : kSubjects) {
    for (const optimize::Shape& shape : {optimize::Shape{5, 0, 0}, optimize::Shape{1, 0, 1}}) {
      std::optional<optimize::Fit> first;
      for (int run = 0; run < 2; ++run) {
        Function function;
        subject.build(function);
        optimize::Curve curve(function.plan, function.constants, 0, function.curve());
        const auto fit = optimize::fit(curve, subject.domain, shape, 10, std::nullopt);
        if (run == 0) {
          first = fit;
          continue;
        }
        ASSERT_EQ(fit.has_value(), first.has_value()) << subject.name;
        if (!fit) continue;
        EXPECT_EQ(fit->coefficients, first->coefficients) << subject.name;
        EXPECT_EQ(fit->divisor, first->divisor) << subject.name;
      }
    }
  }
}

}  // namespace
}  // namespace lacquer::test::fit_test
