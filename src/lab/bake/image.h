// A texture that a pattern computes, as an image.
#pragma once

#include <cstdint>
#include <string>

#include "preview/ball.h"

namespace lacquer::baking {

/// RGBA of 8 bits, PNG: each texel is the mean of four places in it, at the texture coordinates (u, v) with
/// the first row at v = 0, on the plane through (u, v, 0). `srgb`: red, green and blue are encoded. Uses
/// threads.
std::string imageOf(const preview::Shading& shading, uint32_t size, bool srgb);

}  // namespace lacquer::baking
