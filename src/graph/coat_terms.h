// The terms of the coat that a profile chooses, wired by the names of their inputs.
#pragma once

#include "graph/profile.h"
#include "graph/surface_builder.h"

namespace lacquer::graph {

class CoatTerms {
public:
  CoatTerms(Graph& graph, const Surface& surface, const CoatSources& coat)
      : graph_(graph), surface_(surface), coat_(coat) {}

  /// The term's result. Adds its node, and those that its inputs come from, unless they are there.
  Source term(const Term& term);

private:
  /// What an input of that name is connected to.
  Source input(std::string_view name);
  Source node(const std::string& id, const std::string& type, Inputs inputs);
  std::vector<std::pair<std::string, Source>> withDielectric(Inputs inputs) const;

  Graph& graph_;
  const Surface& surface_;
  const CoatSources& coat_;
};

}  // namespace lacquer::graph
