// What is proved of a module's operations, as values.
#pragma once

#include <string>
#include <vector>

#include "analysis/prove.h"
#include "lacquer/reflection.h"

namespace lacquer {

/// What must keep to its domain, for people.
std::vector<std::string> operandTexts(const ir::Module& module, const std::vector<analysis::Proof>& proofs);

Reached reachedOf(const analysis::Range& range);

/// `operand`: the text of what must keep to the domain.
OperationProof operationOf(const ir::Dag& dag, const analysis::Proof& proof, std::string operand);

/// How many operations that have a domain are proved to keep to it; the others are appended.
size_t proofsOf(const ir::Module& module, std::vector<OperationProof>& unproved);

}  // namespace lacquer
