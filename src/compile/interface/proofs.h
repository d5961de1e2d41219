// What is proved of a module, as JSON.
#pragma once

#include <string>
#include <vector>

#include "analysis/prove.h"
#include "json/json.h"

namespace lacquer {

using json::Json;

/// [lo, hi], with "nan" behind them for what may be no number.
Json rangeJson(const analysis::Range& range);

/// What must keep to its domain, for people.
std::vector<std::string> operandTexts(const ir::Module& module, const std::vector<analysis::Proof>& proofs);

/// `operand`: the text of what must keep to the domain.
Json operationJson(const ir::Dag& dag, const analysis::Proof& proof, const std::string& operand);

/// {"safe": n, "unproved": [...]}: the operations that have a domain.
Json proofsJson(const ir::Module& module);

}  // namespace lacquer
