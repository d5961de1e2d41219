#include "prove/prove.h"

#include <fmt/format.h>

#include "interface/proofs.h"
#include "lacquer/tools.h"
#include "lower/lower.h"
#include "prove/nodes.h"
#include "setting/language.h"
#include "setting/messages.h"
#include "shader/module.h"

namespace lacquer {

namespace {

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

Result<Proofs> proveGraph(const graph::Graph& graph, const ir::Module& module, const lang::Library& library,
                          const Options& options, Precision precision) {
  Result<std::vector<Claim>> claims = contractClaims(graph, library, options);
  if (!claims) return tl::make_unexpected(claims.error());
  const analysis::Proofs found = analysis::prove(module, {arithmeticOf(precision), analysis::kSceneLimit});
  std::vector<std::string> operands = operandTexts(module, found.operations);
  Proofs proofs{graph.name, shaderId(module, library), {}, {}, std::move(*claims)};
  for (size_t i = 0; i < operands.size(); ++i)
    proofs.operations.push_back(operationOf(module.dag, found.operations[i], std::move(operands[i])));
  for (const analysis::OutputRange& range : found.outputs)
    proofs.outputs.push_back({module.outputs[range.output].name, reachedOf(range.reached)});
  return proofs;
}

std::optional<std::vector<NodeProof>> proveNodes(const Options& options, Messages& messages,
                                                 Precision precision) {
  const auto library = libraryFor(options);
  if (!library) return report(library.error(), {}, messages), std::nullopt;
  const Diagnostics found = (*library)->check();
  report(found, {}, messages);
  if (hasError(found)) return std::nullopt;
  return proveNodes(**library, arithmeticOf(precision));
}

}  // namespace lacquer
