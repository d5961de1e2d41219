#include "mtlx/element.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>

#include "support/text.h"

namespace lacquer::materialx {

const std::string* Element::find(std::string_view attribute) const {
  for (const auto& [name, value] : attributes) {
    if (name == attribute) return &value;
  }
  return nullptr;
}

std::string_view Element::get(std::string_view attribute) const {
  const std::string* value = find(attribute);
  return value == nullptr ? std::string_view() : std::string_view(*value);
}

void Element::set(std::string_view attribute, std::string value) {
  for (auto& [name, old] : attributes) {
    if (name != attribute) continue;
    old = std::move(value);
    return;
  }
  attributes.emplace_back(std::string(attribute), std::move(value));
}

const Element* Element::child(std::string_view of, std::string_view named) const {
  if (!sorted.empty() && sorted.size() == children.size()) {
    const auto nameOf = [&](uint32_t i) { return children[i].name(); };
    const auto before = [&](uint32_t i, std::string_view wanted) { return nameOf(i) < wanted; };
    for (auto at = std::lower_bound(sorted.begin(), sorted.end(), named, before);
         at != sorted.end() && nameOf(*at) == named; ++at) {
      if (children[*at].category == of) return &children[*at];
    }
    return nullptr;
  }
  for (const Element& child : children) {
    if (child.category == of && child.name() == named) return &child;
  }
  return nullptr;
}

void Element::index() {
  constexpr size_t kMany = 16;
  sorted.clear();
  if (children.size() >= kMany) {
    sorted.resize(children.size());
    std::iota(sorted.begin(), sorted.end(), 0U);
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](uint32_t a, uint32_t b) { return children[a].name() < children[b].name(); });
  }
  for (Element& child : children) child.index();
}

bool isNodeElement(const Element& element) {
  constexpr std::string_view kOthers[] = {
      "input",     "output",         "token",       "nodedef",      "implementation", "comment",   "typedef",
      "unitdef",   "unittypedef",    "geompropdef", "attributedef", "targetdef",      "backdrop",  "look",
      "lookgroup", "materialassign", "propertyset", "collection",   "geominfo",       "variantset"};
  return std::find(std::begin(kOthers), std::end(kOthers), element.category) == std::end(kOthers);
}

size_t countOfElements(const Element& element) {
  size_t count = 1;
  for (const Element& child : element.children) count += countOfElements(child);
  return count;
}

bool isConnected(const Element& input) {
  return input.find("nodename") != nullptr || input.find("nodegraph") != nullptr ||
         input.find("interfacename") != nullptr ||
         (input.find("output") != nullptr && input.find("value") == nullptr);
}

std::string_view wideEncoding(std::string_view text) {
  using namespace std::string_view_literals;
  for (const std::string_view start : {"\xFF\xFE\0\0"sv, "\0\0\xFE\xFF"sv, "<\0\0\0"sv, "\0\0\0<"sv})
    if (text.starts_with(start)) return "UTF-32";
  for (const std::string_view start : {"\xFF\xFE"sv, "\xFE\xFF"sv, "<\0"sv, "\0<"sv})
    if (text.starts_with(start)) return "UTF-16";
  return {};
}

namespace {

void writeValue(std::string_view value, std::string& text) {
  for (const char c : value) {
    switch (c) {
      case '&': text += "&amp;"; break;
      case '<': text += "&lt;"; break;
      case '>': text += "&gt;"; break;
      case '"': text += "&quot;"; break;
      case '\n': text += "&#10;"; break;
      case '\r': text += "&#13;"; break;
      case '\t': text += "&#9;"; break;
      default: text += static_cast<unsigned char>(c) < ' ' ? '_' : c;  // XML has no other control characters
    }
  }
}

/// `space`: the namespace around the element, which it has without saying it.
void writeElement(const Element& element, size_t depth, std::string_view space, std::string& text) {
  text.append(2 * depth, ' ').append("<").append(element.category);
  for (const auto& [name, value] : element.attributes) {
    if (depth > 0 && name == "namespace" && value == space) continue;
    text.append(" ").append(name).append("=\"");
    writeValue(value, text);
    text += '"';
  }
  if (element.children.empty()) return void(text += "/>\n");
  text += ">\n";
  const std::string* own = element.find("namespace");
  for (const Element& child : element.children)
    writeElement(child, depth + 1, own == nullptr ? space : *own, text);
  text.append(2 * depth, ' ').append("</").append(element.category).append(">\n");
}

}  // namespace

std::string toXml(const Element& root) {
  std::string text = "<?xml version=\"1.0\"?>\n";
  writeElement(root, 0, root.get("namespace"), text);
  return text;
}

std::optional<std::vector<double>> numbersOf(std::string_view value) {
  constexpr size_t kMost = 16;  // of a matrix44
  std::vector<double> numbers;
  value = trimmed(value);
  while (true) {
    // MaterialX's own reader takes spaces between numbers, too.
    size_t comma = value.find_first_of(", \t\r\n");
    std::string_view one = value.substr(0, comma);
    if (comma != std::string_view::npos && value[comma] != ',') {
      const size_t next = value.find_first_not_of(" \t\r\n", comma);
      comma = value[next] == ',' ? next : next - 1;
    }
    if (one.starts_with('+')) one.remove_prefix(1);
    double number = 0;
    auto [end, error] = std::from_chars(one.data(), one.data() + one.size(), number);
    if (error == std::errc::result_out_of_range) {
      // Too small is 0; what is too large is the largest, which its reader refuses.
      const bool small = one.find("e-") != std::string_view::npos ||
                         one.find("E-") != std::string_view::npos ||
                         one.substr(one.starts_with('-') ? 1 : 0).starts_with("0.") || one.starts_with('.');
      number = small ? 0 : std::numeric_limits<double>::max();
      error = {};
    }
    if (error != std::errc{} || end != one.data() + one.size() || !std::isfinite(number)) return std::nullopt;
    numbers.push_back(number);
    if (comma == std::string_view::npos) return numbers;
    if (numbers.size() == kMost) return std::nullopt;
    value.remove_prefix(comma + 1);
    value.remove_prefix(std::min(value.find_first_not_of(" \t\r\n"), value.size()));
  }
}

}  // namespace lacquer::materialx
