#include "environment/panorama.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "support/limits.h"

namespace lacquer::environment {

namespace {

constexpr float kMost = 65408;

void warn(Diagnostics& warnings, const Place& place, std::string code, std::string message,
          std::string help) {
  warnings.push_back({std::move(code), Severity::Warning, place, std::move(message), std::move(help), {}});
}

}  // namespace

void clean(std::vector<Rgb>& colors, double scale, const Place& place, Diagnostics& warnings) {
  size_t wrong = 0, large = 0;
  for (Rgb& color : colors) {
    for (float& x : color) {
      if (scale != 1) x = static_cast<float>(x * scale);
      if (std::isnan(x) || x < 0) {
        ++wrong;
        x = 0;
      } else if (x > kMost) {
        ++large;
        x = kMost;
      }
      x += 0.0F;  // no -0
    }
  }
  if (wrong > 0) {
    warn(warnings, place, "environment-numbers", fmt::format("{} numbers are negative or none", wrong),
         "radiance is finite and not negative; 0 takes their place");
  }
  if (large > 0) {
    warn(warnings, place, "environment-numbers", fmt::format("{} numbers are larger than {}", large, kMost),
         "scale the picture down, and environment_intensity up; what the cubes' formats hold takes their "
         "place");
  }
}

tl::unexpected<Diagnostics> unreadable(const Place& place, std::string message) {
  return fail("environment-unreadable", place, std::move(message),
              "Radiance HDR (.hdr), OpenEXR (.exr) and cube maps in KTX2 files are read");
}

Result<void> checkSize(int64_t width, int64_t height, uint64_t most, const Place& place) {
  if (width < 1 || height < 1 || width > kLongestSide || height > kLongestSide)
    return unreadable(place, fmt::format("the picture claims {} x {} pixels", width, height));
  const auto pixels = static_cast<uint64_t>(width) * static_cast<uint64_t>(height);
  if (pixels <= most) return {};
  return fail("image-too-large", place,
              fmt::format("the picture has {} x {} pixels, more than {}", width, height, most),
              raising("image"));
}

Result<Panorama> readPanorama(std::string_view bytes, uint64_t most, const Place& place,
                              Diagnostics& warnings) {
  const auto read = [&]() -> Result<Panorama> {
    if (bytes.starts_with("#?RADIANCE\n") || bytes.starts_with("#?RGBE\n"))
      return readRadiance(bytes, most, place);
    if (bytes.starts_with(std::string_view("\x76\x2f\x31\x01", 4))) return readOpenExr(bytes, most, place);
    return unreadable(place, "this is neither Radiance HDR nor OpenEXR nor KTX2");
  };
  Result<Panorama> panorama = read();
  if (!panorama) return panorama;
  clean(panorama->texels, 1, place, warnings);
  if (panorama->width != 2 * panorama->height) {
    warn(warnings, place, "environment-shape",
         fmt::format("the picture has {} x {} pixels", panorama->width, panorama->height),
         "an equirectangular one is twice as wide as high; it is stretched to the whole sphere");
  }
  return panorama;
}

}  // namespace lacquer::environment
