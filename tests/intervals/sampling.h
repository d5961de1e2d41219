// Random values for the inputs of a module, within their ranges, with the edges over-represented.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "ir/module.h"
#include "lang/ast.h"

namespace lacquer::test {

using Floats = std::array<float, 4>;

/// Whether a test that draws floats for every node's parameters takes this one: it has no matrices and no
/// integers, and of a standard node's forms it is the one of three floats, or the only one.
bool drawable(const lang::NodeDecl& node);

/// One drawing of everything that a module may read, a pure function of the seed: two modules that read the
/// same inputs see the same numbers. What nodes call N, V, L, T, B, sum, length2, NdotL and so on belongs to
/// one geometry: unit vectors as float32 rounds them, now and then of no length, equal, opposite or at right
/// angles.
class World {
public:
  /// `limit`: stands for the open ends of ranges.
  World(uint64_t seed, double limit);

  Floats input(const ir::Input& input) const;
  /// A texel: of an environment within half floats, else in [0, 1].
  Floats texel(bool environment, std::string_view texture, const Floats& coordinates) const;
  /// A difference of neighbours.
  Floats difference(const Floats& value, int axis) const;
  /// How many of `most` lights are on.
  int lights(int most) const;

private:
  bool geometry(std::string_view name, Floats& out) const;
  void makeGeometry();

  uint64_t seed_;
  double limit_;
  Floats n_{}, v_{}, l_{}, t_{}, b_{};
};

}  // namespace lacquer::test
