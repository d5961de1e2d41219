// Which of a template's givens differ for each light or each vertex, and which ports may take such values. A
// value of a light is only good under a sum over the lights, a value of a vertex only where it is
// interpolated.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "lang/ast.h"

namespace lacquer::graph {

/// What a value differs with, as bits.
using Ties = uint8_t;
inline constexpr Ties kLight = 1;
inline constexpr Ties kVertex = 2;

/// The ties that some operation in the node's bodies, or in what they call, unties.
class NodeRates {
public:
  Ties untied(const lang::NodeDecl& node);

private:
  std::unordered_map<const lang::NodeDecl*, Ties> known_;
};

struct TemplateRates {
  std::unordered_map<std::string, Ties> givens;        ///< by the name that a graph writes: "light_sample.L"
  std::unordered_map<std::string_view, Ties> refused;  ///< by port: what its value may not be tied to
};

TemplateRates templateRates(const lang::TemplateDecl& decl, NodeRates& nodes);

}  // namespace lacquer::graph
