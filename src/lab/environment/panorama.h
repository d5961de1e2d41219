// A picture of all that is around a point: Radiance HDR or OpenEXR, equirectangular.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "support/diagnostic.h"

namespace lacquer::environment {

using Rgb = std::array<float, 3>;
using Vec3 = std::array<double, 3>;

/// Linear radiance, row by row from the top (+y). A row goes once around y: its middle is at +x, three
/// quarters of it at +z, as the lookup u = 0.5 + atan(z, x) / (2 pi), v = acos(y) / pi has it. Numbers are
/// finite, not negative and at most 65408, the most that the formats of cube maps hold.
struct Panorama {
  uint32_t width = 0, height = 0;
  std::vector<Rgb> texels;
};

/// Scales colours and replaces what is no radiance: not a number and negative by 0, too large by the most.
/// `warnings` tells how often.
void clean(std::vector<Rgb>& colors, double scale, const Place& place, Diagnostics& warnings);

/// Decodes a picture of at most `most` pixels and 32768 in a row or column; memory is taken for the pixels
/// that its head claims. The colours are cleaned; `warnings` tells of a picture that is not twice as wide as
/// high, too. Errors: "environment-unreadable", "image-too-large".
Result<Panorama> readPanorama(std::string_view bytes, uint64_t most, const Place& place,
                              Diagnostics& warnings);

// The formats, once the first bytes have told which it is. Numbers are as they stand in the file.
Result<Panorama> readRadiance(std::string_view bytes, uint64_t most, const Place& place);
Result<Panorama> readOpenExr(std::string_view bytes, uint64_t most, const Place& place);

// What both say.
tl::unexpected<Diagnostics> unreadable(const Place& place, std::string message);
/// Of a side, in pixels.
constexpr int kLongestSide = 32768;
/// Errors: "environment-unreadable" for a side of 0 or beyond that, "image-too-large".
Result<void> checkSize(int64_t width, int64_t height, uint64_t most, const Place& place);

}  // namespace lacquer::environment
