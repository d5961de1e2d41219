// Radiance's RGBE.
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>

#include "environment/panorama.h"

// This format and no other is compiled in.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#ifdef __GNUC__
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wsign-compare"
#endif
#include <stb/stb_image.h>
#ifdef __GNUC__
#pragma GCC diagnostic pop
#endif

namespace lacquer::environment {

namespace {

/// Whether the encoded rows are all there: behind the end stb reads zeros, and a run of none keeps it reading
/// for ever. `data` begins behind the head.
bool rowsAreSound(std::string_view data, size_t width, size_t height) {
  constexpr size_t kLeastEncoded = 8, kMark = 4, kChannels = 4, kRepeated = 128;
  const auto at = [&](size_t i) { return static_cast<unsigned char>(data[i]); };
  const auto flat = [&] { return data.size() / kChannels / width >= height; };
  if (width < kLeastEncoded) return flat();
  for (size_t row = 0; row < height; ++row) {
    if (data.size() < kMark) return false;
    // From a row without the mark on stb takes all as flat, from the first row on.
    if (at(0) != 2 || at(1) != 2 || at(2) >= kRepeated) return flat();
    data.remove_prefix(kMark);
    for (size_t channel = 0; channel < kChannels; ++channel) {
      for (size_t left = width; left > 0;) {
        if (data.empty()) return false;
        const size_t code = at(0);
        const size_t count = code > kRepeated ? code - kRepeated : code;
        const size_t bytes = 1 + (code > kRepeated ? 1 : count);
        if (count == 0 || count > left || data.size() < bytes) return false;
        data.remove_prefix(bytes);
        left -= count;
      }
    }
  }
  return true;
}

/// What is behind the head: an empty line, and then that of the size.
std::string_view dataOf(std::string_view bytes) {
  const size_t empty = bytes.find("\n\n");
  const size_t end = empty == std::string_view::npos ? empty : bytes.find('\n', empty + 2);
  return end == std::string_view::npos ? std::string_view() : bytes.substr(end + 1);
}

struct Free {
  void operator()(float* pixels) const { stbi_image_free(pixels); }
};

}  // namespace

Result<Panorama> readRadiance(std::string_view bytes, uint64_t most, const Place& place) {
  constexpr int kChannels = 3;
  if (bytes.size() > static_cast<size_t>(std::numeric_limits<int>::max()))
    return unreadable(place, "a Radiance file has less than 2 GiB");
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const auto length = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  if (stbi_info_from_memory(data, length, &width, &height, &channels) == 0)
    return unreadable(place, "the picture's head is damaged, or its rows do not run from the upper left");
  if (const Result<void> fits = checkSize(width, height, most, place); !fits)
    return tl::make_unexpected(fits.error());
  if (!rowsAreSound(dataOf(bytes), static_cast<size_t>(width), static_cast<size_t>(height)))
    return unreadable(place, "the picture is damaged");
  const std::unique_ptr<float, Free> pixels(
      stbi_loadf_from_memory(data, length, &width, &height, &channels, kChannels));
  if (!pixels) return unreadable(place, "the picture is damaged");
  Panorama panorama{static_cast<uint32_t>(width), static_cast<uint32_t>(height), {}};
  panorama.texels.resize(size_t{panorama.width} * panorama.height);
  std::memcpy(panorama.texels.data(), pixels.get(), panorama.texels.size() * sizeof(Rgb));
  return panorama;
}

}  // namespace lacquer::environment
