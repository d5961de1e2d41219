// The division of a run's structures among programs, as the cache keeps it: a run whose materials differ from
// an earlier one's in numbers alone measures nothing.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "programs/curve.h"
#include "run/fallbacks.h"
#include "run/lift.h"

namespace lacquer {

/// Structures of one program, by their keys, and what their materials have together.
struct SharedProgram {
  Lift lift;
  std::vector<Key> structures;
};

struct Divided {
  std::vector<SharedProgram> shared;
  programs::Curve curve;  ///< without the number of materials
  /// Different known lights, and vertex stages: materials share programs only within one of each.
  uint64_t light_sets = 0, vertex_sets = 0;
  Fallbacks fallbacks;
};

/// A material's use of a shader, and its share of the picture.
struct ProgramUse {
  std::string shader;
  double weight = 0;
};

/// The shares of each shader, added up: in an order that is not that of the files, which would show in how
/// the sum is rounded.
std::map<std::string, double> weightsByShader(const std::vector<ProgramUse>& uses);

/// Of everything that Programs decides by. Of the examples' numbers only those that decide of a graph are in
/// it (model/shape.h). None where a driver is asked that cannot be told from others.
std::optional<Key> dividedKey(const std::vector<const Structure*>& structures, const Examples& examples,
                              const std::vector<ProgramUse>& uses, const Setting& setting);

/// A program that materials share, and the structures of the graphs that were united for it; empty where they
/// could not be.
struct UnitedProgram {
  std::vector<Key> members;
  programs::United united;
};

/// In the order of Divided::shared.
struct UnitedPrograms {
  std::vector<UnitedProgram> programs;
  Key digest;
};

std::string toBlob(const UnitedPrograms& united, const Setting& setting);
/// Nothing where the bytes are not the programs of this division.
std::optional<UnitedPrograms> unitedFrom(std::string_view bytes, const Divided& divided,
                                         const Setting& setting);

std::string toBlob(const Divided& divided);
/// Nothing where the bytes are none of these structures.
std::optional<Divided> dividedFrom(std::string_view bytes, const std::vector<const Structure*>& structures,
                                   const Setting& setting);

}  // namespace lacquer
