#include <fmt/format.h>

#include <utility>

#include "lang/parser.h"

namespace lacquer::lang {

/// `a.b.c` as one text. Words of the language may stand behind a point.
bool Parser::dottedName(std::string_view& out, Span& span, std::string_view what) {
  if (!name(out, span, what)) return false;
  while (is(".") && token(1).kind == Token::Kind::Name) {
    at_ += 2;
    span = since(span.offset);
  }
  out = reporter_.text(span);
  return true;
}

bool Parser::names(std::vector<std::string_view>& out, std::string_view what) {
  do {
    std::string_view one;
    Span span;
    if (!dottedName(one, span, what)) return false;
    out.push_back(one);
  } while (accept(","));
  return true;
}

bool Parser::string(std::string_view& out, std::string_view what) {
  if (token().kind != Token::Kind::String) return syntax(fmt::format("expected {} in quotes", what));
  out = token().text;
  ++at_;
  return true;
}

/// Reads `{ items }`; after an error in one it goes on with the next.
template <class Item>
void Parser::braces(std::string_view after, Item item) {
  const Span open = token().span;
  if (!expect("{", after)) return;
  if (nesting_ >= kDeepest) {
    tooDeep();
    return;
  }
  ++nesting_;
  while (!is("}")) {
    if (token().kind == Token::Kind::End) {
      unclosed(open);
      break;
    }
    if (!item()) skipStatement();
  }
  --nesting_;
  accept("}");
}

// -- extensions --

ExtensionDecl Parser::extension() {
  ExtensionDecl decl;
  decl.text = reporter_.text();
  docs(decl.doc, &decl.source);
  decl.core = is("material");
  ++at_;
  if (!name(decl.name, decl.span, "the extension's name")) return decl;
  braces("the extension's name", [&] { return extensionItem(decl); });
  end();
  return decl;
}

bool Parser::extensionItem(ExtensionDecl& decl) {
  const auto list = [&](std::vector<std::string_view>& to) {
    return names(to, "the name of an extension") && expect(";", "the names");
  };
  if (accept("draft")) return list(decl.drafts);
  if (accept("needs")) return list(decl.needs);
  if (accept("excludes")) return list(decl.excludes);
  if (is("yields") || is("loses")) {
    std::vector<std::string_view>& to = is("yields") ? decl.yields_to : decl.loses_to;
    ++at_;
    return expect("to", "'yields' or 'loses'") && list(to);
  }
  Span ignored;
  if (accept("inside")) {
    return name(decl.inside, ignored, "the name of the extension that it stands in") &&
           expect(";", "the name");
  }
  if (accept("status")) return name(decl.status, ignored, "the status") && expect(";", "the status");
  return property(decl.properties);
}

bool Parser::property(std::vector<PropertyDecl>& out) {
  PropertyDecl item;
  if (accept("object")) {
    item.kind = PropertyDecl::Kind::Object;
    if (!name(item.name, item.span, "the object's name")) return false;
    braces("the object's name", [&] { return property(item.members); });
    out.push_back(std::move(item));
    return true;
  }
  if (accept("texture")) return texture(item) && (out.push_back(std::move(item)), true);
  if (accept("choice")) return choice(item) && (out.push_back(std::move(item)), true);
  if (!isType()) {
    return syntax("expected a property",
                  "there are float, vec2, vec3, vec4, bool, choice, texture and object");
  }
  if (!type(item.type, "the property's type") || !name(item.name, item.span, "the property's name"))
    return false;
  item.kind = item.type == ir::Type::Bool ? PropertyDecl::Kind::Bool : PropertyDecl::Kind::Number;
  if (!role(item)) return false;
  if (is("in")) {
    item.range_syntax = range();
    if (!item.range_syntax) return false;
  }
  if (accept("tested")) {
    if (!expect("to", "'tested'")) return false;
    item.tested_syntax = expression();
    if (!item.tested_syntax) return false;
  }
  // A number without a default may be absent, which is no number.
  if (is(";") && item.kind == PropertyDecl::Kind::Number) {
    ++at_;
    item.prose = proseBehind();
    out.push_back(std::move(item));
    return true;
  }
  if (!expect("=", "the property")) return false;
  item.default_syntax = expression();
  if (!item.default_syntax) return false;
  if (accept("neutral")) {
    item.neutral_syntax = expression();
    if (!item.neutral_syntax) return false;
  }
  item.folded = accept("folded");
  if (!expect(";", "the default")) return false;
  item.prose = proseBehind();
  out.push_back(std::move(item));
  return true;
}

bool Parser::role(PropertyDecl& item) {
  item.role = item.name;
  Span ignored;
  return !accept("as") || name(item.role, ignored, "what parts call it");
}

/// `texture NAME [as ROLE] [srgb] [.rgb] [{ members }];`
bool Parser::texture(PropertyDecl& item) {
  item.kind = PropertyDecl::Kind::Texture;
  item.type = ir::Type::Texture2D;
  if (!name(item.name, item.span, "the texture's name") || !role(item)) return false;
  item.srgb = accept("srgb");
  if (accept(".")) {
    Span ignored;
    if (!name(item.channels, ignored, "the channels")) return false;
  }
  if (is("{")) {
    item.prose = {};
    braces("the texture", [&] { return property(item.members); });
    return true;
  }
  if (!expect(";", "the texture")) return false;
  item.prose = proseBehind();
  return true;
}

/// `choice NAME of A, B = A;`
bool Parser::choice(PropertyDecl& item) {
  item.kind = PropertyDecl::Kind::Choice;
  item.type = ir::Type::Int;
  if (!name(item.name, item.span, "the property's name") || !role(item)) return false;
  if (!expect("of", "the name") || !names(item.choices, "a value")) return false;
  std::string_view by_default;
  Span place;
  if (!expect("=", "the values") || !name(by_default, place, "one of the values")) return false;
  const auto found = std::find(item.choices.begin(), item.choices.end(), by_default);
  if (found == item.choices.end()) {
    reporter_.error("unknown-value", place, fmt::format("'{}' is none of the values", by_default));
    return false;
  }
  item.default_value = ir::Components{static_cast<double>(found - item.choices.begin())};
  if (!expect(";", "the default")) return false;
  item.prose = proseBehind();
  return true;
}

// -- parts, profiles, layers, switches --

PartDecl Parser::part() {
  PartDecl decl;
  decl.text = reporter_.text();
  docs(decl.doc, &decl.source);
  accept("part");
  TermDecl whole;
  if (!name(decl.name, decl.span, "the part's name")) return decl;
  whole.name = decl.name;
  whole.span = decl.span;
  if (accept("of") && !names(decl.of, "the name of an extension")) return decl;
  if (accept("over") && !names(decl.over, "the name of a part below")) return decl;
  if (!termConditions(whole)) return decl;
  decl.terms.push_back(std::move(whole));
  std::string_view section;
  braces("the part's head", [&] { return partItem(decl, 0, section); });
  end();
  return decl;
}

bool Parser::termConditions(TermDecl& term) {
  if (accept("when")) {
    term.when = expression();
    if (!term.when) return false;
    if (token().kind == Token::Kind::String && !string(term.when_reason, "the reason")) return false;
  }
  if (accept("unless")) {
    term.unless = expression();
    if (!term.unless) return false;
    if (token().kind == Token::Kind::String && !string(term.unless_reason, "the reason")) return false;
  }
  return true;
}

bool Parser::partItem(PartDecl& decl, uint32_t term, std::string_view& section) {
  if (is("term") && token(1).kind == Token::Kind::Name) {
    ++at_;
    TermDecl inner;
    inner.parent = term;
    if (!dottedName(inner.name, inner.span, "the term's name") || !termConditions(inner)) return false;
    const auto index = static_cast<uint32_t>(decl.terms.size());
    decl.terms.push_back(std::move(inner));
    std::string_view inner_section = section;
    braces("the term's head", [&] { return partItem(decl, index, inner_section); });
    return true;
  }
  if (token().kind == Token::Kind::Name && token(1).is(":")) {
    section = token().text;
    at_ += 2;
    return true;
  }
  LineDecl line;
  line.term = term;
  line.section = section;
  if (!this->line(line)) return false;
  decl.lines.push_back(std::move(line));
  return true;
}

bool Parser::alternatives(LineDecl& line) {
  do {
    Alternative one;
    one.value = expression();
    if (!one.value) return false;
    if (is("when") || is("unless")) {
      one.unless = is("unless");
      ++at_;
      one.condition = expression();
      if (!one.condition) return false;
    }
    line.alternatives.push_back(std::move(one));
  } while (accept("or"));
  return expect(";", "the value");
}

bool Parser::line(LineDecl& line) {
  const bool keyword = token(1).kind == Token::Kind::Name;
  if (keyword && accept("replace")) {
    line.kind = LineDecl::Kind::Replace;
    line.span = token().span;
    line.target = expression();
    return line.target && expect("with", "what is replaced") && alternatives(line);
  }
  if (keyword && accept("require")) return require(line);
  if (keyword && accept("out")) {
    line.kind = LineDecl::Kind::Out;
  } else if (keyword && accept("bool")) {
    line.kind = LineDecl::Kind::Flag;
  } else if (keyword && accept("shared")) {
    line.shared = true;
  } else if (keyword && accept("light")) {
    line.light = true;
  }
  if (!dottedName(line.id, line.span, "a line: its name") || !expect("=", "the line's name")) return false;
  return alternatives(line);
}

/// `require VALUE else "code" [at PROPERTY] "message" "help" skip "reason";`
bool Parser::require(LineDecl& line) {
  line.kind = LineDecl::Kind::Require;
  line.span = token().span;
  do {
    Alternative one;
    one.value = expression();
    if (!one.value) return false;
    line.alternatives.push_back(std::move(one));
  } while (accept("or"));
  if (!expect("else", "what is required") || !string(line.code, "the warning's code")) return false;
  if (accept("at")) {
    line.place = expression();
    if (!line.place) return false;
  }
  return string(line.message, "the warning") && string(line.help, "what helps") &&
         expect("skip", "the warning") && string(line.reason, "the reason") && expect(";", "the reason");
}

ProfileDecl Parser::profile() {
  ProfileDecl decl;
  decl.text = reporter_.text();
  docs(decl.doc, &decl.source);
  const bool lod = accept("lod");
  if (!lod) accept("profile");
  if (!name(decl.name, decl.span, lod ? "the lod's name" : "the profile's name")) return decl;
  decl.by_default = !lod && accept("default");
  braces("the name", [&] {
    LineDecl line;
    if (!this->line(line)) return false;
    decl.lines.push_back(std::move(line));
    return true;
  });
  end();
  return decl;
}

LayersDecl Parser::layers() {
  LayersDecl decl;
  decl.text = reporter_.text();
  docs(decl.doc, nullptr);
  accept("layers");
  if (!name(decl.name, decl.span, "the name of the layers")) return decl;
  braces("the name", [&] {
    if (accept("sections")) return names(decl.sections, "a section") && expect(";", "the sections");
    std::string_view one;
    Span span;
    if (!name(one, span, "the name of a part") || !expect(";", "the part")) return false;
    decl.parts.push_back(one);
    decl.spans.push_back(span);
    return true;
  });
  end();
  return decl;
}

SwitchDecl Parser::switchDecl() {
  SwitchDecl decl;
  docs(decl.doc, nullptr);
  accept("switch");
  if (!name(decl.name, decl.span, "the switch's name") || !expect("=", "the switch's name")) return decl;
  if (!is("true") && !is("false")) {
    syntax("expected true or false");
    return decl;
  }
  decl.value = is("true");
  ++at_;
  expect(";", "the value");
  end();
  return decl;
}

}  // namespace lacquer::lang
