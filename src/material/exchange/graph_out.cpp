#include "exchange/graph_out.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "exchange/pattern_out.h"
#include "gltf/facts.h"
#include "graph/contracts.h"
#include "materialx/materialx.h"
#include "support/relative.h"
#include "support/text.h"

namespace lacquer::exchange {

bool isOfMaterialX(const graph::Contract* contract) {
  return contract != nullptr && contract->decl != nullptr &&
         contract->decl->source.starts_with("MaterialX") && !contract->decl->category.empty();
}

namespace {

using graph::Source;
using materialx::Element;

class GraphOut {
public:
  /// `flat` is what `of` is without its groups.
  GraphOut(const graph::Graph& of, const graph::Graph& flat, const lang::Library& library,
           const std::string& path, Written& written)
      : flat_(flat), library_(library), path_(path), written_(written), contracts_(flat, library) {
    for (size_t i = 0; i < of.nodes.size(); ++i) places_.emplace(of.nodes[i].id, i);
  }

  void write(const std::string& folder) {
    sort();
    graph::Group group;
    group.name = materialx::graphName(flat_.name.empty() ? "graph" : flat_.name);
    for (const size_t place : contracts_.main().order().order) {
      if (said_[place]) group.nodes.push_back(flat_.nodes[place]);
    }
    outputs(group);
    if (group.outputs.empty()) {
      written_.said.clear();
      written_.said.push_back({"nothing-said",
                               Severity::Error,
                               {path_, 0, 0, {}},
                               "the graph has no node of MaterialX's",
                               "those of docs/standard-nodes.md are",
                               {}});
      return;
    }
    document(std::move(group), folder);
  }

private:
  /// A node within a group has no place of its own among the graph's.
  void notSaid(size_t place, std::string message) {
    const auto own = places_.find(flat_.nodes[place].id);
    addBounded(written_.said,
               {"not-said",
                Severity::Warning,
                {path_, 0, 0, own == places_.end() ? "" : fmt::format("/nodes/{}", own->second)},
                std::move(message),
                {},
                {}});
  }

  /// Which nodes can be said: MaterialX's, of whose sources all can.
  void sort() {
    said_.assign(flat_.nodes.size(), false);
    for (const size_t place : contracts_.main().order().order) {
      const graph::Node& node = flat_.nodes[place];
      if (!isOfMaterialX(contracts_.of(node))) {
        notSaid(place, fmt::format("the node {}, {}, is none of MaterialX's", quote(node.id), node.type));
        continue;
      }
      said_[place] = true;
      for (size_t i = 0; i < node.inputs.size() && said_[place]; ++i) {
        const std::optional<size_t> from = contracts_.main().source(place, i);
        if (!from || said_[*from]) continue;
        said_[place] = false;
        notSaid(place, fmt::format("the node {} takes a value from {}, which is not said", quote(node.id),
                                   quote(flat_.nodes[*from].id)));
      }
    }
  }

  const graph::NodeRef* saidOf(const Source& source) const {
    const auto* ref = std::get_if<graph::NodeRef>(&source.from);
    const std::optional<size_t> place = ref == nullptr ? std::nullopt : contracts_.main().find(ref->node);
    return place && said_[*place] ? ref : nullptr;
  }

  /// Outputs for values that ports take, by the ports' names, and for those that other nodes take, by the
  /// names of the nodes that give them.
  void outputs(graph::Group& group) {
    materialx::NameSet names;
    std::vector<Source> known;
    const auto add = [&](std::string_view name, const Source& source) {
      if (std::find(known.begin(), known.end(), source) != known.end()) return;
      known.push_back(source);
      group.outputs.emplace_back(names.free(materialx::graphName(name)), source);
    };
    for (const auto& [port, source] : flat_.outputs) {
      if (saidOf(source) != nullptr) add(port, source);
    }
    for (size_t i = 0; i < flat_.nodes.size(); ++i) {
      for (const auto& [input, source] : flat_.nodes[i].inputs) {
        const graph::NodeRef* ref = said_[i] ? nullptr : saidOf(source);
        if (ref != nullptr)
          add((ref->output.empty() ? ref->node : ref->node + "." + ref->output) + "_out", source);
      }
    }
  }

  /// A direction is a vector there, and other values of three components are colours.
  static bool isVector(std::string_view name) {
    return name.find("normal") != name.npos || name.find("tangent") != name.npos ||
           name.find("position") != name.npos;
  }

  void document(graph::Group group, const std::string& folder) {
    constexpr std::string_view kBody = "_body";
    graph::Graph graph = flat_;
    graph.nodes.clear();
    graph.outputs.clear();
    graph::Group body;
    body.name = kBody;
    graph::Node& instance = body.nodes.emplace_back();
    instance.id = "all";
    instance.type = group.name;
    instance.group = true;
    std::vector<SurfaceOut> surfaces(1);
    for (const auto& [name, source] : group.outputs) {
      const std::optional<graph::Offer> offer = contracts_.offer(source, contracts_.main());
      const ir::Type type = offer ? offer->type : ir::Type::Float;
      const Source taken{graph::NodeRef{"all", name}, {}};
      const bool color = type == ir::Type::Vec3 && !isVector(name);
      body.outputs.emplace_back(name, taken);
      surfaces[0].inputs.push_back({name, color ? "color3" : materialx::nameOf(type), {}, taken});
    }
    graph.groups = {group, body};
    gltf::Scene scene;
    scene.path = path_;
    const std::string from = folderOf(path_);
    const Moved moved(from, folder.empty() ? from : folder);
    PatternsOut patterns(graph, library_, scene, surfaces, moved, written_.said);
    Element root;
    root.category = "materialx";
    root.attributes = {{"version", "1.39"}, {"colorspace", "lin_rec709"}};
    patterns.write(root);
    written_.text = materialx::toXml(root);
  }

  const graph::Graph& flat_;
  const lang::Library& library_;
  const std::string& path_;
  Written& written_;
  const graph::Contracts contracts_;
  std::vector<bool> said_;
  std::map<std::string_view, size_t> places_;  ///< in the graph, by id
};

/// The matrix that a node of a flat graph makes of numbers alone; nothing of another node.
std::optional<graph::Literal> matrixBy(const graph::Node& node) {
  constexpr std::pair<std::string_view, ir::Type> kForms[] = {{"creatematrix<mat3>", ir::Type::Mat3},
                                                              {"creatematrix<vec4, mat4>", ir::Type::Mat4}};
  const auto form = std::find_if(std::begin(kForms), std::end(kForms),
                                 [&](const auto& one) { return one.first == node.type; });
  if (form == std::end(kForms)) return std::nullopt;
  graph::Literal matrix{form->second, {}};
  const int side = ir::componentCount(ir::partType(matrix.type));
  for (int column = 1; column <= side; ++column) {
    const auto input = std::find_if(node.inputs.begin(), node.inputs.end(), [&](const auto& one) {
      return one.first == fmt::format("in{}", column);
    });
    const auto* numbers =
        input == node.inputs.end() ? nullptr : std::get_if<graph::Literal>(&input->second.from);
    if (numbers == nullptr || !input->second.swizzle.empty() || numbers->type != ir::partType(matrix.type))
      return std::nullopt;
    for (int i = 0; i < side; ++i) matrix.matrix.push_back(numbers->number(i));
  }
  return matrix;
}

/// A document has matrices of numbers as values: nodes that make them are not needed.
void writeMatrices(graph::Graph& flat) {
  std::map<std::string, graph::Literal, std::less<>> made;
  for (const graph::Node& node : flat.nodes) {
    if (auto matrix = matrixBy(node)) made.emplace(node.id, std::move(*matrix));
  }
  std::erase_if(flat.nodes, [&](const graph::Node& node) { return made.contains(node.id); });
  graph::eachSource(flat, [&](graph::Source& source) {
    const auto* ref = std::get_if<graph::NodeRef>(&source.from);
    const auto found = ref == nullptr ? made.end() : made.find(ref->node);
    if (found != made.end()) source.from = found->second;
  });
}

}  // namespace

Written graphToMaterialX(const graph::Graph& graph, const lang::Library& library, const std::string& path,
                         const std::string& folder) {
  Written written;
  graph::Graph flat = graph::flattened(graph, library);
  writeMatrices(flat);
  GraphOut(graph, flat, library, path, written).write(folder);
  return written;
}

}  // namespace lacquer::exchange
