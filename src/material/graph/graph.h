// The typed node graph between a material and the DAG: nodes of the library, wired. This is what an authoring
// tool edits: add nodes, connect, set values, check, print.
#pragma once

#include <array>
#include <concepts>
#include <iterator>
#include <map>
#include <optional>
#include <span>
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

/// A value written into the graph: a Float, a vector, a Bool, a matrix.
struct Literal {
  ir::Type type = ir::Type::Float;
  ir::Components value{};
  /// Of a matrix its numbers, column by column; `value` says nothing then.
  std::vector<double> matrix{};

  double number(int component) const {
    const auto i = static_cast<size_t>(component);
    return !ir::isMatrix(type) ? value[i] : i < matrix.size() ? matrix[i] : 0;
  }
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

/// An attribute of the vertices, whatever the template knows of: the application's own, "_WETNESS", or a set
/// of colours or texture coordinates, "COLOR_1". Interpolated; integers and bools are one vertex's.
struct AttributeRef {
  std::string name;
  ir::Type type = ir::Type::Float;  ///< isAttributeType()
  bool operator==(const AttributeRef&) const = default;
};

/// Whether a name is one that an AttributeRef may have: it begins with an underscore and goes on with letters
/// and digits, or with underscores between, 64 characters at most; or it is COLOR_n or TEXCOORD_n.
bool isAttributeName(std::string_view name);
/// Whether an AttributeRef may have that type. A bool is stored as a float, and true where that is not 0. A
/// matrix is stored as its columns: columnName().
bool isAttributeType(ir::Type type);
inline constexpr std::string_view kAttributeTypes =
    "it is float, int, uint, a vector of one of these such as vec2, ivec2 or uvec2, mat3, mat4 or bool";
/// What a parameter's type may be.
inline constexpr std::string_view kParameterTypes =
    "it is a float, an int, a uint, a bool, a vector of them, a mat3 or a mat4";
/// Whether two names mean one attribute: a template may write WETNESS for glTF's _WETNESS, and shaders do not
/// tell capitals from small letters.
bool sameAttribute(std::string_view a, std::string_view b);
/// At most so many of them in one graph; no device takes more attributes.
inline constexpr size_t kMostOwnAttributes = 16;

/// An output of another node. `output` is empty for a node with a single result.
struct NodeRef {
  std::string node;
  std::string output;
  bool operator==(const NodeRef&) const = default;
};

/// An input of the group that the source stands in.
struct InputRef {
  std::string name;
  bool operator==(const InputRef&) const = default;
};

/// One of the values of an input that have names (lang::Param::choices): "world".
struct Choice {
  std::string name;
  bool operator==(const Choice&) const = default;
};

/// Where an input or a port gets its value from, with an optional swizzle ("rgb", "g") on the way. A float
/// goes to every component where a vector is wanted; its only swizzles are "x", "xx" and so on.
struct Source {
  std::variant<Literal, ParameterRef, TextureRef, GivenRef, NodeRef, InputRef, Choice, AttributeRef> from;
  std::string swizzle;
  bool operator==(const Source&) const = default;
};

using Inputs = std::vector<std::pair<std::string, Source>>;

/// A use of a library node, or of a group.
struct Node {
  std::string id;  ///< unique where it stands, dotted: "coat.absorption"
  /// The library node's name, "coat_absorption", or with `group` the group's. Of a node with several forms it
  /// is the name of all of them, "add", or of one, "add<vec3>".
  std::string type;
  std::string variant;  ///< empty for the reference body
  Inputs inputs;        ///< by parameter name; inputs with defaults may be absent
  bool group = false;
  bool at_vertices = false;  ///< its results are computed at the vertices and interpolated
  /// The term of a specification that it is, "coat.absorption": what the code calls it, and its place there,
  /// before those with larger ones. Without a term the code has the library's name of it: ids never reach it.
  std::string term{};
  uint32_t place = kAnyPlace;
  std::string ui{};  ///< of a tool's, any JSON; may be empty

  static constexpr uint32_t kAnyPlace = ~uint32_t{0};
  bool operator==(const Node&) const = default;
};

using Outputs = std::vector<std::pair<std::string, Source>>;

/// What an instance of a group may be given.
struct GroupInput {
  std::string name;
  ir::Type type = ir::Type::Float;  ///< of a value or of a texture
  ir::Range range{};                ///< of each component; without ends: what it goes to says it
  /// Of the file, not of the instance: a literal, a parameter, a texture or what the template gives. Without
  /// one each instance has to give it.
  std::optional<Source> by_default{};
  std::string ui{};
  bool operator==(const GroupInput&) const = default;
};

/// A graph that is used as a node. Its nodes see their group's inputs, the parameters and textures of the
/// file and what the template gives.
struct Group {
  std::string name;
  std::vector<GroupInput> inputs{};
  std::vector<Node> nodes{};
  Outputs outputs{};
  std::string ui{};
  bool operator==(const Group&) const = default;
};

struct Parameter : ir::Parameter {
  std::string ui{};
  /// Of a matrix its columns, which are parameters of their own in a flat graph: columnName(). Its `value`
  /// and `neutral` say nothing.
  struct Column {
    ir::Components value{};
    ir::Components neutral{};
    bool operator==(const Column&) const = default;
  };
  std::vector<Column> columns{};
  std::string column_of{};  ///< in a flat graph the matrix that it is a column of

  /// A component of today's value, of a matrix column by column, and of `neutral`.
  double number(int component) const;
  double neutralNumber(int component) const;
  /// All of them.
  std::vector<double> numbers() const;
  /// Takes as many as the type has components.
  void setNumbers(std::span<const double> all);
  void setNeutralNumbers(std::span<const double> all);
};
/// "m_0": what a column of the parameter `m` is called, and of the attribute `_M` "_M_0".
std::string columnName(std::string_view matrix, int column);

enum class Wrap : uint8_t { Repeat, Clamp, Mirror };

/// What stands in the name of a file for a tile: "<UDIM>" for its number, 1001 + floor(u) + 10 floor(v), or
/// "<UVTILE>" for "u1_v1", each 1 + floor(). Empty where the file is one image.
std::string_view tileToken(std::string_view file);
/// The file of a tile, counted from 0 on: 1001 and u1_v1, 1002 and u2_v1.
std::string tileFile(std::string file, size_t tile);

/// In the graph's text, by their numbers.
inline constexpr std::array<std::string_view, 3> kWrapWords = {"repeat", "clamp", "mirror"};
inline constexpr std::array<std::string_view, 7> kFilterWords = {"open",
                                                                 "nearest",
                                                                 "linear",
                                                                 "nearest-mipmap-nearest",
                                                                 "linear-mipmap-nearest",
                                                                 "nearest-mipmap-linear",
                                                                 "linear-mipmap-linear"};

struct Texture : ir::TextureSlot {
  std::string file{};          ///< below the folder of the graph's; empty for glTF's texture
  bool own_sampler = false;    ///< of glTF's texture: what follows counts, and not its sampler
  std::array<Wrap, 2> wrap{};  ///< s and t
  bool nearest = false;        ///< else linear
  /// What is there without an image: linear, or encoded where `srgb` says so for its RGB.
  std::optional<ir::Components> color{};
  /// Beside `pointer` the textureInfos of other properties that have the same texel, in order.
  std::vector<std::string> also{};
  std::string ui{};
  Place place{};  ///< of a document's file name; no part of the graph's text
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
  /// Of the template's optional attributes, those that the primitive has; and those that nodes of the library
  /// ask for by `given _NAME`.
  std::vector<std::string> attributes;
  std::vector<Parameter> parameters;
  std::vector<Texture> textures;
  std::vector<Group> groups;
  std::vector<Node> nodes;
  Outputs outputs;  ///< the template's ports
  std::vector<Skipped> skipped;
  std::string ui;

  // Editing. Names and ids are checked by check(), not here. Nodes and parameters are spoken of by their
  // places in the lists above, which hold until one is removed.

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
  std::optional<size_t> findTexture(std::string_view wanted) const;
  std::optional<size_t> findGroup(std::string_view wanted) const;
  /// Removes a node; its users keep dangling edges, which check() reports.
  bool remove(std::string_view id);
  /// Whether the primitive has an attribute that not every one has: by `attributes`.
  bool hasAttribute(std::string_view wanted) const;
  /// Says why a term is not there. A term that several parts have is named once, with the first reason.
  void skip(std::string_view term, std::string reason);
};

/// Calls with each source that nodes and outputs have.
template <class Change>
void eachSource(std::vector<Node>& nodes, Outputs& outputs, Change change) {
  for (Node& node : nodes) {
    for (auto& [input, source] : node.inputs) change(source);
  }
  for (auto& [output, source] : outputs) change(source);
}

/// Of a graph also those within its groups, and the defaults of their inputs.
template <class Change>
void eachSource(Graph& graph, Change change) {
  eachSource(graph.nodes, graph.outputs, change);
  for (Group& group : graph.groups) {
    eachSource(group.nodes, group.outputs, change);
    for (GroupInput& input : group.inputs) {
      if (input.by_default) change(*input.by_default);
    }
  }
}

/// Everything lowering relies on: node types and variants exist, ids are unique, inputs exist, are connected
/// once and have the right type, references resolve, swizzles fit, literals lie in the contract's range, no
/// cycles, no group within itself, the template's ports without default are delivered with the right type,
/// and that groups make no more than `most` nodes. `place.pointer` of each diagnostic is a JSON pointer into
/// the graph's JSON form: what is wrong in a group is said once, where it stands in the group.
Diagnostics check(const Graph& graph, const lang::Library& library, uint64_t most = Limits{}.nodes);

/// Warnings ("may-leave-range") of what check() takes on trust: what is connected and may come to lie outside
/// of the range of what it goes to, by the range of a parameter or what a node or the template is declared to
/// give; with `undeclared` also of what is declared to give no range at all. Where there is neither, a
/// checked graph's colours are finite and not negative. What is wrong in another way is left to check().
Diagnostics doubts(const Graph& graph, const lang::Library& library, bool undeclared = false);

/// Without what belongs to one material or to a tool: the name, JSON pointers, images, `ui`.
Graph bare(Graph graph);
Texture bare(const Texture& texture);

/// What the outputs of each node of a graph are in the flat one, by its path: "coat.f0", "rust", and of a
/// node in the group that "rust" is an instance of "rust/mix". An only result has no name.
using FlatOutputs = std::map<std::string, Outputs, std::less<>>;

/// A checked graph with its groups' nodes in their places, whose ids begin with the instance's: "rust.mix",
/// with the form of each node as its type, and with matrices of its parameters made of columns. A graph
/// without groups, forms and matrices comes back as it is, unless its outputs are asked for.
Graph flattened(Graph graph, const lang::Library& library, FlatOutputs* outputs = nullptr);

/// One of them by a node's path, behind which a dot and the output's name stand where it has several.
/// "no-such-node", "unknown-output".
Result<Source> outputAt(const FlatOutputs& outputs, const std::string& path);

/// The nodes of a flat, checked graph that its outputs reach, in the order of the code: sources first, by the
/// terms' places, and where nothing says otherwise in the order in which the template's ports and the nodes'
/// inputs ask for them. Neither the order of the lists nor ids matter. `also`: a source whose nodes come,
/// too.
std::vector<size_t> codeOrder(const Graph& graph, const lang::Library& library, const Source* also = nullptr);

/// Equal for flat, checked graphs of one shader as far as the graph says it: not ids, orders, values of
/// parameters, images and tools' own words, nor what the outputs do not reach.
std::string programKey(const Graph& graph, const lang::Library& library);

/// The JSON form (docs/graph-format.md), two spaces of indent, stable key order, a final newline.
std::string toJson(const Graph& graph);

/// Reads the JSON form; `name` stands for the file in diagnostics. Does not check() it.
Result<Graph> fromJson(std::string_view text, const std::string& name, const Limits& limits = {});

/// One source in its JSON form, as an edit of a graph is given.
Result<Source> sourceFromJson(std::string_view text);

/// GraphViz: one box per node with its inputs, parameters and textures as leaves.
std::string toDot(const Graph& graph);

}  // namespace lacquer::graph
