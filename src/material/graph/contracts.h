// What the nodes of a graph take and give: what the library declares of a node, and what a group comes to.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "graph/graph.h"
#include "graph/order.h"
#include "support/arena.h"

namespace lacquer::graph {

/// What a node takes and gives.
struct Contract {
  const lang::NodeDecl* decl = nullptr;  ///< null for a group
  std::span<const lang::Param> params;   ///< of a group: with a default where the group has one
  std::span<const lang::Param> results;
  /// Of a group, by result: false where nothing is known of it, because something before it is wrong.
  const std::vector<bool>* known = nullptr;

  const lang::Param* param(std::string_view name) const;
  /// The place of a result: by its name, or without one of the only result.
  std::optional<size_t> result(std::string_view output) const;
  bool knows(size_t result) const { return known == nullptr || (*known)[result]; }
};

/// Where sources stand: the graph itself, or one of its groups.
class Body {
public:
  Body(const Graph& graph, const Group* group);
  const Group* group() const { return group_; }
  const std::vector<Node>& nodes() const { return *nodes_; }
  const Outputs& outputs() const { return *outputs_; }
  /// The first node of that id.
  std::optional<size_t> find(std::string_view id) const;
  /// The node that an input of a node takes its value from, by their places; nothing where it takes it from
  /// elsewhere.
  std::optional<size_t> source(size_t node, size_t input) const;
  /// Its nodes behind what they take values from; found once.
  const Order& order() const;

private:
  const Group* group_;
  const std::vector<Node>* nodes_;
  const Outputs* outputs_;
  static constexpr size_t kNone = ~size_t{0};
  NameMap<size_t> places_;
  std::vector<size_t> sources_;  ///< by node and input, or kNone
  std::vector<size_t> first_;    ///< of a node in `sources_`
  mutable std::optional<Order> order_;
};

/// What a source is declared to give.
struct Offer {
  ir::Type type;
  bool has_range = false;
  ir::Range range{};
};

/// Why a graph means none of a node's forms.
struct NoForm {
  std::string message, help;
  std::string_view broken;  ///< the form that it means, which is wrong itself; then the others are empty
};

/// Of a graph that stays as it is and may be wrong: then less is known of it. Not to be moved.
class Contracts {
public:
  Contracts(const Graph& graph, const lang::Library& library);
  Contracts(const Contracts&) = delete;
  Contracts& operator=(const Contracts&) = delete;

  /// Null where the library has no such template, or it is wrong.
  const lang::TemplateDecl* templateDecl() const { return template_; }
  /// Null where there is no such node or group, or the library's is wrong.
  const Contract* of(const Node& node) const;
  /// Of a node with several forms, why none of them is meant; nothing where one is, or where that follows
  /// from what it is connected to.
  std::optional<NoForm> whyNoForm(const Node& node, const Body& body) const;
  /// The same by name, of a group where `group`.
  const Contract* of(std::string_view type, bool group) const;
  const Body& main() const { return main_; }
  /// Of a group, by its place.
  const Body& body(size_t group) const { return bodies_[group]; }
  /// Groups behind those that they use, and the circles of groups within themselves.
  const Order& groups() const { return order_; }
  /// Whether something stands for a parameter that nothing is connected to: a constant, or what the template
  /// gives.
  bool hasDefault(const lang::Param& param) const;
  /// Where it is the file's parameter; null where there is none.
  const Parameter* parameter(std::string_view name) const;
  /// A texture of the file's or of the template's; Texture2D and so on.
  std::optional<ir::Type> texture(std::string_view name) const;
  /// What a source in a body gives, behind its swizzle; nothing where that cannot be said.
  std::optional<Offer> offer(const Source& source, const Body& body) const;
  /// The same in front of the swizzle.
  std::optional<Offer> base(const Source& source, const Body& body) const;

private:
  struct OfGroup {
    std::vector<lang::Param> params, results;
    std::vector<bool> known;
    Contract contract;
  };
  const Contract* found(const Node& node) const;
  void orderGroups();
  void chooseForms(const Body& body);
  std::string connectedText(const Node& node, const Body& body) const;
  std::vector<const lang::NodeDecl*> candidates(const Node& node, const Body& body) const;
  void close(size_t group);

  const Graph& graph_;
  const lang::Library& library_;
  const lang::TemplateDecl* template_ = nullptr;
  Body main_;
  std::vector<Body> bodies_;
  std::vector<OfGroup> of_groups_;
  Order order_;
  mutable Arena arena_;
  mutable NameMap<Contract> of_library_{&arena_};
  mutable std::vector<const Contract*> of_main_;  ///< by the graph's node; null as long as there is none
  std::unordered_map<const Node*, const lang::NodeDecl*> forms_;  ///< of nodes that have several
  NameMap<size_t> groups_{&arena_}, parameters_{&arena_}, textures_{&arena_};
};

/// Leaves of a range what lies in another one, too.
void narrow(ir::Range& range, const ir::Range& by);

/// The type and range behind a swizzle; nothing where the swizzle does not fit.
std::optional<ir::Type> swizzled(ir::Type type, std::string_view swizzle);

/// One swizzle behind another.
std::string swizzleBehind(const std::string& first, const std::string& second);
/// A float for each component of a vector of that type.
Source widened(Source source, ir::Type type);

/// Whether a value of a type can stand where another is wanted: it has it, or is a float for a vector.
bool fits(ir::Type from, ir::Type to);
/// Whether a literal can: the same, and whole numbers for integers.
bool fits(const Literal& literal, ir::Type to);

}  // namespace lacquer::graph
