#include "lang/parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "lang/suggest.h"
#include "lang/words.h"

namespace lacquer::lang {

namespace {

/// The types by the lengths of their names: rows of one length lie beside each other.
struct TypeNames {
  static constexpr size_t kLongest = 16;
  struct Row {
    std::string_view name;
    ir::Type type;
  };
  std::array<Row, ir::kTypes.size()> rows{};
  std::array<uint8_t, kLongest + 2> first{};  ///< of the names of a length

  TypeNames() {
    for (size_t i = 0; i < rows.size(); ++i) rows[i] = {ir::typeName(ir::kTypes[i]), ir::kTypes[i]};
    std::stable_sort(rows.begin(), rows.end(),
                     [](const Row& a, const Row& b) { return a.name.size() < b.name.size(); });
    for (const Row& row : rows) {
      for (size_t length = row.name.size() + 1; length < first.size(); ++length) ++first[length];
    }
  }
};

}  // namespace

std::optional<ir::Type> findType(std::string_view name) {
  static const TypeNames kNames;
  if (name.empty() || name.size() > TypeNames::kLongest) return std::nullopt;
  for (size_t i = kNames.first[name.size()]; i < kNames.first[name.size() + 1]; ++i) {
    const TypeNames::Row& row = kNames.rows[i];
    if (row.name[0] == name[0] && row.name == name) return row.type;
  }
  return std::nullopt;
}

bool isReserved(std::string_view name) {
  return std::find(std::begin(kValueWords), std::end(kValueWords), name) != std::end(kValueWords) ||
         findType(name).has_value();
}

Parser::Parser(Reporter& reporter, uint32_t begin, uint32_t end, TypeBindings bindings)
    : reporter_(reporter), bindings_(std::move(bindings)), tokens_(tokenize(reporter, begin, end)) {
  dropStrayDocs();
}

/// Doc lines belong before the declaration and before its variants. Elsewhere they would be lost without a
/// word.
void Parser::dropStrayDocs() {
  const auto isDoc = [](const Token& token) { return token.kind == Token::Kind::Doc; };
  const auto declared = std::find_if_not(tokens_.begin(), tokens_.end(), isDoc);
  if (std::none_of(declared, tokens_.end(), isDoc)) return;
  std::vector<Token> kept;
  kept.reserve(tokens_.size());
  bool leading = true;
  for (size_t i = 0; i < tokens_.size(); ++i) {
    const bool doc = tokens_[i].kind == Token::Kind::Doc;
    leading = leading && doc;
    if (doc && !leading) {
      size_t next = i;
      while (tokens_[next].kind == Token::Kind::Doc) ++next;
      if (!tokens_[next].is("variant")) {
        reporter_.error("misplaced-doc", tokens_[i].span, "this doc line documents nothing",
                        "'///' goes before a declaration or a variant; use '//' here");
        continue;
      }
    }
    kept.push_back(tokens_[i]);
  }
  tokens_ = std::move(kept);
}

bool Parser::accept(std::string_view symbol) {
  if (!is(symbol)) return false;
  ++at_;
  return true;
}

namespace {

std::string shown(const Token& token) {
  switch (token.kind) {
    case Token::Kind::End: return "the end";
    case Token::Kind::String: return "a string";
    case Token::Kind::Doc: return "a doc line";
    case Token::Kind::Name:
    case Token::Kind::Number:
    case Token::Kind::Symbol: break;
  }
  return fmt::format("'{}'", token.text.substr(0, 40));
}

}  // namespace

bool Parser::expect(std::string_view symbol, std::string_view after) {
  if (accept(symbol)) return true;
  // A missing end of something is best shown where it should have been.
  if (aborted_) return false;
  const Span before = last().span;
  const bool closes = at_ > 0 && (symbol == ";" || symbol == ")" || symbol == "]" || symbol == ",");
  const Span place = closes ? Span{before.offset + before.length, 1} : token().span;
  reporter_.error("syntax", place,
                  fmt::format("expected '{}' after {}, got {}", symbol, after, shown(token())));
  return false;
}

bool Parser::syntax(std::string message, std::string help) {
  if (aborted_) return false;
  const bool says_what = message.starts_with("expected");
  if (says_what) message += fmt::format(", got {}", shown(token()));
  reporter_.error("syntax", token().span, std::move(message), std::move(help));
  return false;
}

/// False, and an error, where a name or a type is followed by the number of an array's elements.
bool Parser::single() {
  if (!is("[")) return true;
  return syntax(
      "there are no arrays",
      "take a vector or a matrix, whose parts are `v[i]` and `m[i]`, or a name for each value and `?:`; "
      "a loop carries locals from round to round");
}

bool Parser::tooDeep() {
  if (!aborted_) {
    reporter_.error("too-deep", token().span, fmt::format("this nests deeper than {} levels", kDeepest),
                    "name parts of it");
  }
  return abort();
}

bool Parser::unclosed(Span open) {
  if (!aborted_) reporter_.error("syntax", open, "this '{' has no '}'");
  return abort();
}

/// What would follow is not worth reading.
bool Parser::abort() {
  aborted_ = true;
  at_ = tokens_.size() - 1;
  return false;
}

bool Parser::name(std::string_view& out, Span& span, std::string_view what) {
  const Token& t = token();
  if (t.kind != Token::Kind::Name) return syntax(fmt::format("expected {}", what));
  // The range of what has no name.
  const bool range = t.is("in") && token(1).is("[");
  if (!isName(t) || range)
    return syntax(fmt::format("expected {}", what), fmt::format("'{}' is a word of the language", t.text));
  out = t.text;
  span = t.span;
  ++at_;
  return true;
}

std::optional<ir::Type> Parser::typeOf(std::string_view word) const {
  for (const auto& [variable, type] : bindings_) {
    if (variable == word) return type;
  }
  return findType(word);
}

/// Words of statements and declarations are names where only a name can stand.
bool Parser::isName(const Token& token) const {
  return token.kind == Token::Kind::Name && !isReserved(token.text) && !typeOf(token.text);
}

bool Parser::type(ir::Type& out, std::string_view what) {
  if (!isType()) {
    const bool unknown = token().kind == Token::Kind::Name && !isReserved(token().text);
    if (unknown) {
      const std::string_view here = typeElsewhere(token().text);
      reporter_.error("unknown-type", token().span, fmt::format("there is no type '{}'", token().text),
                      !here.empty()
                          ? fmt::format("it is called {} here", here)
                          : "types are bool, int, uint and float, their vectors (bvec2, ivec2, uvec2, vec2 "
                            "and so on), mat3, "
                            "mat4, sampler2D, samplerCube, sampler2DShadow, sampler2DArray and sampler3D");
      return false;
    }
    return syntax(fmt::format("expected {}", what));
  }
  out = *typeOf(token().text);
  ++at_;
  return true;
}

Span Parser::since(uint32_t begin) const {
  const Span end = last().span;
  return {begin, std::max(end.offset + end.length, begin + 1) - begin};
}

void Parser::docs(std::string& doc, std::string* source, std::string* category) {
  constexpr std::string_view kSource = "source:", kCategory = "category:";
  for (; token().kind == Token::Kind::Doc; ++at_) {
    std::string_view line = token().text;
    if (source != nullptr && trim(line).starts_with(kSource)) {
      const std::string_view text = trim(trim(line).substr(kSource.size()));
      *source += (source->empty() ? "" : "; ") + std::string(text);
    } else if (category != nullptr && trim(line).starts_with(kCategory)) {
      *category = trim(trim(line).substr(kCategory.size()));
    } else {
      doc += (doc.empty() ? "" : "\n") + std::string(line);
    }
  }
  while (!doc.empty() && doc.back() == '\n') doc.pop_back();
}

void Parser::end() {
  if (token().kind == Token::Kind::End) return;
  syntax("expected a declaration", is("}") ? "there is a '}' too many" : "");
}

std::string_view Parser::proseBehind() const { return last().comment; }

ConstDecl Parser::constant() {
  ConstDecl decl;
  docs(decl.doc, nullptr);
  accept("const");
  if (!type(decl.type, "the constant's type") || !single() ||
      !name(decl.name, decl.span, "the constant's name") || !single())
    return decl;
  if (!expect("=", "the constant's name")) return decl;
  decl.syntax = expression();
  if (!decl.syntax || !expect(";", "the constant's value")) return decl;
  if (decl.doc.empty()) decl.doc = proseBehind();
  end();
  return decl;
}

ExprPtr Parser::bound() {
  const uint32_t begin = token().span.offset;
  const bool minus = is("-") && token(1).is("inf");
  if (minus || is("inf")) {
    at_ += minus ? 2 : 1;
    ExprPtr literal = make(Expr::Kind::Literal, begin, "inf");
    literal->number = (minus ? -1 : 1) * std::numeric_limits<double>::infinity();
    return literal;
  }
  return expression();
}

/// `in [lo, hi] [or 0]`; empty after an error, or when there is none.
RangeSyntax Parser::range() {
  RangeSyntax range;
  if (!accept("in")) return range;
  const uint32_t begin = token().span.offset;
  if (!expect("[", "'in'")) return {};
  range.lo = bound();
  if (!range.lo || !expect(",", "the lower bound")) return {};
  range.hi = bound();
  if (!range.hi || !expect("]", "the upper bound")) return {};
  range.span = since(begin);
  if (!accept("or")) return range;
  range.or_zero = token().integer && token().number == 0;
  if (!range.or_zero) {
    syntax("expected 0 after 'or'", "a range may have 0 beside it: `in [1, inf] or 0`");
    return {};
  }
  ++at_;
  return range;
}

/// `TYPE [name] [in [lo, hi] [or 0]]`. The name's absence from the result marks an error.
Param Parser::param(bool named) {
  Param param;
  const uint32_t begin = token().span.offset;
  if (!type(param.type, "a type") || !single()) return param;
  param.span = since(begin);
  if (named && !name(param.name, param.span, "a name")) return param;
  if (!single()) param.name = {};
  if (is("in")) {
    param.range_syntax = range();
    if (!param.range_syntax) param.name = {};
  }
  return param;
}

void Parser::params(NodeDecl& node) {
  while (!is(")")) {
    Param param = this->param(true);
    if (param.name.empty()) return;
    if (accept("of") && !choicesOf(param)) return;
    if (accept("=") && !byDefault(param)) return;
    if (!hints(param.hints)) return;
    const bool more = accept(",");
    param.prose = proseBehind();
    node.params.push_back(std::move(param));
    if (more && is(")")) {
      syntax("expected a parameter");
      return;
    }
    if (!more && !is(")")) {
      expect(",", "a parameter");
      return;
    }
  }
}

/// `of A, B, C`: names of the values 0, 1 and 2. The list ends where another parameter begins.
bool Parser::choicesOf(Param& param) {
  const auto another = [&] { return is(",") && isName(token(1)) && !isName(token(2)) && !token(2).is("["); };
  do {
    Span ignored;
    if (!name(param.choices.emplace_back(), ignored, "the name of a value")) return false;
  } while (another() && accept(","));
  return true;
}

/// `= VALUE`, `= given NAME`, `= given NAME or VALUE`, or of choices `= NAME`.
bool Parser::byDefault(Param& param) {
  if (is("given") && token(1).kind == Token::Kind::Name) {
    ++at_;
    Span span;
    if (!dottedName(param.given, span, "the name of what a template gives")) return false;
    if (!accept("or")) return true;
  }
  const auto choice = std::find(param.choices.begin(), param.choices.end(), token().text);
  if (token().kind == Token::Kind::Name && choice != param.choices.end()) {
    ++at_;
    param.default_syntax = make(Expr::Kind::Literal, last().span.offset, last().text);
    param.default_syntax->untyped = true;
    param.default_syntax->type = ir::Type::Int;
    param.default_syntax->number = static_cast<double>(choice - param.choices.begin());
    return true;
  }
  param.default_syntax = expression();
  return param.default_syntax != nullptr;
}

/// `label "Scale" unit "meter" soft [0, 10] color advanced`, in any order.
bool Parser::hints(Hints& hints) {
  for (;;) {
    if (accept("color")) {
      hints.color = true;
    } else if (accept("advanced")) {
      hints.advanced = true;
    } else if (is("label") || is("unit")) {
      std::string_view& text = is("label") ? hints.label : hints.unit;
      ++at_;
      if (!string(text, "what a tool shows, in quotes")) return false;
    } else if (accept("soft")) {
      const uint32_t begin = token().span.offset;
      if (!expect("[", "'soft'")) return false;
      hints.soft_syntax.lo = expression();
      if (!hints.soft_syntax.lo || !expect(",", "the lower end")) return false;
      hints.soft_syntax.hi = expression();
      if (!hints.soft_syntax.hi || !expect("]", "the upper end")) return false;
      hints.soft_syntax.span = since(begin);
    } else {
      return true;
    }
  }
}

void Parser::results(NodeDecl& node) {
  if (!accept("(")) {
    Param result = param(false);
    node.results.push_back(std::move(result));
    return;
  }
  do {
    Param result = param(true);
    if (result.name.empty()) return;
    result.prose = is(",") ? token().comment : proseBehind();
    node.results.push_back(std::move(result));
  } while (accept(","));
  expect(")", "the results");
}

/// The list behind the name, which the scanner has read (forms.h).
bool Parser::skipForms() {
  if (!accept("<")) return true;
  while (!is(">") && token().kind != Token::Kind::End) ++at_;
  return expect(">", "the types");
}

NodeDecl Parser::nodeHead() {
  NodeDecl decl;
  docs(decl.doc, &decl.source, &decl.category);
  accept("node");
  if (!name(decl.name, decl.span, "the node's name") || !skipForms()) return decl;
  decl.family = decl.name;
  const size_t errors = reporter_.count();
  if (!expect("(", "the node's name")) return decl;
  params(decl);
  if (reporter_.count() != errors || !expect(")", "the parameters")) return decl;
  if (expect("->", "the parameters")) results(decl);
  return decl;
}

NodeDecl Parser::node() {
  const size_t errors = reporter_.count();
  NodeDecl decl = nodeHead();
  if (reporter_.count() != errors || !body(decl.body.statements)) return decl;
  while (is("variant") || token().kind == Token::Kind::Doc) {
    Variant variant;
    docs(variant.doc, nullptr);
    accept("variant");
    if (!name(variant.name, variant.span, "the variant's name")) return decl;
    if (!body(variant.body.statements)) return decl;
    decl.variants.push_back(std::move(variant));
  }
  end();
  return decl;
}

TemplateDecl Parser::templateDecl() {
  TemplateDecl decl;
  docs(decl.doc, nullptr);
  accept("template");
  if (!name(decl.name, decl.span, "the template's name")) return decl;
  if (accept("extends")) {
    Span ignored;
    if (!name(decl.base, ignored, "the name of the template that it extends")) return decl;
  }
  const Span open = token().span;
  if (!expect("{", "the template's name")) return decl;
  while (!is("}")) {
    if (token().kind == Token::Kind::End) {
      unclosed(open);
      return decl;
    }
    if (!templateItem(decl)) skipStatement();
  }
  accept("}");
  end();
  return decl;
}

bool Parser::templateItem(TemplateDecl& decl) {
  if (is("default") && token(1).is(";")) {
    at_ += 2;
    decl.is_default = true;
    return true;
  }
  if (accept("block")) return block(decl);
  if (accept("given")) return given(decl);
  if (accept("port")) return port(decl);
  if (accept("output")) return output(decl);
  if (is("extend") && token(1).is("block")) return extendedBlock(decl);
  if (is("light") && token(1).is("kind")) return lightKind(decl);
  if (is("extend") && token(1).is("light") && token(2).is("kind")) {
    ++at_;
    if (!lightKind(decl)) return false;
    decl.light_kinds.back().extends = true;
    return true;
  }
  if (is("lights") && token(1).is("from")) return lightLists(decl);
  if (is("replace") && token(1).is("output")) {
    at_ += 2;
    if (!output(decl)) return false;
    decl.outputs.back().replaces = true;
    return true;
  }
  if (is("without") && token(1).is("output")) {
    at_ += 2;
    do {
      WithoutDecl& without = decl.without.emplace_back();
      if (!name(without.name, without.span, "the name of the output")) return false;
    } while (accept(","));
    return expect(";", "the output's name");
  }
  if (is("attribute") || is("fact")) return attribute(decl);
  constexpr std::array<std::string_view, 5> kOptional = {"block", "environment", "object", "output",
                                                         "attribute"};
  if (is("late") && token(1).is("optional") && token(2).is("block")) {
    ++at_;
    if (!templateItem(decl)) return false;
    return decl.blocks.back().late = true;
  }
  const std::string_view what = token(1).text;
  if (is("optional") && std::find(kOptional.begin(), kOptional.end(), what) != kOptional.end()) {
    ++at_;
    if (!templateItem(decl)) return false;
    bool& optional = what == "block"       ? decl.blocks.back().optional
                     : what == "output"    ? decl.outputs.back().optional
                     : what == "attribute" ? decl.attributes.back().optional
                                           : decl.environments.back().optional;
    optional = true;
    return true;
  }
  if (is("environment") || is("object")) {
    EnvironmentDecl item;
    item.object = is("object");
    ++at_;
    if (!type(item.type, "the texture's type") || !name(item.name, item.span, "the texture's name"))
      return false;
    if (accept("=")) {
      item.texel_syntax = expression();
      if (!item.texel_syntax) return false;
    }
    if (!expect(";", "the texture's name")) return false;
    item.prose = proseBehind();
    decl.environments.push_back(std::move(item));
    return true;
  }
  return syntax(
      "expected a part of a template",
      "its parts are default, block, extend block, light kind, lights from, attribute, fact, environment, "
      "object, given, "
      "port, output, optional block, late optional block, optional attribute, optional environment, optional "
      "object, optional "
      "output, replace output and without output");
}

/// `attribute TYPE NAME by SWITCH, ...;` or `fact NAME by SWITCH, ...;`
bool Parser::attribute(TemplateDecl& decl) {
  AttributeDecl item;
  item.fact = item.optional = is("fact");
  ++at_;
  if (!item.fact && !type(item.type, "the attribute's type")) return false;
  if (!name(item.name, item.span, item.fact ? "the fact's name" : "the attribute's name")) return false;
  if (accept("by")) {
    do {
      Span ignored;
      if (!name(item.by.emplace_back(), ignored, "the name of the switch")) return false;
    } while (accept(","));
  }
  if (!expect(";", item.fact ? "the fact" : "the attribute")) return false;
  item.prose = proseBehind();
  decl.attributes.push_back(std::move(item));
  return true;
}

bool Parser::block(TemplateDecl& decl) {
  constexpr std::array<std::pair<std::string_view, BlockRole>, 4> kRoles = {{{"frame", BlockRole::Frame},
                                                                             {"lights", BlockRole::Lights},
                                                                             {"object", BlockRole::Object},
                                                                             {"list", BlockRole::List}}};
  BlockDecl item;
  const auto role = std::find_if(kRoles.begin(), kRoles.end(), [&](const auto& r) { return is(r.first); });
  if (role == kRoles.end()) return syntax("expected the block's role", "it is frame, lights, object or list");
  ++at_;
  item.role = role->second;
  if (!name(item.type_name, item.type_span, "the block's type name")) return false;
  if (!name(item.instance, item.span, "the block's own name")) return false;
  if (is("[") && token(1).is("]")) {
    at_ += 2;
    item.endless = true;
  } else if (accept("[")) {
    item.array_syntax = expression();
    if (!item.array_syntax || !expect("]", "the number of elements")) return false;
  }
  if (accept("count")) {
    item.count_syntax = expression();
    if (!item.count_syntax) return false;
  }
  if (!blockFields(item)) return false;
  decl.blocks.push_back(std::move(item));
  return true;
}

bool Parser::extendedBlock(TemplateDecl& decl) {
  at_ += 2;
  BlockDecl item;
  item.extension = true;
  if (!name(item.instance, item.span, "the name of the block that it extends") || !blockFields(item))
    return false;
  decl.blocks.push_back(std::move(item));
  return true;
}

bool Parser::blockFields(BlockDecl& block) {
  const Span open = token().span;
  if (!expect("{", "the block's name")) return false;
  block.prose = proseBehind();
  while (!is("}")) {
    if (token().kind == Token::Kind::End) return unclosed(open);
    if (!blockField(block)) skipStatement();
  }
  accept("}");
  return true;
}

/// `TYPE name [ [elements] ] [in [lo, hi]] [= default];`
bool Parser::blockField(BlockDecl& block) {
  BlockFieldDecl field;
  if (!type(field.type, "a type") || !name(field.name, field.span, "a name")) return false;
  if (accept("[")) {
    field.array_syntax = expression();
    if (!field.array_syntax || !expect("]", "the number of elements")) return false;
  }
  if (is("in")) {
    field.range_syntax = range();
    if (!field.range_syntax) return false;
  }
  if (accept("=")) {
    field.default_syntax = expression();
    if (!field.default_syntax) return false;
  }
  if (!expect(";", "the field")) return false;
  field.prose = proseBehind();
  block.fields.push_back(std::move(field));
  return true;
}

/// `light kind NAME { FIELD = value; ... }`
bool Parser::lightKind(TemplateDecl& decl) {
  at_ += 2;
  LightKindDecl item;
  if (!name(item.name, item.span, "the name of the kind of light")) return false;
  const Span open = token().span;
  if (!expect("{", "the kind's name")) return false;
  item.prose = proseBehind();
  while (!is("}")) {
    if (token().kind == Token::Kind::End) return unclosed(open);
    LightFieldDecl field;
    const bool named = name(field.name, field.span, "a field of the lights") && expect("=", "the field");
    if (named) field.value = expression();
    if (!field.value || !expect(";", "the value")) {
      skipStatement();
      continue;
    }
    item.fields.push_back(std::move(field));
  }
  accept("}");
  decl.light_kinds.push_back(std::move(item));
  return true;
}

/// `lights from RANGES[EXPR] through NUMBERS;`
bool Parser::lightLists(TemplateDecl& decl) {
  LightListsDecl item;
  item.span = token().span;
  at_ += 2;
  if (!name(item.ranges, item.ranges_span, "the list of ranges") || !expect("[", "the list of ranges"))
    return false;
  item.index = expression();
  if (!item.index || !expect("]", "the number of the range")) return false;
  if (!accept("through"))
    return syntax("expected 'through'", "write `through` and the list of the lights' numbers");
  if (!name(item.numbers, item.numbers_span, "the list of the lights' numbers") ||
      !expect(";", "the list of the lights' numbers"))
    return false;
  if (decl.light_lists) return syntax("the lights come from lists already", "a template says so once");
  decl.light_lists = std::move(item);
  return true;
}

bool Parser::given(TemplateDecl& decl) {
  GivenDecl item;
  Param result;
  if (isType()) {
    result = param(true);
    if (result.name.empty()) return false;
    item.has_type = true;
  } else if (!name(result.name, result.span, "a type or the name of the given")) {
    return false;
  } else if (is("in")) {
    return syntax("a given with a range has a type", fmt::format("write the type before '{}'", result.name));
  }
  item.name = std::exchange(result.name, {});
  item.span = result.span;
  item.results.push_back(std::move(result));
  if (!expect("=", "the given's name")) return false;
  item.value = expression();
  if (!item.value || !expect(";", "the value")) return false;
  item.prose = proseBehind();
  decl.givens.push_back(std::move(item));
  return true;
}

bool Parser::port(TemplateDecl& decl) {
  PortDecl item;
  item.param = param(true);
  if (item.param.name.empty()) return false;
  if (accept("=")) {
    item.default_value = expression();
    if (!item.default_value) return false;
  }
  if (!expect(";", "the port")) return false;
  item.param.prose = proseBehind();
  decl.ports.push_back(std::move(item));
  return true;
}

bool Parser::output(TemplateDecl& decl) {
  constexpr std::array<std::pair<std::string_view, OutputRole>, 5> kRoles = {
      {{"position", OutputRole::Position},
       {"color", OutputRole::Color},
       {"discard", OutputRole::Discard},
       {"depth", OutputRole::Depth},
       {"displacement", OutputRole::Displacement}}};
  OutputDecl item;
  const auto role = std::find_if(kRoles.begin(), kRoles.end(), [&](const auto& r) { return is(r.first); });
  if (role == kRoles.end())
    return syntax("expected what is put out", "it is position, color, discard, depth or displacement");
  ++at_;
  item.role = role->second;
  if (!type(item.type, "the output's type") || !name(item.name, item.span, "the output's name")) return false;
  if (!expect("=", "the output's name")) return false;
  item.value = expression();
  if (!item.value || !expect(";", "the value")) return false;
  item.prose = proseBehind();
  decl.outputs.push_back(std::move(item));
  return true;
}

}  // namespace lacquer::lang
