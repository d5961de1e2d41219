// The split sum's factors, which shaders read from the texture environment_dfg.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "eval/image.h"

namespace lacquer::eval {

/// What the height-correlated GGX lobe of glTF 2.0, Appendix B, reflects of an environment of radiance 1:
/// scale and bias of F0 scale + bias, by quadrature in double. `NdotV` in (0, 1], `roughness` in [0, 1]
/// (alpha is clamped as in shaders). Karis 2013, "Real Shading in Unreal Engine 4".
std::array<double, 2> environmentDfg(double NdotV, double roughness);

/// Texels of a table: `size` rows of roughness with `size` columns of NdotV, at texel centres, scale and bias
/// each.
std::vector<float> environmentDfgTable(uint32_t size);

/// The table that evaluation reads, as an image; to be looked up bilinearly and clamped to its edge.
std::shared_ptr<const Image> environmentDfgImage();
/// Such a lookup.
Sampler environmentDfgSampler();

}  // namespace lacquer::eval
