// What the tests of graphs share.
#pragma once

#include <string>

#include "graph/graph.h"
#include "lang/library.h"

namespace lacquer::test {

/// The library of library.node.
const lang::Library& sampleLibrary();

/// All diagnostics as text, a line feed behind each.
std::string formatAll(const Diagnostics& diagnostics);

/// The graph of a JSON text; a test failure and an empty graph when it cannot be read.
graph::Graph graphOf(const std::string& text);

graph::Source number(double x);
graph::Source ref(std::string node, std::string output = {});

}  // namespace lacquer::test
