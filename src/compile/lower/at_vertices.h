// A value of the fragment as the vertices have it.
#pragma once

#include <optional>
#include <vector>

#include "ir/loops.h"

namespace lacquer::lower {

class AtVertices {
public:
  /// `first_level`: a lookup without a level takes the first, which is what it does at the vertices.
  explicit AtVertices(ir::Dag& dag, bool first_level = false) : dag_(dag), first_level_(first_level) {}

  /// The same made of what is interpolated, as it is before that. Nothing where the value has something in it
  /// that vertices do not know: a light, a derivative, the side of the triangle, a lookup without a level.
  std::optional<ir::ValueId> operator()(ir::ValueId root);

private:
  ir::ValueId made(ir::ValueId id);

  bool knownToVertices(ir::ValueId id) const;

  ir::Dag& dag_;
  bool first_level_;
  ir::LoopCopies loops_;
  std::vector<ir::ValueId> known_;  ///< by value; kNoValue where it was not asked for, or cannot be
};

}  // namespace lacquer::lower
