// The typed node graph between a material and the DAG: nodes of the library, wired. This is what an authoring
// tool edits: add nodes, connect, set values, check, print.
#pragma once

#include <concepts>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "ir/module.h"
#include "lang/library.h"
#include "support/diagnostic.h"
#include "support/limits.h"

namespace lacquer::graph {

/// A value written into the graph: a Float, a vector, a Bool.
struct Literal {
  ir::Type type = ir::Type::Float;
  ir::Components value{};
  bool operator==(const Literal&) const = default;
};

/// An editable number of the material: Graph::parameters by name.
struct ParameterRef {
  std::string name;
  bool operator==(const ParameterRef&) const = default;
};

/// A texture with its sampler: Graph::textures by name, or one of the template's environment textures.
struct TextureRef {
  std::string name;
  bool operator==(const TextureRef&) const = default;
};

/// What the template gives: "view", "uv0", "light.direction".
struct GivenRef {
  std::string name;
  bool operator==(const GivenRef&) const = default;
};

/// An output of another node. `output` is empty for a node with a single result.
struct NodeRef {
  std::string node;
  std::string output;
  bool operator==(const NodeRef&) const = default;
};

/// Where an input or a port gets its value from, with an optional swizzle ("rgb", "g") on the way.
struct Source {
  std::variant<Literal, ParameterRef, TextureRef, GivenRef, NodeRef> from;
  std::string swizzle;
  bool operator==(const Source&) const = default;
};

using Inputs = std::vector<std::pair<std::string, Source>>;

/// A use of a library node: one term.
struct Node {
  std::string id;       ///< unique in the graph, dotted: "coat.absorption"
  std::string type;     ///< the library node's name: "coat_absorption"
  std::string variant;  ///< empty for the reference body
  Inputs inputs;        ///< by parameter name; inputs with defaults may be absent
  bool operator==(const Node&) const = default;
};

/// Why a term that the material could have is not in the graph.
struct Skipped {
  std::string term;    ///< "coat.darkening"
  std::string reason;  ///< "coatDarkeningFactor is 0"
  bool operator==(const Skipped&) const = default;
};

struct Graph {
  std::string name;           ///< the material's name
  std::string template_name;  ///< "forward"
  /// Of the template's optional attributes, those that the primitive has.
  std::vector<std::string> attributes;
  std::vector<ir::Parameter> parameters;
  std::vector<ir::TextureSlot> textures;
  std::vector<Node> nodes;  ///< in an order in which a node's sources stand before it
  std::vector<std::pair<std::string, Source>> outputs;  ///< the template's ports
  std::vector<Skipped> skipped;

  // Editing. Names and ids are checked by check(), not here. Nodes and parameters are spoken of by their
  // places in the lists above, which hold until one is removed or check() sorts the nodes.

  /// Adds a node and returns its place.
  size_t add(std::string id, std::string type);
  /// Not for a list in braces: std::vector would copy what is in it.
  template <std::same_as<Inputs> T>
  size_t add(std::string id, std::string type, T inputs) {
    const size_t node = add(std::move(id), std::move(type));
    nodes[node].inputs = std::move(inputs);
    return node;
  }
  template <size_t N>
  size_t add(std::string id, std::string type, std::pair<std::string, Source> (&&inputs)[N]) {
    return add(std::move(id), std::move(type),
               Inputs(std::make_move_iterator(inputs), std::make_move_iterator(inputs + N)));
  }
  /// Connects (or reconnects) an input of the node at a place.
  void connect(size_t node, std::string_view input, Source source);
  std::optional<size_t> find(std::string_view id) const;
  std::optional<size_t> findParameter(std::string_view wanted) const;
  /// Removes a node; its users keep dangling edges, which check() reports.
  bool remove(std::string_view id);
  /// Says why a term is not there. A term that several parts have is named once, with the first reason.
  void skip(std::string_view term, std::string reason);
};

/// Everything lowering relies on: node types and variants exist, ids are unique, inputs exist, are connected
/// once and have the right type, references resolve, swizzles fit, literals lie in the contract's range, no
/// cycles, the template's ports without default are delivered with the right type. Puts nodes into a valid
/// order when they are not (stable). `place.pointer` of each diagnostic is a JSON pointer into the graph's
/// JSON form.
Diagnostics check(Graph& graph, const lang::Library& library);

/// Warnings ("may-leave-range") of what check() takes on trust: what is connected and may come to lie outside
/// of the range of what it goes to, by the range of a parameter or what a node or the template is declared to
/// give; with `undeclared` also of what is declared to give no range at all. Where there is neither, a
/// checked graph's colours are finite and not negative. What is wrong in another way is left to check(),
/// which may order the nodes: places are those before it.
Diagnostics doubts(const Graph& graph, const lang::Library& library, bool undeclared = false);

/// The JSON form (docs/graph-format.md), two spaces of indent, stable key order, a final newline.
std::string toJson(const Graph& graph);

/// Reads the JSON form; `name` stands for the file in diagnostics. Does not check() it.
Result<Graph> fromJson(std::string_view text, const std::string& name, const Limits& limits = {});

/// One source in its JSON form, as an edit of a graph is given.
Result<Source> sourceFromJson(std::string_view text);

/// GraphViz: one box per node with its inputs, parameters and textures as leaves.
std::string toDot(const Graph& graph);

}  // namespace lacquer::graph
