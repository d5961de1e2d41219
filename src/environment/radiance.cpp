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
  const std::unique_ptr<float, Free> pixels(
      stbi_loadf_from_memory(data, length, &width, &height, &channels, kChannels));
  if (!pixels) return unreadable(place, "the picture is damaged");
  Panorama panorama{static_cast<uint32_t>(width), static_cast<uint32_t>(height), {}};
  panorama.texels.resize(size_t{panorama.width} * panorama.height);
  std::memcpy(panorama.texels.data(), pixels.get(), panorama.texels.size() * sizeof(Rgb));
  return panorama;
}

}  // namespace lacquer::environment
