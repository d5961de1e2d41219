// Images on the CPU: decoded, and looked up as a sampler does at the first mip level.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "eval/bindings.h"
#include "support/diagnostic.h"

namespace lacquer::eval {

/// RGBA as stored, in [0, 1], row by row from the top. Grey images have equal RGB, images without alpha
/// have 1.
struct Image {
  int width = 0, height = 0;
  std::vector<std::array<float, 4>> texels;
};

/// Decodes PNG, JPEG and what else stb_image reads, with 8 or 16 bits per channel. Errors:
/// "image-unreadable".
Result<Image> decodeImage(std::string_view bytes, const Place& place);

enum class Wrap : uint8_t { Repeat, Clamp, Mirror };

struct Lookup {
  Wrap s = Wrap::Repeat, t = Wrap::Repeat;
  bool nearest = false;  ///< else bilinear
  bool srgb = false;     ///< RGB is decoded before it is filtered, as an sRGB format does
};

/// A sampler of an image. A coordinate that is no finite number counts as 0.
Sampler makeSampler(std::shared_ptr<const Image> image, const Lookup& lookup);

/// IEC 61966-2-1, one channel.
double decodeSrgb(double encoded);

}  // namespace lacquer::eval
