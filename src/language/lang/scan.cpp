#include "lang/scan.h"

#include <algorithm>
#include <array>
#include <optional>

#include "lang/lexer.h"
#include "lang/words.h"

namespace lacquer::lang {
namespace {

/// What a word at the start of a declaration declares.
std::optional<DeclKind> declaredBy(std::string_view word) {
  for (const DeclWord& row : kDeclWords) {
    if (word.size() == row.word.size() && word[0] == row.word[0] && word == row.word) return row.kind;
  }
  return std::nullopt;
}

class Scanner {
public:
  explicit Scanner(Reporter& reporter) : reporter_(reporter), text_(reporter.text()) {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
  }

  std::vector<ScannedDecl> run() {
    while (at_ < text_.size()) step();
    if (!found_.empty()) found_.back().end = static_cast<uint32_t>(text_.size());
    // What has no name was reported, and only bounded its neighbours.
    std::erase_if(found_, [](const ScannedDecl& d) { return d.name.empty(); });
    return std::move(found_);
  }

private:
  bool atLineStart() const { return at_ == 0 || text_[at_ - 1] == '\n'; }
  bool outside() const { return braces_ == 0 && parentheses_ == 0; }

  void skipTo(std::string_view mark, size_t from) {
    const size_t end = text_.find(mark, from);
    at_ = end == std::string_view::npos ? text_.size() : end + mark.size();
  }

  void step() {
    const char c = text_[at_];
    if (isSpace(c)) {
      do ++at_;
      while (at_ < text_.size() && isSpace(text_[at_]));
      return;
    }
    if (!outside() && !atLineStart() && isPlain(c)) return plain();
    if (isNameStart(c)) return word();
    if (c != '/') return other(c);
    const std::string_view rest = text_.substr(at_, 4);
    if (rest.starts_with("///") && !rest.starts_with("////")) {
      if (!docs_ && (outside() || atLineStart())) docs_ = at_;
      skipTo("\n", at_);
    } else if (rest.starts_with("//")) {
      skipTo("\n", at_);
    } else if (rest.starts_with("/*")) {
      skipTo("*/", at_ + 2);
    } else {
      other(c);
    }
  }

  /// Within braces only these end what cannot begin a declaration.
  static bool isPlain(char c) {
    static constexpr auto kPlain = [] {
      std::array<bool, 256> plain{};
      plain.fill(true);
      for (const char end : {'{', '}', '(', ')', '/', '"', '\n'})
        plain[static_cast<unsigned char>(end)] = false;
      return plain;
    }();
    return kPlain[static_cast<unsigned char>(c)];
  }

  void plain() {
    docs_.reset();
    do ++at_;
    while (at_ < text_.size() && isPlain(text_[at_]));
  }

  void other(char c) {
    stray(1);
    docs_.reset();
    if (c == '{') ++braces_;
    if (c == '}' && braces_ > 0) --braces_;
    if (c == '(') ++parentheses_;
    if (c == ')' && parentheses_ > 0) --parentheses_;
    if (c == '"') {
      do ++at_;
      while (at_ < text_.size() && text_[at_] != '"' && text_[at_] != '\n');
    }
    if (at_ < text_.size()) ++at_;
    while (isDigit(c) && at_ < text_.size() && isNamePart(text_[at_])) ++at_;
  }

  std::string_view takeWord() {
    const char* const begin = text_.data() + at_;
    const char* const end = std::find_if_not(begin, text_.data() + text_.size(), isNamePart);
    at_ += static_cast<size_t>(end - begin);
    return {begin, static_cast<size_t>(end - begin)};
  }

  void word() {
    const size_t begin = at_;
    const bool may_begin = outside() || atLineStart();
    const std::string_view word = takeWord();
    const std::optional<DeclKind> kind = may_begin ? declaredBy(word) : std::nullopt;
    if (!kind) {
      at_ = begin;
      stray(word.size());
      at_ = begin + word.size();
      docs_.reset();
      return;
    }
    const auto start = static_cast<uint32_t>(docs_.value_or(begin));
    docs_.reset();
    braces_ = parentheses_ = 0;
    if (!found_.empty()) found_.back().end = start;
    ScannedDecl& decl = found_.emplace_back();
    decl.kind = *kind;
    decl.begin = start;
    if (*kind == DeclKind::Const) name();  // the type
    decl.name = name();
    if (decl.name.empty()) {
      reporter_.error("syntax", {static_cast<uint32_t>(begin), static_cast<uint32_t>(word.size())},
                      "expected a name behind '" + std::string(word) + "'",
                      *kind == DeclKind::Const ? "a constant is `const float NAME = value;`" : "");
    }
  }

  /// The next word, if nothing else comes first.
  std::string_view name() {
    while (at_ < text_.size() && isSpace(text_[at_])) ++at_;
    if (at_ >= text_.size() || !isNameStart(text_[at_])) return {};
    return takeWord();
  }

  /// Before the first declaration there is nothing that could report it later.
  void stray(size_t length) {
    if (!found_.empty() || said_) return;
    said_ = true;
    reporter_.error("syntax", {static_cast<uint32_t>(at_), static_cast<uint32_t>(length)},
                    "expected a declaration: a const, a node, a template, an extension, a part or a profile");
  }

  Reporter& reporter_;
  std::string_view text_;
  size_t at_ = 0;
  std::optional<size_t> docs_;  ///< where the doc lines began that nothing but space follows so far
  uint32_t braces_ = 0, parentheses_ = 0;
  bool said_ = false;
  std::vector<ScannedDecl> found_;
};

}  // namespace

std::vector<ScannedDecl> scan(Reporter& reporter) { return Scanner(reporter).run(); }

}  // namespace lacquer::lang
