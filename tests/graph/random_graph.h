// Graphs at random: wrong ones, but with everything that the JSON form can hold.
#pragma once

#include <random>

#include "graph/graph.h"

namespace lacquer::test {

graph::Graph randomGraph(std::mt19937_64& random);

/// A finite double of any size, denormal ones, zeros of both signs and whole numbers among them.
double randomDouble(std::mt19937_64& random);

}  // namespace lacquer::test
