#include "interface/proofs.h"

#include <cmath>

#include "targets/target.h"

namespace lacquer {

namespace {

Json endJson(double x) { return std::isfinite(x) ? Json(x) : Json(x < 0 ? "-inf" : "inf"); }

}  // namespace

Json rangeJson(const analysis::Range& range) {
  Json json = Json::array({endJson(range.lo), endJson(range.hi)});
  // Beside what lies in the range it may be no number.
  if (range.nan) json.push_back("nan");
  return json;
}

Json operationJson(const ir::Dag& dag, const analysis::Proof& proof, const std::string& operand) {
  const std::string& term = dag.terms()[dag.termOf(proof.id)].name;
  Json json = {{"term", term}};
  if (const std::string_view name = dag.nameOf(proof.id); !name.empty()) json["name"] = name;
  json["operation"] = ir::info(dag[proof.id].op).name;
  json["rate"] = ir::rateName(dag[proof.id].rate);
  json["operand"] = operand;
  json["need"] = proof.need;
  json["reached"] = rangeJson(proof.reached);
  return json;
}

std::vector<std::string> operandTexts(const ir::Module& module, const std::vector<analysis::Proof>& proofs) {
  std::vector<ir::ValueId> operands;
  for (const analysis::Proof& proof : proofs) operands.push_back(proof.operand);
  return targets::expressionTexts(module, operands);
}

Json proofsJson(const ir::Module& module) {
  std::vector<analysis::Proof> proofs = analysis::prove(module).operations;
  const size_t safe = std::erase_if(proofs, [](const analysis::Proof& proof) { return proof.safe; });
  const std::vector<std::string> operands = operandTexts(module, proofs);
  Json unproved = Json::array();
  for (size_t i = 0; i < proofs.size(); ++i)
    unproved.push_back(operationJson(module.dag, proofs[i], operands[i]));
  return {{"safe", safe}, {"unproved", std::move(unproved)}};
}

}  // namespace lacquer
