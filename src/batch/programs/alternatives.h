// What several graphs have in one place: their nodes compared, their sources sorted into alternatives.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "graph/graph.h"

namespace lacquer::programs {

using Members = std::vector<uint32_t>;                            ///< places in a list of graphs, ascending
using Sources = std::vector<std::pair<uint32_t, graph::Source>>;  ///< by member

Members joined(const Members& a, const Members& b);

/// The same text for the same source.
std::string textOf(const graph::Source& source);

/// Nodes of several graphs: those of one id, type, variant and image have one key.
class Keys {
public:
  static constexpr uint32_t kNone = ~uint32_t{0};

  void add(const graph::Graph& graph);
  size_t count() const { return all_.size(); }
  const Members& members(uint32_t key) const { return all_[key].members; }
  /// The first member's.
  const graph::Node& node(uint32_t key) const { return *all_[key].nodes[0]; }
  const graph::Node* nodeOf(uint32_t key, uint32_t member) const;
  /// Of a member's node by its id.
  uint32_t of(uint32_t member, const std::string& id) const;
  /// The texture whose texel the node is; empty for another node.
  const std::string& sampled(uint32_t key) const { return all_[key].sampled; }

private:
  struct Key {
    Members members;
    std::vector<const graph::Node*> nodes;  ///< by member
    std::string sampled;
  };
  std::vector<Key> all_;
  std::map<std::string, uint32_t> keys_;
  std::vector<std::map<std::string, uint32_t, std::less<>>> ids_;  ///< by member
};

/// A source and the members that have it.
struct Alternative {
  graph::Source source;  ///< in the words of the first member
  Members members;
  uint32_t key = Keys::kNone;  ///< of a node
};

/// In the order of their first members.
std::vector<Alternative> alternatives(const Keys& keys, Sources sources);

/// The texel that stands in for a texture, as far as something is asked of it.
class Texel {
public:
  /// False, and nothing changed, where the texel cannot be that: components are exact in every format at 0
  /// and 1 alone.
  bool take(const graph::Literal& literal, const std::string& swizzle);
  ir::Components value() const;

private:
  std::array<std::optional<double>, 4> components_{};
};

/// Bools of the material's block that tell members apart.
class Choices {
public:
  explicit Choices(size_t members) : members_(members) {}

  /// A choice that is on for `first` and off for `others`, or with `swapped` the other way round. What it is
  /// for the rest is decided by later calls.
  struct Chosen {
    size_t flag;
    bool swapped;
  };
  Chosen of(const Members& first, const Members& others);
  /// Its name, got by `free` from a wish when it is asked for first.
  const std::string& name(size_t flag, const std::function<std::string(const std::string&)>& free);
  void each(const std::function<void(const std::string& name, const std::vector<bool>& on)>& call) const;

private:
  struct Flag {
    std::string name;
    std::vector<std::optional<bool>> on;
  };
  static bool fits(const Flag& flag, const Members& members, bool on);
  static void set(Flag& flag, const Members& members, bool on);

  size_t members_;
  std::vector<Flag> flags_;
};

}  // namespace lacquer::programs
