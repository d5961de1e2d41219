#include "texture/table.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>
#include <cmath>
#include <utility>

#include "texture/png.h"

namespace lacquer::texture {

namespace {

void append(std::string& bytes, uint64_t value, int count = 4) {
  for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFFU);
}

uint16_t unormBits(float x) { return static_cast<uint16_t>(std::lround(x * 65535.0F)); }

/// DirectDraw Surface, DXGI_FORMAT_R16G16_UNORM (Microsoft, "Programming Guide for DDS").
std::string dds(uint32_t size, std::span<const float> values) {
  constexpr uint32_t kCapsHeightWidthPitchFormat = 0x100F;
  constexpr uint32_t kFourCc = 4;
  constexpr uint32_t kDx10 = 0x30315844;
  constexpr uint32_t kTexture = 0x1000;
  constexpr uint32_t kR16G16Unorm = 35;
  constexpr uint32_t kTexture2D = 3;
  std::string bytes = "DDS ";
  for (const uint32_t word :
       {uint32_t{124}, kCapsHeightWidthPitchFormat, size, size, size * 4, uint32_t{0}, uint32_t{1}})
    append(bytes, word);
  for (int i = 0; i < 11; ++i) append(bytes, 0);
  for (const uint32_t word :
       {uint32_t{32}, kFourCc, kDx10, uint32_t{0}, uint32_t{0}, uint32_t{0}, uint32_t{0}, uint32_t{0}})
    append(bytes, word);
  for (const uint32_t word : {kTexture, uint32_t{0}, uint32_t{0}, uint32_t{0}, uint32_t{0}})
    append(bytes, word);
  for (const uint32_t word : {kR16G16Unorm, kTexture2D, uint32_t{0}, uint32_t{1}, uint32_t{0}})
    append(bytes, word);
  for (const float x : values) append(bytes, unormBits(x), 2);
  return bytes;
}

/// The basic data format descriptor of two halves (Khronos Data Format 1.3, "The Basic Data Format Descriptor
/// Block"): linear, without a colour space of its own.
std::string descriptorOfHalves() {
  constexpr uint32_t kSamples = 2;
  constexpr uint32_t kBlock = 24 + 16 * kSamples;
  constexpr uint32_t kModelRgb = 1;
  constexpr uint32_t kTransferLinear = 1;
  constexpr uint32_t kSignedFloat = 0xC0;
  constexpr uint32_t kMinusOne = 0xBF800000;
  constexpr uint32_t kOne = 0x3F800000;
  std::string bytes;
  append(bytes, 4 + kBlock);
  append(bytes, 0);                                   // Khronos, basic format
  append(bytes, 2U | kBlock << 16U);                  // version 1.3
  append(bytes, kModelRgb | kTransferLinear << 16U);  // primaries unspecified
  append(bytes, 0);                                   // texel blocks of 1 x 1
  append(bytes, 4, 8);                                // bytes of plane 0
  for (uint32_t channel = 0; channel < kSamples; ++channel) {
    append(bytes, 16 * channel | 15U << 16U | (channel | kSignedFloat) << 24U);
    append(bytes, 0);
    append(bytes, kMinusOne);
    append(bytes, kOne);
  }
  return bytes;
}

/// KTX File Format 2.0, one level without supercompression.
std::string ktx2(uint32_t size, std::span<const float> values) {
  constexpr uint32_t kR16G16Sfloat = 83;
  constexpr uint32_t kHeader = 80;
  constexpr uint32_t kLevelIndex = 24;
  const std::string descriptor = descriptorOfHalves();
  std::string keys;
  for (const std::string& pair :
       {std::string("KTXorientation\0rd\0", 18), std::string("KTXwriter\0Lacquer\0", 18)}) {
    append(keys, pair.size());
    keys += pair;
    while (keys.size() % 4 != 0) keys += '\0';
  }
  std::string bytes = "\xABKTX 20\xBB\r\n\x1A\n";
  for (const uint32_t word : {kR16G16Sfloat, uint32_t{2}, size, size, uint32_t{0}, uint32_t{0}, uint32_t{1},
                              uint32_t{1}, uint32_t{0}})
    append(bytes, word);
  append(bytes, kHeader + kLevelIndex);
  append(bytes, descriptor.size());
  append(bytes, kHeader + kLevelIndex + descriptor.size());
  append(bytes, keys.size());
  append(bytes, 0, 8);
  append(bytes, 0, 8);
  assert(bytes.size() == kHeader);
  const uint64_t length = uint64_t{4} * size * size;
  append(bytes, kHeader + kLevelIndex + descriptor.size() + keys.size(), 8);
  append(bytes, length, 8);
  append(bytes, length, 8);
  bytes += descriptor + keys;
  for (const float x : values) append(bytes, halfBits(x), 2);
  return bytes;
}

std::string png(uint32_t size, std::span<const float> values) {
  std::string rows;
  for (size_t i = 0; i < values.size(); ++i) {
    const uint16_t bits = unormBits(values[i]);
    rows += static_cast<char>(bits >> 8U);
    rows += static_cast<char>(bits & 0xFFU);
    if (i % 2 == 1) rows += std::string(2, '\0');
  }
  return pngOf16BitRgb(size, size, rows);
}

}  // namespace

uint16_t halfBits(float x) {
  assert(x >= 0 && x <= 1);
  if (x == 0) return 0;
  int exponent = 0;
  std::frexp(x, &exponent);
  // The spacing of halves about x: 10 bits behind the first, and no finer than the least of them.
  const int spacing = std::max(exponent - 11, -24);
  const auto steps = static_cast<uint32_t>(std::nearbyint(std::ldexp(x, -spacing)));
  return static_cast<uint16_t>(steps + (static_cast<uint32_t>(spacing + 24) << 10U));
}

std::optional<Container> containerOf(std::string_view path) {
  constexpr std::array kEndings = {std::pair(".dds", Container::Dds), std::pair(".ktx2", Container::Ktx2),
                                   std::pair(".png", Container::Png)};
  std::string lower;
  for (const char c : path) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const auto& [ending, container] : kEndings) {
    if (lower.ends_with(ending)) return container;
  }
  return std::nullopt;
}

std::string tableFile(Container container, uint32_t size, std::span<const float> values) {
  assert(values.size() == size_t{2} * size * size);
  switch (container) {
    case Container::Dds: return dds(size, values);
    case Container::Ktx2: return ktx2(size, values);
    case Container::Png: return png(size, values);
  }
  return {};
}

}  // namespace lacquer::texture
