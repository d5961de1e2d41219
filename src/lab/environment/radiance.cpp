// Radiance's RGBE: one reader both checks the bytes and decodes them.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "environment/panorama.h"

namespace lacquer::environment {

namespace {

constexpr size_t kPlanes = 4;
/// A code above it repeats one byte, by the difference; up to it, that many bytes follow.
constexpr size_t kRepeated = 128;

struct RadianceHead {
  int64_t width = 0, height = 0;
  std::string_view data;  ///< what is behind the head
};

size_t byteAt(std::string_view bytes, size_t at) { return static_cast<unsigned char>(bytes[at]); }

/// The first line of `text`, which loses it and its end; nothing where no line ends.
std::optional<std::string_view> takeLine(std::string_view& text) {
  const size_t end = text.find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end + 1);
  return line;
}

/// The number behind an axis, both of which `line` loses.
std::optional<int64_t> takeSide(std::string_view& line, std::string_view axis) {
  const auto skipSpaces = [&] { line.remove_prefix(std::min(line.find_first_not_of(' '), line.size())); };
  if (!line.starts_with(axis)) return std::nullopt;
  line.remove_prefix(axis.size());
  skipSpaces();
  int64_t side = 0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), side);
  if (error != std::errc()) return std::nullopt;
  line.remove_prefix(static_cast<size_t>(end - line.data()));
  skipSpaces();
  return side;
}

/// Lines up to an empty one, of which one names the format, and then that of the size.
std::optional<RadianceHead> readHead(std::string_view bytes) {
  std::string_view rest = bytes;
  bool rgbe = false;
  std::optional<std::string_view> line = takeLine(rest);
  for (; line && !line->empty(); line = takeLine(rest)) rgbe |= *line == "FORMAT=32-bit_rle_rgbe";
  line = takeLine(rest);
  if (!rgbe || !line) return std::nullopt;
  const std::optional<int64_t> height = takeSide(*line, "-Y ");
  const std::optional<int64_t> width = takeSide(*line, "+X ");
  if (!height || !width) return std::nullopt;
  // To readers with C's strings a line that begins with a NUL is the empty one: they would see another
  // picture.
  if (bytes.substr(0, bytes.size() - rest.size()).find('\0') != std::string_view::npos) return std::nullopt;
  return RadianceHead{*width, *height, rest};
}

/// The first row tells of all whether they are run-length coded. Narrow and wide ones never are.
bool isEncoded(std::string_view data, size_t width) {
  constexpr size_t kNarrowest = 8, kWidest = 32767;
  return width >= kNarrowest && width <= kWidest && data.size() >= kPlanes && byteAt(data, 0) == 2 &&
         byteAt(data, 1) == 2 && byteAt(data, 2) < kRepeated;
}

/// What a row takes at least: its mark, and of each plane runs as long as there are.
size_t leastBytes(size_t width, bool encoded) {
  constexpr size_t kLongestRun = 127, kRun = 2;
  return encoded ? kPlanes + kPlanes * kRun * ((width + kLongestRun - 1) / kLongestRun) : kPlanes * width;
}

/// One plane of a row, which `data` loses.
bool readPlane(std::string_view& data, size_t plane, std::string& row) {
  const size_t width = row.size() / kPlanes;
  for (size_t x = 0; x < width;) {
    if (data.empty()) return false;
    const size_t code = byteAt(data, 0);
    const bool repeated = code > kRepeated;
    const size_t count = repeated ? code - kRepeated : code;
    const size_t bytes = 1 + (repeated ? 1 : count);
    // Zeros would be runs of none, for ever.
    if (count == 0 || count > width - x || data.size() < bytes) return false;
    for (size_t i = 0; i < count; ++i) row[kPlanes * x++ + plane] = data[repeated ? 1 : 1 + i];
    data.remove_prefix(bytes);
  }
  return true;
}

/// The next row's RGBE, pixel by pixel, which `data` loses. An encoded row begins with a mark and the width.
bool readRow(std::string_view& data, bool encoded, std::string& row) {
  if (!encoded) {
    if (data.size() < row.size()) return false;
    std::memcpy(row.data(), data.data(), row.size());
    data.remove_prefix(row.size());
    return true;
  }
  const size_t width = row.size() / kPlanes;
  if (!isEncoded(data, width) || (byteAt(data, 2) << 8 | byteAt(data, 3)) != width) return false;
  data.remove_prefix(kPlanes);
  for (size_t plane = 0; plane < kPlanes; ++plane) {
    if (!readPlane(data, plane, row)) return false;
  }
  return true;
}

Rgb decodeRgbe(const char* rgbe) {
  constexpr int kBias = 128 + 8;
  const auto number = [&](size_t i) { return static_cast<unsigned char>(rgbe[i]); };
  if (number(3) == 0) return {};
  const float scale = std::ldexp(1.0F, number(3) - kBias);
  return {number(0) * scale, number(1) * scale, number(2) * scale};
}

}  // namespace

Result<Panorama> readRadiance(std::string_view bytes, uint64_t most, const Place& place) {
  const std::optional<RadianceHead> head = readHead(bytes);
  if (!head)
    return unreadable(place, "the picture's head is damaged, or its rows do not run from the upper left");
  if (const Result<void> fits = checkSize(head->width, head->height, most, place); !fits)
    return tl::make_unexpected(fits.error());
  Panorama panorama{static_cast<uint32_t>(head->width), static_cast<uint32_t>(head->height), {}};
  const size_t width = panorama.width, height = panorama.height;
  std::string_view data = head->data;
  const bool encoded = isEncoded(data, width);
  // Before any room is taken for the pixels.
  if (data.size() / leastBytes(width, encoded) < height) return unreadable(place, "the picture is damaged");
  panorama.texels.resize(width * height);
  std::string row(kPlanes * width, '\0');
  for (size_t y = 0; y < height; ++y) {
    if (!readRow(data, encoded, row)) return unreadable(place, "the picture is damaged");
    for (size_t x = 0; x < width; ++x) panorama.texels[y * width + x] = decodeRgbe(row.data() + kPlanes * x);
  }
  return panorama;
}

}  // namespace lacquer::environment
