#include "cli/prove.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "answer/answer.h"
#include "cli/graphs.h"
#include "cli/streams.h"
#include "cli/table.h"
#include "support/text.h"

namespace lacquer::cli {

namespace {

std::string rangeText(const Reached& reached) {
  const auto end = [](double x) {
    return std::isfinite(x) ? fmt::format("{:.7g}", x) : x < 0 ? "-inf" : "inf";
  };
  return fmt::format("[{}, {}]{}", end(reached.low), end(reached.high), reached.nan ? " or no number" : "");
}

void printClaims(const std::vector<Claim>& claims, const std::string& where) {
  for (const Claim& claim : claims) {
    if (claim.proved) continue;
    fmt::print("  {}{}: must be {}, may be {}\n", where, printable(claim.what), printable(claim.need),
               rangeText(claim.reached));
  }
}

size_t proved(const std::vector<Claim>& claims) {
  return static_cast<size_t>(
      std::count_if(claims.begin(), claims.end(), [](const Claim& claim) { return claim.proved; }));
}

void printShader(const Proofs& proofs) {
  const auto safe = std::count_if(proofs.operations.begin(), proofs.operations.end(),
                                  [](const OperationProof& proof) { return proof.safe; });
  fmt::print("{} ({}): {} of {} operations safe, {} of {} arguments within their nodes' contracts\n",
             printable(proofs.material), printable(proofs.shader), safe, proofs.operations.size(),
             proved(proofs.contracts), proofs.contracts.size());
  for (const OperationProof& proof : proofs.operations) {
    if (proof.safe) continue;
    fmt::print("  {}{}: {} of {}: must be {}, may be {}\n", printable(proof.term),
               proof.name.empty() ? "" : "." + printable(proof.name), proof.operation,
               printable(proof.operand), proof.need, rangeText(proof.reached));
  }
  printClaims(proofs.contracts, "argument ");
  for (const OutputProof& output : proofs.outputs)
    fmt::print("  output {} is in {}\n", printable(output.name), rangeText(output.reached));
}

bool proveNodes(const ProveFlags& flags, const Options& options, Messages& messages) {
  const auto nodes = lacquer::proveNodes(options, messages, flags.precision);
  if (!nodes) return false;
  size_t good = 0;
  size_t all = 0;
  for (const NodeProof& node : *nodes) {
    const std::string variant = node.variant.empty() ? "" : "." + printable(node.variant);
    for (const auto* claims : {&node.operations, &node.results, &node.calls}) {
      good += proved(*claims);
      all += claims->size();
      if (!flags.json) printClaims(*claims, printable(node.node) + variant + ", ");
    }
  }
  if (flags.json)
    fmt::print("{}\n", answerJson(*nodes));
  else
    fmt::print("{}: {} of {} proved\n", countOf(nodes->size(), "node"), good, countOf(all, "claim"));
  return good == all;
}

bool proveGraph(Graph graph, const ProveFlags& flags, const Options& options, Messages& messages) {
  const std::optional<Proofs> proofs = graph ? graph.prove(options, messages, flags.precision) : std::nullopt;
  if (!proofs) return false;
  if (flags.json)
    fmt::print("{}\n", answerJson(*proofs));
  else
    printShader(*proofs);
  return true;
}

}  // namespace

bool prove(const std::vector<std::string>& files, const std::vector<std::string>& materials,
           const ProveFlags& flags, const Options& options, Messages& messages) {
  if (files.empty()) return proveNodes(flags, options, messages);
  size_t found = 0;
  const auto each = [&](Graph graph) { return proveGraph(std::move(graph), flags, options, messages); };
  const bool good = eachGraph(files, materials, options, messages, each, found);
  if (found == 0 && good)
    say("{}: error: no material of that name [no-such-material]\n", printable(files[0]));
  return good && found > 0;
}

}  // namespace lacquer::cli
