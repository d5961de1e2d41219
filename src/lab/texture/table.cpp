#include "texture/table.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include "support/letters.h"
#include "texture/container.h"
#include "texture/png.h"

namespace lacquer::texture {

namespace {

uint16_t unormBits(float x) { return static_cast<uint16_t>(std::lround(x * 65535.0F)); }

constexpr uint32_t kChannels = 2;

std::string dds(uint32_t size, std::span<const float> values) {
  constexpr uint32_t kR16G16Unorm = 35;
  std::string bytes;
  for (const float x : values) append(bytes, unormBits(x), 2);
  return ddsFile({0, kR16G16Unorm, 2, 4, {}}, {size, 1, {std::move(bytes)}});
}

std::string ktx2(uint32_t size, std::span<const float> values) {
  constexpr uint32_t kR16G16Sfloat = 83;
  constexpr uint32_t kSignedFloat = 0xC0;
  constexpr uint32_t kMinusOne = 0xBF800000;
  constexpr uint32_t kOne = 0x3F800000;
  TexelFormat format{kR16G16Sfloat, 0, 2, 4, {}};
  for (uint32_t i = 0; i < kChannels; ++i)
    format.channels.push_back({16 * i, 16, i | kSignedFloat, kMinusOne, kOne});
  std::string bytes;
  for (const float x : values) append(bytes, halfBits(x), 2);
  return ktx2File(format, {size, 1, {std::move(bytes)}});
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

std::optional<Container> containerOf(std::string_view path) {
  constexpr std::array kEndings = {std::pair(".dds", Container::Dds), std::pair(".ktx2", Container::Ktx2),
                                   std::pair(".png", Container::Png)};
  const std::string name = lowered(path);
  for (const auto& [ending, container] : kEndings) {
    if (name.ends_with(ending)) return container;
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
