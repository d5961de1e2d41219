// What the targets share that write no stage but pack the material's block: cpp, js.
#pragma once

#include <limits>
#include <string_view>

#include "ir/module.h"

namespace lacquer::targets {

/// The fold column of ops.def: an op's meaning in C++, with T for the arithmetic and a, b, c for the
/// operands.
std::string_view foldText(ir::Op op);
/// True when the op is one function of <cmath>.
bool isStandard(ir::Op op);
/// True when the op stands before or between its operands. Not of integers, which the packers hold in doubles
/// (ir/whole.h).
bool isOperator(ir::Op op);
/// True of an op on integers, and of one that makes an integer or a number of one.
bool ofWholes(ir::Op op);

/// The largest number that a block holds.
inline constexpr double kLargestFloat = std::numeric_limits<float>::max();

/// The numbers that a parameter is packed with: its range, as far as floats or integers go.
struct PackedRange {
  double low, high;
  bool or_zero;  ///< 0 is one of them although `low` is above it
  bool whole;    ///< and the nearest integer
};
PackedRange packedRange(const ir::Parameter& parameter);

/// The block that is packed; null where there is none.
const ir::Block* materialBlock(const ir::Module& module);
/// True when a stage reads the block.
bool usesBlock(const ir::Module& module, const ir::Block& block);

}  // namespace lacquer::targets
