// Colours of a template that puts out more of them than devices have: those that a material may lack share
// the places behind the others, component by component.
#pragma once

#include <string>
#include <vector>

#include "ir/module.h"
#include "lang/ast.h"
#include "support/diagnostic.h"

namespace lacquer::lower {

/// Whether the template declares more colours than ir::kMostColors: then its optional ones are packed.
bool packsOutputs(const lang::TemplateDecl& decl);

class OutputPacker {
public:
  OutputPacker(ir::Dag& dag, const lang::TemplateDecl& decl) : dag_(dag), decl_(decl) {}

  /// What an optional output puts out, and what it would without any port of the graph: components that are
  /// the same value in both tell nothing and are left out.
  void add(const lang::OutputDecl& output, ir::ValueId value, ir::ValueId without);

  /// An output that every material has, and that tells nothing of this one: its place may be taken.
  void idle(std::string_view output) { idle_.emplace_back(output); }

  /// Adds to `outputs` what was added, in its order, four components to a colour called "packed_0",
  /// "packed_1", …; what is left of the last one is 0. Their locations are those from `first` on, and where
  /// these do not do, those of idle outputs, which go. Error "over-limit": that does not do either.
  Diagnostics finish(uint32_t first, std::vector<ir::Output>& outputs);

private:
  struct Component {
    ir::ValueId value;
    std::string name;
    const lang::OutputDecl* of;
  };

  ir::Output colorOf(size_t number);
  Diagnostics tooMany(uint32_t fixed) const;

  ir::Dag& dag_;
  const lang::TemplateDecl& decl_;
  std::vector<Component> components_;
  std::vector<std::string> idle_;
};

}  // namespace lacquer::lower
