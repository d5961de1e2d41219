// Pictures of eight bits per channel: fill, copy, write, and PNG.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lacquer::preview {

using Color = std::array<uint8_t, 3>;  ///< sRGB

class Picture {
public:
  Picture(uint32_t width, uint32_t height, Color color)
      : width_(width), height_(height), pixels_(size_t{width} * height, color) {}

  uint32_t width() const { return width_; }
  uint32_t height() const { return height_; }
  Color& at(uint32_t x, uint32_t y) { return pixels_[size_t{y} * width_ + x]; }
  const Color& at(uint32_t x, uint32_t y) const { return pixels_[size_t{y} * width_ + x]; }

  /// What lies outside is cut off, here and below.
  void fill(int x, int y, int width, int height, Color color);
  void copy(const Picture& from, int x, int y);
  /// One line, its upper left corner at x, y; `scale` pixels for each of the font's.
  void write(std::string_view text, int x, int y, int scale, Color color);

  std::string png() const;

private:
  uint32_t width_, height_;
  std::vector<Color> pixels_;
};

/// The pixels that write() takes.
int textWidth(std::string_view text, int scale);
inline int textHeight(int scale) { return 12 * scale; }

/// The text in at most `lines` lines of that width, as the font can show it (a character beyond ASCII is a
/// `?`). Lines break behind `_`, `-`, `/` and blanks where they can. What does not fit is left out of
/// the middle: the end of a name tells it from its neighbours as often as its beginning.
std::vector<std::string> fittedText(std::string_view text, int width, int scale, size_t lines);

/// Linear light to a display's code: the Khronos PBR neutral tone mapper. Colours below 0.8 keep hue and
/// brightness, so that a base colour is seen as the file has it.
std::array<double, 3> toneMap(std::array<double, 3> c);
/// IEC 61966-2-1, one channel, [0, 1] to 0…255.
uint8_t encodeSrgb(double linear);

}  // namespace lacquer::preview
