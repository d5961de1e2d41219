// Edits of a graph: each is checked where it is made, says what is wrong, and changes nothing then. What an
// edit brings about elsewhere (a node that is gone, another type of what goes on) is check()'s to say.
//
// Names of nodes, inputs and outputs of a group have the group and a slash before them: "worn/mix".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "graph/graph.h"

namespace lacquer::graph {

class Editor {
public:
  /// `most`: nodes, parameters, textures and groups that a graph may have of each. Without `checked` only
  /// what an edit speaks of must be there: what takes an edit back brings what was there before.
  Editor(Graph& graph, const lang::Library& library, uint64_t most = Limits{}.nodes, bool checked = true)
      : graph_(graph), library_(library), most_(most), checked_(checked) {}

  /// Where something is put into a list; at the end without it or beyond the end.
  using Place = std::optional<size_t>;

  /// A node whose id is a name in the graph or, behind a slash, in a group. It may be connected already: what
  /// it is connected to is checked. Errors: "wrong-name", "duplicate-name", "unknown-node", "unknown-group",
  /// "cycle" for a group within itself, and those of connect().
  Result<void> addNode(Node node, Place place = {});
  /// What takes values from it stays connected. "no-such-node".
  Result<void> removeNode(const std::string& id);
  /// And in all that takes values from it. `to` is a name in the same body, without a group's, that nothing
  /// takes values from in vain: the same holds for other names.
  Result<void> renameNode(const std::string& id, const std::string& to);
  /// "unknown-variant".
  Result<void> setVariant(const std::string& id, const std::string& variant);
  Result<void> setStage(const std::string& id, bool at_vertices);
  /// A new input stands where the node declares it, or at a place. "no-such-node", and what check() says of
  /// the input: "unknown-input", "wrong-type", "out-of-range", "cycle", ….
  Result<void> connect(const std::string& node, std::string_view input, const Source& source,
                       Place place = {});
  /// The input has its default again. "not-connected".
  Result<void> disconnect(const std::string& node, std::string_view input);
  /// A port of the template, or an output of a group.
  Result<void> setOutput(const std::string& port, const Source& source, Place place = {});
  Result<void> removeOutput(const std::string& port);

  Result<void> addParameter(Parameter parameter, Place place = {});
  /// All of it but its name and its tool's own words. Where its type stays, all that takes its value from it
  /// has to accept it.
  Result<void> setParameter(const Parameter& parameter);
  Result<void> renameParameter(const std::string& name, const std::string& to);
  Result<void> removeParameter(const std::string& name);
  Result<void> addTexture(Texture texture, Place place = {});
  Result<void> setTexture(const Texture& texture);
  Result<void> renameTexture(const std::string& name, const std::string& to);
  Result<void> removeTexture(const std::string& name);

  /// A group as it is; "cycle" where it contains itself.
  Result<void> addGroup(Group group, Place place = {});
  /// A graph as a group: its parameters are inputs with their values as defaults, its textures are textures
  /// of this one and inputs, its groups are groups of this one.
  Result<void> addGroup(const std::string& name, const Graph& graph);
  Result<void> renameGroup(const std::string& name, const std::string& to);
  Result<void> removeGroup(const std::string& name);
  Result<void> addInput(const std::string& group, GroupInput input, Place place = {});
  Result<void> setInput(const std::string& group, const GroupInput& input);
  Result<void> renameInput(const std::string& path, const std::string& to);
  Result<void> removeInput(const std::string& path);
  /// Puts nodes of one body into a new group of that name, and one instance in their place. What they take
  /// from elsewhere becomes inputs, what others take from them outputs. "cycle" where a node that stays would
  /// stand between them.
  Result<void> makeGroup(const std::vector<std::string>& nodes, const std::string& name,
                         const std::string& instance);
  /// Puts the nodes of an instance's group in its place. "not-a-group".
  Result<void> expand(const std::string& id);

  enum class Part : uint8_t { Graph, Node, Parameter, Texture, Group, Input };
  /// The tool's own words; null where there is no such part, and an error.
  Result<std::string*> ui(Part part, const std::string& name);

  /// Whose nodes a path speaks of, and what it calls there. "no-such-group".
  struct Where {
    Group* group = nullptr;
    std::vector<Node>* nodes = nullptr;
    Outputs* outputs = nullptr;
    std::string name;
  };
  Result<Where> where(const std::string& path);
  /// And the node's place. "no-such-node".
  Result<size_t> node(const std::string& path, Where& where);
  Result<size_t> group(const std::string& name);
  /// Of what a path of an input of a group speaks: without a group "no-such-input".
  Result<Where> ofGroup(const std::string& path);

private:
  Result<void> freeName(std::string_view name, std::string_view what, bool taken) const;
  Result<void> freeId(const std::vector<Node>& nodes, const std::string& id) const;
  Result<void> hasRoom(size_t count, std::string_view what) const;
  Result<void> accepted(const Where& where, size_t node, const std::string* input);
  template <class Check>
  Result<void> good(const Check& check);
  Result<void> goodGroups();
  template <class Ref>
  bool wanted(const std::string& name);

  Graph& graph_;
  const lang::Library& library_;
  uint64_t most_;
  bool checked_;
};

/// Does an edit that is given as a JSON object (docs/graph-format.md, "Edits"), or an array of edits one
/// after the other, and returns what takes it back, which leaves the same bytes. On an error nothing has
/// changed.
Result<std::string> edit(Graph& graph, const lang::Library& library, std::string_view json,
                         const Limits& limits);

}  // namespace lacquer::graph
