// What a variant does to the colour of a whole material, at worst.
#pragma once

#include <cstdint>
#include <string>

#include "lang/library.h"

namespace lacquer::bench {

/// A colour below this counts as this dark when an error is taken relative to it: a step of an 8-bit channel.
inline constexpr double kDark = 1.0 / 256;

/// The largest relative error that was found of any colour channel, over all parameters of a coated material
/// in their ranges (IORs from 1 to 4 when `any_ior`, else 1.5), views and lights above the surface: under one
/// light, and under a white environment. Random points first, then a search that goes on from the worst. In
/// double, against the reference body. 0 when no material uses the node.
double worstColorError(const lang::Library& library, const std::string& node, const std::string& variant,
                       bool any_ior);

}  // namespace lacquer::bench
