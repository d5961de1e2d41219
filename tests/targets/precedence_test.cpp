// Random expressions are printed, parsed again by the languages' common grammar, and must be the same trees;
// and no pair of parentheses may be dropped without changing the tree.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <optional>
#include <random>

#include "targets/clike.h"
#include "targets/samples.h"

namespace lacquer::targets {

using ir::Op;
using ir::Stage;
using ir::Type;
using ir::ValueId;

namespace {

/// Recursive descent over C's precedences. A tree is written with all its parentheses: "(+ a (* b c))".
class Parser {
public:
  explicit Parser(std::string_view text) : text_(text) {}

  /// Nothing when the text is not one expression.
  std::optional<std::string> run() {
    const std::string tree = ternary();
    skip();
    return failed_ || at_ != text_.size() ? std::nullopt : std::optional(tree);
  }

private:
  void skip() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }
  bool accept(std::string_view token) {
    skip();
    if (!text_.substr(at_).starts_with(token)) return false;
    at_ += token.size();
    return true;
  }
  void expect(std::string_view token) { failed_ |= !accept(token); }

  std::string ternary() {
    const std::string condition = binary(0);
    if (!accept("?")) return condition;
    const std::string yes = ternary();
    expect(":");
    return fmt::format("(?: {} {} {})", condition, yes, ternary());
  }

  std::string binary(size_t level) {
    static const std::vector<std::vector<std::string_view>> kLevels = {{"||"},      {"&&"},     {"=="},
                                                                       {"<=", "<"}, {"+", "-"}, {"*", "/"}};
    if (level == kLevels.size()) return unary();
    std::string left = binary(level + 1);
    for (bool more = true; more;) {
      more = false;
      for (const std::string_view token : kLevels[level]) {
        if (!accept(token)) continue;
        left = fmt::format("({} {} {})", token, left, binary(level + 1));
        more = true;
        break;
      }
    }
    return left;
  }

  std::string unary() {
    if (accept("--")) failed_ = true;
    if (accept("-")) return fmt::format("(- {})", unary());
    if (accept("!")) return fmt::format("(! {})", unary());
    return postfix();
  }

  std::string postfix() {
    std::string tree = primary();
    while (accept(".")) tree = fmt::format("(.{} {})", word(), tree);
    return tree;
  }

  std::string word() {
    skip();
    const size_t begin = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_'))
      ++at_;
    failed_ |= at_ == begin;
    return std::string(text_.substr(begin, at_ - begin));
  }

  std::string primary() {
    if (accept("(")) {
      const std::string inner = ternary();
      expect(")");
      return inner;
    }
    skip();
    if (at_ < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at_]))) {
      std::string number = word();
      if (at_ < text_.size() && text_[at_] == '.') number += '.' + (++at_, word());
      return number;
    }
    std::string name = word();
    if (!accept("(")) return name;
    std::string tree = "(" + name;
    do {
      tree += ' ' + ternary();
      if (failed_) return tree;
    } while (accept(","));
    expect(")");
    return tree + ")";
  }

  std::string_view text_;
  size_t at_ = 0;
  bool failed_ = false;
};

std::string literalTree(double x) {
  const Expression literal = floatLiteral(x);
  return literal.precedence == Precedence::Unary ? fmt::format("(- {})", literal.text.substr(1))
                                                 : literal.text;
}

/// The same tree, from the DAG.
std::string treeOf(const ir::Module& module, const Dialect& dialect, ValueId id) {
  const ir::Dag& dag = module.dag;
  const ir::Value& value = dag[id];
  if (value.op == Op::Input) {
    const ir::Input& input = dag.inputOf(id);
    return fmt::format("(.{} {})", module.blocks[input.block].fields[input.field].name, "frame");
  }
  if (value.op == Op::Constant) {
    if (value.type == Type::Bool) return dag.constantOf(id)[0] != 0 ? "true" : "false";
    if (value.type == Type::Float) return literalTree(dag.constantOf(id)[0]);
    const bool once = dag.isConstant(id, dag.constantOf(id)[0]) && dialect.type(Type::Vec3) == "vec3";
    std::string tree = fmt::format("({}", dialect.type(value.type));
    for (int i = 0; i < (once ? 1 : ir::componentCount(value.type)); ++i) {
      tree += ' ' + literalTree(dag.constantOf(id)[static_cast<size_t>(i)]);
    }
    return tree + ")";
  }
  if (value.op == Op::Swizzle) {
    std::string picks;
    for (int i = 0; i < ir::componentCount(value.type); ++i)
      picks += "xyzw"[ir::swizzleComponent(value.payload, i)];
    return fmt::format("(.{} {})", picks, treeOf(module, dialect, value.args[0]));
  }
  if (value.op == Op::Construct && value.count == 1 && dialect.type(Type::Vec3) == "float3") {
    const std::string picks(static_cast<size_t>(ir::componentCount(value.type)), 'x');
    return fmt::format("(.{} {})", picks, treeOf(module, dialect, value.args[0]));
  }
  const std::string_view head =
      value.op == Op::Construct ? dialect.type(value.type) : dialect.spelling(value.op);
  std::string tree = fmt::format("({}", head);
  for (const ValueId operand : value.operands()) tree += ' ' + treeOf(module, dialect, operand);
  return tree + ")";
}

class RandomTrees {
public:
  explicit RandomTrees(uint32_t seed) : random_(seed) {
    std::vector<std::pair<std::string, Type>> fields;
    for (const char* name : {"a", "b", "c", "d", "e"}) fields.push_back({name, Type::Float});
    for (const char* name : {"u", "v"}) fields.push_back({name, Type::Vec3});
    b.block(ir::BlockRole::Frame, "Frame", "frame", fields);
  }

  Builder b;

  ValueId number(int depth) {
    if (depth == 0)
      return below(4) == 0 ? b.dag().constant(below(5) - 2.5)
                           : b.field(std::string("frame.") + "abcde"[below(5)]);
    switch (below(9)) {
      case 0:
      case 1: return b.dag().add(number(depth - 1), number(depth - 1));
      case 2:
      case 3: return b.dag().sub(number(depth - 1), number(depth - 1));
      case 4: return b.dag().mul(number(depth - 1), number(depth - 1));
      case 5: return b.dag().div(number(depth - 1), number(depth - 1));
      case 6: return b.dag().make(Op::Neg, {number(depth - 1)});
      case 7: return b.dag().make(Op::Select, {truth(depth - 1), number(depth - 1), number(depth - 1)});
      default: break;
    }
    if (below(2) == 0) return b.dag().make(Op::Min, {number(depth - 1), number(depth - 1)});
    return b.dag().component(vector(depth - 1), below(3));
  }

  ValueId truth(int depth) {
    const int kind = depth == 0 ? below(2) : below(6);
    const int next = depth == 0 ? 0 : depth - 1;
    if (kind == 0) return b.dag().make(Op::Less, {number(next), number(next)});
    if (kind == 1) return b.dag().make(Op::LessEqual, {number(next), number(next)});
    if (kind == 2) return b.dag().make(Op::Equal, {number(next), number(next)});
    if (kind == 3) return b.dag().make(Op::And, {truth(next), truth(next)});
    if (kind == 4) return b.dag().make(Op::Or, {truth(next), truth(next)});
    return b.dag().make(Op::Not, {truth(next)});
  }

  ValueId vector(int depth) {
    if (depth == 0) return b.field(below(2) == 0 ? "frame.u" : "frame.v");
    switch (below(6)) {
      case 0: return b.dag().add(vector(depth - 1), vector(depth - 1));
      case 1: return b.dag().sub(vector(depth - 1), number(depth - 1));
      case 2: return b.dag().mul(number(depth - 1), vector(depth - 1));
      case 3: return b.dag().make(Op::Select, {truth(depth - 1), vector(depth - 1), vector(depth - 1)});
      case 4: return b.dag().swizzle(vector(depth - 1), {{2, 0, 1}});
      default: return b.dag().construct(Type::Vec3, {number(depth - 1)});
    }
  }

private:
  int below(int n) { return static_cast<int>(random_() % static_cast<uint32_t>(n)); }
  std::mt19937 random_;
};

/// The text without the parentheses at `open` and its partner; nothing when they are a call's, or stand
/// around a choice within a choice, or `&&` within `||`, where they are for the reader and for compilers that
/// warn.
std::optional<std::string> withoutPair(const std::string& text, size_t open) {
  if (open > 0 && std::isalnum(static_cast<unsigned char>(text[open - 1]))) return std::nullopt;
  int depth = 0;
  size_t close = open;
  bool choice = false, both = false;
  for (;; ++close) {
    depth += text[close] == '(' ? 1 : text[close] == ')' ? -1 : 0;
    choice |= depth == 1 && text[close] == '?';
    both |= depth == 1 && text[close] == '&';
    if (depth == 0) break;
  }
  const bool of_either =
      text.compare(close + 1, 3, " ||") == 0 || (open >= 3 && text.substr(open - 3, 3) == "|| ");
  if (both && of_either) return std::nullopt;
  if (choice && open >= 2 && text.substr(open - 2, 2) == "? ") return std::nullopt;
  std::string result = text;
  result[open] = ' ';
  result[close] = ' ';
  return result;
}

std::string printExpression(const Dialect& dialect, const ir::Module& module, ValueId value) {
  constexpr size_t kAll = 1 << 30;
  return printExpressions(dialect, module, {{value}}, kAll)[0];
}

void expectSameTrees(const Dialect& dialect) {
  int parentheses = 0;
  for (uint32_t seed = 0; seed < 3000; ++seed) {
    RandomTrees trees(seed);
    const ValueId x = trees.number(1 + static_cast<int>(seed % 6));
    const ValueId out = trees.b.dag().construct(Type::Vec4, {x, trees.b.field("frame.u")});
    const std::string text = printExpression(dialect, trees.b.module, out);
    const std::string tree = treeOf(trees.b.module, dialect, out);
    ASSERT_EQ(Parser(text).run(), tree) << text;
    for (size_t at = 0; at < text.size(); ++at) {
      if (text[at] != '(') continue;
      const auto bare = withoutPair(text, at);
      if (!bare) continue;
      ++parentheses;
      ASSERT_NE(Parser(*bare).run(), tree) << "needless at " << at << ": " << text;
    }
  }
  EXPECT_GT(parentheses, 5000) << "the trees are too simple to show anything";
}

}  // namespace

TEST(Precedence, GlslReadsBackAsTheSameTree) { expectSameTrees(glslVulkan()); }
TEST(Precedence, HlslReadsBackAsTheSameTree) { expectSameTrees(hlsl()); }

TEST(Precedence, CompilersAcceptTheTrees) {
  for (uint32_t seed = 0; seed < 12; ++seed) {
    RandomTrees trees(seed + 100000);
    ValueId total = trees.b.field("frame.u");
    for (int k = 0; k < 20; ++k) total = trees.b.dag().add(total, trees.vector(4));
    trees.b.color("color", trees.b.dag().construct(Type::Vec4, {total, trees.number(4)}));
    for (const Target target : kTextTargets) {
      expectCompiles(print(trees.b.module, Stage::Fragment, target), Stage::Fragment, target);
    }
  }
}

TEST(Precedence, TheCommonCases) {
  Builder b;
  b.block(ir::BlockRole::Frame, "Frame", "frame",
          {{"a", Type::Float}, {"b", Type::Float}, {"c", Type::Float}, {"v", Type::Vec3}});
  ir::Dag& dag = b.dag();
  const ValueId x = b.field("frame.a");
  const ValueId y = b.field("frame.b");
  const ValueId z = b.field("frame.c");
  const auto text = [&](ValueId id) { return expressionTexts(b.module, {{id}})[0]; };
  EXPECT_EQ(text(dag.sub(x, dag.sub(y, z))), "frame.a - (frame.b - frame.c)");
  EXPECT_EQ(text(dag.sub(dag.sub(x, y), z)), "frame.a - frame.b - frame.c");
  EXPECT_EQ(text(dag.div(x, dag.mul(y, z))), "frame.a / (frame.b * frame.c)");
  EXPECT_EQ(text(dag.mul(dag.add(x, y), z)), "(frame.a + frame.b) * frame.c");
  EXPECT_EQ(text(dag.make(Op::Not, {dag.make(Op::Less, {x, y})})), "!(frame.a < frame.b)");
  EXPECT_EQ(text(dag.mul(x, dag.constant(-2))), "frame.a * -2.0");
  EXPECT_EQ(text(dag.make(Op::Neg, {dag.mul(x, y)})), "-(frame.a * frame.b)");
  EXPECT_EQ(text(dag.construct(Type::Vec3, {dag.add(x, y)})), "vec3(frame.a + frame.b)");
  EXPECT_EQ(printExpression(hlsl(), b.module, dag.construct(Type::Vec3, {dag.add(x, y)})),
            "(frame.a + frame.b).xxx");
  EXPECT_EQ(printExpression(hlsl(), b.module, dag.construct(Type::Vec3, {x})), "frame.a.xxx");
  EXPECT_EQ(printExpression(hlsl(), b.module, dag.make(Op::Sign, {x})), "float(sign(frame.a))");
  EXPECT_EQ(text(dag.constant(Type::Vec3, {0.5, 0.5, 0.5})), "vec3(0.5)");
  EXPECT_EQ(text(dag.constant(Type::Vec2, {0.5, -1})), "vec2(0.5, -1.0)");
  const ValueId factor =
      dag.input({ir::InputKind::Parameter, "coat_ior", Type::Float, ir::Rate::Material, {}, 0, 0});
  EXPECT_EQ(text(dag.sub(factor, dag.constant(1))), "coat_ior - 1.0");
  EXPECT_EQ(printExpression(hlsl(), b.module, dag.constant(Type::Vec2, {1, 1})), "float2(1.0, 1.0)");
}

TEST(Precedence, WhatDoublesIsCutShort) {
  Builder b;
  b.block(ir::BlockRole::Frame, "Frame", "frame", {{"a", Type::Float}});
  ir::Dag& dag = b.dag();
  ValueId x = b.field("frame.a");
  for (int i = 0; i < 100; ++i) x = dag.mul(x, dag.add(x, dag.constant(1)));
  EXPECT_EQ(printExpressions(glslVulkan(), b.module, {{x, b.field("frame.a")}}, 30),
            (std::vector<std::string>{"frame.a * (frame.a + 1.0) * (f…", "frame.a"}));
  const ValueId sum = dag.make(Op::SumOverLights, {x});
  EXPECT_EQ(printExpressions(glslVulkan(), b.module, {{sum}}, 30)[0], "sum_over_lights(frame.a * (fra…");
}

}  // namespace lacquer::targets
