// Which variants an error budget allows: `./dev bench error` has measured what each of them is wrong by and
// saves, and the program holds the table.
#pragma once

#include <span>
#include <string_view>

#include "graph/graph.h"
#include "lacquer.h"

namespace lacquer {

/// A variant that is cheaper than its reference body.
struct VariantRow {
  std::string_view node, variant;
  double any_ior;  ///< the largest relative error of a colour, for IORs from 1 to 4 of base and coat
  double ior_1_5;  ///< the same where both are 1.5
  double saved;    ///< cycles of inverse throughput on navi21, in a material with everything
};

std::span<const VariantRow> variantTable();

/// Relative errors one on top of the other: (1 + a) (1 + b) - 1.
inline double combined(double a, double b) { return a + b + a * b; }

/// Picks variants for the nodes that name none: those that save the most while their errors combine to no
/// more than `budget`. Of equal savings the smaller error wins, then the table's order.
void applyBudget(graph::Graph& graph, double budget);

/// What is in the graph in place of reference bodies, as far as the table knows it.
std::vector<MaterialTerms::Variant> variantsOf(const graph::Graph& graph);

/// All errors combined.
double expectedError(const std::vector<MaterialTerms::Variant>& variants);

}  // namespace lacquer
