#include "preview/canvas.h"

#include <stb/stb_easy_font.h>
#include <stb/stb_image_write.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace lacquer::preview {

namespace {

/// What stb_easy_font writes for each corner.
struct Corner {
  float x, y, z;
  unsigned char color[4];
};
/// It wants about 270 bytes for a character; none takes more than this.
constexpr size_t kQuadsOfCharacter = 24;

std::string ascii(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xC0) == 0x80) continue;  // inside of a UTF-8 sequence
    result += byte >= 32 && byte < 127 ? c : '?';
  }
  return result;
}

}  // namespace

void Picture::fill(int x, int y, int width, int height, Color color) {
  const int right = std::min(x + width, static_cast<int>(width_));
  const int bottom = std::min(y + height, static_cast<int>(height_));
  for (int row = std::max(y, 0); row < bottom; ++row) {
    for (int column = std::max(x, 0); column < right; ++column)
      at(static_cast<uint32_t>(column), static_cast<uint32_t>(row)) = color;
  }
}

void Picture::copy(const Picture& from, int x, int y) {
  for (uint32_t row = 0; row < from.height(); ++row) {
    for (uint32_t column = 0; column < from.width(); ++column)
      fill(x + static_cast<int>(column), y + static_cast<int>(row), 1, 1, from.at(column, row));
  }
}

void Picture::write(std::string_view text, int x, int y, int scale, Color color) {
  std::string shown = ascii(text);
  std::vector<Corner> corners(4 * kQuadsOfCharacter * (shown.size() + 1));
  const int quads = stb_easy_font_print(0, 0, shown.data(), nullptr, corners.data(),
                                        static_cast<int>(corners.size() * sizeof(Corner)));
  for (int i = 0; i < quads; ++i) {
    const Corner& first = corners[4 * static_cast<size_t>(i)];
    const Corner& opposite = corners[4 * static_cast<size_t>(i) + 2];
    const auto at = [&](float a) { return static_cast<int>(std::lround(a)) * scale; };
    fill(x + at(first.x), y + at(first.y), at(opposite.x) - at(first.x), at(opposite.y) - at(first.y), color);
  }
}

std::string Picture::png() const {
  std::string bytes;
  const auto append = [](void* to, void* data, int size) {
    static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<size_t>(size));
  };
  stbi_write_png_to_func(append, &bytes, static_cast<int>(width_), static_cast<int>(height_), 3,
                         pixels_.data(), static_cast<int>(width_ * sizeof(Color)));
  return bytes;
}

int textWidth(std::string_view text, int scale) {
  std::string shown = ascii(text);
  return stb_easy_font_width(shown.data()) * scale;
}

namespace {

/// The length of the first line.
size_t lineLength(const std::string& text, int width, int scale) {
  size_t fits = text.size();
  while (fits > 1 && textWidth(text.substr(0, fits), scale) > width) --fits;
  if (fits == text.size()) return fits;
  const size_t last = text.substr(0, fits).find_last_of("_-/ ");
  return last == std::string::npos ? fits : last + 1;
}

std::vector<std::string> wrapped(std::string text, int width, int scale) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const size_t length = lineLength(text, width, scale);
    lines.push_back(text.substr(0, length));
    text.erase(0, length);
  }
  return lines;
}

}  // namespace

std::vector<std::string> fittedText(std::string_view text, int width, int scale, size_t lines) {
  // A sheet has no room for more: what is longer need not be tried character by character.
  constexpr size_t kLongest = 160;
  std::string all = ascii(text);
  if (all.size() > kLongest) all = all.substr(0, kLongest / 2) + all.substr(all.size() - kLongest / 2);
  std::vector<std::string> result = wrapped(all, width, scale);
  for (size_t left_out = 1; result.size() > lines && left_out < all.size(); ++left_out) {
    const size_t kept = all.size() - left_out;
    result = wrapped(all.substr(0, (kept + 1) / 2) + ".." + all.substr(all.size() - kept / 2), width, scale);
  }
  if (result.size() > lines) result.resize(lines);
  return result;
}

std::array<double, 3> toneMap(std::array<double, 3> c) {
  // Khronos PBR Neutral Tone Mapper, https://github.com/KhronosGroup/ToneMapping (specification 1.0).
  constexpr double kStart = 0.8 - 0.04;
  constexpr double kDesaturation = 0.15;
  const double least = std::min({c[0], c[1], c[2]});
  const double offset = least < 0.08 ? least - 6.25 * least * least : 0.04;
  for (double& x : c) x -= offset;
  const double peak = std::max({c[0], c[1], c[2]});
  if (peak < kStart) return c;
  const double d = 1 - kStart;
  const double mapped = 1 - d * d / (peak + d - kStart);
  const double white = 1 - 1 / (kDesaturation * (peak - mapped) + 1);
  for (double& x : c) x = x * (mapped / peak) * (1 - white) + mapped * white;
  return c;
}

uint8_t encodeSrgb(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  const double code = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  return static_cast<uint8_t>(std::lround(code * 255));
}

}  // namespace lacquer::preview
