/// Node graphs: what a material is made of, to look at and to edit. lacquer.h says what holds for every
/// declaration.
#pragma once

#include <limits>
#include <memory>

#include "lacquer/options.h"
#include "lacquer/results.h"

namespace lacquer {

class Shader;
struct Trial;
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
  std::string name;           ///< "coat_roughness_factor"
  std::string type;           ///< "float", "vec2", "vec3", "vec4" or "bool"
  std::vector<double> value;  ///< today's, 1 to 4 components; of a bool 0 or 1
  Range range;
  std::string pointer;  ///< JSON pointer of the glTF property; may be empty
};

/// A texture of a material. A shader that reads it has its name as ReflectedTexture::slot.
struct TextureUse {
  std::string name;     ///< "coat_roughness_texture"
  std::string type;     ///< "sampler2D"
  bool srgb = false;    ///< its texels are to be decoded, by the image's format
  int texture = -1;     ///< index in the file's `textures`; -1 for none
  std::string pointer;  ///< JSON pointer of the textureInfo; may be empty
};

/// A node graph: one term of the specification is one node (`lacquer nodes` lists them).
///
/// Edits check what they are told, not what comes of it: names of inputs and ports, types, ranges and cycles
/// are check()'s business. An edit that fails leaves the graph as it was. A graph is edited and checked by
/// one thread at a time: check() and all that begins with it put the nodes into an order in which sources
/// stand first.
class Graph {
public:
  explicit operator bool() const { return impl_ != nullptr; }

  /// Reads the JSON form (docs/graph-format.md); `name` stands for the file in messages. Empty on an error.
  static Graph fromJson(std::string_view text, const std::string& name, Messages& messages);
  /// Reads a file in the JSON form. Of the options, `limits`.
  static Graph load(const std::string& path, const Options& options, Messages& messages);
  /// The material's; empty where it has none.
  const std::string& name() const;
  /// The JSON form, which reads back as the same graph; of an empty graph an empty text.
  std::string toJson() const;
  /// The graph for GraphViz: a box for each node; of an empty graph an empty text.
  std::string toDot() const;
  /// In their order in the JSON form.
  std::vector<Parameter> parameters() const;
  /// The same, of the textures.
  std::vector<TextureUse> textures() const;

  /// Adds a node of the library's type `type`, not yet connected. "duplicate-name" when there is one of that
  /// id.
  bool addNode(const std::string& id, const std::string& type, Messages& messages);
  /// What was connected to it stays so, which check() reports. "no-such-node".
  bool removeNode(const std::string& id, Messages& messages);
  /// Connects an input of a node, again if it is connected, to a source in its JSON form: `0.5`, `[1, 0, 0]`,
  /// `{"node": "coat.f0"}`, `{"parameter": "x"}`, `{"texture": "x"}`, `{"given": "view"}`, each object with
  /// an optional "swizzle". "no-such-node", or what is wrong with the source.
  bool connect(const std::string& node, const std::string& input, std::string_view source,
               Messages& messages);
  /// The same for a port of the template.
  bool setOutput(const std::string& port, std::string_view source, Messages& messages);
  /// Adds an editable number of 1 to 4 components, with an unbounded range, or changes the value of the one
  /// of that name; a bool is 0 or 1. "wrong-count" for another number of components than it has, "not-finite"
  /// for an infinite one and NaN, "out-of-range" for one that fits no 32-bit float.
  bool setParameter(const std::string& name, const std::vector<double>& value, Messages& messages);
  /// Changes what a parameter may be; check() refuses values outside. "no-such-parameter"; "wrong-range" for
  /// a range that holds no number, and for `or_zero` where `low` is not above 0; "out-of-range" for a finite
  /// end that fits no 32-bit float.
  bool setRange(const std::string& parameter, const Range& range, Messages& messages);

  /// Everything that generation relies on: types, ranges, names, cycles. True when there is no error. Of the
  /// options, `node_directories`.
  bool check(Messages& messages, const Options& options = {});
  /// The address of the graph's structure under these options, 64 hexadecimal digits: equal for graphs whose
  /// shaders are the same, so that one of them is generated and packs the blocks of all: Shader::pack() is
  /// given each one's parameters(). With Parameters::Baked the numbers belong to it. Cheap: nothing is
  /// generated. The same in every process of one build of the library. Empty on an error of the options.
  std::string structure(const Options& options, Messages& messages) const;
  /// Checks, lowers, optimises and prints every target. Empty on an error, but for code that a compiler or
  /// validator refuses: that is a bug of Lacquer, said in a message, and the shader is there to be looked at.
  Shader generate(const Options& options, Messages& messages);
  /// The DAG with the rate of every value, as a text for people, after the pass of that name, one of
  /// passNames(); "" for the last. Empty on an error: "unknown-pass".
  std::string dump(const Options& options, std::string_view pass, Messages& messages);
  /// What is proved of the shader for all inputs in their ranges (docs/intervals.md). Nothing on an error.
  std::optional<Proofs> prove(const Options& options, Messages& messages,
                              Precision precision = Precision::Vulkan);

private:
  friend class Scene;
  friend std::optional<Evaluation> evaluate(const Graph&, const std::string&, Engine, const Strings&,
                                            const Options&, Messages&, const Trial&);
  friend std::vector<uint8_t> drawBall(const Graph&, uint32_t, const Strings&, const Options&, Messages&,
                                       const Trial&, const ValueLook&);
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

/// Whether a file is taken for a graph, where it may be one: its name ends in ".json".
bool isGraphFile(std::string_view path);

/// The names that Graph::dump() takes, in order: "lower", then the passes.
Strings passNames();

}  // namespace lacquer
