// Collects what is wrong in one declaration.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "lang/ast.h"
#include "support/diagnostic.h"

namespace lacquer::lang {

/// The most errors that are worth reading at once.
inline constexpr size_t kMostErrors = 20;

class Reporter {
public:
  Reporter(std::string_view file, std::string_view text) : file_(file), text_(text) {}

  void error(std::string_view code, Span span, std::string message, std::string help = {}) {
    if (full()) return;
    Diagnostic diagnostic{std::string(code),  Severity::Error, {std::string(file_), 0, 0, {}},
                          std::move(message), std::move(help), {}};
    locate(diagnostic, text_, span.offset, span.length);
    diagnostics_.push_back(std::move(diagnostic));
  }

  /// One more than is shown, so that it can be said that there are more.
  bool full() const { return diagnostics_.size() > kMostErrors; }
  size_t count() const { return diagnostics_.size(); }
  std::string_view file() const { return file_; }
  std::string_view text() const { return text_; }
  std::string_view text(Span span) const { return text_.substr(span.offset, span.length); }
  /// Counted on from where the last question was, as questions come in the order of the text.
  uint32_t lineOf(Span span) const {
    if (span.offset < counted_) counted_ = 0, line_ = 1;
    const std::string_view more = text_.substr(counted_, span.offset - counted_);
    line_ += static_cast<uint32_t>(std::count(more.begin(), more.end(), '\n'));
    counted_ = span.offset;
    return line_;
  }
  Diagnostics take() { return std::move(diagnostics_); }

private:
  std::string_view file_, text_;
  mutable uint32_t counted_ = 0, line_ = 1;
  Diagnostics diagnostics_;
};

}  // namespace lacquer::lang
