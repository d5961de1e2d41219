// Proofs about the node library: that a node keeps its contract for everything its contract lets in.
#pragma once

#include <string>
#include <vector>

#include "analysis/prove.h"
#include "lacquer/results.h"
#include "lang/library.h"
#include "lower/inline.h"

namespace lacquer {

/// How many outputs a result of that type is: one, of a matrix one for each column.
uint32_t outputCount(ir::Type type);

/// A node by itself: its parameters are inputs in their declared ranges, its results are outputs, in order; a
/// matrix is its columns, `name[0]` and so on.
struct NodeModule {
  ir::Module module;
  struct Call {
    const lang::NodeDecl* node;
    std::vector<ir::ValueId> arguments;
  };
  std::vector<Call> calls;
};
/// `rate`: of all parameters; by it `uniform(x)` in a body chooses.
NodeModule nodeModule(const lang::NodeDecl& node, std::string_view variant,
                      ir::Rate rate = ir::Rate::Fragment);

/// The ranges of the arguments of a call against the callee's contract. Appends a claim for each bounded
/// parameter.
void proveCall(const ir::Module& module, const NodeModule::Call& call, int budget,
               std::vector<Claim>& claims);

NodeProof proveNode(const lang::NodeDecl& node, std::string_view variant,
                    analysis::Arithmetic arithmetic = analysis::Arithmetic::Vulkan);

/// Every variant of every node, by name. The library must check.
std::vector<NodeProof> proveNodes(const lang::Library& library,
                                  analysis::Arithmetic arithmetic = analysis::Arithmetic::Vulkan);

/// "in [0, 1]"
std::string rangeText(const ir::Interval& range);

}  // namespace lacquer
