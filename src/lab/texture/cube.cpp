#include "texture/cube.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "texture/container.h"

namespace lacquer::texture {

namespace {

constexpr uint32_t kFaces = 6;
constexpr uint32_t kAlpha = 15;

TexelFormat halves() {
  constexpr uint32_t kSignedFloat = 0xC0;
  constexpr uint32_t kMinusOne = 0xBF800000;
  constexpr uint32_t kOne = 0x3F800000;
  TexelFormat format{97, 10, 2, 8, {}};
  for (uint32_t i = 0; i < 4; ++i)
    format.channels.push_back({16 * i, 16, (i == 3 ? kAlpha : i) | kSignedFloat, kMinusOne, kOne});
  return format;
}

/// Of each channel the nine bits, then the exponent that it shares (Khronos Data Format 1.3, "Shared exponent
/// formats": the mantissa that stands for 1 at the least exponent's bias, 15).
TexelFormat sharedExponents() {
  constexpr uint32_t kExponent = 0x20;
  TexelFormat format{123, 67, 4, 4, {}};
  for (uint32_t i = 0; i < 3; ++i) {
    format.channels.push_back({9 * i, 9, i, 0, 8448});
    format.channels.push_back({27, 5, i | kExponent, 15, 31});
  }
  return format;
}

std::string bytesOf(CubeTexels format, const CubeLevel& level) {
  assert(level.texels.size() == size_t{kFaces} * level.size * level.size);
  constexpr uint16_t kHalfOne = 0x3C00;
  std::string bytes;
  bytes.reserve(level.texels.size() * (format == CubeTexels::Half ? 8 : 4));
  for (const Rgb& color : level.texels) {
    if (format == CubeTexels::Rgb9e5) {
      append(bytes, rgb9e5Bits(color));
      continue;
    }
    for (const float x : color) append(bytes, halfBits(std::min(x, kMostRadiance)), 2);
    append(bytes, kHalfOne, 2);
  }
  return bytes;
}

}  // namespace

uint32_t rgb9e5Bits(const Rgb& color) {
  constexpr int kBits = 9, kBias = 15;
  const float largest = std::min(std::max({color[0], color[1], color[2]}), kMostRadiance);
  int exponent = 0;
  std::frexp(largest, &exponent);
  int shared = largest > 0 ? std::max(exponent + kBias, 0) : 0;
  const auto mantissa = [&](float x) {
    return static_cast<uint32_t>(
        std::nearbyint(std::ldexp(std::min(x, kMostRadiance), kBits + kBias - shared)));
  };
  // Rounding up may take a bit more.
  if (mantissa(largest) == 1U << kBits) ++shared;
  assert(shared < 32);
  uint32_t bits = static_cast<uint32_t>(shared) << 27U;
  for (uint32_t i = 0; i < 3; ++i) bits |= mantissa(color[i]) << (9 * i);
  return bits;
}

std::string cubeFile(Container container, CubeTexels format, const std::vector<CubeLevel>& levels) {
  assert(!levels.empty() && container != Container::Png);
  Levels made;
  made.size = levels[0].size;
  made.faces = kFaces;
  for (const CubeLevel& level : levels) made.bytes.push_back(bytesOf(format, level));
  const TexelFormat texels = format == CubeTexels::Half ? halves() : sharedExponents();
  return container == Container::Dds ? ddsFile(texels, made) : ktx2File(texels, made);
}

}  // namespace lacquer::texture
