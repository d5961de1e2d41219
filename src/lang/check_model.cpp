#include <fmt/format.h>

#include <algorithm>

#include "lang/checker.h"

namespace lacquer::lang {

using ir::Type;

void Checker::modelDoc(const std::string& doc, const std::string* source, Span span, std::string_view what) {
  if (doc.empty()) {
    reporter_.error("missing-doc", span, fmt::format("the {} has no documentation", what),
                    "say what it is in a line `/// ...` above it");
  }
  if (source != nullptr && source->empty()) {
    reporter_.error("missing-source", span, fmt::format("the {} has no source", what),
                    "say what it follows in a line `/// source: DOCUMENT, \"SECTION\"` above it");
  }
}

void Checker::property(PropertyDecl& item, bool texture_member) {
  using Kind = PropertyDecl::Kind;
  if (item.kind == Kind::Object || item.kind == Kind::Texture) {
    const bool texture = item.kind == Kind::Texture;
    if (texture_member || (texture && item.channels.find_first_not_of("rgba") != std::string_view::npos)) {
      reporter_.error("wrong-type", item.span,
                      texture_member ? "a textureInfo has numbers alone" : "channels are letters of rgba");
    }
    for (PropertyDecl& member : item.members) property(member, texture);
    for (size_t i = 0; i < item.members.size(); ++i) {
      for (size_t j = 0; j < i; ++j) {
        if (item.members[i].name != item.members[j].name) continue;
        reporter_.error("duplicate-name", item.members[i].span,
                        fmt::format("there are two properties '{}'", item.members[i].name));
      }
    }
    return;
  }
  if (item.kind == Kind::Choice) return;
  if (item.type != Type::Bool && !ir::isFloating(item.type)) {
    reporter_.error("wrong-type", item.span, fmt::format("a property cannot be {}", aType(item.type)),
                    "bools, floats, vectors, textures and choices are possible");
    return;
  }
  rangeOf(item);
  defaultOf(item);
  const auto value = [&](ExprPtr& syntax, Type type, std::string_view what) {
    return syntax ? constantValue(syntax, type, what) : Constant{};
  };
  if (const Constant tested = value(item.tested_syntax, Type::Float, "the tested bound"))
    item.tested = (*tested)[0];
  if (item.neutral_syntax) {
    item.neutral = value(item.neutral_syntax, item.type, fmt::format("the neutral value of '{}'", item.name));
  }
}

void Checker::extension(ExtensionDecl& decl) {
  modelDoc(decl.doc, &decl.source, decl.span, fmt::format("extension '{}'", decl.name));
  for (PropertyDecl& item : decl.properties) property(item, false);
  for (size_t i = 0; i < decl.properties.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      if (decl.properties[i].name != decl.properties[j].name) continue;
      reporter_.error("duplicate-name", decl.properties[i].span,
                      fmt::format("there are two properties '{}'", decl.properties[i].name));
    }
  }
}

void Checker::part(PartDecl& decl) {
  modelDoc(decl.doc, nullptr, decl.span, fmt::format("part '{}'", decl.name));
}

void Checker::profile(ProfileDecl& decl, std::string_view kind) {
  modelDoc(decl.doc, nullptr, decl.span, fmt::format("{} '{}'", kind, decl.name));
}

}  // namespace lacquer::lang
