// The contact sheet: pictures in rows and columns with their names below, sections with a heading.
#pragma once

#include <string>
#include <vector>

#include "preview/canvas.h"
#include "support/diagnostic.h"

namespace lacquer::preview {

inline constexpr Color kBackground{34, 36, 40};

struct Cell {
  std::string name;
  std::vector<std::string> lines;  ///< smaller print below the name
  std::vector<Picture> pictures;   ///< side by side, of equal size
};

struct Section {
  std::string heading;  ///< may be empty
  std::vector<Cell> cells;
};

/// Whether a sheet may have room for so many pictures: to be asked before they are drawn. Errors:
/// "sheet-too-large".
Result<void> mayLayOut(size_t pictures, uint32_t size);

/// `title` stands above all and may be empty. `columns` is a number of cells, 0 for a choice that leaves few
/// places empty. Errors: "sheet-too-large".
Result<Picture> layOut(const std::vector<Section>& sections, const std::string& title, uint32_t size,
                       uint32_t columns);

}  // namespace lacquer::preview
