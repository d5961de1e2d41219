// The rules that are code, held to exact arithmetic: every form that they give of a node is equal to it.
#include <gtest/gtest.h>

#include <random>

#include "optimize/exact.h"
#include "optimize/rules.h"

namespace lacquer::test::coded_test {
namespace {

using ir::Op;
using ir::Rate;
using ir::Type;
using optimize::EGraph;
using optimize::kNoRef;
using optimize::Node;
using optimize::NodeId;
using optimize::Ref;

constexpr size_t kLights = 3;
constexpr double kClose = 1e-40;

/// A graph over inputs, with numbers for them: those of the lights' rate have others for each light.
class World {
public:
  explicit World(uint64_t seed) : random_(seed), graph_(constants_, 1, kLights, 10000) {}

  Ref input(Type type, Rate rate, bool positive = false) {
    const auto number = static_cast<ir::ValueId>(values_.size());
    std::vector<ExactVector> values(kLights);
    for (size_t light = 0; light < kLights; ++light) {
      for (Exact& x : values[light]) {
        const double drawn = static_cast<double>(static_cast<int64_t>(random_() % 2049) - 1024) / 64;
        x = Exact(positive ? std::abs(drawn) + 0.5 : drawn);
      }
      if (rate != Rate::Light) values[light] = values[0];
    }
    values_.push_back(std::move(values));
    optimize::Facts facts;
    facts.real.fill({positive ? 0.5 : -100, 100, false});
    facts.lit = facts.real;
    return graph_.add({Op::Input, type, rate, 0, 0, {}, number}, &facts);
  }

  /// The node of a class that has that operation.
  NodeId nodeOf(Ref id, Op op) const {
    for (const NodeId node : graph_[id].nodes) {
      if (graph_.node(node).op == op) return node;
    }
    ADD_FAILURE() << "no such node";
    return 0;
  }

  ExactVector at(Ref id, size_t light) const {
    const Node& node = graph_.node(graph_[id].nodes.front());
    if (node.opaque()) return values_[node.source][light];
    if (node.op == Op::SumOverLights) {
      ExactVector sum = at(node.args[0], 0);
      for (size_t other = 1; other < kLights; ++other) {
        const ExactVector more = at(node.args[0], other);
        for (size_t c = 0; c < 4; ++c) sum[c] = test::apply(Op::Add, std::array{sum[c], more[c]});
      }
      return sum;
    }
    std::vector<ExactVector> operands;
    std::vector<const ExactVector*> places;
    std::vector<Type> types;
    for (const Ref operand : node.operands()) {
      operands.push_back(at(operand, light));
      types.push_back(graph_[operand].type);
    }
    for (const ExactVector& operand : operands) places.push_back(&operand);
    return evaluate(node, places, types, constants_);
  }

  /// How many forms the rules give of a node; all must be equal to it. A lookup's: the same direction.
  size_t hold(NodeId node) {
    size_t forms = 0;
    for (const optimize::CodedRule& rule : optimize::codedRules()) {
      std::vector<Ref> equal;
      rule.apply(graph_, node, equal);
      for (const Ref other : equal) {
        if (other == kNoRef) continue;
        ++forms;
        const bool lookup = ir::readsTexture(graph_.node(node).op);
        for (size_t light = 0; light < kLights; ++light) {
          const Ref left = lookup ? graph_.node(node).args[1] : graph_.classOf(node);
          const Ref right = lookup ? graph_.node(graph_[other].nodes.front()).args[1] : other;
          lookup ? expectParallel(rule, at(left, light), at(right, light))
                 : expectEqual(rule, at(left, light), at(right, light), graph_.width(left));
        }
      }
    }
    return forms;
  }

  EGraph& graph() { return graph_; }

private:
  static void expectEqual(const optimize::CodedRule& rule, const ExactVector& a, const ExactVector& b,
                          int width) {
    for (size_t c = 0; c < static_cast<size_t>(width); ++c) {
      EXPECT_TRUE(distance(a[c], b[c]) < kClose || std::abs(a[c].rounded() - b[c].rounded()) < kClose)
          << rule.name << ": " << a[c].rounded() << " and " << b[c].rounded();
    }
  }

  static void expectParallel(const optimize::CodedRule& rule, const ExactVector& a, const ExactVector& b) {
    double along = 0;
    for (size_t c = 0; c < 3; ++c) {
      const size_t d = (c + 1) % 3;
      const Exact left = test::apply(Op::Mul, std::array{a[c], b[d]});
      const Exact right = test::apply(Op::Mul, std::array{a[d], b[c]});
      EXPECT_LT(distance(left, right), kClose) << rule.name;
      along += a[c].rounded() * b[c].rounded();
    }
    EXPECT_GT(along, 0) << rule.name;
  }

  std::mt19937_64 random_;
  optimize::Constants constants_;
  EGraph graph_;
  std::vector<std::vector<ExactVector>> values_;
};

constexpr int kTimes = 50;

TEST(CodedRules, PartsOfVectorsAreThoseOfTheirOperands) {
  constexpr std::array kOne{Op::Neg, Op::Abs};
  constexpr std::array kTwo{Op::Add, Op::Mul, Op::Max, Op::Min};
  const std::array<int, 2> picks{2, 0};
  for (int seed = 0; seed < kTimes; ++seed) {
    World world(static_cast<uint64_t>(seed));
    EGraph& graph = world.graph();
    const Ref a = world.input(Type::Vec3, Rate::Fragment);
    const Ref b = world.input(Type::Vec3, Rate::Fragment);
    const Ref s = world.input(Type::Float, Rate::Fragment);
    const Ref p = world.input(Type::Vec3, Rate::Fragment, true);
    std::vector<Ref> wholes;
    for (const Op op : kOne) wholes.push_back(graph.make(op, {a}));
    for (const Op op : kTwo) wholes.push_back(graph.make(op, {a, b}));
    wholes.push_back(graph.make(Op::Mul, {a, s}));
    wholes.push_back(graph.make(Op::Sqrt, {p}));
    wholes.push_back(graph.make(Op::Div, {p}));
    wholes.push_back(
        graph.make(Op::Clamp, {a, graph.constant(Type::Float, -1), graph.constant(Type::Float, 1)}));
    wholes.push_back(graph.as(Type::Vec3, s));
    for (const Ref whole : wholes) {
      ASSERT_NE(whole, kNoRef);
      const Ref part = graph.add(
          {Op::Swizzle, Type::Vec2, Rate::Fragment, 1, ir::packSwizzle(picks), {whole}, ir::kNoValue});
      EXPECT_GE(world.hold(world.nodeOf(part, Op::Swizzle)), 1U)
          << static_cast<int>(graph.node(graph[whole].nodes.front()).op);
    }
  }
}

TEST(CodedRules, ProductsOfADotGoIntoTheSum) {
  for (int seed = 0; seed < kTimes; ++seed) {
    World world(static_cast<uint64_t>(seed));
    EGraph& graph = world.graph();
    for (const Type type : {Type::Vec2, Type::Vec3, Type::Vec4}) {
      const Ref dot =
          graph.make(Op::Dot, {world.input(type, Rate::Fragment), world.input(type, Rate::Fragment)});
      const Ref sum = graph.make(Op::Add, {dot, world.input(Type::Float, Rate::Fragment)});
      EXPECT_EQ(world.hold(world.nodeOf(sum, Op::Add)), 1U);
    }
  }
}

TEST(CodedRules, DirectionsHaveNoLength) {
  for (int seed = 0; seed < kTimes; ++seed) {
    World world(static_cast<uint64_t>(seed));
    EGraph& graph = world.graph();
    const Ref map = world.input(Type::TextureCube, Rate::Frame);
    const Ref a = world.input(Type::Vec3, Rate::Fragment);
    const auto lookup = [&](Ref factor) {
      Node node{Op::Texture, Type::Vec4, Rate::Fragment, 2, 0, {}, 900 + factor};
      node.args[0] = map;
      node.args[1] = graph.make(Op::Mul, {a, factor});
      return world.hold(world.nodeOf(graph.add(node), Op::Texture));
    };
    EXPECT_EQ(lookup(world.input(Type::Float, Rate::Fragment, true)), 1U);
    EXPECT_EQ(lookup(world.input(Type::Float, Rate::Fragment)), 0U);  // it may point the other way
  }
}

TEST(CodedRules, WhatIsTheSameForAllLightsLeavesTheirSum) {
  for (int seed = 0; seed < kTimes; ++seed) {
    World world(static_cast<uint64_t>(seed));
    EGraph& graph = world.graph();
    const Ref fixed = world.input(Type::Vec3, Rate::Fragment);
    const Ref light = world.input(Type::Vec3, Rate::Light);
    const Ref other = world.input(Type::Vec3, Rate::Light);
    const auto sum = [&](Ref of) {
      Node node{Op::SumOverLights, Type::Vec3, Rate::Fragment, 1, 0, {of}, ir::kNoValue};
      return world.hold(world.nodeOf(graph.add(node), Op::SumOverLights));
    };
    EXPECT_EQ(sum(graph.make(Op::Mul, {fixed, light})), 1U);
    EXPECT_EQ(sum(graph.make(Op::Add, {other, light})), 1U);
    EXPECT_EQ(sum(graph.make(Op::Mul, {other, light})), 0U);
  }
}

}  // namespace
}  // namespace lacquer::test::coded_test
