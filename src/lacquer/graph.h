/// Node graphs: what a material is made of, to look at and to edit. lacquer.h says what holds for every
/// declaration.
#pragma once

#include <limits>
#include <memory>

#include "lacquer/options.h"
#include "lacquer/results.h"

namespace lacquer {

class Scene;
class Shader;
struct EditedGraph;
struct PointArrays;
struct Trial;
struct Tuned;
struct ValueLook;

/// The numbers that something may be given, each component of a vector for itself; both ends belong to it.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  /// 0 is one of them although `low` is above it: an index of refraction is 0, which stands for an infinite
  /// one, or at least 1.
  bool or_zero = false;
  bool operator==(const Range&) const = default;
};

/// An editable number of a material.
struct Parameter {
  std::string name;  ///< "coat_roughness_factor"
  /// "float", "int", "uint", "bool", a vector of one of them, "vec3", "mat3" or "mat4". Shaders are given the
  /// columns of a matrix `m` as the parameters `m_0` to `m_2`.
  std::string type;
  std::vector<double> value;  ///< today's, 1 to 4 components; of a bool 0 or 1; of a matrix column by column
  Range range;
  std::string pointer;  ///< JSON pointer of the glTF property; may be empty
  std::string ui{};     ///< the tool's own words, JSON; may be empty
};

enum class Wrap : uint8_t { Repeat, Clamp, Mirror };
enum class Filter : uint8_t {
  Open,  ///< the file leaves it to the engine
  Nearest,
  Linear,
  NearestMipmapNearest,
  LinearMipmapNearest,
  NearestMipmapLinear,
  LinearMipmapLinear
};
/// How a texture is looked up.
struct TextureSampler {
  Wrap wrap_s = Wrap::Repeat, wrap_t = Wrap::Repeat;
  Filter mag_filter = Filter::Open, min_filter = Filter::Open;
  bool operator==(const TextureSampler&) const = default;
};

/// A texture of a material. A shader that reads it has its name as ReflectedTexture::slot.
struct TextureUse {
  std::string name;     ///< "coat_roughness_texture"
  std::string type;     ///< "sampler2D"
  bool srgb = false;    ///< its texels are to be decoded, by the image's format
  int texture = -1;     ///< index in the file's `textures`; -1 for none
  std::string pointer;  ///< JSON pointer of the textureInfo; may be empty
  std::string file{};   ///< of a graph's own: the image below the folder of the graph; else empty
  std::string ui{};     ///< the tool's own words, JSON; may be empty
  /// Beside `pointer` the textureInfos of other properties that have the same texel, in order. One of them
  /// that is changed alone has a texture of its own then: another program.
  Strings also{};
  /// How it is looked up, where the graph says so: of a file, and of a procedural texture, in place of the
  /// sampler of the file's texture.
  std::optional<TextureSampler> sampler{};
};

/// What something is connected to.
struct Connection {
  std::string name;    ///< of the input, the port or the output
  std::string source;  ///< in its JSON form
  bool operator==(const Connection&) const = default;
};

/// A node of a graph.
struct NodeUse {
  std::string id;
  std::string type;     ///< the library's node, "coat_absorption", or with `group` a group of the graph
  std::string variant;  ///< empty for the reference
  bool group = false;
  bool at_vertices = false;  ///< it is computed at the vertices, and its results are interpolated
  std::vector<Connection> inputs;
  std::string ui{};  ///< the tool's own words, JSON; may be empty
  bool operator==(const NodeUse&) const = default;
};

/// What a node or a template takes, or what a node gives.
struct Socket {
  std::string name;       ///< of an only output empty
  std::string type;       ///< "vec3"
  Range range;            ///< without ends where none is declared
  bool optional = false;  ///< of an input: it has a default
  std::string source{};   ///< what an input is connected to, in its JSON form; empty for nothing
};
struct Sockets {
  std::vector<Socket> inputs, outputs;  ///< as they are declared
};

/// What has changed of a graph since its last generation, the gravest.
enum class Change : uint8_t {
  Nothing,   ///< nothing that a shader or its application sees: ids, orders, groups, tools' own words
  Numbers,   ///< the bytes of the material's block, which Shader::packGraph() makes of it
  Textures,  ///< the images or samplers of its textures, and perhaps numbers
  Program,   ///< the shader: it is to be generated
};

/// A node graph: one term of the specification is one node (`lacquer nodes` lists them).
///
/// Each edit is checked where it is made, against the library of the options that the graph was made with:
/// names, types, ranges, cycles. One that fails says why and leaves the graph as it was. What it brings about
/// elsewhere (a node that is gone from below others) is check()'s to say. Nodes of a group are named with the
/// group and a slash before the id: "worn/mix". A graph is edited and generated by one thread at a time.
class Graph {
public:
  explicit operator bool() const { return impl_ != nullptr; }

  /// Reads the JSON form (docs/graph-format.md); `name` stands for the file in messages. Empty on an error.
  /// Of the options, what the library is made of, and `limits`.
  static Graph fromJson(std::string_view text, const std::string& name, Messages& messages,
                        const Options& options = {});
  /// Reads a file in the JSON form. Of the options, the same.
  static Graph load(const std::string& path, const Options& options, Messages& messages);
  /// The material's; empty where it has none.
  const std::string& name() const;
  /// The JSON form, which reads back as the same graph; of an empty graph an empty text.
  std::string toJson() const;
  /// The graph for GraphViz: a box for each node; of an empty graph an empty text.
  std::string toDot() const;

  // -- what is there, in the order of the JSON form

  std::vector<Parameter> parameters() const;
  std::vector<TextureUse> textures() const;
  /// The names of its groups.
  Strings groups() const;
  /// The nodes of the graph, or with a group's name of that.
  std::vector<NodeUse> nodes(const std::string& group = {}) const;
  /// The template's ports that are connected, or the outputs of a group.
  std::vector<Connection> outputs(const std::string& group = {}) const;
  /// What a node takes and gives; without a node the template's ports, as inputs. Nothing, and
  /// "no-such-node", "unknown-node" or "unknown-template", where that is not known.
  std::optional<Sockets> sockets(const std::string& node, Messages& messages) const;

  // -- edits

  /// Adds a node of the library's type `type`, not yet connected. Of an overloaded node, "add", the types of
  /// what is connected to it choose the form, and check() says "no-form" while they choose none; a form may
  /// be named, too: "add<vec3>". "duplicate-name" when there is one of that id, "wrong-name", "unknown-node".
  bool addNode(const std::string& id, const std::string& type, Messages& messages);
  /// The same of a group of the graph. "unknown-group", and "cycle" for a group within itself.
  bool addInstance(const std::string& id, const std::string& group, Messages& messages);
  /// What was connected to it stays so, which check() reports. "no-such-node".
  bool removeNode(const std::string& id, Messages& messages);
  /// And in all that takes values from it; `to` has no group before it. "no-such-node", "duplicate-name",
  /// "wrong-name".
  bool renameNode(const std::string& id, const std::string& to, Messages& messages);
  /// Connects an input of a node, again if it is connected, to a source in its JSON form: `0.5`, `[1, 0, 0]`,
  /// `{"node": "coat.f0"}`, `{"parameter": "x"}`, `{"texture": "x"}`, `{"given": "view"}`, each object with
  /// an optional "swizzle". "no-such-node", "unknown-input", "wrong-type", "out-of-range", "cycle", or what
  /// is wrong with the source.
  bool connect(const std::string& node, const std::string& input, std::string_view source,
               Messages& messages);
  /// The input has its default again. "not-connected".
  bool disconnect(const std::string& node, const std::string& input, Messages& messages);
  /// The same for a port of the template, or an output of a group: "worn/color".
  bool setOutput(const std::string& port, std::string_view source, Messages& messages);
  bool removeOutput(const std::string& port, Messages& messages);
  /// Adds an editable number of 1 to 4 components, with an unbounded range, or changes the value of the one
  /// of that name; a bool is 0 or 1. "wrong-count" for another number of components than it has, "not-finite"
  /// for an infinite one and NaN, "out-of-range" for one that fits no 32-bit float, is not in the parameter's
  /// range or not in that of what it goes to, "wrong-type" for a fraction where a whole number is wanted.
  bool setParameter(const std::string& name, const std::vector<double>& value, Messages& messages);
  /// Changes what a parameter may be. "no-such-parameter"; "wrong-range" for a range that holds no number,
  /// and for `or_zero` where `low` is not above 0; "out-of-range" for a finite end that fits no 32-bit float,
  /// and where today's value is not in the range.
  bool setRange(const std::string& parameter, const Range& range, Messages& messages);
  /// Puts nodes into a new group, and an instance of it in their place: what they take from elsewhere becomes
  /// inputs, what others take from them outputs. "cycle" where a node that stays would stand between them.
  bool makeGroup(const Strings& nodes, const std::string& group, const std::string& instance,
                 Messages& messages);
  /// A graph as a group of this one: its parameters and textures are inputs with their values as defaults.
  bool addGroup(const std::string& group, const Graph& graph, Messages& messages);
  /// Puts the nodes of an instance's group in its place. "not-a-group".
  bool expand(const std::string& node, Messages& messages);
  /// Any edit in its JSON form, or an array of them, which are all made or none (docs/graph-format.md,
  /// "Edits"). The edit that takes it back, after which the graph has the same bytes; empty on an error.
  std::string edit(std::string_view json, Messages& messages);

  /// Compared with what generate() was last given; Program before that, and while check() fails. Where
  /// parameters were baked, numbers are of the program.
  Change changes() const;

  /// Everything that generation relies on: types, ranges, names, cycles. True when there is no error. Of the
  /// options, what the library is made of, and `limits`.
  bool check(Messages& messages, const Options& options = {}) const;
  /// The address of the structure, 64 hexadecimal digits: one of those that share it is generated, and packs
  /// the blocks of all, with each one's parameters(). Ids, orders, groups, `ui`, images and what no output
  /// reaches change nothing; names of parameters and textures do, with Parameters::Baked numbers, too. Cheap,
  /// and the same in every process of one build. Empty on an error, which those of check() are, too.
  std::string structure(const Options& options, Messages& messages) const;
  /// Checks, lowers, optimises and prints every target. Empty on an error, but for code that a compiler or
  /// validator refuses: that is a bug of Lacquer, said in a message, and the shader is there to be looked at.
  Shader generate(const Options& options, Messages& messages);
  /// The DAG with the rate of every value, as a text for people, after the pass of that name, one of
  /// passNames(); "" for the last. Empty on an error: "unknown-pass".
  std::string dump(const Options& options, std::string_view pass, Messages& messages) const;
  /// What is proved of the shader for all inputs in their ranges (docs/intervals.md). Nothing on an error.
  std::optional<Proofs> prove(const Options& options, Messages& messages,
                              Precision precision = Precision::Vulkan) const;

private:
  friend class Scene;
  friend class Shader;
  friend std::optional<Evaluation> evaluate(const Graph&, const std::string&, Engine, const Strings&,
                                            const Options&, Messages&, const Trial&);
  friend std::optional<Evaluation> evaluate(const Graph&, const PointArrays&, Engine, const Strings&,
                                            const Options&, Messages&, const Trial&);
  friend std::vector<uint8_t> drawBall(const Graph&, uint32_t, const Strings&, const Options&, Messages&,
                                       const Trial&, const ValueLook&);
  friend std::optional<Tuned> tune(const Graph&, const Options&, Messages&, const Progress&);
  friend std::string toMaterialX(const Scene&, const Strings&, const std::string&,
                                 const std::vector<EditedGraph>&, const Options&, Messages&);
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

/// Whether a file is taken for a graph, where it may be one: its name ends in ".json".
bool isGraphFile(std::string_view path);

/// The names that Graph::dump() takes, in order: "lower", then the passes.
Strings passNames();

}  // namespace lacquer
