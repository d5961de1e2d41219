// What the command line prints for people.
#pragma once

#include <string>
#include <string_view>

#include "lacquer.h"

namespace lacquer::cli {

/// Columns of the terminal behind stderr; 0 when it is none.
int terminalWidth();

/// Text from a file as a terminal may show it: control characters but line ends and tabs become `?`.
std::string printable(std::string_view text);

/// Materials with their terms, then shaders with their files.
void printReport(const Report& report, const Options& options);

/// The library (or one node) as text or JSON, from nodesJson(). False when there is no node of that name.
bool printNodes(const std::string& text, const std::string& name, bool as_json);

}  // namespace lacquer::cli
