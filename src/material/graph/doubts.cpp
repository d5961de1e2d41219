// What check() takes on trust: that what is connected stays in the range of what it goes to.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "graph/graph.h"
#include "graph/text.h"
#include "json/path.h"
#include "support/arena.h"
#include "support/text.h"

namespace lacquer::graph {

namespace {

using json::Path;

const lang::Param* named(const std::vector<lang::Param>& params, std::string_view name) {
  const auto it =
      std::find_if(params.begin(), params.end(), [&](const lang::Param& p) { return p.name == name; });
  return it == params.end() ? nullptr : &*it;
}

class Doubts {
public:
  Doubts(const Graph& graph, const lang::Library& library, bool undeclared)
      : graph_(graph), library_(library), undeclared_(undeclared) {
    // A name that stands twice is check()'s to tell.
    for (const ir::Parameter& parameter : graph.parameters) parameters_.emplace(parameter.name, &parameter);
    for (const Node& node : graph.nodes) nodes_.emplace(node.id, &node);
    if (!library.has(lang::DeclKind::Template, graph.template_name)) return;
    if (const auto found = library.template_(graph.template_name)) template_ = *found;
  }

  Diagnostics run() {
    for (size_t i = 0; i < graph_.nodes.size(); ++i) {
      const Node& node = graph_.nodes[i];
      const lang::NodeDecl* decl = declOf(node);
      if (decl == nullptr) continue;
      for (const auto& [name, source] : node.inputs) {
        const auto place = [&, index = i, input = std::string_view(name)] {
          return pointerTo({"nodes", std::to_string(index), "inputs", input});
        };
        look(source, named(decl->params, name), place, [&, input = std::string_view(name)] {
          return fmt::format("'{}' of the node '{}'", printable(input), printable(node.id));
        });
      }
    }
    for (const auto& [name, source] : graph_.outputs) {
      if (template_ == nullptr) break;
      const std::string_view output = name;
      const auto port = std::find_if(template_->ports.begin(), template_->ports.end(),
                                     [&](const lang::PortDecl& p) { return p.param.name == output; });
      if (port == template_->ports.end()) continue;
      look(
          source, &port->param,
          [&] {
            return pointerTo({"outputs", output});
          },
          [&] { return fmt::format("the port '{}'", printable(output)); });
    }
    shorten(found_);
    return std::move(found_);
  }

private:
  /// What a source may be: what a parameter may become, what a given or a node is declared to give.
  struct Given {
    bool known = false;  ///< to this library; not a literal or a texture, which check() looks at
    bool has_range = false;
    ir::Range range;
  };

  static std::string pointerTo(std::initializer_list<std::string_view> members) {
    std::string text;
    const Path root;
    for (const std::string_view member : members) text += Path(root, member).text();
    return text;
  }

  const lang::NodeDecl* declOf(const Node& node) const {
    if (!library_.has(lang::DeclKind::Node, node.type)) return nullptr;
    const auto found = library_.node(node.type);
    return found ? *found : nullptr;
  }

  Given givenBy(const Source& source) const {
    const lang::Param* declared = nullptr;
    if (const auto* parameter = std::get_if<ParameterRef>(&source.from)) {
      const auto it = parameters_.find(parameter->name);
      return it == parameters_.end() ? Given{} : Given{true, true, it->second->range};
    }
    if (const auto* given = std::get_if<GivenRef>(&source.from)) {
      const auto found = template_ == nullptr ? std::nullopt : template_->find(given->name);
      if (found) declared = &found->given->results[found->index];
    } else if (const auto* node = std::get_if<NodeRef>(&source.from)) {
      const auto it = nodes_.find(node->node);
      const lang::NodeDecl* decl = it == nodes_.end() ? nullptr : declOf(*it->second);
      if (decl != nullptr) declared = named(decl->results, node->output);
    }
    if (declared == nullptr) return {};
    return {true, declared->has_range, declared->range};
  }

  template <class Place, class What>
  void look(const Source& source, const lang::Param* into, Place place, What what) {
    if (into == nullptr || !into->has_range || !ir::isFloating(into->type)) return;
    const Given given = givenBy(source);
    if (!given.known || (!given.has_range && !undeclared_) || !hasRoom(found_)) return;
    const ir::Range& to = into->range;
    const bool gap = to.gap > given.range.gap && given.range.lo < to.gap;
    if (given.has_range && given.range.lo >= to.lo && given.range.hi <= to.hi && !gap) return;
    found_.push_back(
        {"may-leave-range",
         Severity::Warning,
         {{}, 0, 0, place()},
         fmt::format("{} takes {}, its source may be {}", what(), ir::rangeText(to),
                     given.has_range ? ir::rangeText(given.range) : "anything"),
         std::holds_alternative<ParameterRef>(source.from)
             ? "outside of it colours may be negative or infinite; give the parameter a \"range\" within it"
             : "outside of it colours may be negative or infinite; put a node with a clamp between",
         {}});
  }

  const Graph& graph_;
  const lang::Library& library_;
  bool undeclared_ = false;
  const lang::TemplateDecl* template_ = nullptr;
  Arena arena_;
  NameMap<const ir::Parameter*> parameters_{&arena_};
  NameMap<const Node*> nodes_{&arena_};
  Diagnostics found_;
};

}  // namespace

Diagnostics doubts(const Graph& graph, const lang::Library& library, bool undeclared) {
  return Doubts(graph, library, undeclared).run();
}

}  // namespace lacquer::graph
