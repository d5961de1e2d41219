// What is known of a module before it is searched.
#pragma once

#include <vector>

#include "analysis/prove.h"
#include "optimize/egraph.h"

namespace lacquer::optimize {

/// A plan with what is known of its nodes.
struct Found {
  Plan plan;
  std::vector<Facts> facts;
  std::vector<bool> known;  ///< false where the facts follow from the operands alone
};

/// The fragment stage of a module as it is.
struct Plain {
  Found found;
  std::vector<Ranges> natural;               ///< of its nodes: in float32, with light as bright as it may be
  double least_lights = 0, most_lights = 1;  ///< that a sum over them has
};
Plain plainOf(const ir::Module& module, Constants& constants);

/// What proofs say of a module that a search must not lose.
struct Proved {
  size_t unsafe = 0;
  std::vector<analysis::OutputRange> outputs;

  explicit Proved(const ir::Module& module);
  /// True where nothing is lost of another's.
  bool keeps(const Proved& plain) const;
};

}  // namespace lacquer::optimize
