#include "environment/cube.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

#include "environment/faces.h"
#include "environment/panorama.h"

namespace lacquer::environment {

namespace {

constexpr std::string_view kMagic("\xABKTX 20\xBB\r\n\x1A\n", 12);
constexpr size_t kHeader = 80, kLevel = 24;

enum class Numbers : uint8_t { Unorm8, Srgb8, Unorm16, Half, Float, SharedExponent, SmallFloats };

/// A VkFormat that is read.
struct Format {
  uint32_t number;
  Numbers numbers;
  uint32_t channels, bytes;  ///< of a texel
};
constexpr Format kFormats[] = {
    {23, Numbers::Unorm8, 3, 3},           // R8G8B8_UNORM
    {29, Numbers::Srgb8, 3, 3},            // R8G8B8_SRGB
    {37, Numbers::Unorm8, 4, 4},           // R8G8B8A8_UNORM
    {43, Numbers::Srgb8, 4, 4},            // R8G8B8A8_SRGB
    {84, Numbers::Unorm16, 3, 6},          // R16G16B16_UNORM
    {90, Numbers::Half, 3, 6},             // R16G16B16_SFLOAT
    {91, Numbers::Unorm16, 4, 8},          // R16G16B16A16_UNORM
    {97, Numbers::Half, 4, 8},             // R16G16B16A16_SFLOAT
    {106, Numbers::Float, 3, 12},          // R32G32B32_SFLOAT
    {109, Numbers::Float, 4, 16},          // R32G32B32A32_SFLOAT
    {122, Numbers::SmallFloats, 3, 4},     // B10G11R11_UFLOAT_PACK32
    {123, Numbers::SharedExponent, 3, 4},  // E5B9G9R9_UFLOAT_PACK32
};

uint64_t number(std::string_view bytes, size_t at, size_t count) {
  uint64_t value = 0;
  for (size_t i = 0; i < count; ++i) value |= uint64_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  return value;
}

/// A float of five bits of exponent and so many of mantissa, without a sign.
/// source: Vulkan, "16-Bit Floating-Point Numbers", "Unsigned 11-Bit Floating-Point Numbers"
float smallFloat(uint32_t bits, int mantissa_bits) {
  const int exponent = static_cast<int>(bits >> mantissa_bits);
  const auto mantissa = static_cast<float>(bits & ((1U << mantissa_bits) - 1));
  if (exponent == 31) return mantissa == 0 ? INFINITY : NAN;
  return exponent == 0
             ? std::ldexp(mantissa, -14 - mantissa_bits)
             : std::ldexp(mantissa + std::ldexp(1.0F, mantissa_bits), exponent - 15 - mantissa_bits);
}

float halfFloat(uint32_t bits) {
  const float size = smallFloat(bits & 0x7FFFU, 10);
  return (bits & 0x8000U) != 0 ? -size : size;
}

/// source: IEC 61966-2-1
float fromSrgb(float x) { return x <= 0.04045F ? x / 12.92F : std::pow((x + 0.055F) / 1.055F, 2.4F); }

float channelOf(std::string_view texel, Numbers numbers, size_t c) {
  switch (numbers) {
    case Numbers::Unorm8: return static_cast<float>(number(texel, c, 1)) / 255;
    case Numbers::Srgb8: return fromSrgb(static_cast<float>(number(texel, c, 1)) / 255);
    case Numbers::Unorm16: return static_cast<float>(number(texel, 2 * c, 2)) / 65535;
    case Numbers::Half: return halfFloat(static_cast<uint32_t>(number(texel, 2 * c, 2)));
    case Numbers::Float: {
      const auto bits = static_cast<uint32_t>(number(texel, 4 * c, 4));
      float value = 0;
      std::memcpy(&value, &bits, sizeof value);
      return value;
    }
    case Numbers::SmallFloats: {
      const auto bits = static_cast<uint32_t>(number(texel, 0, 4));
      return c < 2 ? smallFloat(bits >> (11 * c) & 0x7FFU, 6) : smallFloat(bits >> 22, 5);
    }
    case Numbers::SharedExponent: break;
  }
  // source: Vulkan, "RGB to Shared Exponent Conversion": nine bits, and a bias of 15
  const auto bits = static_cast<uint32_t>(number(texel, 0, 4));
  return std::ldexp(static_cast<float>(bits >> (9 * c) & 0x1FFU), static_cast<int>(bits >> 27) - 15 - 9);
}

/// What the file's head says.
struct Head {
  const Format* format = nullptr;
  uint32_t size = 0, layers = 0;
  uint64_t offset = 0, length = 0;  ///< of the largest level
};

Result<Head> headOf(std::string_view bytes, const Place& place) {
  const auto wrong = [&](std::string message, std::string help) {
    return fail("environment-unreadable", place, std::move(message), std::move(help));
  };
  if (bytes.size() < kHeader + kLevel)
    return wrong(
        fmt::format("a KTX2 file has at least {} bytes, this one {}", kHeader + kLevel, bytes.size()),
        "it was cut off");
  const auto field = [&](size_t at) { return static_cast<uint32_t>(number(bytes, at, 4)); };
  const uint32_t format = field(12), width = field(20), height = field(24), depth = field(28);
  const uint32_t scheme = field(44);
  if (field(36) != kFaces || depth != 0 || width != height || width == 0) {
    return wrong("the KTX2 file holds no cube map", "it has six faces, which are as wide as high");
  }
  if (scheme != 0) {
    return wrong(fmt::format("the KTX2 file is supercompressed, by scheme {}", scheme),
                 "store its levels as they are");
  }
  Head head;
  head.format = std::find_if(std::begin(kFormats), std::end(kFormats),
                             [&](const Format& row) { return row.number == format; });
  if (head.format == std::end(kFormats)) {
    return wrong(
        fmt::format("the KTX2 file's texels have the VkFormat {}", format),
        "R8G8B8 (UNORM, SRGB), R16G16B16 (UNORM, SFLOAT) and R32G32B32_SFLOAT, with or without alpha, "
        "E5B9G9R9_UFLOAT_PACK32 and B10G11R11_UFLOAT_PACK32 are read");
  }
  head.size = width;
  head.layers = std::max(field(32), 1U);
  head.offset = number(bytes, kHeader, 8);
  head.length = number(bytes, kHeader + 8, 8);
  return head;
}

}  // namespace

bool isKtx2(std::string_view bytes) { return bytes.starts_with(kMagic); }

Result<texture::CubeLevel> readCube(std::string_view bytes, uint32_t layer, uint64_t most,
                                    const Place& place) {
  const Result<Head> head = headOf(bytes, place);
  if (!head) return tl::make_unexpected(head.error());
  if (Result<void> good = checkSize(head->size, int64_t{kFaces} * head->size, most, place); !good)
    return tl::make_unexpected(good.error());
  if (layer >= head->layers) {
    return fail("environment-unreadable", place, fmt::format("the KTX2 file has no cube map {}", layer),
                fmt::format("it has {}, from 0 on", head->layers));
  }
  const Format& format = *head->format;
  const uint64_t texels = uint64_t{kFaces} * head->size * head->size;
  const uint64_t skipped = layer * texels * format.bytes, wanted = texels * format.bytes;
  if (head->offset > bytes.size() || head->length > bytes.size() - head->offset || skipped > head->length ||
      wanted > head->length - skipped) {
    return fail("environment-unreadable", place, "the KTX2 file ends before its largest level does",
                "it was cut off, or its index is wrong");
  }
  texture::CubeLevel cube{head->size, std::vector<texture::Rgb>(static_cast<size_t>(texels))};
  size_t at = static_cast<size_t>(head->offset + skipped);
  for (texture::Rgb& color : cube.texels) {
    const std::string_view texel = bytes.substr(at, format.bytes);
    for (size_t c = 0; c < 3; ++c) color[c] = channelOf(texel, format.numbers, c);
    at += format.bytes;
  }
  return cube;
}

}  // namespace lacquer::environment
