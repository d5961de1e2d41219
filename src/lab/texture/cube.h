// Cube maps of radiance with mip levels, as files.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "texture/table.h"

namespace lacquer::texture {

using Rgb = std::array<float, 3>;

/// The faces of one level: `size` rows of `size` texels each, the first row at the top, in the order +x, -x,
/// +y, -y, +z, -z and in the orientation that all APIs share.
struct CubeLevel {
  uint32_t size = 0;
  std::vector<Rgb> texels;
};

enum class CubeTexels : uint8_t {
  Half,    ///< R16G16B16A16_SFLOAT, alpha 1
  Rgb9e5,  ///< E5B9G9R9_UFLOAT_PACK32: nine bits a channel, one exponent; half of the bytes
};

/// The largest number that both formats hold; larger ones become it.
inline constexpr float kMostRadiance = 65408;

/// The whole file, .dds or .ktx2. Each level has half the size of the one before. Numbers are finite and not
/// negative.
std::string cubeFile(Container container, CubeTexels format, const std::vector<CubeLevel>& levels);

/// Three numbers as E5B9G9R9 (Vulkan, "Shared Exponent to RGB"): its bits, rounded to the nearest.
uint32_t rgb9e5Bits(const Rgb& color);

}  // namespace lacquer::texture
