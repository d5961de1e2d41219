#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

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
  if (item.kind == Kind::Choice) return choices(item);
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
  numbers(item, texture_member);
}

void Checker::choices(const PropertyDecl& item) {
  std::set<std::string_view> seen;
  for (const std::string_view choice : item.choices) {
    if (seen.insert(choice).second) continue;
    reporter_.error("duplicate-name", spanOf(choice),
                    fmt::format("'{}' is a value of '{}' already", choice, item.name));
  }
}

/// The numbers that stand beside a property's range must make sense with it.
void Checker::numbers(const PropertyDecl& item, bool texture_member) {
  if (texture_member && item.type != Type::Float) {
    reporter_.error("wrong-type", item.span, fmt::format("a textureInfo has no {}", ir::typeName(item.type)),
                    "its numbers are floats");
  }
  constexpr std::string_view kTaken[] = {"index", "texCoord", "extensions", "extras"};
  if (texture_member && std::find(std::begin(kTaken), std::end(kTaken), item.name) != std::end(kTaken)) {
    reporter_.error("duplicate-name", item.span, fmt::format("a textureInfo has '{}' anyway", item.name));
  }
  const auto outside = [&](const ir::Components& value) {
    for (int c = 0; c < ir::componentCount(item.type); ++c) {
      const double x = value[static_cast<size_t>(c)];
      if (!std::isfinite(x) || (ir::isFloating(item.type) && !item.range.contains(x))) return true;
    }
    return false;
  };
  if (item.neutral && outside(*item.neutral)) {
    reporter_.error("out-of-range", item.neutral_syntax ? item.neutral_syntax->span : item.span,
                    fmt::format("the neutral value of '{}' is not in its range", item.name),
                    fmt::format("the range is {}", ir::rangeText(item.range)));
  }
  if (item.default_value && outside(*item.default_value)) {
    reporter_.error("out-of-range", item.span,
                    fmt::format("the default of '{}' is no number of its range", item.name));
  }
  if (item.tested && !item.range.contains(*item.tested)) {
    reporter_.error("out-of-range", item.span,
                    fmt::format("'{}' is tested to {}, which is not in its range", item.name, *item.tested),
                    fmt::format("the range is {}", ir::rangeText(item.range)));
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
