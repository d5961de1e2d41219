#include "texture/png.h"

#include <array>
#include <cstdlib>
#include <string_view>

/// Of stb_image_write.h, whose declarations leave it out. The result is freed with free().
extern "C" unsigned char* stbi_zlib_compress(unsigned char* data, int data_len, int* out_len, int quality);

namespace lacquer::texture {

namespace {

void appendBig(std::string& bytes, uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xFFU);
}

/// PNG, annex D.
uint32_t checkOf(std::string_view bytes) {
  uint32_t check = ~uint32_t{0};
  for (const char byte : bytes) {
    check ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) check = check >> 1U ^ (0xEDB88320U & (0U - (check & 1U)));
  }
  return ~check;
}

void appendChunk(std::string& bytes, std::string_view kind, std::string_view content) {
  appendBig(bytes, static_cast<uint32_t>(content.size()));
  const size_t begin = bytes.size();
  bytes += kind;
  bytes += content;
  appendBig(bytes, checkOf(std::string_view(bytes).substr(begin)));
}

/// Each row less the one above it: filter 2.
std::string filtered(uint32_t height, const std::string& rows) {
  const size_t length = rows.size() / height;
  std::string bytes;
  for (size_t i = 0; i < rows.size(); ++i) {
    if (i % length == 0) bytes += '\2';
    bytes += static_cast<char>(rows[i] - (i < length ? 0 : rows[i - length]));
  }
  return bytes;
}

}  // namespace

std::string pngOf16BitRgb(uint32_t width, uint32_t height, const std::string& rows) {
  constexpr int kQuality = 8;
  std::string header;
  appendBig(header, width);
  appendBig(header, height);
  for (const char byte : {16, 2, 0, 0, 0}) header += byte;  // bits, RGB, deflate, filters, not interlaced
  std::string plain = filtered(height, rows);
  int length = 0;
  unsigned char* packed = stbi_zlib_compress(reinterpret_cast<unsigned char*>(plain.data()),
                                             static_cast<int>(plain.size()), &length, kQuality);
  std::string bytes = "\x89PNG\r\n\x1A\n";
  appendChunk(bytes, "IHDR", header);
  appendChunk(bytes, "IDAT", {reinterpret_cast<const char*>(packed), static_cast<size_t>(length)});
  appendChunk(bytes, "IEND", {});
  std::free(packed);
  return bytes;
}

}  // namespace lacquer::texture
