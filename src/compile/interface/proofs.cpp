#include "interface/proofs.h"

#include <utility>

#include "targets/target.h"

namespace lacquer {

Reached reachedOf(const analysis::Range& range) { return {range.lo, range.hi, range.nan}; }

OperationProof operationOf(const ir::Dag& dag, const analysis::Proof& proof, std::string operand) {
  return {dag.terms()[dag.termOf(proof.id)].name,
          std::string(dag.nameOf(proof.id)),
          std::string(ir::info(dag[proof.id].op).name),
          std::string(ir::rateName(dag[proof.id].rate)),
          std::move(operand),
          std::string(proof.need),
          reachedOf(proof.reached),
          proof.safe};
}

std::vector<std::string> operandTexts(const ir::Module& module, const std::vector<analysis::Proof>& proofs) {
  std::vector<ir::ValueId> operands;
  for (const analysis::Proof& proof : proofs) operands.push_back(proof.operand);
  return targets::expressionTexts(module, operands);
}

size_t proofsOf(const ir::Module& module, std::vector<OperationProof>& unproved) {
  std::vector<analysis::Proof> proofs = analysis::prove(module).operations;
  const size_t safe = std::erase_if(proofs, [](const analysis::Proof& proof) { return proof.safe; });
  std::vector<std::string> operands = operandTexts(module, proofs);
  for (size_t i = 0; i < proofs.size(); ++i)
    unproved.push_back(operationOf(module.dag, proofs[i], std::move(operands[i])));
  return safe;
}

}  // namespace lacquer
