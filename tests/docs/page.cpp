#include "docs/page.h"

#include <algorithm>

namespace lacquer::test {

std::vector<std::string> split(std::string_view text, std::string_view separator) {
  std::vector<std::string> parts;
  size_t at = 0;
  while (at < text.size()) {
    const size_t end = std::min(text.find(separator, at), text.size());
    parts.emplace_back(text.substr(at, end - at));
    at = end + separator.size();
  }
  return parts;
}

std::vector<Fence> fences(std::string_view page) {
  std::vector<Fence> found;
  bool inside = false;
  size_t number = 0;
  for (const std::string& line : split(page, "\n")) {
    ++number;
    if (line.starts_with("```")) {
      inside = !inside;
      if (inside) found.push_back({line.substr(3), number + 1, {}});
    } else if (inside) {
      found.back().text += line + "\n";
    }
  }
  return found;
}

std::vector<std::string> links(std::string_view page) {
  std::vector<std::string> found;
  bool inside = false;
  for (const std::string& line : split(page, "\n")) {
    if (line.starts_with("```")) inside = !inside;
    for (size_t at = 0; !inside && (at = line.find("](", at)) != std::string::npos;) {
      const size_t end = line.find(')', at);
      if (end == std::string::npos) break;
      found.push_back(line.substr(at + 2, end - at - 2));
      at = end;
    }
  }
  return found;
}

std::string regenerate(std::string_view page, const std::function<std::string(std::string_view name)>& make) {
  constexpr std::string_view kBegin = "<!-- generated: ";
  constexpr std::string_view kEnd = "<!-- :generated -->";
  std::string out;
  size_t at = 0;
  for (size_t begin = 0; (begin = page.find(kBegin, at)) != std::string_view::npos;) {
    const size_t name = begin + kBegin.size();
    const size_t name_end = page.find(" -->\n", name);
    const size_t end = page.find(kEnd, name);
    if (name_end == std::string_view::npos || end == std::string_view::npos) {
      make({});
      break;
    }
    const size_t text = name_end + 5;
    out.append(page.substr(at, text - at));
    out += make(page.substr(name, name_end - name));
    at = end;
  }
  out.append(page.substr(at));
  return out;
}

std::string dedented(const std::vector<std::string>& lines) {
  if (lines.empty()) return {};
  const size_t indent = std::min(lines[0].find_first_not_of(' '), lines[0].size());
  std::string out;
  for (const std::string& line : lines) {
    const size_t blanks = std::min(line.find_first_not_of(' '), line.size());
    out += line.substr(std::min(indent, blanks)) + "\n";
  }
  return out;
}

}  // namespace lacquer::test
