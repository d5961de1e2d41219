// The passes of the pipeline, one free function a file. Each leaves a module that verify() accepts.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "ir/module.h"
#include "support/diagnostic.h"

namespace lacquer::passes {

/// What is known of the lights. Any: a run-time count of lights of every kind (the module as lowered).
/// Otherwise fixed counts; lights lie in the array in the order of the template's kinds.
struct LightFacts {
  bool any = true;
  std::map<std::string, uint32_t, std::less<>> counts{};  ///< by the kind's name: ir::LightKind
  bool operator==(const LightFacts&) const = default;
};

/// The stages in which programs read what is bound.
struct Readers {
  std::map<std::pair<uint32_t, uint32_t>, ir::Stages> blocks{};  ///< by set and binding
  std::map<std::string, ir::Stages, std::less<>> textures{};     ///< by the names of OtherLayout
  bool empty() const { return blocks.empty() && textures.empty(); }
};

/// Of a program in whose place a module is to be drawn with, with the same buffers and textures bound.
struct OtherLayout {
  uint32_t block = 0;  ///< bytes of its material block: the module's own fields lie behind them
  /// Where it has textures, by the graph's names and, of an environment's, the template's.
  std::map<std::string, ir::Binding, std::less<>> textures{};
  std::map<std::string, uint32_t, std::less<>> inputs{};  ///< locations of what it reads of the vertices
  /// The other way about: the programs that are to be drawn with in the module's place.
  Readers readers{};
  bool empty() const { return block == 0 && textures.empty() && inputs.empty(); }
};

/// What is wrong with the facts for this module's template: a kind that it does not have, more lights than
/// its array holds. Codes "unknown-light", "too-many-lights".
Diagnostics checkLights(const ir::Module& module, const LightFacts& facts);

/// Splits each sum over the lights into one per kind that occurs, with the fields that the kind fixes as
/// constants. A count of one leaves no loop, a count of zero no code. The facts must be good.
void specializeLights(ir::Module& module, const LightFacts& facts);

/// Removes clamps, minima, maxima, absolute values, comparisons and choices that interval analysis proves
/// idle for every input in its range. What the outputs are does not change, but for the colours of fragments
/// that are always dropped, which become 0.
void simplifyRanges(ir::Module& module);

/// Leaves out what loops carry and nobody asks for.
void pruneLoops(ir::Module& module);

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
/// order of their names, and those that are animated fields of the block as they are.
void place(ir::Module& module, const OtherLayout& other = {});

/// Gives the material's textures that are left their places, those of `other` where that has them, and drops
/// the others. What is read of the vertices has `other`'s locations, and what its readers read their stages.
void bind(ir::Module& module, const OtherLayout& other = {});

/// Makes elements of lists of the objects and of the material, which a number of each instance picks, and of
/// the material's textures elements of arrays, whose numbers lie behind the material's block. One pipeline
/// then draws all materials of a structure. The module must be bound.
void makeBindless(ir::Module& module);

/// Makes one texture of those of the material that have one sampler and one format, each a layer of it, whose
/// number lies behind the material's block. A texture whose sampler is not known stays as it is. The module
/// must be bound.
void makeArrays(ir::Module& module);

/// Marks the operations of fragments that may be done at half precision, as long as no colour changes by more
/// than `error` (analysis/relax.h). 0 marks none.
void relax(ir::Module& module, double error);

/// Forms of a module with relaxed operations: itself, then some in which the operations that are still
/// relaxed have types of 16 bits (ir::Half), each within `error`. The same for the same module.
std::vector<ir::Module> halves(const ir::Module& module, double error);

/// Two resources in one place ("slot-clash"): a mistake of Lacquer's, or of whoever made the module.
Diagnostics checkPlaces(const ir::Module& module);

}  // namespace lacquer::passes
