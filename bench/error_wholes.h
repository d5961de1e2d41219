// Errors of whole coated materials, by profile: E1 of their colours, E3 of what the coat leaves of its base's
// light.
#pragma once

#include <string>
#include <vector>

#include "bench/error_subjects.h"

namespace lacquer::bench {

struct Whole {
  std::string profile;
  bool environment = false;  ///< under a white one, else under one light
  /// The shader in float, its preshader's fields rounded, against the graph in double: relative to the
  /// colour, or to kDark where that is more. Any parameters, IORs from 1 to 4, isotropic and anisotropic
  /// coats.
  Spread rounding;
  /// A smooth coat over a Lambertian base against quadrature, absolute: IORs from 1 to 4, any tint, albedo,
  /// view and light.
  Spread physics;
};

/// Two for each profile of the library, over so many points each, ends of the ranges included.
std::vector<Whole> wholes(const lang::Library& library, size_t points);

}  // namespace lacquer::bench
