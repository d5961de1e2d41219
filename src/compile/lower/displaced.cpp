#include "lower/displaced.h"

#include <fmt/format.h>

#include <algorithm>

#include "lower/at_vertices.h"

namespace lacquer::lower {

std::string unknownAtVertices(const lang::Expr& displacement, const lang::TemplateDecl& template_decl,
                              const graph::Graph& graph, const std::vector<ir::ValueId>& slots,
                              ir::Dag& dag) {
  for (const lang::PortDecl& port : template_decl.ports) {
    if (displacement.kind != lang::Expr::Kind::Slot || port.slot != displacement.slot) continue;
    const auto it = std::find_if(graph.outputs.begin(), graph.outputs.end(),
                                 [&](const auto& output) { return output.first == port.param.name; });
    AtVertices at_vertices(dag, true);
    if (it == graph.outputs.end() || at_vertices(slots[port.slot])) return {};
    const auto* node = std::get_if<graph::NodeRef>(&it->second.from);
    const auto* given = std::get_if<graph::GivenRef>(&it->second.from);
    const std::string taken = node != nullptr    ? fmt::format("the node '{}'", node->node)
                              : given != nullptr ? fmt::format("'{}' of the template", given->name)
                                                 : "what they have not";
    return fmt::format(": the output /outputs/{} takes {}", it->first, taken);
  }
  for (const lang::ExprPtr& arg : displacement.args) {
    if (!arg) continue;
    std::string found = unknownAtVertices(*arg, template_decl, graph, slots, dag);
    if (!found.empty()) return found;
  }
  return {};
}

}  // namespace lacquer::lower
