// PNG with 16 bits a channel, which stb's writer does not have.
#pragma once

#include <cstdint>
#include <string>

namespace lacquer::texture {

/// The whole file, without a word on its colour space. `rows`: for each texel red, green and blue of two
/// bytes, the high one first.
std::string pngOf16BitRgb(uint32_t width, uint32_t height, const std::string& rows);

}  // namespace lacquer::texture
