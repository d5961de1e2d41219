// Source text to tokens.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "lang/reporter.h"

namespace lacquer::lang {

struct Token {
  enum class Kind : uint8_t { Name, Number, String, Symbol, Doc, End };
  Kind kind = Kind::End;
  bool integer = false;       ///< Number without point and exponent
  bool without_sign = false;  ///< an integer with the suffix `u`
  Span span;
  std::string_view text;     ///< String: between the quotes; Doc: behind `///` and one space
  std::string_view comment;  ///< the `//` comment behind it on its line, the next token's line being another
  double number = 0;

  bool is(std::string_view symbol) const {
    return (kind == Kind::Symbol || kind == Kind::Name) && text.size() == symbol.size() &&
           text[0] == symbol[0] && text == symbol;
  }
};

/// The tokens of text[begin, end), an End token last. What cannot be a token is reported and left out.
std::vector<Token> tokenize(Reporter& reporter, uint32_t begin, uint32_t end);

inline bool isNameStart(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
inline bool isDigit(char c) { return c >= '0' && c <= '9'; }
/// By a table: texts are made of these.
inline bool isNamePart(char c) {
  static constexpr auto kParts = [] {
    std::array<bool, 256> parts{};
    for (int i = 0; i < 128; ++i) {
      parts[static_cast<size_t>(i)] =
          (i >= 'a' && i <= 'z') || (i >= 'A' && i <= 'Z') || i == '_' || (i >= '0' && i <= '9');
    }
    return parts;
  }();
  return kParts[static_cast<unsigned char>(c)];
}
inline bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// Without spaces at both ends.
std::string_view trim(std::string_view text);

}  // namespace lacquer::lang
