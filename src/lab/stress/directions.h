// Directions to integrate reflected light over, dense where narrow lobes are.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "stress/vectors.h"

namespace lacquer::stress {

/// A GGX lobe about the z axis, stretched along x and y.
struct Lobe {
  double alpha_t = 1, alpha_b = 1;
  bool back = false;  ///< of mirrors that send light back: turned by half a turn about the z axis
};

struct Direction {
  Vec3 l;
  double weight = 0;  ///< solid angle that it stands for
};

/// For integrands that are a smooth function, plus such functions times the lobes as seen along `v` (unit,
/// z > 0): `count` directions for the first and for each lobe. Those of a lobe are the mirror
/// directions of its visible facets (Heitz 2018, "Sampling the GGX Distribution of Visible Normals", in the
/// form of Dupuy and Benyoub 2023), on a lattice; all are weighted by the balance heuristic
/// (Veach 1997, section 9.2.2).
std::vector<Direction> directions(const Vec3& v, std::span<const Lobe> lobes, size_t count);

}  // namespace lacquer::stress
