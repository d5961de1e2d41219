#include "mtlx/well_formed.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <utility>

#include "mtlx/element.h"
#include "support/text.h"

namespace lacquer::materialx {

namespace {

bool isXmlCharacter(uint32_t c) {
  return c == '\t' || c == '\n' || c == '\r' || (c >= 0x20 && c < 0xD800) || (c >= 0xE000 && c < 0xFFFE) ||
         (c >= 0x10000 && c < 0x110000);
}

/// The bytes of the character at the start of a text; 0 where it is not UTF-8 or none of XML's.
size_t characterAt(std::string_view text) {
  const auto byte = [&](size_t i) { return static_cast<uint32_t>(static_cast<unsigned char>(text[i])); };
  const uint32_t first = byte(0);
  if (first < 0x80) return isXmlCharacter(first) ? 1 : 0;
  const size_t size = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < size) return 0;
  uint32_t c = first & (0xFFu >> (size + 1));
  for (size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0u) != 0x80) return 0;
    c = (c << 6) | (byte(i) & 0x3Fu);
  }
  const uint32_t least = size == 4 ? 0x10000 : size == 3 ? 0x800 : 0x80;
  return c >= least && isXmlCharacter(c) ? size : 0;
}

/// Whether a text begins with a reference to a character: one of XML's five names, or a number.
bool isReference(std::string_view text) {
  const std::string_view name = text.substr(1, std::min(text.find(';'), text.size()) - 1);
  if (text.find(';') == std::string_view::npos) return false;
  constexpr std::string_view kNames[] = {"amp", "lt", "gt", "quot", "apos"};
  if (std::find(std::begin(kNames), std::end(kNames), name) != std::end(kNames)) return true;
  const bool hex = name.starts_with("#x");
  if (!name.starts_with('#')) return false;
  const std::string_view digits = name.substr(hex ? 2 : 1);
  uint32_t number = 0;
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), number, hex ? 16 : 10);
  return error == std::errc{} && end == digits.data() + digits.size() && isXmlCharacter(number);
}

/// Whether a text begins with the name of a token in angle brackets: MaterialX's own documents have `<UDIM>`
/// in file names as it is.
bool isToken(std::string_view text) {
  const size_t end = text.find('>');
  if (end == std::string_view::npos || end < 2) return false;
  const std::string_view name = text.substr(1, end - 1);
  return std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

/// The error of a comment that begins there, or of a declaration that is not the first of the text.
std::optional<Malformed> malformedBeside(std::string_view text, size_t at) {
  constexpr std::string_view kComment = "<!--", kDeclaration = "<?xml";
  const std::string_view rest = text.substr(at);
  if (rest.starts_with(kComment)) {
    const size_t dashes = text.find("--", at + kComment.size());
    if (dashes == std::string_view::npos || text.substr(dashes).starts_with("-->")) return std::nullopt;
    return Malformed{dashes, "a comment has \"--\"", "it has single hyphens alone, and none at its end"};
  }
  const size_t behind = kDeclaration.size();
  const bool declares = rest.starts_with(kDeclaration) && rest.size() > behind &&
                        std::string_view(" \t\r\n?").find(rest[behind]) != std::string_view::npos;
  const size_t first = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  if (!declares || at == first) return std::nullopt;
  return Malformed{at, "the declaration <?xml … ?> is not the first in the file",
                   "it stands there, or is left out"};
}

}  // namespace

std::optional<Malformed> malformed(std::string_view text) {
  constexpr std::pair<std::string_view, std::string_view> kPassed[] = {
      {"<!--", "-->"}, {"<![CDATA[", "]]>"}, {"<?", "?>"}};
  char quote_open = 0;  // of an attribute
  bool tag = false;
  size_t passed = 0;  // within a comment and the like up to here
  for (size_t i = 0; i < text.size();) {
    const size_t size = characterAt(text.substr(i));
    if (size == 0) return Malformed{i, "this is no character of XML in UTF-8", "save the file as UTF-8"};
    const char c = text[i];
    for (const auto& [open, close] : kPassed) {
      if (i < passed || tag || c != '<' || !text.substr(i).starts_with(open)) continue;
      if (std::optional<Malformed> bad = malformedBeside(text, i)) return bad;
      const size_t end = text.find(close, i + open.size());
      passed = end == std::string_view::npos ? text.size() : end + close.size();
    }
    if (i >= passed) {
      if (!tag && c == ']' && text.substr(i).starts_with("]]>"))
        return Malformed{i, "a text has \"]]>\"", "it is written \"]]&gt;\" there"};
      if (quote_open != 0 && c == '<' && !isToken(text.substr(i)))
        return Malformed{i, "an attribute has a \"<\"", "it is written \"&lt;\" there"};
      if (c == '&' && !isReference(text.substr(i, 16)))
        return Malformed{i,
                         fmt::format("{} is no character that XML knows",
                                     quote(text.substr(i, std::min<size_t>(text.find(';', i) - i + 1, 12)))),
                         "XML has &amp; &lt; &gt; &quot; &apos; and numbers such as &#10;"};
      if (tag && quote_open == 0 && (c == '"' || c == '\''))
        quote_open = c;
      else if (c == quote_open)
        quote_open = 0;
      else if (quote_open == 0 && (c == '<' || c == '>'))
        tag = c == '<';
    }
    i += size;
  }
  return std::nullopt;
}

}  // namespace lacquer::materialx
