// Which operations of a fragment may be done at half precision (`mediump` of GLSL ES, RelaxedPrecision of
// SPIR-V), proved by ranges and by errors carried forward. docs/intervals.md, "Half precision".
#pragma once

#include <span>
#include <vector>

#include "ir/module.h"

namespace lacquer::analysis {

struct Relaxation {
  /// Operations whose operands and result may be rounded to half precision, and what only moves such results;
  /// ascending.
  std::vector<ir::ValueId> values;
  /// What all of them together may change of a component of a colour: as a part of it, or of 1 where that is
  /// more, for light of at most 1 (relaxedBound()).
  double bound = 0;
};

/// The operations of a placed module's fragments that are worth it and keep every colour within `error`,
/// which is below 1. The same for the same module.
Relaxation relax(const ir::Module& module, double error);

/// The bound for these values of the module: with r and a, where a component of a colour is x without
/// rounding, it changes by at most r |x| + a, and the bound is r + a. Light is what the colours are linear in
/// and what no range bounds: radiance of lights, texels and intensity of the environment, emission. Where
/// each is at most 1 that holds; a grows with them as the colour does. Infinite where nothing is proved.
double relaxedBound(const ir::Module& module, std::span<const ir::ValueId> values);

/// These operations of the module, what only moves their results, and the bound.
Relaxation relaxationOf(const ir::Module& module, std::span<const ir::ValueId> operations);

/// True of what moves numbers and changes none but their signs.
bool onlyMoves(ir::Op op);

/// What relaxedBound() takes for light: fields, parameters and texels; ascending.
std::vector<ir::ValueId> lightsOf(const ir::Module& module);

/// What is at half precision, on paper.
struct RelaxedCost {
  uint32_t operations = 0, all = 0;  ///< of scalars, in fragments; what moves numbers counts nothing
  uint32_t cycles = 0,
           all_cycles = 0;   ///< the same with divisions, roots and transcendentals at a quarter rate
  uint32_t conversions = 0;  ///< scalars that pass between the two precisions
};
RelaxedCost relaxedCost(const ir::Module& module);

}  // namespace lacquer::analysis
