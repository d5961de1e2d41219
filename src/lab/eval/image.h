// Images on the CPU: decoded, and looked up as a sampler does at the first mip level.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>
#include <variant>
#include <vector>

#include "eval/bindings.h"
#include "support/diagnostic.h"

namespace lacquer::eval {

/// RGBA, row by row from the top, in the numbers of the file: whole ones of 8 or 16 bits stand for [0, 1].
/// Grey images have equal RGB, images without alpha have 1.
struct Image {
  template <class Number>
  using Texels = std::vector<std::array<Number, 4>>;

  int width = 0, height = 0;
  /// Of an array of images: they stand one behind the other in `texels`, all of one size.
  int layers = 1;
  std::variant<Texels<float>, Texels<uint8_t>, Texels<uint16_t>> texels;

  size_t size() const {
    return static_cast<size_t>(width) * static_cast<size_t>(height) * static_cast<size_t>(layers);
  }
  /// What a texel's numbers stand for. `i` is below size().
  std::array<float, 4> at(size_t i) const;
};

struct ImageSize {
  int width = 0, height = 0;
  bool wide = false;  ///< 16 bits per channel
  uint64_t pixels() const { return static_cast<uint64_t>(width) * static_cast<uint64_t>(height); }
};

/// What the head of a PNG or a JPEG claims; no other format is looked at. Errors: "image-unreadable".
Result<ImageSize> sizeOfImage(std::string_view bytes, const Place& place);

/// Decodes a PNG or a JPEG of at most `most` pixels. Memory is taken for the pixels that the head claims, and
/// no more, whatever follows. Errors: "image-unreadable", "image-too-large".
Result<Image> decodeImage(std::string_view bytes, uint64_t most, const Place& place);

/// The images, nothing for what is missing, as the layers of an array; `missing` stands in the numbers of the
/// file for each texel of a layer that is not there. Errors: "image-size" where two are not of one size; the
/// place is that of the whole.
Result<Image> layered(const std::vector<std::shared_ptr<const Image>>& layers,
                      const std::array<double, 4>& missing, const Place& place);

enum class Wrap : uint8_t { Repeat, Clamp, Mirror };

struct Lookup {
  Wrap s = Wrap::Repeat, t = Wrap::Repeat;
  bool nearest = false;  ///< else bilinear
  bool srgb = false;     ///< RGB is decoded before it is filtered, as an sRGB format does
};

/// A sampler of an image, or of an array of them: its third coordinate is the layer, the nearest one. A
/// coordinate that is no finite number counts as 0.
Sampler makeSampler(std::shared_ptr<const Image> image, const Lookup& lookup);

/// The inverse of decodeSrgb().
double encodedSrgb(double linear);

/// IEC 61966-2-1, one channel.
double decodeSrgb(double encoded);

}  // namespace lacquer::eval
