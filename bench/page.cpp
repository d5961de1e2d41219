#include "bench/page.h"

#include <fmt/format.h>

#include "support/file.h"

namespace lacquer::bench {

bool renewPage(const std::string& path, const std::string& text, std::string_view mark) {
  const std::string opening = fmt::format("<!-- {}: -->\n", mark);
  const std::string closing = fmt::format("<!-- :{} -->\n", mark);
  Result<std::string> page = readFile(path);
  if (!page) return false;
  const size_t begin = page->find(opening);
  const size_t end = page->find(closing);
  if (begin == std::string::npos || end == std::string::npos || end < begin) return false;
  const size_t first = begin + opening.size();
  page->replace(first, end - first, text);
  return writeFile(path, *page).has_value();
}

}  // namespace lacquer::bench
