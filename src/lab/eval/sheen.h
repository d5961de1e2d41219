// What the fibres of a sheen reflect, which shaders read from the texture environment_sheen.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace lacquer::eval {

/// Texels of a table: `size` rows of roughness with `size` columns of a cosine, at texel centres, two numbers
/// each. The second is 1 / max(E, 1), E the albedo of KHR_materials_sheen's D V: it passes 1 towards grazing.
/// The first is the albedo of D V times the second at N.V and at N.L, which is at most 1. By quadrature in
/// double; alpha is clamped as in shaders. Conty and Kulla 2017, "Production Friendly Microfacet Sheen BRDF".
std::vector<float> environmentSheenTable(uint32_t size);

/// One row of it, at other cosines in (0, 1].
std::vector<std::array<double, 2>> environmentSheen(const std::vector<double>& cosines, double roughness);

}  // namespace lacquer::eval
