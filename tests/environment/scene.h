// Surroundings to test with, and what the maps of them should hold by plain sums over all of their pixels.
#pragma once

#include <string>

#include "environment/maps.h"

namespace lacquer::test {

using environment::Panorama;
using environment::Rgb;
using environment::Vec3;

/// A sky over a ground, a window with edges, a strip of colours, and a sun of `sun` times the sky in a few
/// pixels.
Panorama outdoors(uint32_t width, double sun);
Panorama constant(uint32_t width, const Rgb& color);

/// The direction of a pixel's middle.
Vec3 directionOf(const Panorama& panorama, double x, double y);

/// What a lobe is: GGX or the fibres' with N = V = R, or the cosine.
enum class Shape { Ggx, Charlie, Cosine };

/// The integral of radiance times the lobe over that of the lobe, by a sum over the pixels, each cut into
/// `parts` by `parts`.
std::array<double, 3> quadrature(const Panorama& panorama, Shape shape, double alpha, const Vec3& direction,
                                 int parts);

/// A Radiance file of the pixels, each row run-length encoded or all of them flat.
std::string radianceFile(const Panorama& panorama, bool encoded);

}  // namespace lacquer::test
