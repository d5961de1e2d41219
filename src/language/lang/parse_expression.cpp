#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "lang/parser.h"
#include "lang/suggest.h"
#include "lang/words.h"

namespace lacquer::lang {

ExprPtr Parser::make(Expr::Kind kind, uint32_t begin, std::string_view name, std::vector<ExprPtr> args) {
  auto expr = std::make_unique<Expr>();
  expr->kind = kind;
  expr->span = since(begin);
  expr->name = name;
  expr->args = std::move(args);
  for (const ExprPtr& arg : expr->args) expr->depth = std::max<uint16_t>(expr->depth, arg->depth + 1);
  if (expr->depth <= kDeepest) return expr;
  tooDeep();
  return nullptr;
}

ExprPtr Parser::expression() {
  if (nesting_ >= kDeepest) {
    tooDeep();
    return nullptr;
  }
  ++nesting_;
  ExprPtr result = conditional();
  --nesting_;
  return result;
}

ExprPtr Parser::conditional() {
  const uint32_t begin = token().span.offset;
  ExprPtr condition = binary(1);
  if (!condition || !is("?")) return condition;
  accept("?");
  ExprPtr yes = expression();
  if (!yes || !expect(":", "the value of '?:' where the condition holds")) return nullptr;
  ExprPtr no = expression();
  if (!no) return nullptr;
  std::vector<ExprPtr> args;
  args.reserve(3);
  args.push_back(std::move(condition));
  args.push_back(std::move(yes));
  args.push_back(std::move(no));
  return make(Expr::Kind::Select, begin, "?:", std::move(args));
}

namespace {

int precedence(const Token& token) {
  constexpr std::string_view kSingle = "|^&<>+-*/%";
  constexpr std::array kLevels = {3, 4, 5, 7, 7, 9, 9, 10, 10, 10};
  constexpr std::array<std::pair<std::string_view, int>, 8> kPairs = {
      {{"||", 1}, {"&&", 2}, {"==", 6}, {"!=", 6}, {"<=", 7}, {">=", 7}, {"<<", 8}, {">>", 8}}};
  if (token.kind != Token::Kind::Symbol) return 0;
  if (token.text.size() == 1) {
    const size_t place = kSingle.find(token.text[0]);
    return place == std::string_view::npos ? 0 : kLevels[place];
  }
  const auto found =
      std::find_if(kPairs.begin(), kPairs.end(), [&](const auto& row) { return token.is(row.first); });
  return found == kPairs.end() ? 0 : found->second;
}

std::vector<ExprPtr> list(ExprPtr a, ExprPtr b = nullptr) {
  std::vector<ExprPtr> args;
  args.reserve(b ? 2 : 1);
  args.push_back(std::move(a));
  if (b) args.push_back(std::move(b));
  return args;
}

}  // namespace

ExprPtr Parser::binary(int least) {
  const uint32_t begin = token().span.offset;
  ExprPtr left = unary();
  while (left) {
    const Token& op = token();
    const int level = precedence(op);
    if (level == 0 || level < least) return left;
    ++at_;
    ExprPtr right = binary(level + 1);
    if (!right) return nullptr;
    left = make(Expr::Kind::Operation, begin, op.text, list(std::move(left), std::move(right)));
  }
  return left;
}

ExprPtr Parser::unary() {
  const Token& op = token();
  constexpr std::string_view kSigns = "-+!~";
  const bool sign = op.kind == Token::Kind::Symbol && op.text.size() == 1 &&
                    kSigns.find(op.text[0]) != std::string_view::npos;
  if (!sign) return postfix();
  if (nesting_ >= kDeepest) {
    tooDeep();
    return nullptr;
  }
  ++at_;
  ++nesting_;
  ExprPtr operand = unary();
  --nesting_;
  if (!operand) return nullptr;
  return make(Expr::Kind::Operation, op.span.offset, op.text, list(std::move(operand)));
}

ExprPtr Parser::postfix() {
  const uint32_t begin = token().span.offset;
  ExprPtr expr = primary();
  while (expr && (is(".") || is("["))) {
    if (accept("[")) {
      ExprPtr place = expression();
      if (!place || !expect("]", "the index")) return nullptr;
      expr = make(Expr::Kind::Index, begin, {}, list(std::move(expr), std::move(place)));
      continue;
    }
    ++at_;
    if (token().kind != Token::Kind::Name) {
      syntax("expected components or a field behind '.'");
      return nullptr;
    }
    const std::string_view member = token().text;
    ++at_;
    expr = make(Expr::Kind::Member, begin, member, list(std::move(expr)));
  }
  return expr;
}

/// A name as a value. A word that begins a statement is one only where an operator, or an end, follows.
bool Parser::isValueName() const {
  const Token& first = token();
  if (!isName(first)) return false;
  if (std::find(std::begin(kBodyWords), std::end(kBodyWords), first.text) == std::end(kBodyWords))
    return true;
  return token(1).kind == Token::Kind::Symbol && !token(1).is("(") && !token(1).is("{") && !token(1).is("!");
}

ExprPtr Parser::primary() {
  const Token& first = token();
  const uint32_t begin = first.span.offset;
  if (first.kind == Token::Kind::Number) {
    ++at_;
    ExprPtr literal = make(Expr::Kind::Literal, begin, first.text);
    literal->number = first.number;
    literal->untyped = first.integer && !first.without_sign;
    literal->type = first.without_sign ? ir::Type::UInt : first.integer ? ir::Type::Int : ir::Type::Float;
    return literal;
  }
  if (first.is("true") || first.is("false")) {
    ++at_;
    ExprPtr literal = make(Expr::Kind::Literal, begin, first.text);
    literal->number = first.text == "true" ? 1 : 0;
    literal->type = ir::Type::Bool;
    return literal;
  }
  if (accept("(")) {
    ExprPtr inner = expression();
    if (!inner || !expect(")", "the expression")) return nullptr;
    return inner;
  }
  if (isType()) {
    ++at_;
    if (!is("(")) {
      syntax(fmt::format("expected '(' behind the type '{}'", first.text),
             "a value of it is made by " + std::string(first.text) + "(...)");
      return nullptr;
    }
    return call(first.text, Expr::Kind::Construct);
  }
  if (isValueName()) {
    ++at_;
    std::vector<ir::Type> types;
    if (!form(types)) return nullptr;
    if (is("(") || is("::")) {
      names_called_.push_back(first.text);
      ExprPtr called = call(first.text, Expr::Kind::Call);
      if (called) {
        called->span = since(begin);
        called->form = std::move(types);
      }
      return called;
    }
    names_read_.push_back(first.text);
    return make(Expr::Kind::Name, begin, first.text);
  }
  syntax("expected an expression", first.is("inf") ? "'inf' is a bound of a range, not a number"
                                   : first.is("{")
                                       ? "a value is made of its parts by its type, `vec3(1, 2, 3)`"
                                       : "");
  return nullptr;
}

/// Behind a name: whether types in angle brackets follow that name a form of a node, and no comparison.
bool Parser::namesForm() const {
  if (!is("<")) return false;
  bool typed = false;
  size_t at = 1;
  for (;; at += 2) {
    if (token(at).kind != Token::Kind::Name) return false;
    typed = typed || typeOf(token(at).text);
    if (token(at + 1).is(">")) break;
    if (!token(at + 1).is(",")) return false;
  }
  if (!token(at + 2).is("(") && !token(at + 2).is("::")) return false;
  return typed || (at == 1 && !typeElsewhere(token(at).text).empty());
}

bool Parser::form(std::vector<ir::Type>& types) {
  if (!namesForm()) return true;
  do {
    ++at_;  // '<' or ','
    if (!type(types.emplace_back(), "a type")) return false;
  } while (is(","));
  return expect(">", "the types");
}

ExprPtr Parser::call(std::string_view name, Expr::Kind kind) {
  const uint32_t begin = last().span.offset;
  std::string_view variant;
  if (accept("::")) {
    Span ignored;
    if (!this->name(variant, ignored, "a variant's name behind '::'")) return nullptr;
  }
  if (!expect("(", "the name of what is called")) return nullptr;
  std::vector<ExprPtr> args;
  std::vector<std::string_view> labels;
  while (!is(")")) {
    if (!args.empty() && !expect(",", "an argument")) return nullptr;
    std::string_view label;
    if (token().kind == Token::Kind::Name && token(1).is("=")) {
      label = token().text;
      at_ += 2;
    }
    ExprPtr arg = expression();
    if (!arg) return nullptr;
    args.push_back(std::move(arg));
    labels.push_back(label);
  }
  accept(")");
  ExprPtr expr = make(kind, begin, name, std::move(args));
  if (!expr) return nullptr;
  if (kind == Expr::Kind::Construct) expr->type = *typeOf(name);
  expr->variant = variant;
  expr->labels = std::move(labels);
  return expr;
}

}  // namespace lacquer::lang
