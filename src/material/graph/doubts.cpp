// What check() takes on trust: that what is connected stays in the range of what it goes to.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "graph/check_body.h"
#include "graph/contracts.h"
#include "graph/text.h"
#include "support/text.h"

namespace lacquer::graph {

namespace {

class Doubts {
public:
  Doubts(const Graph& graph, const lang::Library& library, bool undeclared)
      : graph_(graph), contracts_(graph, library), undeclared_(undeclared) {}

  Diagnostics run() {
    for (size_t i = 0; i < graph_.groups.size(); ++i) {
      group(i);
      nodes(contracts_.body(i));
    }
    nodes(contracts_.main());
    const lang::TemplateDecl* decl = contracts_.templateDecl();
    for (const auto& [name, source] : graph_.outputs) {
      if (decl == nullptr) break;
      const std::string_view output = name;
      const auto port = std::find_if(decl->ports.begin(), decl->ports.end(),
                                     [&](const lang::PortDecl& p) { return p.param.name == output; });
      if (port == decl->ports.end()) continue;
      look(
          source, contracts_.main(), &port->param, [&] { return pointerTo("outputs", output); },
          [&] { return fmt::format("the port {}", inQuotes(output)); });
    }
    shorten(found_);
    return std::move(found_);
  }

private:
  void nodes(const Body& body) {
    const std::string above = body.group() == nullptr ? "" : pointerTo("groups", body.group()->name);
    const std::string where =
        body.group() == nullptr ? "" : fmt::format(" in the group {}", inQuotes(body.group()->name));
    for (size_t i = 0; i < body.nodes().size(); ++i) {
      const Node& node = body.nodes()[i];
      const Contract* contract = contracts_.of(body.nodes()[i]);
      if (contract == nullptr) continue;
      for (const auto& [name, source] : node.inputs) {
        // What comes from outside of a group is looked at there.
        if (std::holds_alternative<InputRef>(source.from)) continue;
        const std::string_view input = name;
        look(
            source, body, contract->param(input),
            [&, index = i] { return fmt::format("{}/nodes/{}{}", above, index, pointerTo("inputs", input)); },
            [&] { return fmt::format("{} of the node {}{}", inQuotes(input), inQuotes(node.id), where); });
      }
    }
  }

  /// An input that says that it takes more than what it goes to.
  void group(size_t place) {
    const Group& group = graph_.groups[place];
    const Contract* contract = contracts_.of(group.name, true);
    for (size_t i = 0; contract != nullptr && i < group.inputs.size(); ++i) {
      const GroupInput& input = group.inputs[i];
      if (input.range == ir::Range{}) continue;
      const Offer offer{input.type, true, input.range};
      doubt(
          offer, &contract->params[i],
          [&] { return pointerTo("groups", group.name) + pointerTo("inputs", input.name) + "/range"; },
          [&] {
            return fmt::format("what {} of the group {} goes to", inQuotes(input.name), inQuotes(group.name));
          },
          "give the input a range within it");
    }
  }

  template <class Place, class What>
  void look(const Source& source, const Body& body, const lang::Param* into, Place place, What what) {
    // A literal is check()'s to look at.
    if (into == nullptr || std::holds_alternative<Literal>(source.from)) return;
    const std::optional<Offer> offer = contracts_.base(source, body);
    if (!offer || !ir::isFloating(offer->type)) return;
    doubt(*offer, into, place, what,
          std::holds_alternative<ParameterRef>(source.from) ? "give the parameter a \"range\" within it"
                                                            : "put a node with a clamp between");
  }

  template <class Place, class What>
  void doubt(const Offer& given, const lang::Param* into, Place place, What what, std::string_view help) {
    if (!into->has_range || !ir::isFloating(into->type)) return;
    if ((!given.has_range && !undeclared_) || !hasRoom(found_)) return;
    const ir::Range& to = into->range;
    const bool gap = to.gap > given.range.gap && given.range.lo < to.gap;
    if (given.has_range && given.range.lo >= to.lo && given.range.hi <= to.hi && !gap) return;
    found_.push_back({"may-leave-range",
                      Severity::Warning,
                      {{}, 0, 0, place()},
                      fmt::format("{} takes {}, its source may be {}", what(), ir::rangeText(to),
                                  given.has_range ? ir::rangeText(given.range) : "anything"),
                      fmt::format("outside of it colours may be negative or infinite; {}", help),
                      {}});
  }

  const Graph& graph_;
  Contracts contracts_;
  bool undeclared_ = false;
  Diagnostics found_;
};

}  // namespace

Diagnostics doubts(const Graph& graph, const lang::Library& library, bool undeclared) {
  return Doubts(graph, library, undeclared).run();
}

}  // namespace lacquer::graph
