// Proofs that no operation of a shader leaves its domain, whatever the inputs in their ranges.
#pragma once

#include <string_view>
#include <vector>

#include "analysis/intervals.h"

namespace lacquer::analysis {

/// One sqrt, inversesqrt, division, pow, log, log2, normalize, acos or atan.
struct Proof {
  ir::ValueId id;
  bool safe;
  ir::ValueId operand;    ///< what must lie in the domain
  Range reached;          ///< all that the operand can be, the widest component
  std::string_view need;  ///< "> 0", ">= 0", "!= 0", "in [-1, 1]", ...
};

/// What an output can be.
struct OutputRange {
  uint32_t output;  ///< index into Module::outputs
  Range reached;
};

struct Proofs {
  std::vector<Proof> operations;     ///< ascending by value
  std::vector<OutputRange> outputs;  ///< of colour outputs
};

/// Of everything that the module's outputs, varyings and preshader reach. An operation whose operand may be
/// no number (infinity minus infinity, an environment map without an assumption) is not safe.
Proofs prove(const ir::Module& module, const IntervalOptions& options = {Arithmetic::Vulkan, kSceneLimit});

/// The same for some values of an evaluated module; operations only.
std::vector<Proof> prove(const ir::Module& module, const Intervals& intervals,
                         std::span<const ir::ValueId> ids);

}  // namespace lacquer::analysis
