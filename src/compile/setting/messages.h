// Diagnostics as the public messages.
#pragma once

#include <string>

#include "lacquer/options.h"
#include "support/diagnostic.h"

namespace lacquer {

Message toMessage(const Diagnostic& diagnostic);
/// Appends, filling in `file` where a diagnostic has none.
void report(const Diagnostics& diagnostics, const std::string& file, Messages& messages);
Diagnostic toDiagnostic(const Message& message);

}  // namespace lacquer
