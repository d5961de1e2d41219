// The tables of docs/accuracy.md.
#pragma once

#include <string>
#include <string_view>

namespace lacquer::accuracy {

/// "direct 1", "direct 0.5", "environment 1", "environment 0.5" (a smooth coat of that tint), "rough" or
/// "grid".
std::string table(std::string_view name);

}  // namespace lacquer::accuracy
