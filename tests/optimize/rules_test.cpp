// Every rule in exact arithmetic.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "optimize/exact.h"
#include "optimize/rules.h"

namespace lacquer::test::rules_test {
namespace {

using ir::Op;
using ir::Type;
using optimize::Condition;
using optimize::EGraph;
using optimize::kNoRef;
using optimize::Letters;
using optimize::NodeId;
using optimize::Pattern;
using optimize::Ref;
using optimize::Rule;

/// 2^-200 beside the 256 bits of a number: sums of numbers of very different sizes lose some.
constexpr double kClose = 1e-40;

size_t lettersOf(const Rule& rule) {
  size_t count = 0;
  for (const Pattern* pattern : {&rule.from, &rule.to}) {
    for (const Pattern::Term& term : pattern->terms) {
      if (term.kind == Pattern::Term::Kind::Letter) count = std::max<size_t>(count, term.letter + size_t{1});
    }
  }
  return count;
}

/// Whether numbers meet a rule's conditions, in every component.
bool meets(const Rule& rule, std::span<const Type> types, std::span<const ExactVector> values) {
  using Kind = Condition::Kind;
  for (const Condition& condition : rule.when) {
    if (condition.kind == Kind::Slow || condition.kind == Kind::Finite) continue;
    if (condition.kind == Kind::Number) {
      if (types[condition.letter] != Type::Float) return false;
      continue;
    }
    const auto other = static_cast<size_t>(std::max(condition.other, 0));
    const auto wide = [&](size_t letter) { return static_cast<size_t>(ir::componentCount(types[letter])); };
    size_t width = wide(condition.letter);
    if (condition.other >= 0) width = std::max(width, wide(other));
    for (size_t c = 0; c < width; ++c) {
      const double a = values[condition.letter][wide(condition.letter) == 1 ? 0 : c].rounded();
      const double b =
          condition.other < 0 ? condition.number : values[other][wide(other) == 1 ? 0 : c].rounded();
      bool good = true;
      if (condition.kind == Kind::Positive) good = a > 0;
      if (condition.kind == Kind::NotNegative) good = a >= 0;
      if (condition.kind == Kind::NotPositive) good = a <= 0;
      if (condition.kind == Kind::NotZero) good = a != 0;
      if (condition.kind == Kind::AtMost) good = a <= b;
      if (condition.kind == Kind::AtLeast) good = a >= b;
      if (!good) return false;
    }
  }
  return true;
}

/// Small rationals, the ends of common ranges, and numbers of any size.
class Draw {
public:
  explicit Draw(uint64_t seed) : random_(seed) {}
  double operator()() {
    constexpr std::array kEdges{0.0, 1.0, -1.0, 0.5, 2.0, -2.0};
    const uint64_t kind = random_() % 8;
    if (kind < 2) return kEdges[random_() % kEdges.size()];
    const double small = static_cast<double>(static_cast<int64_t>(random_() % 2049) - 1024) / 256;
    if (kind < 6) return small;
    return std::ldexp(small, static_cast<int>(random_() % 41) - 20);
  }

private:
  std::mt19937_64 random_;
};

/// The value of a class that has one node, over letters.
class Evaluation {
public:
  Evaluation(const EGraph& graph, const Letters& letters, std::span<const ExactVector> values)
      : graph_(graph), letters_(letters), values_(values) {}

  ExactVector operator()(Ref id) const {
    for (size_t i = 0; i < values_.size(); ++i) {
      if (letters_[i] != kNoRef && graph_.find(letters_[i]) == graph_.find(id)) return values_[i];
    }
    const optimize::Node& node = graph_.node(graph_[id].nodes.front());
    std::vector<ExactVector> operands;
    std::vector<const ExactVector*> places;
    std::vector<Type> types;
    for (const Ref operand : node.operands()) {
      operands.push_back((*this)(operand));
      types.push_back(graph_[operand].type);
    }
    places.reserve(operands.size());
    for (const ExactVector& operand : operands) places.push_back(&operand);
    return evaluate(node, places, types, graph_.constants());
  }

private:
  const EGraph& graph_;
  const Letters& letters_;
  std::span<const ExactVector> values_;
};

struct Outcome {
  size_t checked = 0;  ///< numbers that were compared
  std::string wrong;   ///< the first that differ
};

/// Holds a rule for letters of these types at random numbers. Where the left side is a number, so must the
/// right one be.
void hold(const Rule& rule, std::span<const Type> types, Outcome& outcome) {
  optimize::Constants constants;
  EGraph graph(constants, 1, 1, 10000);
  Letters letters;
  letters.fill(kNoRef);
  for (size_t i = 0; i < types.size(); ++i)
    letters[i] = graph.add({Op::Input, types[i], ir::Rate::Fragment, 0, 0, {}, static_cast<ir::ValueId>(i)});
  const Ref from = optimize::build(graph, rule.from, letters);
  const Ref to =
      from == kNoRef ? kNoRef : graph.as(graph[from].type, optimize::build(graph, rule.to, letters));
  if (from == kNoRef || to == kNoRef) return;  // such types do not fit, and the rule says nothing of them
  Draw draw(7 + types.size());
  for (int tried = 0; tried < 3000 && outcome.checked < 1000; ++tried) {
    std::vector<ExactVector> values(types.size());
    for (size_t i = 0; i < types.size(); ++i) {
      for (Exact& component : values[i])
        component = Exact(types[i] == Type::Bool ? (draw() > 0 ? 1 : 0) : draw());
    }
    if (!meets(rule, types, values)) continue;
    const ExactVector left = Evaluation(graph, letters, values)(from);
    const ExactVector right = Evaluation(graph, letters, values)(to);
    for (size_t c = 0; c < static_cast<size_t>(ir::componentCount(graph[from].type)); ++c) {
      if (!left[c].finite()) continue;
      ++outcome.checked;
      // What a sum cancels to is small beside its terms.
      if (distance(left[c], right[c]) < kClose || std::abs(left[c].rounded() - right[c].rounded()) < kClose)
        continue;
      if (!outcome.wrong.empty()) continue;
      outcome.wrong = fmt::format("{} => {} gives {} and {} for", rule.left, rule.right, left[c].rounded(),
                                  right[c].rounded());
      for (size_t i = 0; i < values.size(); ++i) outcome.wrong += fmt::format(" {}", values[i][c].rounded());
    }
  }
}

/// For letters of all types: numbers, vectors, truths.
Outcome hold(const Rule& rule) {
  constexpr std::array kTypes{Type::Float, Type::Vec3, Type::Bool};
  const size_t count = lettersOf(rule);
  Outcome all;
  std::vector<Type> types(count);
  size_t ways = 1;
  for (size_t i = 0; i < count; ++i) ways *= kTypes.size();
  for (size_t way = 0; way < ways && all.wrong.empty(); ++way) {
    size_t rest = way;
    for (Type& type : types) type = kTypes[rest % kTypes.size()], rest /= kTypes.size();
    Outcome one;
    hold(rule, types, one);
    all.checked += one.checked;
    all.wrong = one.wrong;
  }
  return all;
}

TEST(Rules, EachHoldsInExactArithmetic) {
  for (const Rule& rule : optimize::rules()) {
    const Outcome outcome = hold(rule);
    EXPECT_EQ(outcome.wrong, "") << rule.name;
    EXPECT_GE(outcome.checked, 300U) << rule.name;
  }
}

TEST(Rules, AWrongOneIsFound) {
  const struct {
    const char *from, *to, *conditions;
  } wrong[] = {{"a * (b + c)", "a * b + c", ""},
               {"sqrt(a * a)", "a", ""},
               {"sqrt(a)", "a * inversesqrt(a)", "a >= 0"},
               {"max(a, b) * c", "max(a * c, b * c)", ""},
               {"b * dot(a, c)", "dot(a * b, c)", ""},
               {"clamp(a, b, c)", "min(max(a, c), b)", ""},
               {"exp2(a + b)", "exp2(a) + exp2(b)", ""},
               {"a - b", "b - a", ""}};
  for (const auto& [from, to, conditions] : wrong)
    EXPECT_NE(hold(optimize::ruleOf("wrong", from, to, conditions, "")).wrong, "") << from << " => " << to;
}

TEST(Rules, NamesAreTold) {
  std::set<std::string_view> names;
  for (const Rule& rule : optimize::rules()) EXPECT_TRUE(names.insert(rule.name).second) << rule.name;
  for (const optimize::CodedRule& rule : optimize::codedRules())
    EXPECT_TRUE(names.insert(rule.name).second) << rule.name;
}

}  // namespace
}  // namespace lacquer::test::rules_test
