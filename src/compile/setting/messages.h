// Diagnostics as the public messages.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "lacquer/options.h"
#include "support/diagnostic.h"

namespace lacquer {

Message toMessage(const Diagnostic& diagnostic);
/// Appends, filling in `file` where a diagnostic has none.
void report(const Diagnostics& diagnostics, const std::string& file, Messages& messages);
Diagnostic toDiagnostic(const Message& message);

/// The value; of an error nothing, and its diagnostics are appended.
template <class T>
std::optional<T> valueOf(Result<T> result, const std::string& file, Messages& messages) {
  if (result) return std::move(*result);
  report(result.error(), file, messages);
  return std::nullopt;
}

}  // namespace lacquer
