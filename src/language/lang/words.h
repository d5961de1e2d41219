// The words of the language, in one place.
#pragma once

#include <string>
#include <string_view>

#include "lang/library.h"

namespace lacquer::lang {

/// A word that begins a declaration.
struct DeclWord {
  std::string_view word;
  DeclKind kind;
  std::string_view name;  ///< of the kind, in messages
};

inline constexpr DeclWord kDeclWords[] = {
    {"const", DeclKind::Const, "constant"},          {"node", DeclKind::Node, "node"},
    {"template", DeclKind::Template, "template"},    {"extension", DeclKind::Extension, "extension"},
    {"material", DeclKind::Extension, "extension"},  {"part", DeclKind::Part, "part"},
    {"profile", DeclKind::Profile, "profile"},       {"lod", DeclKind::Lod, "lod"},
    {"layers", DeclKind::Layers, "order of layers"}, {"switch", DeclKind::Switch, "switch"},
};

/// "node", "extension".
constexpr std::string_view kindName(DeclKind kind) {
  for (const DeclWord& row : kDeclWords) {
    if (row.kind == kind) return row.name;
  }
  return {};
}
/// "a node", "an extension".
inline std::string aKind(DeclKind kind) {
  const std::string_view name = kindName(kind);
  const bool vowel = std::string_view("aeiou").find(name[0]) != std::string_view::npos;
  return std::string(vowel ? "an " : "a ") + std::string(name);
}

/// Values, which cannot be names. The words of statements and declarations can, where only a name can stand.
inline constexpr std::string_view kValueWords[] = {"true", "false", "inf"};

/// Those that begin a part of a body: a name only where what follows can stand behind a value.
inline constexpr std::string_view kBodyWords[] = {"variant", "let", "if", "else", "for", "return", "assume"};

}  // namespace lacquer::lang
