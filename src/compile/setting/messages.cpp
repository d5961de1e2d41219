#include "setting/messages.h"

#include <algorithm>

namespace lacquer {

Message toMessage(const Diagnostic& d) {
  const auto level = d.severity == Severity::Error     ? Message::Level::Error
                     : d.severity == Severity::Warning ? Message::Level::Warning
                                                       : Message::Level::Note;
  return {level,          d.code,    d.place.file, d.place.pointer, d.place.line,
          d.place.column, d.message, d.help,       format(d)};
}

Diagnostic toDiagnostic(const Message& m) {
  const auto severity = m.level == Message::Level::Error     ? Severity::Error
                        : m.level == Message::Level::Warning ? Severity::Warning
                                                             : Severity::Note;
  return {m.code, severity, {m.file, m.line, m.column, m.pointer}, m.message, m.help, {}};
}

void report(const Diagnostics& diagnostics, const std::string& file, Messages& messages) {
  for (Diagnostic d : diagnostics) {
    if (d.place.file.empty()) d.place.file = file;
    messages.push_back(toMessage(d));
  }
}

bool hasError(const Messages& messages) {
  return std::any_of(messages.begin(), messages.end(),
                     [](const Message& m) { return m.level == Message::Level::Error; });
}

}  // namespace lacquer
