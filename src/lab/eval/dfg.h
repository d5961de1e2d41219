// The split sum's factors, which shaders read from the texture environment_dfg, and the tables that
// evaluation reads.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>
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

/// The table behind a template's texture, "environment_dfg" or "environment_sheen" (eval/sheen.h): its first
/// two channels, to be looked up bilinearly and clamped to its edge. Null for every other name.
std::shared_ptr<const Image> environmentTable(std::string_view name);
/// Such a lookup, for one of the two names; none, which is not to be called, for every other.
Sampler environmentSampler(std::string_view name);

}  // namespace lacquer::eval
