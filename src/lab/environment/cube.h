// A cube map of all that is around a point, from a KTX2 file.
#pragma once

#include <cstdint>
#include <string_view>

#include "support/diagnostic.h"
#include "texture/cube.h"

namespace lacquer::environment {

/// By its first bytes.
bool isKtx2(std::string_view bytes);

/// The largest level of a cube map, the numbers as they stand in the file, those of sRGB as linear ones. Of
/// an array of cubes it is `layer`. Formats are those of KHR_lights_environment, and the same with four
/// channels or floats of 32 bits; without supercompression. A cube has at most `most` texels. Errors:
/// "environment-unreadable", "image-too-large".
/// source: KTX File Format 2.0; KHR_lights_environment, "KTX v2 Images"
Result<texture::CubeLevel> readCube(std::string_view bytes, uint32_t layer, uint64_t most,
                                    const Place& place);

}  // namespace lacquer::environment
