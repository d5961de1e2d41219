// Containers of textures as bytes: KTX2 and DDS, of one texture, of an array's layers or of a cube's six
// faces, with mip levels.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lacquer::texture {

/// One channel of a texel in KTX2's data format descriptor (Khronos Data Format 1.3, "Sample Information").
struct Channel {
  uint32_t offset = 0, bits = 0;  ///< in the texel
  uint32_t id = 0;                ///< 0 red, 1 green, 2 blue, 15 alpha, with the qualifiers above
  uint32_t lower = 0, upper = 0;
};

/// What the containers say of a texel.
struct TexelFormat {
  uint32_t vulkan = 0;     ///< VkFormat
  uint32_t dxgi = 0;       ///< DXGI_FORMAT
  uint32_t type_size = 0;  ///< bytes of one of its numbers, as KTX2 has it
  uint32_t bytes = 0;      ///< of a texel
  std::vector<Channel> channels;
  bool srgb = false;  ///< red, green and blue are encoded, of BT.709's primaries
};

/// The bytes of each mip level from the largest on: the faces one after the other, +x, -x, +y, -y, +z, -z of
/// a cube, each row by row.
struct Levels {
  uint32_t size = 0;   ///< width and height of the largest; each next one has half of it
  uint32_t faces = 1;  ///< or 6
  std::vector<std::string> bytes;
  uint32_t height = 0;  ///< where it is not the width
  uint32_t layers = 0;  ///< of an array, which are one behind the other as faces are; 0 for none
};

/// Little-endian, `count` bytes of it.
void append(std::string& bytes, uint64_t value, int count = 4);

/// KTX File Format 2.0, without supercompression.
std::string ktx2File(const TexelFormat& format, const Levels& levels);

/// DirectDraw Surface with the header of Direct3D 10 (Microsoft, "Programming Guide for DDS").
std::string ddsFile(const TexelFormat& format, const Levels& levels);

/// The half nearest to a number in [0, 65504], the even one of two: its bits.
uint16_t halfBits(float x);

}  // namespace lacquer::texture
