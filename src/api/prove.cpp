// What is proved of a shader, as JSON: for the manifest, and in full for `lacquer prove`.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/manifest.h"
#include "api/node_proofs.h"
#include "lower/lower.h"
#include "passes/prove.h"
#include "targets/target.h"

namespace lacquer {

namespace {

Json endJson(double x) { return std::isfinite(x) ? Json(x) : Json(x < 0 ? "-inf" : "inf"); }

Json rangeJson(const passes::Range& range) {
  Json json = Json::array({endJson(range.lo), endJson(range.hi)});
  // Beside what lies in the range it may be no number.
  if (range.nan) json.push_back("nan");
  return json;
}

/// `operand`: the text of what must keep to the domain.
Json operationJson(const ir::Dag& dag, const passes::Proof& proof, const std::string& operand) {
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

Json claimJson(const Claim& claim) {
  return {{"what", claim.what},
          {"need", claim.need},
          {"reached", rangeJson(claim.reached)},
          {"proved", claim.proved}};
}

Json claimsJson(const std::vector<Claim>& claims) {
  Json json = Json::array();
  for (const Claim& claim : claims) json.push_back(claimJson(claim));
  return json;
}

/// The arguments of all nodes of a graph against their contracts, on the module as lowered.
Result<std::vector<Claim>> contractClaims(const graph::Graph& graph, const lang::Library& library,
                                          const Options& options) {
  std::vector<NodeModule::Call> calls;
  lower::LowerOptions lowering;
  if (options.parameters == Parameters::Baked) lowering.parameters = lower::ParameterMode::Baked;
  lowering.on_call = [&](const lang::NodeDecl& node, std::span<const ir::ValueId> arguments) {
    calls.push_back({&node, {arguments.begin(), arguments.end()}});
  };
  const Result<ir::Module> module = lower::lower(graph, library, lowering);
  if (!module) return tl::make_unexpected(module.error());
  std::vector<Claim> claims;
  for (const NodeModule::Call& call : calls) proveCall(*module, call, 200, claims);
  return claims;
}

}  // namespace

Json proofsJson(const ir::Module& module) {
  std::vector<passes::Proof> proofs = passes::prove(module).operations;
  const size_t safe = std::erase_if(proofs, [](const passes::Proof& proof) { return proof.safe; });
  const std::vector<std::string> operands = operandTexts(module, proofs);
  Json unproved = Json::array();
  for (size_t i = 0; i < proofs.size(); ++i)
    unproved.push_back(operationJson(module.dag, proofs[i], operands[i]));
  return {{"safe", safe}, {"unproved", std::move(unproved)}};
}

std::string Graph::prove(const Options& options, Messages& messages) {
  if (!filled(impl_.get(), "graph", messages)) return {};
  const Result<ir::Module> module = impl_->module(options, checkReading);
  if (!module) {
    report(module.error(), impl_->file, messages);
    return {};
  }
  const Result<std::vector<Claim>> claims = contractClaims(impl_->graph, **libraryFor(options), options);
  if (!claims) {
    report(claims.error(), impl_->file, messages);
    return {};
  }
  const passes::Proofs proofs = passes::prove(*module);
  const std::vector<std::string> operands = operandTexts(*module, proofs.operations);
  Json operations = Json::array();
  for (size_t i = 0; i < operands.size(); ++i) {
    Json row = operationJson(module->dag, proofs.operations[i], operands[i]);
    row["safe"] = proofs.operations[i].safe;
    operations.push_back(std::move(row));
  }
  Json outputs = Json::array();
  for (const passes::OutputRange& range : proofs.outputs) {
    outputs.push_back({{"name", module->outputs[range.output].name}, {"reached", rangeJson(range.reached)}});
  }
  return Json{{"material", impl_->graph.name},
              {"shader", shaderId(*module, **libraryFor(options))},
              {"operations", std::move(operations)},
              {"outputs", std::move(outputs)},
              {"contracts", claimsJson(*claims)}}
      .dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string proveNodesJson(const Options& options, Messages& messages) {
  const auto library = libraryFor(options);
  if (!library) {
    report(library.error(), {}, messages);
    return {};
  }
  if (const Diagnostics wrong = (*library)->checkAll(); !wrong.empty()) {
    report(wrong, {}, messages);
    return {};
  }
  Json nodes = Json::array();
  for (const NodeProof& proof : proveNodes(**library)) {
    Json row = {{"name", proof.node}};
    if (!proof.variant.empty()) row["variant"] = proof.variant;
    row["operations"] = claimsJson(proof.operations);
    row["results"] = claimsJson(proof.results);
    row["calls"] = claimsJson(proof.calls);
    nodes.push_back(std::move(row));
  }
  return Json{{"nodes", std::move(nodes)}}.dump(
      2, ' ', false, Json::error_handler_t::replace);  // a node file may hold any bytes
}

}  // namespace lacquer
