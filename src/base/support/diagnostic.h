// Errors as values: what every folder returns when its input is wrong.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace lacquer {

enum class Severity : uint8_t { Note, Warning, Error };

/// Where a diagnostic points: a text position, a JSON pointer, or only a file.
struct Place {
  std::string file;     ///< path as the user gave it; empty when there is none
  uint32_t line = 0;    ///< 1-based; 0 when the place is not a text position
  uint32_t column = 0;  ///< 1-based, in bytes
  std::string pointer;  ///< JSON pointer (RFC 6901), e.g. "/materials/0/name"
  bool operator==(const Place&) const = default;
};

/// One thing that is wrong (or worth knowing) in the user's input.
struct Diagnostic {
  std::string code;  ///< stable, lower-case, dash-separated, e.g. "factor-out-of-range"
  Severity severity = Severity::Error;
  Place place;
  std::string message;  ///< what is wrong
  std::string help;     ///< what is right; may be empty
  std::string excerpt;  ///< the offending line and a caret line below it; may be empty
  bool operator==(const Diagnostic&) const = default;
};

using Diagnostics = std::vector<Diagnostic>;

/// Either a value or the reasons why there is none (at least one of severity Error).
template <class T>
using Result = tl::expected<T, Diagnostics>;

/// An unexpected result made of one error.
tl::unexpected<Diagnostics> fail(std::string code, Place place, std::string message, std::string help = {});

/// A file of others may be wrong in a million places, and nobody reads more than the first of them.
inline constexpr size_t kMostDiagnostics = 1000;

/// False when a list holds so many that addBounded() takes no more.
inline bool hasRoom(const Diagnostics& list) { return list.size() < kMostDiagnostics; }
/// True when it has said that there are more, too.
inline bool isFull(const Diagnostics& list) { return list.size() > kMostDiagnostics; }

/// Adds one where there is room. One more then says that there are others, and is as grave as the gravest.
void addBounded(Diagnostics& to, Diagnostic one);

/// "error", "warning" or "note".
std::string_view severityName(Severity severity);

/// The text form: `file:line:column: error: message [code]`, then the excerpt and `  help: …` where given.
/// A JSON place is written `file:/pointer: error: …`. No trailing newline.
std::string format(const Diagnostic& diagnostic);

bool hasError(const Diagnostics& diagnostics);

/// Fills line, column and excerpt of a diagnostic from a byte offset into `text`.
/// `length` bytes (at least one) are underlined. Tabs in the line are kept before the caret.
void locate(Diagnostic& diagnostic, std::string_view text, size_t offset, size_t length = 1);

}  // namespace lacquer
