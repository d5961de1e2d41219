#include "eval/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "support/limits.h"

namespace {

/// Bytes that the decoder may take in one piece. A stream that unpacks to more than its image holds is
/// stopped by it.
thread_local size_t largest_block = 0;

/// Zeros: a JPEG may use tables that it has not got, and those are read as the memory has them.
void* takeBlock(size_t size) { return size <= largest_block ? std::calloc(size, 1) : nullptr; }
void* growBlock(void* block, size_t size) {
  return size <= largest_block ? std::realloc(block, size) : nullptr;
}

/// Where a PNG's first chunk of data is empty the decoder copies none of it to a null pointer, which C leaves
/// undefined.
void* copyBlock(void* to, const void* from, size_t size) {
  return size == 0 ? to : std::memcpy(to, from, size);
}

}  // namespace

// The two formats of glTF and no other are compiled in.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#define STBI_MALLOC(size) takeBlock(size)
#define STBI_REALLOC(block, size) growBlock(block, size)
#define STBI_FREE(block) std::free(block)
#ifdef __GNUC__
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wsign-compare"
#endif
#define memcpy copyBlock
#include <stb/stb_image.h>
#undef memcpy
#ifdef __GNUC__
#pragma GCC diagnostic pop
#endif

namespace lacquer::eval {

namespace {

/// Sides of more than this no GPU takes.
constexpr int kLongest = 32768;
/// What the decoder takes beside the pixels: tables, and the head of what it unpacks.
constexpr size_t kBeside = size_t{1} << 20;

tl::unexpected<Diagnostics> unreadable(const Place& place, std::string message) {
  return fail("image-unreadable", place, std::move(message), "PNG and JPEG are read");
}

/// "a KTX2 file": what the bytes are that are not read.
std::string_view formatOf(std::string_view bytes) {
  if (bytes.starts_with("\xABKTX 20\xBB\r\n\x1A\n")) return "a KTX2 file";
  if (bytes.starts_with("RIFF") && bytes.substr(0, 12).ends_with("WEBP")) return "a WebP file";
  return "neither a PNG nor a JPEG";
}

bool isPngOrJpeg(std::string_view bytes) {
  return bytes.starts_with("\x89PNG\r\n\x1a\n") || bytes.starts_with("\xff\xd8\xff");
}

/// One of JPEG's segments of Huffman tables: each table's sixteen counts of codes, then as many values. stb
/// writes as many as the counts say into room for 256.
bool huffmanTablesFit(std::string_view segment) {
  constexpr size_t kCounts = 16;
  constexpr size_t kMostCodes = 256;
  while (!segment.empty()) {
    if (segment.size() < 1 + kCounts) return false;
    size_t codes = 0;
    for (size_t i = 1; i <= kCounts; ++i) codes += static_cast<unsigned char>(segment[i]);
    if (codes > kMostCodes || codes > segment.size() - 1 - kCounts) return false;
    segment.remove_prefix(1 + kCounts + codes);
  }
  return true;
}

/// Scans of a JPEG. Each goes over all of its pixels, however few bytes it has; encoders write about ten.
constexpr size_t kMostScans = 100;

/// What the decoder must not see in a JPEG; empty where all is well, and for what is no JPEG. Finds its
/// markers as stb does: between segments whatever is no 0xFF is passed over, and so is what a scan encodes,
/// with its 0xFF00 and its restarts.
std::string jpegFault(std::string_view bytes) {
  constexpr unsigned kStuffed = 0x00, kTables = 0xC4, kRestart0 = 0xD0, kStart = 0xD8, kEnd = 0xD9,
                     kScan = 0xDA, kFill = 0xFF;
  if (bytes.starts_with('\x89')) return {};
  size_t scans = 0;
  const auto at = [&](size_t i) { return static_cast<unsigned char>(bytes[i]); };
  for (size_t i = 0; i + 1 < bytes.size();) {
    if (at(i) != kFill) {
      ++i;
      continue;
    }
    const unsigned marker = at(++i);
    if (marker == kFill) continue;
    ++i;
    if (marker == kStuffed || (marker >= kRestart0 && marker <= kStart)) continue;
    if (marker == kEnd || i + 2 > bytes.size()) return {};
    if (marker == kScan && ++scans > kMostScans) return fmt::format("it has more than {} scans", kMostScans);
    const size_t length = at(i) * size_t{256} + at(i + 1);
    const size_t here = std::min(length, bytes.size() - i);
    if (marker == kTables && (length < 2 || !huffmanTablesFit(bytes.substr(i + 2, here - 2))))
      return "it has a bad Huffman table";
    i += std::max<size_t>(here, 2);
  }
  return {};
}

/// The decoder's words for what it was not given are no fault of the machine's memory: takeBlock() has no
/// more for a stream that unpacks to more than its image.
std::string damaged() {
  const std::string_view reason = stbi_failure_reason();
  return "the image is damaged" + (reason == "outofmem" ? std::string() : fmt::format(": {}", reason));
}

const stbi_uc* dataOf(std::string_view bytes) { return reinterpret_cast<const stbi_uc*>(bytes.data()); }

template <class Number>
Result<Image> imageOf(const Number* pixels, int width, int height, const ImageSize& size,
                      const Place& place) {
  if (pixels == nullptr) return unreadable(place, damaged());
  if (width != size.width || height != size.height) return unreadable(place, "the image is damaged");
  Image::Texels<Number> texels(size.pixels());
  std::memcpy(texels.data(), pixels, texels.size() * sizeof texels[0]);
  return Image{width, height, 1, std::move(texels)};
}

struct Free {
  void operator()(void* pixels) const { stbi_image_free(pixels); }
};

}  // namespace

std::array<float, 4> Image::at(size_t i) const {
  return std::visit(
      [i]<class Number>(const Texels<Number>& all) {
        if constexpr (std::is_same_v<Number, float>) {
          return all[i];
        } else {
          constexpr float kScale = 1.0F / static_cast<float>(std::numeric_limits<Number>::max());
          std::array<float, 4> texel{};
          for (size_t c = 0; c < 4; ++c) texel[c] = static_cast<float>(all[i][c]) * kScale;
          return texel;
        }
      },
      texels);
}

Result<ImageSize> sizeOfImage(std::string_view bytes, const Place& place) {
  if (!isPngOrJpeg(bytes)) return unreadable(place, fmt::format("this is {}", formatOf(bytes)));
  if (bytes.size() > static_cast<size_t>(std::numeric_limits<int>::max()))
    return unreadable(place, "the image is too large");
  if (const std::string fault = jpegFault(bytes); !fault.empty())
    return unreadable(place, "the image is damaged: " + fault);
  const int length = static_cast<int>(bytes.size());
  largest_block = kBeside;
  ImageSize size;
  int channels = 0;
  if (stbi_info_from_memory(dataOf(bytes), length, &size.width, &size.height, &channels) == 0 ||
      size.width < 1 || size.height < 1) {
    return unreadable(place, "the image is damaged");
  }
  size.wide = stbi_is_16_bit_from_memory(dataOf(bytes), length) != 0;
  return size;
}

Result<Image> decodeImage(std::string_view bytes, uint64_t most, const Place& place) {
  const Result<ImageSize> size = sizeOfImage(bytes, place);
  if (!size) return tl::make_unexpected(size.error());
  if (size->width > kLongest || size->height > kLongest) {
    return fail("image-too-large", place,
                fmt::format("the image has {} by {} pixels", size->width, size->height),
                fmt::format("a side has at most {}", kLongest));
  }
  if (size->pixels() > most) {
    return fail("image-too-large", place,
                fmt::format("the image has {} by {} pixels, more than {}", size->width, size->height, most),
                raising("image"));
  }
  // Four channels, JPEG's blocks at the edges; twice that, for the decoder doubles what it unpacks to.
  constexpr size_t kBlocks = 64;
  const size_t numbers =
      4 * (static_cast<size_t>(size->width) + kBlocks) * (static_cast<size_t>(size->height) + kBlocks);
  largest_block = 2 * ((size->wide ? 2 : 1) * numbers + bytes.size()) + kBeside;
  const int length = static_cast<int>(bytes.size());
  int width = 0;
  int height = 0;
  int channels = 0;
  if (size->wide) {
    const std::unique_ptr<stbi_us, Free> pixels(
        stbi_load_16_from_memory(dataOf(bytes), length, &width, &height, &channels, 4));
    return imageOf(pixels.get(), width, height, *size, place);
  }
  const std::unique_ptr<stbi_uc, Free> pixels(
      stbi_load_from_memory(dataOf(bytes), length, &width, &height, &channels, 4));
  return imageOf(pixels.get(), width, height, *size, place);
}

Result<Image> layered(const std::vector<std::shared_ptr<const Image>>& layers,
                      const std::array<double, 4>& missing, const Place& place) {
  const Image* first = nullptr;
  bool bytes = true;
  for (const auto& layer : layers) {
    // What stands for one that is missing need not be a number of 8 bits.
    if (layer == nullptr) bytes = false;
    if (layer == nullptr) continue;
    bytes = bytes && std::holds_alternative<Image::Texels<uint8_t>>(layer->texels);
    if (first == nullptr) first = layer.get();
    if (layer->width == first->width && layer->height == first->height) continue;
    return fail("image-size", place,
                fmt::format("one image has {} by {} pixels, another {} by {}", first->width, first->height,
                            layer->width, layer->height),
                "the layers of a texture are of one size");
  }
  Image made;
  made.width = first == nullptr ? 1 : first->width;
  made.height = first == nullptr ? 1 : first->height;
  const size_t each = made.size();
  const auto fill = [&]<class Number>(Image::Texels<Number> texels, const auto& of) {
    std::array<Number, 4> absent{};
    for (size_t c = 0; std::is_same_v<Number, float> && c < 4; ++c)
      absent[c] = static_cast<Number>(missing[c]);
    texels.reserve(each * layers.size());
    for (const auto& layer : layers) {
      for (size_t i = 0; i < each; ++i) texels.push_back(layer == nullptr ? absent : of(*layer, i));
    }
    made.texels = std::move(texels);
  };
  if (bytes)
    fill(Image::Texels<uint8_t>(),
         [](const Image& image, size_t i) { return std::get<Image::Texels<uint8_t>>(image.texels)[i]; });
  else
    fill(Image::Texels<float>(), [](const Image& image, size_t i) { return image.at(i); });
  made.layers = static_cast<int>(layers.size());
  return made;
}

double encodedSrgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
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
    const double z =
        std::isfinite(uv[2]) ? std::clamp(std::floor(uv[2] + 0.5), 0.0, image_->layers - 1.0) : 0;
    const auto texel = [&](double column, double row) { return at(column, row, static_cast<size_t>(z)); };
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
  std::array<double, 4> at(double x, double y, size_t layer) const {
    const size_t column = wrapped(x, image_->width, lookup_.s);
    const size_t row = wrapped(y, image_->height, lookup_.t) + layer * static_cast<size_t>(image_->height);
    const std::array<float, 4> stored = image_->at(row * static_cast<size_t>(image_->width) + column);
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
  const std::array<int, 3> size{image->width, image->height, image->layers};
  Sampler sampler = ImageSampler(std::move(image), lookup);
  sampler.size = size;
  return sampler;
}

}  // namespace lacquer::eval
