#include "lang/lexer.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "support/letters.h"
#include "support/text.h"

namespace lacquer::lang {

std::string_view trim(std::string_view text) {
  while (!text.empty() && isSpace(text.front())) text.remove_prefix(1);
  while (!text.empty() && isSpace(text.back())) text.remove_suffix(1);
  return text;
}

namespace {

constexpr uint32_t kLongestName = 255;

/// The length of the symbol that begins with these characters; 0 for none.
uint32_t symbolLength(char first, char second, char third) {
  switch (first) {
    case '(':
    case ')':
    case '{':
    case '}':
    case '[':
    case ']':
    case ',':
    case ';':
    case '?':
    case '.':
    case '~': return 1;
    case '-': return second == '>' || second == '-' || second == '=' ? 2 : 1;
    case '+': return second == '+' || second == '=' ? 2 : 1;
    case '&': return second == '&' || second == '=' ? 2 : 1;
    case '|': return second == '|' || second == '=' ? 2 : 1;
    case ':': return second == ':' ? 2 : 1;
    case '<':
    case '>': return second == first ? (third == '=' ? 3 : 2) : (second == '=' ? 2 : 1);
    case '=':
    case '!':
    case '*':
    case '/':
    case '%':
    case '^': return second == '=' ? 2 : 1;
    default: return 0;
  }
}

class Lexer {
public:
  Lexer(Reporter& reporter, uint32_t begin, uint32_t end)
      : reporter_(reporter), text_(reporter.text().substr(0, end)), at_(begin) {}

  std::vector<Token> run() {
    tokens_.reserve((text_.size() - at_) / 4 + 2);
    while (skipSpace()) token();
    tokens_.push_back({});
    tokens_.back().span = {static_cast<uint32_t>(text_.size()), 0};
    return std::move(tokens_);
  }

private:
  bool ends(uint32_t ahead = 0) const { return at_ + ahead >= text_.size(); }
  char look(uint32_t ahead = 0) const { return ends(ahead) ? '\0' : text_[at_ + ahead]; }

  uint32_t lineEnd() const {
    const size_t end = text_.find('\n', at_);
    return static_cast<uint32_t>(end == std::string_view::npos ? text_.size() : end);
  }

  /// To the next token; false at the end.
  bool skipSpace() {
    bool same_line = !tokens_.empty();
    while (!ends()) {
      const char c = text_[at_];
      if (isSpace(c)) {
        same_line = same_line && c != '\n';
        ++at_;
      } else if (c != '/') {
        return true;
      } else if (look(1) == '*') {
        const size_t end = text_.find("*/", at_ + 2);
        if (end == std::string_view::npos) {
          reporter_.error("unterminated-comment", {at_, 2}, "this comment has no end", "close it with '*/'");
          at_ = static_cast<uint32_t>(text_.size());
        } else {
          at_ = static_cast<uint32_t>(end) + 2;
        }
      } else if (look(1) == '/' && !isDoc()) {
        const uint32_t end = lineEnd();
        if (same_line) tokens_.back().comment = trim(text_.substr(at_ + 2, end - at_ - 2));
        at_ = end;
      } else {
        return true;
      }
    }
    return false;
  }

  /// `///` and not a line of slashes.
  bool isDoc() const { return look() == '/' && look(1) == '/' && look(2) == '/' && look(3) != '/'; }

  void token() {
    const char c = look();
    if (isNameStart(c)) return name();
    if (isDoc()) return doc();
    if (isDigit(c) || (c == '.' && isDigit(look(1)))) return number();
    if (c == '"') return string();
    if (const uint32_t length = symbolLength(c, look(1), look(2))) return add(Token::Kind::Symbol, length);
    invalid();
  }

  void add(Token::Kind kind, uint32_t length) {
    Token& token = tokens_.emplace_back();
    token.kind = kind;
    token.span = {at_, length};
    token.text = text_.substr(at_, length);
    at_ += length;
  }

  void doc() {
    add(Token::Kind::Doc, lineEnd() - at_);
    std::string_view& text = tokens_.back().text;
    text.remove_prefix(3);
    if (text.starts_with(' ')) text.remove_prefix(1);
    while (!text.empty() && isSpace(text.back())) text.remove_suffix(1);
  }

  void name() {
    const char* const begin = text_.data() + at_;
    const char* const end = text_.data() + text_.size();
    const auto length = static_cast<uint32_t>(std::find_if_not(begin, end, isNamePart) - begin);
    const Span span{at_, length};
    add(Token::Kind::Name, length);
    if (length <= kLongestName) return;
    reporter_.error("name-too-long", span, fmt::format("this name has {} characters", length),
                    fmt::format("a name has at most {}", kLongestName));
    tokens_.back().text = tokens_.back().text.substr(0, kLongestName);  // for the messages to come
  }

  /// `0x` and digits: the bits of an integer.
  void hexadecimal() {
    uint32_t length = 2;
    while (isHexDigit(look(length))) ++length;
    const std::string_view digits = text_.substr(at_ + 2, length - 2);
    const bool without_sign = look(length) == 'u';
    const uint32_t end = length + (without_sign ? 1 : 0);
    uint32_t tail = end;
    while (isNamePart(look(tail))) ++tail;
    const std::string_view all = text_.substr(at_, tail);
    uint32_t bits = 0;
    const bool good =
        tail == end && !digits.empty() && digits.size() <= 8 &&
        std::from_chars(digits.data(), digits.data() + digits.size(), bits, 16).ec == std::errc{};
    if (!good) {
      reporter_.error("invalid-number", {at_, tail}, fmt::format("'{}' is not a number", printable(all)),
                      "behind 0x stand one to eight hexadecimal digits, and 'u' for a uint");
    }
    add(Token::Kind::Number, tail);
    Token& token = tokens_.back();
    token.integer = true;
    token.without_sign = without_sign;
    token.number = bits;
  }

  void number() {
    if (look() == '0' && look(1) == 'x') return hexadecimal();
    uint32_t length = 0;
    bool integer = true;
    while (isDigit(look(length))) ++length;
    if (look(length) == '.') {
      integer = false;
      do ++length;
      while (isDigit(look(length)));
    }
    const uint32_t sign = look(length + 1) == '+' || look(length + 1) == '-' ? 1 : 0;
    if ((look(length) == 'e' || look(length) == 'E') && isDigit(look(length + 1 + sign))) {
      integer = false;
      length += 1 + sign;
      while (isDigit(look(length))) ++length;
    }
    const bool without_sign = integer && look(length) == 'u' && !isNamePart(look(length + 1));
    uint32_t tail = length + (without_sign ? 1 : 0);
    while (isNamePart(look(tail))) ++tail;
    if (tail != length && !without_sign) {
      const std::string_view digits = text_.substr(at_, length);
      reporter_.error("invalid-number", {at_, tail},
                      fmt::format("'{}' is not a number", printable(text_.substr(at_, tail))),
                      fmt::format("numbers have no suffix but the 'u' of a uint; perhaps '{}' is meant",
                                  printable(digits)));
    }
    const std::string_view digits = text_.substr(at_, length);
    add(Token::Kind::Number, tail);
    Token& token = tokens_.back();
    token.integer = integer;
    token.without_sign = without_sign;
    if (integer && length == 1) {
      token.number = digits[0] - '0';
      return;
    }
    // Some readers want a digit on both sides of the point.
    std::string padded = digits.starts_with('.') ? "0" : "";
    padded += digits;
    const auto parsed = std::from_chars(padded.data(), padded.data() + padded.size(), token.number);
    const bool zero =
        digits.substr(0, digits.find_first_of("eE")).find_first_of("123456789") == std::string_view::npos;
    if (zero) {
      token.number = 0;
    } else if (parsed.ec != std::errc{} || token.number > std::numeric_limits<float>::max() ||
               static_cast<float>(token.number) == 0) {
      reporter_.error("number-out-of-range", token.span,
                      fmt::format("'{}' does not fit a float", printable(digits)),
                      "numbers lie between 1.4e-45 and 3.4e38");
      token.number = 1;
    }
  }

  void string() {
    const uint32_t end = lineEnd();
    const size_t close = text_.substr(0, end).find('"', at_ + 1);
    if (close == std::string_view::npos) {
      reporter_.error("unterminated-string", {at_, end - at_}, "this string has no end",
                      "close it with '\"' on the same line");
      add(Token::Kind::String, end - at_);
      tokens_.back().text.remove_prefix(1);
      return;
    }
    add(Token::Kind::String, static_cast<uint32_t>(close) + 1 - at_);
    tokens_.back().text.remove_prefix(1);
    tokens_.back().text.remove_suffix(1);
  }

  void invalid() {
    const auto byte = static_cast<unsigned char>(look());
    uint32_t length = 1;
    while (byte >= 0x80 && (static_cast<unsigned char>(look(length)) & 0xC0U) == 0x80 && length < 4) ++length;
    // Only what a terminal can show is shown.
    std::string shown = byte < 0x20 || byte == 0x7F || byte >= 0x80 ? fmt::format("the byte 0x{:02x}", byte)
                                                                    : fmt::format("'{}'", look());
    reporter_.error("invalid-character", {at_, length}, fmt::format("{} has no meaning here", shown),
                    "outside comments and strings, the language is written in ASCII");
    at_ += length;
  }

  Reporter& reporter_;
  std::string_view text_;
  uint32_t at_;
  std::vector<Token> tokens_;
};

}  // namespace

std::vector<Token> tokenize(Reporter& reporter, uint32_t begin, uint32_t end) {
  return Lexer(reporter, begin, end).run();
}

}  // namespace lacquer::lang
