#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "lang/parser.h"

namespace lacquer::lang {

/// `{ ... }`. False when the end was not found.
bool Parser::body(std::vector<Statement>& statements) {
  if (nesting_ >= kDeepest) return tooDeep();
  const Span open = token().span;
  if (!is("{")) return syntax("expected '{'", "braces stand around a body of one statement, too");
  accept("{");
  ++nesting_;
  while (!is("}")) {
    if (token().kind == Token::Kind::End) return unclosed(open);
    if (!statement(statements)) skipStatement();
  }
  --nesting_;
  accept("}");
  return true;
}

/// To behind the next `;`, or behind a whole `{ ... }`, or before the `}` that ends the block.
void Parser::skipStatement() {
  uint32_t depth = 0;
  while (token().kind != Token::Kind::End) {
    if (is("{")) ++depth;
    if (is("}")) {
      if (depth == 0) return;
      --depth;
      if (depth == 0) {
        ++at_;
        if (!is("else")) return;
        continue;
      }
    }
    const bool done = is(";") && depth == 0;
    ++at_;
    if (done) return;
  }
}

bool Parser::statement(std::vector<Statement>& statements) {
  Statement out;
  const uint32_t begin = token().span.offset;
  bool good = false;
  // A local may be called as a statement begins.
  constexpr std::string_view kAssigns[] = {"=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>="};
  const bool assigns = isName(token()) && std::any_of(std::begin(kAssigns), std::end(kAssigns),
                                                      [&](std::string_view op) { return token(1).is(op); });
  if (assigns) {
    good = assignment(out);
  } else if (is("let") || isType()) {
    good = local(out);
  } else if (is("if")) {
    good = ifStatement(out);
  } else if (is("for")) {
    good = forStatement(out);
  } else if (is("return")) {
    good = returnStatement(out);
  } else if (is("assume")) {
    good = assumeStatement(out);
  } else if (isName(token()) && !is("else")) {
    good = assignment(out);
  } else {
    return syntax("expected a statement", is("else") ? "'else' follows the '}' of an 'if'" : "");
  }
  if (!good) return false;
  out.span = since(begin);
  statements.push_back(std::move(out));
  return true;
}

bool Parser::local(Statement& out) {
  out.kind = Statement::Kind::Let;
  out.inferred = accept("let");
  if (!out.inferred && !(type(out.type, "a type") && single())) return false;
  if (!name(out.name, out.name_span, "a name for the local") || !single()) return false;
  if (!is("=")) {
    return syntax(fmt::format("expected '=' and the value of '{}'", out.name),
                  "every local has a value from the start");
  }
  accept("=");
  ExprPtr value = expression();
  if (!value) return false;
  out.values.push_back(std::move(value));
  if (is(","))
    return syntax("a statement declares one local", "end it by ';', and give the next one its own type");
  return expect(";", "the value");
}

bool Parser::assignment(Statement& out) {
  for (const std::string_view word : {"while", "do", "switch", "break", "continue", "discard"}) {
    if (is(word))
      return syntax(fmt::format("there is no '{}'", word),
                    "there are 'let', 'if', 'for', 'return' and 'assume'");
  }
  if (is("const") && token(1).kind == Token::Kind::Name)
    return syntax("there is no 'const' in a body",
                  "a local that nothing assigns is one; constants of a file stand outside of nodes");
  out.kind = Statement::Kind::Assign;
  const Token target = token();
  ++at_;
  out.name = target.text;
  out.name_span = target.span;
  const Token& op = token();
  constexpr std::string_view kCompound[] = {"+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>="};
  const bool compound = std::any_of(std::begin(kCompound), std::end(kCompound),
                                    [&](std::string_view spelling) { return op.is(spelling); });
  if (op.is("(") || op.is("::")) {
    return syntax("a call alone does nothing",
                  "everything is pure: name the result, `let x = " + std::string(target.text) + "(...);`");
  }
  if (op.is(".")) {
    return syntax("a component cannot be assigned alone",
                  fmt::format("assign the whole, `{0} = vec3({0}.x, ...);`", target.text));
  }
  if (op.is("++") || op.is("--")) {
    return syntax(fmt::format("there is no '{}' here", op.text),
                  fmt::format("write `{} {}= 1;`", target.text, op.text[0]));
  }
  if (op.kind == Token::Kind::Name && token(1).is("=")) {
    --at_;
    return type(out.type, "a type");  // which it is not
  }
  if (!compound && !op.is("=")) return syntax(fmt::format("expected '=' behind '{}'", target.text));
  ++at_;
  ExprPtr value = expression();
  if (!value) return false;
  if (compound) {
    // `x op= e` is `x = x op e`; that it reads x does not make x used (see Checker::assign).
    out.inferred = true;
    auto self = std::make_unique<Expr>();
    self->kind = Expr::Kind::Name;
    self->name = target.text;
    self->span = target.span;
    std::vector<ExprPtr> args;
    args.push_back(std::move(self));
    args.push_back(std::move(value));
    value = make(Expr::Kind::Operation, target.span.offset, op.text.substr(0, op.text.size() - 1),
                 std::move(args));
    if (!value) return false;
  }
  out.values.push_back(std::move(value));
  return expect(";", "the value");
}

bool Parser::ifStatement(Statement& out) {
  out.kind = Statement::Kind::If;
  accept("if");
  if (!expect("(", "'if'")) return false;
  ExprPtr condition = expression();
  if (!condition || !expect(")", "the condition")) return false;
  out.values.push_back(std::move(condition));
  if (!body(out.body)) return false;
  if (!accept("else")) return true;
  if (!is("if")) return body(out.otherwise);
  if (nesting_ >= kDeepest) return tooDeep();
  ++nesting_;
  const bool good = statement(out.otherwise);
  --nesting_;
  return good;
}

/// `for (int i = FIRST; i < LAST; ++i) { ... }`
bool Parser::forStatement(Statement& out) {
  constexpr std::string_view kForm = "a loop is `for (int i = 0; i < COUNT; ++i) { ... }`";
  out.kind = Statement::Kind::For;
  accept("for");
  const auto wants = [&](std::string_view what) {
    if (accept(what)) return true;
    syntax(fmt::format("expected '{}'", what), std::string(kForm));
    // Its semicolons do not end the statement.
    while (token().kind != Token::Kind::End && !is("{") && !is("}")) ++at_;
    return false;
  };
  if (!wants("(") || !wants("int")) return false;
  if (!name(out.name, out.name_span, "the name of the counter")) return false;
  if (!wants("=")) return false;
  ExprPtr first = expression();
  if (!first || !wants(";") || !wants(out.name)) return false;
  const bool inclusive = accept("<=");
  if (!inclusive && !wants("<")) return false;
  ExprPtr last = expression();
  if (!last || !wants(";")) return false;
  if (accept("++")) {
    if (!wants(out.name)) return false;
  } else if (!wants(out.name) || !wants("++")) {
    return false;
  }
  if (!wants(")")) return false;
  out.inclusive = inclusive;
  out.values.push_back(std::move(first));
  out.values.push_back(std::move(last));
  return body(out.body);
}

/// At `(`: whether a comma stands directly inside these parentheses.
bool Parser::returnsSeveral() const {
  if (!is("(")) return false;
  int depth = 0;
  for (size_t i = at_; i < tokens_.size(); ++i) {
    const Token& t = tokens_[i];
    if (t.is("(")) ++depth;
    if (t.is(")") && --depth == 0) return false;
    if (t.is(",") && depth == 1) return true;
    if (t.is(";") || t.is("{") || t.is("}")) return false;
  }
  return false;
}

bool Parser::returnStatement(Statement& out) {
  out.kind = Statement::Kind::Return;
  accept("return");
  if (is(";"))
    return syntax("expected a value behind 'return'",
                  "a node is a function of its parameters, and gives a value");
  const bool several = returnsSeveral();
  if (several) accept("(");
  do {
    ExprPtr value = expression();
    if (!value) return false;
    out.values.push_back(std::move(value));
  } while (several && accept(","));
  if (several && !expect(")", "the values")) return false;
  return expect(";", "the value");
}

bool Parser::assumeStatement(Statement& out) {
  out.kind = Statement::Kind::Assume;
  accept("assume");
  if (!expect("(", "'assume'")) return false;
  ExprPtr value = expression();
  if (!value) return false;
  out.values.push_back(std::move(value));
  if (!is("in"))
    return syntax("expected 'in' and a range", "an assumption is `assume(x in [0, 1], \"why it holds\");`");
  out.range_syntax = range();
  if (!out.range_syntax) return false;
  if (!is(","))
    return syntax("expected ',' and the reason", "an assumption is `assume(x in [0, 1], \"why it holds\");`");
  accept(",");
  constexpr std::string_view kWhy = "say why it holds: nothing else checks it";
  if (token().kind != Token::Kind::String) return syntax("expected the reason, in quotes", std::string(kWhy));
  if (trim(token().text).empty()) return syntax("the reason is empty", std::string(kWhy));
  out.reason = token().text;
  ++at_;
  return expect(")", "the reason") && expect(";", "')'");
}

}  // namespace lacquer::lang
