// Tokens to declarations. Names stay unresolved and types unchecked: see checker.h.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lang/ast.h"
#include "lang/forms.h"
#include "lang/lexer.h"
#include "lang/model_decl.h"
#include "lang/reporter.h"

namespace lacquer::lang {

/// The deepest nesting of expressions, and of statements, that is accepted: everything after recurses.
inline constexpr uint32_t kDeepest = 256;

class Parser {
public:
  /// Parses one declaration, which is text[begin, end). What is wrong goes to the reporter; after an error in
  /// a statement it goes on with the next.
  /// `bindings`: what names of types stand for in a form of a node.
  Parser(Reporter& reporter, uint32_t begin, uint32_t end, TypeBindings bindings = {});

  ConstDecl constant();
  NodeDecl node();
  /// The same without its body and variants.
  NodeDecl nodeHead();
  TemplateDecl templateDecl();
  ExtensionDecl extension();
  PartDecl part();
  ProfileDecl profile();
  LayersDecl layers();
  SwitchDecl switchDecl();

  /// Every name that is read as a value, and every name that is called: some are of other declarations.
  const std::vector<std::string_view>& namesRead() const { return names_read_; }
  const std::vector<std::string_view>& namesCalled() const { return names_called_; }

private:
  // parser.cpp: declarations
  void dropStrayDocs();
  void docs(std::string& doc, std::string* source, std::string* category = nullptr);
  void end();
  Param param(bool named);
  RangeSyntax range();
  ExprPtr bound();
  void params(NodeDecl& node);
  bool choicesOf(Param& param);
  bool byDefault(Param& param);
  bool hints(Hints& hints);
  void results(NodeDecl& node);
  std::string_view proseBehind() const;
  bool templateItem(TemplateDecl& decl);
  bool attribute(TemplateDecl& decl);
  bool block(TemplateDecl& decl);
  bool blockFields(BlockDecl& block);
  bool blockField(BlockDecl& block);
  bool extendedBlock(TemplateDecl& decl);
  bool lightKind(TemplateDecl& decl);
  bool lightLists(TemplateDecl& decl);
  bool given(TemplateDecl& decl);
  bool port(TemplateDecl& decl);
  bool output(TemplateDecl& decl);

  // parse_model.cpp
  bool dottedName(std::string_view& out, Span& span, std::string_view what);
  bool names(std::vector<std::string_view>& out, std::string_view what);
  bool string(std::string_view& out, std::string_view what);
  template <class Item>
  void braces(std::string_view after, Item item);
  bool extensionItem(ExtensionDecl& decl);
  bool property(std::vector<PropertyDecl>& out);
  bool role(PropertyDecl& item);
  bool texture(PropertyDecl& item);
  bool choice(PropertyDecl& item);
  bool termConditions(TermDecl& term);
  bool partItem(PartDecl& decl, uint32_t term, std::string_view& section);
  bool line(LineDecl& line);
  bool alternatives(LineDecl& line);
  bool require(LineDecl& line);

  // parse_statement.cpp
  bool body(std::vector<Statement>& statements);
  bool statement(std::vector<Statement>& statements);
  bool local(Statement& out);
  bool assignment(Statement& out);
  bool ifStatement(Statement& out);
  bool forStatement(Statement& out);
  bool returnStatement(Statement& out);
  bool assumeStatement(Statement& out);
  bool returnsSeveral() const;
  void skipStatement();

  // parse_expression.cpp
  ExprPtr expression();
  ExprPtr conditional();
  ExprPtr binary(int least);
  ExprPtr unary();
  ExprPtr postfix();
  ExprPtr primary();
  ExprPtr call(std::string_view name, Expr::Kind kind);
  bool namesForm() const;
  bool form(std::vector<ir::Type>& types);
  ExprPtr make(Expr::Kind kind, uint32_t begin, std::string_view name, std::vector<ExprPtr> args = {});

  // tokens
  const Token& token(size_t ahead = 0) const { return tokens_[std::min(at_ + ahead, tokens_.size() - 1)]; }
  const Token& last() const { return tokens_[at_ == 0 ? 0 : at_ - 1]; }
  bool is(std::string_view symbol) const { return token().is(symbol); }
  bool accept(std::string_view symbol);
  bool expect(std::string_view symbol, std::string_view after);
  bool name(std::string_view& out, Span& span, std::string_view what);
  bool type(ir::Type& out, std::string_view what);
  std::optional<ir::Type> typeOf(std::string_view word) const;
  bool isType() const { return token().kind == Token::Kind::Name && typeOf(token().text).has_value(); }
  bool isName(const Token& token) const;
  bool isValueName() const;
  bool skipForms();
  /// From a token's offset to the last token consumed.
  Span since(uint32_t begin) const;
  bool syntax(std::string message, std::string help = {});
  bool single();
  bool tooDeep();
  bool unclosed(Span open);
  bool abort();

  Reporter& reporter_;
  TypeBindings bindings_;
  std::vector<Token> tokens_;
  size_t at_ = 0;
  uint32_t nesting_ = 0;
  bool aborted_ = false;
  std::vector<std::string_view> names_read_, names_called_;
};

/// "float" and so on; nothing for another word.
std::optional<ir::Type> findType(std::string_view name);

/// Words that cannot be names.
bool isReserved(std::string_view name);

}  // namespace lacquer::lang
