#include "bench/page.h"

#include <string_view>

#include "support/file.h"

namespace lacquer::bench {

bool renewPage(const std::string& path, const std::string& text) {
  constexpr std::string_view kBegin = "<!-- measured: -->\n";
  constexpr std::string_view kEnd = "<!-- :measured -->\n";
  Result<std::string> page = readFile(path);
  if (!page) return false;
  const size_t begin = page->find(kBegin);
  const size_t end = page->find(kEnd);
  if (begin == std::string::npos || end == std::string::npos || end < begin) return false;
  const size_t first = begin + kBegin.size();
  page->replace(first, end - first, text);
  return writeFile(path, *page).has_value();
}

}  // namespace lacquer::bench
