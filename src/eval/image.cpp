#include "eval/image.h"

#include <stb/stb_image.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lacquer::eval {

namespace {

/// More than any GPU takes; a larger claim in a file's header must not reserve memory.
constexpr int kLargest = 32768;

struct Free {
  void operator()(void* pixels) const { stbi_image_free(pixels); }
};

template <class Texel>
void fill(Image& image, const Texel* pixels) {
  constexpr float kScale = 1.0F / static_cast<float>(std::numeric_limits<Texel>::max());
  image.texels.resize(static_cast<size_t>(image.width) * static_cast<size_t>(image.height));
  for (size_t i = 0; i < image.texels.size(); ++i) {
    for (size_t c = 0; c < 4; ++c) image.texels[i][c] = static_cast<float>(pixels[4 * i + c]) * kScale;
  }
}

}  // namespace

Result<Image> decodeImage(std::string_view bytes, const Place& place) {
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const auto wrong = [&](std::string message) {
    return fail("image-unreadable", place, std::move(message), "PNG and JPEG are read");
  };
  if (bytes.size() > static_cast<size_t>(std::numeric_limits<int>::max()))
    return wrong("the image is too large");
  const int size = static_cast<int>(bytes.size());
  Image image;
  int channels = 0;
  if (stbi_info_from_memory(data, size, &image.width, &image.height, &channels) == 0) {
    return wrong("this is no image, or of no known format");
  }
  if (image.width < 1 || image.height < 1 || image.width > kLargest || image.height > kLargest) {
    return wrong("the image is too large");
  }
  if (stbi_is_16_bit_from_memory(data, size) != 0) {
    const std::unique_ptr<stbi_us, Free> pixels(
        stbi_load_16_from_memory(data, size, &image.width, &image.height, &channels, 4));
    if (!pixels) return wrong("the image is damaged");
    fill(image, pixels.get());
  } else {
    const std::unique_ptr<stbi_uc, Free> pixels(
        stbi_load_from_memory(data, size, &image.width, &image.height, &channels, 4));
    if (!pixels) return wrong("the image is damaged");
    fill(image, pixels.get());
  }
  return image;
}

double decodeSrgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

namespace {

/// The texel that a whole-numbered coordinate names. `size` is at least 1.
size_t wrapped(double index, int size, Wrap wrap) {
  const double n = size;
  switch (wrap) {
    case Wrap::Repeat: index -= n * std::floor(index / n); break;
    case Wrap::Clamp: break;
    case Wrap::Mirror:
      index -= 2 * n * std::floor(index / (2 * n));
      if (index >= n) index = 2 * n - 1 - index;
      break;
  }
  // Rounding of a huge coordinate may land one off.
  return static_cast<size_t>(std::clamp(index, 0.0, n - 1));
}

class ImageSampler {
public:
  ImageSampler(std::shared_ptr<const Image> image, const Lookup& lookup)
      : image_(std::move(image)), lookup_(lookup) {}

  std::array<double, 4> operator()(size_t, const std::array<double, 3>& uv, double) const {
    const double x = std::isfinite(uv[0]) ? uv[0] * image_->width : 0;
    const double y = std::isfinite(uv[1]) ? uv[1] * image_->height : 0;
    if (lookup_.nearest) return texel(std::floor(x), std::floor(y));
    const double left = std::floor(x - 0.5);
    const double top = std::floor(y - 0.5);
    const double fx = x - 0.5 - left;
    const double fy = y - 0.5 - top;
    const auto a = texel(left, top);
    const auto b = texel(left + 1, top);
    const auto c = texel(left, top + 1);
    const auto d = texel(left + 1, top + 1);
    std::array<double, 4> result{};
    for (size_t i = 0; i < 4; ++i) {
      result[i] = (a[i] * (1 - fx) + b[i] * fx) * (1 - fy) + (c[i] * (1 - fx) + d[i] * fx) * fy;
    }
    return result;
  }

private:
  std::array<double, 4> texel(double x, double y) const {
    const size_t column = wrapped(x, image_->width, lookup_.s);
    const size_t row = wrapped(y, image_->height, lookup_.t);
    const std::array<float, 4>& stored = image_->texels[row * static_cast<size_t>(image_->width) + column];
    std::array<double, 4> result{};
    for (size_t i = 0; i < 4; ++i) {
      result[i] = static_cast<double>(stored[i]);
      if (lookup_.srgb && i < 3) result[i] = decodeSrgb(result[i]);
    }
    return result;
  }

  std::shared_ptr<const Image> image_;
  Lookup lookup_;
};

}  // namespace

Sampler makeSampler(std::shared_ptr<const Image> image, const Lookup& lookup) {
  return ImageSampler(std::move(image), lookup);
}

}  // namespace lacquer::eval
