// Groups' nodes in their places. Sources come before what takes from them, so that nothing here goes deeper
// than groups lie within groups.
#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>

#include "graph/check_body.h"
#include "graph/contracts.h"
#include "graph/graph.h"
#include "graph/matrices.h"
#include "graph/text.h"
#include "lang/suggest.h"
#include "support/text.h"

namespace lacquer::graph {

std::string swizzleBehind(const std::string& first, const std::string& second) {
  if (first.empty() || second.empty()) return first.empty() ? second : first;
  std::string all;
  for (const char component : swizzleComponents(second)) all += first[static_cast<size_t>(component)];
  return all;
}

Source widened(Source source, ir::Type type) {
  source.swizzle = swizzleBehind(source.swizzle.empty() ? "x" : source.swizzle,
                                 std::string(static_cast<size_t>(ir::componentCount(type)), 'x'));
  return source;
}

namespace {

class Flattening {
public:
  Flattening(const Graph& graph, const lang::Library& library, FlatOutputs* told)
      : graph_(graph), contracts_(graph, library), told_(told) {
    for (const Node& node : graph.nodes) taken_.insert(node.id);
  }

  void run(std::vector<Node>& nodes, Outputs& outputs) {
    Scope scope{contracts_.main(), {}, {}, {}, {}};
    nodes_ = &nodes;
    expand(scope);
    for (const auto& [port, source] : graph_.outputs) outputs.emplace_back(port, flat(source, scope));
  }

private:
  /// Nodes that see each other: the graph's own, or those of an instance.
  struct Scope {
    const Body& body;
    std::string path;              ///< of an instance: "rust/inner"
    std::vector<Source> inputs;    ///< of an instance, in the order of its group's
    std::vector<std::string> ids;  ///< by node, of those that are none: in the flat graph
    std::vector<Outputs> outputs;  ///< by node, of those that are instances
  };

  void expand(Scope& scope) {
    const std::vector<Node>& nodes = scope.body.nodes();
    scope.ids.resize(nodes.size());
    scope.outputs.resize(nodes.size());
    for (const size_t place : scope.body.order().order) {
      const Node& node = nodes[place];
      const std::string path = scope.path.empty() ? node.id : scope.path + "/" + node.id;
      if (node.group) {
        scope.outputs[place] = instance(node, path, scope);
        if (told_ != nullptr) told_->emplace(path, scope.outputs[place]);
        continue;
      }
      scope.ids[place] = scope.path.empty() ? node.id : freeId(path);
      Node& made = nodes_->emplace_back(node);
      if (const Contract* contract = contracts_.of(node)) made.type = contract->decl->name;
      made.id = scope.ids[place];
      for (auto& [name, source] : made.inputs) source = flat(source, scope);
      if (told_ != nullptr) tell(path, made);
    }
  }

  void tell(const std::string& path, const Node& node) {
    Outputs& outputs = (*told_)[path];
    for (const lang::Param& result : contracts_.of(node)->results) {
      const std::string name(result.name);
      outputs.emplace_back(name, Source{NodeRef{node.id, name}, {}});
    }
  }

  std::string freeId(std::string path) {
    std::replace(path.begin(), path.end(), '/', '.');
    std::string id = path;
    for (size_t i = 2; !taken_.insert(id).second; ++i) id = path + "_" + std::to_string(i);
    return id;
  }

  Outputs instance(const Node& node, const std::string& path, const Scope& scope) {
    const size_t group = *graph_.findGroup(node.type);
    Scope inner{contracts_.body(group), path, {}, {}, {}};
    for (const GroupInput& input : graph_.groups[group].inputs) {
      const auto it = std::find_if(node.inputs.begin(), node.inputs.end(),
                                   [&](const auto& given) { return given.first == input.name; });
      const Source& source = it == node.inputs.end() ? *input.by_default : it->second;
      inner.inputs.push_back(wide(source, scope, input.type));
    }
    expand(inner);
    Outputs outputs;
    for (const auto& [name, source] : inner.body.outputs()) outputs.emplace_back(name, flat(source, inner));
    return outputs;
  }

  /// The source among the flat nodes.
  Source flat(const Source& source, const Scope& scope) const {
    const Source* found = nullptr;
    if (const auto* input = std::get_if<InputRef>(&source.from)) {
      const auto& inputs = scope.body.group()->inputs;
      const auto it = std::find_if(inputs.begin(), inputs.end(),
                                   [&](const GroupInput& one) { return one.name == input->name; });
      found = &scope.inputs[static_cast<size_t>(it - inputs.begin())];
    } else if (const auto* ref = std::get_if<NodeRef>(&source.from)) {
      const size_t place = *scope.body.find(ref->node);
      const Node& node = scope.body.nodes()[place];
      if (!node.group) return {NodeRef{scope.ids[place], ref->output}, source.swizzle};
      found = &scope.outputs[place][*contracts_.of(node)->result(ref->output)].second;
    }
    return found == nullptr ? source : Source{found->from, swizzleBehind(found->swizzle, source.swizzle)};
  }

  /// A float stands for every component where the group has a vector.
  Source wide(const Source& source, const Scope& scope, ir::Type wanted) const {
    Source made = flat(source, scope);
    const std::optional<Offer> offer = contracts_.offer(source, scope.body);
    if (!ir::isFloatVector(wanted) || !offer || offer->type != ir::Type::Float) return made;
    return widened(std::move(made), wanted);
  }

  const Graph& graph_;
  Contracts contracts_;
  FlatOutputs* told_;
  std::vector<Node>* nodes_ = nullptr;
  std::unordered_set<std::string> taken_;
};

}  // namespace

Graph flattened(Graph graph, const lang::Library& library, FlatOutputs* told) {
  const auto plain = [&](const Node& node) { return library.has(lang::DeclKind::Node, node.type); };
  if (!graph.groups.empty() || told != nullptr ||
      !std::all_of(graph.nodes.begin(), graph.nodes.end(), plain)) {
    std::vector<Node> nodes;
    Outputs outputs;
    Flattening(graph, library, told).run(nodes, outputs);
    graph.nodes = std::move(nodes);
    graph.outputs = std::move(outputs);
    graph.groups.clear();
  }
  if (hasMatrices(graph)) takeColumns(graph, library, told);
  return graph;
}

/// Whether a node is named by the end of its name: of a document's node by its path there, "NG/rm".
static bool endsLike(std::string name, std::string end) {
  std::replace(name.begin(), name.end(), '/', '.');
  std::replace(end.begin(), end.end(), '/', '.');
  return name.ends_with("." + end);
}

Result<Source> outputAt(const FlatOutputs& outputs, const std::string& path) {
  const auto exact = outputs.find(path);
  if (exact != outputs.end() && exact->second.size() == 1) return exact->second[0].second;
  std::vector<std::string_view> names;
  const auto listed = [&](const Outputs& of) {
    for (const auto& [name, source] : of) names.push_back(name);
    return names.empty() ? std::string("it has none") : "it has " + listOf(names);
  };
  if (exact != outputs.end())
    return fail("unknown-output", {},
                fmt::format("the node {} has {} outputs", inQuotes(path), exact->second.size()),
                listed(exact->second) + "; one is named behind a dot");
  const size_t dot = path.rfind('.');
  const auto node = dot == std::string::npos ? outputs.end() : outputs.find(path.substr(0, dot));
  if (node != outputs.end()) {
    const std::string wanted = path.substr(dot + 1);
    for (const auto& [name, source] : node->second) {
      if (name == wanted) return source;
    }
    return fail("unknown-output", {},
                fmt::format("the node {} has no output {}", inQuotes(node->first), inQuotes(wanted)),
                listed(node->second));
  }
  const size_t last = path.find_last_of("./");
  for (const bool whole : {true, false}) {
    if (!whole && last == std::string::npos) break;
    for (const auto& [name, of] : outputs) {
      if (endsLike(name, whole ? path : path.substr(0, last))) names.push_back(name);
    }
    if (names.size() > 1)
      return fail("no-such-node", {}, fmt::format("{} may be any of {} nodes", inQuotes(path), names.size()),
                  "name one: " + shortList(names));
    if (names.size() == 1)
      return outputAt(outputs, std::string(names[0]) + (whole ? "" : "." + path.substr(last + 1)));
  }
  for (const auto& [name, of] : outputs) names.push_back(name);
  return fail("no-such-node", {}, fmt::format("there is no node {}", inQuotes(path)),
              lang::didYouMean(path, names, names.empty() ? std::string() : "there are " + shortList(names)));
}

}  // namespace lacquer::graph
