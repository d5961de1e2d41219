// The passes of the pipeline, one free function a file. Each leaves a module that verify() accepts.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/module.h"

namespace lacquer::passes {

/// What is known of the lights. Any: a run-time count of lights of every type (the module as lowered).
/// Otherwise fixed counts; lights lie in the array as directional, point, spot.
struct LightFacts {
  bool any = true;
  uint32_t directional = 0, point = 0, spot = 0;
  bool operator==(const LightFacts&) const = default;
};

/// Splits each sum over the lights into one per type that occurs, with the fields of that type as constants.
/// A count of one leaves no loop, a count of zero no code.
void specializeLights(ir::Module& module, const LightFacts& facts);

/// Removes clamps, minima, maxima, absolute values, comparisons and choices that interval analysis proves
/// idle for every input in its range. What the outputs are does not change, but for the colours of fragments
/// that are always dropped, which become 0.
void simplifyRanges(ir::Module& module);

/// Divides by the preshader's values with their reciprocals, which the preshader makes.
void takeReciprocals(ir::Module& module);

/// Gathers the Floats that scale vectors, takes them out of dot products, and leaves out what only scales the
/// direction of a cube map lookup.
void placeScales(ir::Module& module);

/// Moves affine functions of interpolated values to the vertex stage where that interpolates no more
/// components.
void hoistToVertex(ir::Module& module);

/// Splits the DAG at its rates: each value of material rate that something faster uses becomes a field of the
/// material block (its expression goes to Module::preshader), each Interpolate a varying. With
/// Module::spec_constants nothing is hoisted: parameters become specialization constants with ids in the
/// order of their names.
void place(ir::Module& module);

/// Numbers the textures that are left, and drops the others.
void bind(ir::Module& module);

}  // namespace lacquer::passes
