// Which of a template's givens differ for each light or each vertex, and which ports may take such values. A
// value of a light is only good under a sum over the lights, a value of a vertex only where it is
// interpolated.
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>

#include "lang/ast.h"

namespace lacquer::graph {

using lang::kLight;
using lang::kVertex;
using lang::Ties;

struct TemplateRates {
  std::unordered_map<std::string, Ties> givens;        ///< by the name that a graph writes: "light_sample.L"
  std::unordered_map<std::string_view, Ties> refused;  ///< by port: what its value may not be tied to
};

TemplateRates templateRates(const lang::TemplateDecl& decl);

}  // namespace lacquer::graph
