// Markdown as the tests of the documentation see it: fenced blocks, links, and regions that are generated.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace lacquer::test {

/// A fenced block.
struct Fence {
  std::string language;
  size_t line = 0;  ///< of its first line of text, 1-based
  std::string text;
};

std::vector<Fence> fences(std::string_view page);

/// The targets of the page's links and pictures, outside fenced blocks.
std::vector<std::string> links(std::string_view page);

/// The page with every region `<!-- generated: NAME -->` … `<!-- :generated -->` made anew. A region without
/// an end is left alone, and `make` is told an empty name.
std::string regenerate(std::string_view page, const std::function<std::string(std::string_view name)>& make);

/// The parts of a text between separators; an empty text has none.
std::vector<std::string> split(std::string_view text, std::string_view separator);

/// The lines without the blanks that the first one begins with.
std::string dedented(const std::vector<std::string>& lines);

}  // namespace lacquer::test
