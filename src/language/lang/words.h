// The words of the language, in one place.
#pragma once

#include <string_view>

#include "lang/library.h"

namespace lacquer::lang {

/// A word that begins a declaration.
struct DeclWord {
  std::string_view word;
  DeclKind kind;
  std::string_view name;  ///< of the kind, in messages
  bool reserved;          ///< nothing else can be named so
};

inline constexpr DeclWord kDeclWords[] = {
    {"const", DeclKind::Const, "constant", true},
    {"node", DeclKind::Node, "node", true},
    {"template", DeclKind::Template, "template", true},
    {"extension", DeclKind::Extension, "extension", false},
    {"material", DeclKind::Extension, "extension", false},
    {"part", DeclKind::Part, "part", false},
    {"profile", DeclKind::Profile, "profile", false},
    {"lod", DeclKind::Lod, "lod", false},
    {"layers", DeclKind::Layers, "order of layers", false},
    {"switch", DeclKind::Switch, "switch", false},
};

/// Those of a body, which are all reserved.
inline constexpr std::string_view kBodyWords[] = {"variant", "let", "if",   "else",  "for", "return",
                                                  "assume",  "in",  "true", "false", "inf"};

}  // namespace lacquer::lang
