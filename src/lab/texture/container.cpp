#include "texture/container.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace lacquer::texture {

namespace {

constexpr uint32_t kCubeFaces = 6;

/// The basic data format descriptor (Khronos Data Format 1.3, "The Basic Data Format Descriptor Block"):
/// linear without a colour space of its own, or sRGB.
std::string descriptorOf(const TexelFormat& format) {
  constexpr uint32_t kModelRgb = 1;
  constexpr uint32_t kTransferLinear = 1;
  constexpr uint32_t kTransferSrgb = 2;
  constexpr uint32_t kPrimariesBt709 = 1;
  const auto block = static_cast<uint32_t>(24 + 16 * format.channels.size());
  std::string bytes;
  append(bytes, 4 + block);
  append(bytes, 0);                  // Khronos, basic format
  append(bytes, 2U | block << 16U);  // version 1.3
  if (format.srgb)
    append(bytes, kModelRgb | kPrimariesBt709 << 8U | kTransferSrgb << 16U);
  else
    append(bytes, kModelRgb | kTransferLinear << 16U);  // primaries unspecified
  append(bytes, 0);                                     // texel blocks of 1 x 1
  append(bytes, format.bytes, 8);                       // bytes of plane 0
  for (const Channel& channel : format.channels) {
    append(bytes, channel.offset | (channel.bits - 1) << 16U | channel.id << 24U);
    append(bytes, 0);
    append(bytes, channel.lower);
    append(bytes, channel.upper);
  }
  return bytes;
}

uint32_t heightOf(const Levels& levels) { return levels.height == 0 ? levels.size : levels.height; }

/// Cubes say nothing of an orientation: theirs is fixed.
std::string keysOf(const Levels& levels) {
  std::string keys;
  const auto add = [&](const std::string& pair) {
    append(keys, pair.size());
    keys += pair;
    while (keys.size() % 4 != 0) keys += '\0';
  };
  if (levels.faces != kCubeFaces) add(std::string("KTXorientation\0rd\0", 18));
  add(std::string("KTXwriter\0Lacquer\0", 18));
  return keys;
}

}  // namespace

void append(std::string& bytes, uint64_t value, int count) {
  for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFFU);
}

std::string ktx2File(const TexelFormat& format, const Levels& levels) {
  constexpr size_t kHeader = 80;
  constexpr size_t kLevelIndex = 24;
  const std::string descriptor = descriptorOf(format);
  const std::string keys = keysOf(levels);
  const size_t count = levels.bytes.size();
  std::string bytes = "\xABKTX 20\xBB\r\n\x1A\n";
  for (const uint32_t word : {format.vulkan, format.type_size, levels.size, heightOf(levels), uint32_t{0},
                              levels.layers, levels.faces, static_cast<uint32_t>(count), uint32_t{0}})
    append(bytes, word);
  const size_t behind = kHeader + kLevelIndex * count;
  append(bytes, behind);
  append(bytes, descriptor.size());
  append(bytes, behind + descriptor.size());
  append(bytes, keys.size());
  append(bytes, 0, 8);
  append(bytes, 0, 8);
  assert(bytes.size() == kHeader);
  // The smallest level comes first in the file, each at a multiple of its texels' size.
  const size_t alignment = std::max<size_t>(format.bytes, 4);
  const auto aligned = [alignment](size_t at) { return (at + alignment - 1) / alignment * alignment; };
  std::vector<size_t> places(count);
  size_t end = behind + descriptor.size() + keys.size();
  for (size_t i = count; i-- > 0;) {
    places[i] = aligned(end);
    end = places[i] + levels.bytes[i].size();
  }
  for (size_t i = 0; i < count; ++i) {
    append(bytes, places[i], 8);
    append(bytes, levels.bytes[i].size(), 8);
    append(bytes, levels.bytes[i].size(), 8);
  }
  bytes += descriptor + keys;
  for (size_t i = count; i-- > 0;) {
    bytes.resize(places[i], '\0');
    bytes += levels.bytes[i];
  }
  return bytes;
}

std::string ddsFile(const TexelFormat& format, const Levels& levels) {
  constexpr uint32_t kCapsHeightWidthPitchFormat = 0x100F;
  constexpr uint32_t kMipMapCount = 0x20000;
  constexpr uint32_t kFourCc = 4;
  constexpr uint32_t kDx10 = 0x30315844;
  constexpr uint32_t kTexture = 0x1000;
  constexpr uint32_t kComplex = 0x8;
  constexpr uint32_t kMipMap = 0x400000;
  constexpr uint32_t kCubeWithAllFaces = 0xFE00;
  constexpr uint32_t kTexture2D = 3;
  constexpr uint32_t kTextureCube = 0x4;
  const bool cube = levels.faces == kCubeFaces;
  const auto count = static_cast<uint32_t>(levels.bytes.size());
  const uint32_t flags = kCapsHeightWidthPitchFormat | (count > 1 ? kMipMapCount : 0);
  const uint32_t caps = kTexture | (count > 1 ? kComplex | kMipMap : 0) | (cube ? kComplex : 0);
  std::string bytes = "DDS ";
  for (const uint32_t word :
       {uint32_t{124}, flags, heightOf(levels), levels.size, levels.size * format.bytes, uint32_t{0}, count})
    append(bytes, word);
  for (int i = 0; i < 11; ++i) append(bytes, 0);
  for (const uint32_t word :
       {uint32_t{32}, kFourCc, kDx10, uint32_t{0}, uint32_t{0}, uint32_t{0}, uint32_t{0}, uint32_t{0}})
    append(bytes, word);
  for (const uint32_t word : {caps, cube ? kCubeWithAllFaces : 0, uint32_t{0}, uint32_t{0}, uint32_t{0}})
    append(bytes, word);
  const uint32_t layers = std::max(levels.layers, 1U), faces = layers * levels.faces;
  for (const uint32_t word : {format.dxgi, kTexture2D, cube ? kTextureCube : 0, layers, uint32_t{0}})
    append(bytes, word);
  // Layer by layer and face by face, each with its levels.
  for (uint32_t face = 0; face < faces; ++face) {
    for (const std::string& level : levels.bytes) {
      const size_t part = level.size() / faces;
      bytes.append(level, face * part, part);
    }
  }
  return bytes;
}

uint16_t halfBits(float x) {
  [[maybe_unused]] constexpr float kMost = 65504;
  assert(x >= 0 && x <= kMost);
  if (x == 0) return 0;
  int exponent = 0;
  std::frexp(x, &exponent);
  // The spacing of halves about x: 10 bits behind the first, and no finer than the least of them.
  const int spacing = std::max(exponent - 11, -24);
  const auto steps = static_cast<uint32_t>(std::nearbyint(std::ldexp(x, -spacing)));
  return static_cast<uint16_t>(steps + (static_cast<uint32_t>(spacing + 24) << 10U));
}

}  // namespace lacquer::texture
