// What holds across the lines of a model, checked once, where they stand: names, types, what a profile
// replaces. A material meets none of it.
#pragma once

#include <set>
#include <string_view>
#include <vector>

#include "lang/ast.h"
#include "model/model.h"

namespace lacquer::model {

/// The text that is being resolved.
struct Text {
  std::string_view file, text;
};

/// What the compiler saw on its way, and where.
struct Uses {
  struct Argument {
    Value value;
    const lang::Param* param;
    Text text;
    lang::Span span;
  };
  struct Path {
    uint32_t id;
    std::string_view path;
    Text text;
    lang::Span span;
  };
  /// A line, with its declaration.
  struct Placed {
    uint32_t line;
    const lang::LineDecl* decl;
    Text text;
  };
  struct Port {
    std::string_view name;
    Text text;
    lang::Span span;
  };
  std::vector<Argument> arguments;
  std::vector<Path> paths;
  std::vector<Placed> lines;
  std::vector<Port> ports;      ///< asked for by `takes`
  std::set<uint32_t> ids;       ///< that a line or a condition reads
  std::set<uint32_t> outs;      ///< that a part reads of what lies below
  std::set<uint32_t> overlays;  ///< lines of the profile or of a lod that stand in place of others
  std::set<uint32_t> adds;      ///< lines of the profile that replace none
};

/// The errors behind those of the templates that are wrong: a name that is not known may be one of theirs.
Diagnostics withWrongTemplates(const lang::Library& library, const Diagnostics& wrong);

/// Errors at their places.
Diagnostics check(const lang::Library& library, const Model& model, const Uses& uses);

}  // namespace lacquer::model
