// What a pattern computes at the texture coordinates, as images: linear texels with mip levels, and files.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "lacquer/exchange.h"
#include "preview/ball.h"

namespace lacquer::baking {

/// A square of linear RGBA, row by row; the first row is at v = 0. Numbers are finite.
struct Image {
  uint32_t size = 0;
  std::vector<std::array<float, 4>> texels;
};

/// Called with the number of rows that have been finished since the last call, from one thread at a time.
using Rows = std::function<void(size_t)>;

struct Sampling {
  uint32_t size = 0;     ///< texels along each side
  uint32_t samples = 2;  ///< places along each side of a texel, an even number
  bool clamp = false;    ///< each value is brought to [0, 1] before the mean, as a texture of 8 bits holds it
  int components = 4;    ///< of a value: one is grey, and of fewer than four alpha is 1
};

/// Each texel is the mean of places in it, in quads, whose neighbours' differences are derivatives: at the
/// texture coordinates (u, v), on the plane through (u, v, 0). What is no number counts as 0. Uses threads;
/// the numbers do not depend on how many.
Image imageOf(const preview::Shading& shading, const Sampling& how, const Rows& rows);

/// The image and its levels, each half as wide as the one before (rounded down), to a single texel: means
/// over the area of each texel in linear numbers.
std::vector<Image> withLevels(Image image);

/// Files of one image: one of all levels, or for PNG, which has none, one for each. `srgb`: red, green and
/// blue are encoded (not in OpenEXR, and not in halves). Errors: "no-openexr" in a build without its library.
Result<Strings> filesOf(const std::vector<Image>& levels, Texels format, uint32_t bits, bool srgb);

/// The whole OpenEXR file, ZIP: halves for 16 bits, else floats; tiles where there are several levels.
Result<std::string> openExrOf(const std::vector<Image>& levels, uint32_t bits);

}  // namespace lacquer::baking
