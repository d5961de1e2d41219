// The parts of check(): what it finds, and the nodes and outputs of one body.
#pragma once

#include <compare>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "graph/contracts.h"
#include "support/diagnostic.h"

namespace lacquer::graph {

/// Where in the graph the check stands. Diagnostics are sorted by it: what is found late comes where it
/// belongs.
struct Spot {
  /// The sections of the JSON form, in its order.
  enum class Section : uint8_t { Template, Parameters, Textures, Groups, Nodes, Outputs };
  Section section = Section::Template;
  size_t item = 0;
  /// Of a group: its inputs, nodes or outputs, and which of them.
  Section part = Section::Template;
  size_t of_part = 0;
  size_t input = 0;  ///< of a node: 1 and up for its inputs, 0 for what stands before them
  auto operator<=>(const Spot&) const = default;
};

/// A name from the graph as it stands in a message.
std::string inQuotes(std::string_view name);
/// "'a', 'b' and 'c'", not too many of them.
std::string shortList(const std::vector<std::string_view>& names);
/// The JSON pointer to a member of a member.
std::string pointerTo(std::string_view section, std::string_view name);

using Names = std::vector<std::string_view>;

/// The names that `name` takes from the elements of a list, for Findings::suggest().
template <class List, class Name>
auto namesOf(const List& list, Name name) {
  return [&list, name] {
    Names names;
    for (const auto& element : list) names.push_back(name(element));
    return names;
  };
}

/// What is wrong, in the order of the file.
class Findings {
public:
  void error(const Spot& spot, std::string pointer, std::string_view code, std::string message,
             std::string help = {});
  /// What is wrong within the library, at its place there.
  void forward(const Spot& spot, const Diagnostics& diagnostics);
  /// "did you mean 'x'?" or `otherwise`; `candidates()` gives the names that exist.
  template <class Candidates>
  std::string suggest(std::string_view name, Candidates candidates, std::string otherwise = {}) {
    return maySuggest() ? nearestOf(name, candidates(), std::move(otherwise)) : otherwise;
  }
  /// Whether there may be one more suggestion: each looks at every candidate.
  bool maySuggest();
  bool empty() const { return found_.empty(); }
  /// Each step finds the first in the file first, as many as anybody reads.
  void nextStep() { before_ = found_.size(); }
  Diagnostics take();

private:
  struct Found {
    Spot spot;
    Diagnostic diagnostic;
  };
  static std::string nearestOf(std::string_view name, const Names& names, std::string otherwise);

  std::vector<Found> found_;
  size_t before_ = 0;
  size_t left_out_ = 0;  ///< what is wrong beyond these
  size_t suggestions_ = 0;
};

/// The names that a list has had. Most lists are short: those are searched.
class Connected {
public:
  void clear() {
    names_.clear();
    many_.clear();
  }
  /// False when it was there already.
  bool insert(std::string_view name);
  bool contains(std::string_view name) const;

private:
  static constexpr size_t kShort = 32;
  Names names_;
  std::unordered_set<std::string_view> many_;
};

/// The graph's own nodes and ports, or those of a group.
class BodyCheck {
public:
  BodyCheck(const Graph& graph, const lang::Library& library, const Contracts& contracts, const Body& body,
            Findings& findings);

  /// Ids, types and variants of the nodes. `libraries`: what is wrong within the library was said of these
  /// already.
  void heads(Connected& libraries);
  /// What nodes and outputs are connected to.
  void connections();
  void cycles() { cycles(nullptr); }
  /// Those alone that a node is in.
  void cycles(const size_t* node);
  /// The defaults of a group's inputs.
  void defaults();

  // For one edit of the body.
  void head(size_t index, Connected& libraries);
  /// An input of a node, by its place among those that are connected.
  void input(size_t index, size_t input);
  /// A port or an output of a group, by its place.
  void output(size_t index);
  /// The default of an input of a group.
  void byDefault(size_t index);

private:
  /// Where a value goes: an input of a node, a port of the template, an output of a group.
  struct Sink {
    Spot spot;
    std::string_view name;  ///< of the input or the port
    const lang::Param* contract = nullptr;
  };
  using Section = Spot::Section;

  Spot spotOf(Section section, size_t item, size_t input = 0) const;
  std::string pointer(std::string_view rest) const;
  std::string nodePointer(size_t index, std::string_view member = {}) const;
  std::string pointerOf(const Sink& sink) const;
  /// As a message calls it: "'ior' of the node 'coat.f0'".
  std::string textOf(const Sink& sink) const;
  /// " in the group 'worn'"; nothing in the graph itself.
  std::string inGroup() const;
  void error(const Sink& sink, std::string_view code, std::string message, std::string help = {});

  /// Says why a node that is none of a group has no contract.
  void noNode(size_t index, Connected& libraries);
  std::string nodeInstead(const std::string& name) const;
  void variant(size_t index, const lang::NodeDecl& decl);
  void unknownInput(const Node& node, const Contract* contract, const Sink& sink);
  void inputs(size_t index);
  void outputs();

  void value(const Source& source, const Sink& sink);
  void range(const Source& source, const Sink& sink);
  bool literal(const Literal& literal, const Sink& sink);
  /// The type of a source; an error, and nothing, where it has none.
  std::optional<ir::Type> typeOf(const Source& source, const Sink& sink);
  void unknown(const Literal& literal, const Sink& sink);
  void unknown(const ParameterRef& ref, const Sink& sink);
  void unknown(const TextureRef& ref, const Sink& sink);
  void unknown(const GivenRef& ref, const Sink& sink);
  void unknown(const AttributeRef& ref, const Sink& sink);
  void unknown(const NodeRef& ref, const Sink& sink);
  void unknown(const InputRef& ref, const Sink& sink);
  void unknown(const Choice& choice, const Sink& sink);
  void chosen(const Choice& choice, const Sink& sink);
  void wrongSwizzle(ir::Type type, const std::string& swizzle, const Sink& sink);
  std::string conversion(const Source& source, ir::Type from, ir::Type to) const;
  std::string converter(ir::Type from, ir::Type to) const;

  const Graph& graph_;
  const lang::Library& library_;
  const Contracts& contracts_;
  const Body& body_;
  size_t group_ = 0;  ///< where it is one
  Findings& findings_;
  Connected connected_;  ///< of the node or the list of outputs that is looked at
};

}  // namespace lacquer::graph
