#include "prove/prove.h"

#include <fmt/format.h>

#include "interface/entry.h"
#include "interface/proofs.h"
#include "lacquer/tools.h"
#include "lower/lower.h"
#include "prove/nodes.h"
#include "setting/language.h"
#include "setting/messages.h"
#include "shader/module.h"

namespace lacquer {

namespace {

Json claimJson(const Claim& claim) {
  return {{"what", claim.what},
          {"need", claim.need},
          {"reached", rangeJson(claim.reached.lo, claim.reached.hi, claim.reached.nan)},
          {"proved", claim.proved}};
}

Json claimsJson(const std::vector<Claim>& claims) {
  Json json = Json::array();
  for (const Claim& claim : claims) json.push_back(claimJson(claim));
  return json;
}

analysis::Arithmetic arithmeticOf(Precision precision) {
  switch (precision) {
    case Precision::Vulkan: break;
    case Precision::Ieee: return analysis::Arithmetic::Ieee;
    case Precision::Mediump: return analysis::Arithmetic::Mediump;
  }
  return analysis::Arithmetic::Vulkan;
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

Result<std::string> proveGraph(const graph::Graph& graph, const ir::Module& module,
                               const lang::Library& library, const Options& options, Precision precision) {
  const Result<std::vector<Claim>> claims = contractClaims(graph, library, options);
  if (!claims) return tl::make_unexpected(claims.error());
  const analysis::Proofs proofs = analysis::prove(module, {arithmeticOf(precision), analysis::kSceneLimit});
  const std::vector<std::string> operands = operandTexts(module, proofs.operations);
  Json operations = Json::array();
  for (size_t i = 0; i < operands.size(); ++i) {
    Json row = operationJson(operationOf(module.dag, proofs.operations[i], operands[i]));
    row["safe"] = proofs.operations[i].safe;
    operations.push_back(std::move(row));
  }
  Json outputs = Json::array();
  for (const analysis::OutputRange& range : proofs.outputs) {
    outputs.push_back({{"name", module.outputs[range.output].name},
                       {"reached", rangeJson(range.reached.lo, range.reached.hi, range.reached.nan)}});
  }
  return Json{{"material", graph.name},
              {"shader", shaderId(module, library)},
              {"operations", std::move(operations)},
              {"outputs", std::move(outputs)},
              {"contracts", claimsJson(*claims)}}
      .dump(2);
}

std::string proveNodesJson(const Options& options, Messages& messages, Precision precision) {
  const auto library = libraryFor(options);
  if (!library) {
    report(library.error(), {}, messages);
    return {};
  }
  const Diagnostics found = (*library)->check();
  report(found, {}, messages);
  if (hasError(found)) return {};
  Json nodes = Json::array();
  for (const NodeProof& proof : proveNodes(**library, arithmeticOf(precision))) {
    Json row = {{"name", proof.node}};
    if (!proof.variant.empty()) row["variant"] = proof.variant;
    row["operations"] = claimsJson(proof.operations);
    row["results"] = claimsJson(proof.results);
    row["calls"] = claimsJson(proof.calls);
    nodes.push_back(std::move(row));
  }
  return Json{{"nodes", std::move(nodes)}}.dump(2);  // a node file may hold any bytes
}

}  // namespace lacquer
