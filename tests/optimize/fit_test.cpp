// Polynomials for functions of one number keep to the error that is proved of them, held to exact arithmetic.
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

/// By Horner in float32.
double valueOf(const optimize::Fit& fit, float x) {
  float sum = 0;
  for (size_t k = fit.coefficients.size(); k-- > 0;) {
    const float product = sum * x;
    sum = product + static_cast<float>(fit.coefficients[k][0]);
  }
  return static_cast<double>(sum);
}

TEST(Fits, KeepToTheirErrors) {
  std::mt19937_64 random(5);
  for (const Subject& subject : kSubjects) {
    Function function;
    subject.build(function);
    optimize::Curve curve(function.plan, function.constants, 0, function.curve());
    for (const size_t degree : {1U, 2U, 3U, 5U}) {
      const auto fit = optimize::fit(curve, subject.domain, degree, 10, std::nullopt);
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
      EXPECT_FALSE(optimize::prove(curve, subject.domain, fit->coefficients, 0.8 * (most - 2 * fit->rounding),
                                   reached))
          << subject.name;
    }
  }
}

TEST(Fits, StayAboveWhatTheyMustNotPass) {
  Function function;
  kSubjects[1].build(function);
  optimize::Curve curve(function.plan, function.constants, 0, function.curve());
  const auto free = optimize::fit(curve, {0, 1, false}, 2, 1, std::nullopt);
  const auto held = optimize::fit(curve, {0, 1, false}, 2, 1, 0);
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
    std::vector<ir::Components> first;
    for (int run = 0; run < 2; ++run) {
      Function function;
      subject.build(function);
      optimize::Curve curve(function.plan, function.constants, 0, function.curve());
      const auto fit = optimize::fit(curve, subject.domain, 4, 1, std::nullopt);
      ASSERT_TRUE(fit) << subject.name;
      if (run == 0) first = fit->coefficients;
      EXPECT_EQ(fit->coefficients, first) << subject.name;
    }
  }
}

}  // namespace
}  // namespace lacquer::test::fit_test
