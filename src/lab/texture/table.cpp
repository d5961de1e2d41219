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

Channel halfChannel(uint32_t i) {
  constexpr uint32_t kSignedFloat = 0xC0;
  constexpr uint32_t kMinusOne = 0xBF800000;
  constexpr uint32_t kOne = 0x3F800000;
  return {16 * i, 16, i | kSignedFloat, kMinusOne, kOne};
}

std::string dds(uint32_t size, std::span<const float> values) {
  constexpr uint32_t kR16G16Unorm = 35;
  std::string bytes;
  for (const float x : values) append(bytes, unormBits(x), 2);
  return ddsFile({0, kR16G16Unorm, 2, 4, {}}, {size, 1, {std::move(bytes)}});
}

std::string ktx2(uint32_t size, std::span<const float> values) {
  constexpr uint32_t kR16G16Sfloat = 83;
  TexelFormat format{kR16G16Sfloat, 0, 2, 4, {}};
  for (uint32_t i = 0; i < kChannels; ++i) format.channels.push_back(halfChannel(i));
  std::string bytes;
  for (const float x : values) append(bytes, halfBits(x), 2);
  return ktx2File(format, {size, 1, {std::move(bytes)}});
}

void appendBig(std::string& bytes, uint16_t bits) {
  bytes += static_cast<char>(bits >> 8U);
  bytes += static_cast<char>(bits & 0xFFU);
}

std::string png(uint32_t size, std::span<const float> values) {
  std::string rows;
  for (size_t i = 0; i < values.size(); ++i) {
    appendBig(rows, unormBits(values[i]));
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

std::string layersFile(Container container, const Layers& layers, std::span<const float> values) {
  constexpr uint32_t kR16Unorm = 56;   // of DXGI
  constexpr uint32_t kR16Sfloat = 76;  // of Vulkan
  assert(values.size() == size_t{layers.width} * layers.height * layers.count);
  assert(container != Container::Png || layers.count == 1);
  std::string bytes;
  for (const float x : values) {
    if (container == Container::Ktx2) append(bytes, halfBits(x), 2);
    if (container == Container::Dds) append(bytes, unormBits(x), 2);
    for (int i = 0; container == Container::Png && i < 3; ++i) appendBig(bytes, unormBits(x));
  }
  if (container == Container::Png) return pngOf16BitRgb(layers.width, layers.height, bytes);
  const TexelFormat format{kR16Sfloat, kR16Unorm, 2, 2, {halfChannel(0)}};
  const Levels levels{layers.width, 1, {std::move(bytes)}, layers.height, layers.count};
  return container == Container::Dds ? ddsFile(format, levels) : ktx2File(format, levels);
}

}  // namespace lacquer::texture
