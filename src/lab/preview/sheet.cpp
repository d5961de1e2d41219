#include "preview/sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lacquer::preview {

namespace {

constexpr Color kText{232, 232, 228};
constexpr Color kFaint{158, 160, 164};
constexpr int kGap = 8;  ///< between balls, and between a ball and its name
constexpr int kMargin = 16;
constexpr uint32_t kFewestColumns = 5;
constexpr uint32_t kMostColumns = 10;
constexpr size_t kNameLines = 2;
/// The encoder counts bytes with an int.
constexpr uint64_t kMostPixels = 400'000'000;

/// A count of columns that leaves the fewest places of the last row empty, and is near to a sheet that is
/// somewhat wider than high.
uint32_t chooseColumns(size_t cells, size_t pictures) {
  const uint32_t fewest = std::max<uint32_t>(kFewestColumns / static_cast<uint32_t>(pictures), 1);
  const uint32_t most = std::max<uint32_t>(kMostColumns / static_cast<uint32_t>(pictures), 1);
  if (cells <= fewest) return static_cast<uint32_t>(std::max<size_t>(cells, 1));
  const double wanted =
      std::sqrt(1.3 * static_cast<double>(cells * pictures)) / static_cast<double>(pictures);
  uint32_t best = fewest;
  double least = 1e9;
  for (uint32_t columns = fewest; columns <= most; ++columns) {
    const size_t rows = (cells + columns - 1) / columns;
    const auto empty = static_cast<double>(rows * columns - cells);
    const double badness = empty / static_cast<double>(columns) + std::abs(columns - wanted) / wanted;
    if (badness < least) {
      least = badness;
      best = columns;
    }
  }
  return best;
}

tl::unexpected<Diagnostics> tooLarge(std::string message) {
  return fail("sheet-too-large", {}, std::move(message), "choose a smaller --size, or fewer materials");
}

class Layout {
public:
  Layout(const std::vector<Section>& sections, uint32_t size, uint32_t columns)
      : sections_(sections), size_(static_cast<int>(size)) {
    size_t cells = 0;
    for (const Section& section : sections) {
      cells = std::max(cells, section.cells.size());
      for (const Cell& cell : section.cells) {
        pictures_ = std::max(pictures_, cell.pictures.size());
        lines_ = std::max(lines_, cell.lines.size());
      }
    }
    columns_ = static_cast<int>(columns > 0 ? columns : chooseColumns(cells, pictures_));
    const int pictures = static_cast<int>(pictures_);
    inner_ = pictures * size_ + (pictures - 1) * kGap;
    width_ = inner_ + 2 * kGap;
    chooseScale();
    for (const Section& section : sections_) {
      for (const Cell& cell : section.cells)
        name_lines_ = std::max(name_lines_, fittedText(cell.name, inner_, scale_, kNameLines).size());
    }
    height_ = size_ + kGap + static_cast<int>(name_lines_) * textHeight(scale_) +
              static_cast<int>(lines_) * textHeight(1) + 2 * kGap;
  }

  Result<Picture> draw(const std::string& title) const {
    int height = kMargin;
    if (!title.empty()) height += textHeight(scale_) + kGap;
    for (const Section& section : sections_) height += heightOf(section);
    const uint64_t width =
        static_cast<uint64_t>(columns_) * static_cast<uint64_t>(width_) + uint64_t{2} * kMargin;
    if (height < 0 || width * static_cast<uint64_t>(height) > kMostPixels)
      return tooLarge(fmt::format("the sheet would have {} x {} pixels", width, height));
    Picture sheet(static_cast<uint32_t>(width), static_cast<uint32_t>(height), kBackground);
    int y = kMargin;
    if (!title.empty()) {
      sheet.write(title, kMargin + kGap, y, scale_, kFaint);
      y += textHeight(scale_) + kGap;
    }
    for (const Section& section : sections_) {
      draw(section, y, sheet);
      y += heightOf(section);
    }
    return sheet;
  }

private:
  /// Twice the font's size where all names fit so.
  void chooseScale() {
    scale_ = 2;
    for (const Section& section : sections_) {
      for (const Cell& cell : section.cells) {
        if (textWidth(cell.name, 2) > inner_) scale_ = 1;
      }
    }
  }

  int headingHeight(const Section& section) const {
    return section.heading.empty() ? 0 : textHeight(scale_) + 2 * kGap;
  }

  int heightOf(const Section& section) const {
    const int rows = (static_cast<int>(section.cells.size()) + columns_ - 1) / columns_;
    return headingHeight(section) + rows * height_;
  }

  void draw(const Section& section, int y, Picture& sheet) const {
    if (!section.heading.empty()) {
      const int width = columns_ * width_ - 2 * kGap;
      const std::vector<std::string> lines = fittedText(section.heading, width, scale_, 1);
      if (!lines.empty()) sheet.write(lines[0], kMargin + kGap, y + kGap / 2, scale_, kFaint);
      sheet.fill(kMargin + kGap, y + textHeight(scale_) + kGap / 2, width, 1, {70, 72, 78});
    }
    y += headingHeight(section);
    for (size_t i = 0; i < section.cells.size(); ++i) {
      const int column = static_cast<int>(i) % columns_;
      const int row = static_cast<int>(i) / columns_;
      draw(section.cells[i], kMargin + column * width_ + kGap, y + row * height_, sheet);
    }
  }

  void draw(const Cell& cell, int x, int y, Picture& sheet) const {
    for (size_t i = 0; i < cell.pictures.size(); ++i)
      sheet.copy(cell.pictures[i], x + static_cast<int>(i) * (size_ + kGap), y);
    y += size_ + kGap;
    const auto centred = [&](const std::string& text, int scale, size_t lines, Color color) {
      for (const std::string& line : fittedText(text, inner_, scale, lines)) {
        sheet.write(line, x + (inner_ - textWidth(line, scale)) / 2, y, scale, color);
        y += textHeight(scale);
      }
    };
    centred(cell.name, scale_, kNameLines, kText);
    for (const std::string& line : cell.lines) centred(line, 1, 1, kFaint);
  }

  const std::vector<Section>& sections_;
  int size_;
  size_t pictures_ = 1, lines_ = 0, name_lines_ = 1;
  int columns_ = 1, inner_ = 0, width_ = 0, height_ = 0, scale_ = 1;
};

}  // namespace

Result<void> mayLayOut(size_t pictures, uint32_t size) {
  const uint64_t each = uint64_t{size} * size;
  if (each == 0 || pictures <= kMostPixels / each) return {};
  return tooLarge(fmt::format("the sheet would have {} balls of {} x {} pixels", pictures, size, size));
}

Result<Picture> layOut(const std::vector<Section>& sections, const std::string& title, uint32_t size,
                       uint32_t columns) {
  return Layout(sections, size, columns).draw(title);
}

}  // namespace lacquer::preview
