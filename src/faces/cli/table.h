// What the command line prints for people.
#pragma once

#include <string>
#include <string_view>

#include "lacquer.h"

namespace lacquer::cli {

/// Columns of the terminal behind stderr; 0 when it is none.
int terminalWidth();

/// Text from a file as a terminal may show it on one line: control characters (C0, DEL, C1), bytes that are
/// no UTF-8, marks of writing direction and separators of lines become `?`. `kept`: line ends or tabs that
/// stay.
std::string printable(std::string_view text, std::string_view kept = {});

/// Materials with their terms, then shaders with their files.
void printReport(const Report& report, const Options& options);

/// The library (or one node) as text or JSON, from nodesJson(). False when there is no node of that name.
bool printNodes(const std::string& text, const std::string& name, bool as_json);

}  // namespace lacquer::cli
