// Names that stand twice in one object, where that is no error.
#pragma once

#include <string>
#include <string_view>

#include "json/json.h"

namespace lacquer::json {

/// As parse() with Doubles::LastCounts, and a warning "duplicate-key" in `told` for each name that stands
/// twice in one object, up to twenty of them: glTF forbids it (glTF 2.0, "JSON Encoding"), and readers differ
/// in which of the two they take.
Result<Json> parseTelling(std::string_view text, const std::string& file, const Limits& limits,
                          Diagnostics& told);

}  // namespace lacquer::json
