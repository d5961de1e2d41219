// Tables of two channels or one, as shaders look them up, as files: DDS, KTX2, PNG.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace lacquer::texture {

enum class Container : uint8_t {
  Dds,   ///< R16G16_UNORM
  Ktx2,  ///< R16G16_SFLOAT, which every API filters, WebGL 2 too
  Png,   ///< 16 bits of red and green, blue 0; decoders of 8 bits see the nearest of theirs
};

/// By the name's ending, in capitals or not: ".dds", ".ktx2", ".png".
std::optional<Container> containerOf(std::string_view path);

/// The whole file of one level. `values`: `size` rows of as many texels of two numbers in [0, 1]; the first
/// row is the first in the file.
std::string tableFile(Container container, uint32_t size, std::span<const float> values);

/// Grey tables of one size, the layers of an array: of R16_SFLOAT in KTX2, R16_UNORM in DDS. A PNG has 16
/// bits of each colour, and one layer.
struct Layers {
  uint32_t width = 0, height = 0, count = 0;
};
/// The whole file. `values`: layer by layer and row by row numbers in [0, 1].
std::string layersFile(Container container, const Layers& layers, std::span<const float> values);

}  // namespace lacquer::texture
