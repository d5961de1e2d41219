// Equal forms of a plan: classes of nodes that are equal in real numbers, each node on classes. See Willsey
// et al. 2021, "egg: Fast and Extensible Equality Saturation".
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "optimize/plan.h"
#include "optimize/ranges.h"

namespace lacquer::optimize {

/// Names a node of an e-graph, not its class.
using NodeId = uint32_t;

/// What is known of the numbers that a class stands for.
struct Facts {
  Ranges real{};  ///< in real arithmetic: what rules ask
  Ranges lit{};   ///< in float32, with light of at most 1 (analysis/relax.h): what errors are measured by
};

struct Class {
  ir::Type type = ir::Type::Float;
  ir::Rate rate = ir::Rate::Light;    ///< the lowest of its nodes
  uint32_t constant = ~uint32_t{0};   ///< its place in Constants where the class is one number
  ir::ValueId origin = ir::kNoValue;  ///< the module's value that it stands for, where there is one
  std::vector<NodeId> nodes;
  std::vector<NodeId> parents;  ///< nodes that have it as an operand
  Facts facts;
};

class EGraph {
public:
  /// `least` and `most` lights that a sum over them has. What is added beyond `limit` nodes is not.
  EGraph(Constants& constants, double least_lights, double most_lights, size_t limit)
      : constants_(constants),
        math_(analysis::Arithmetic::Vulkan),
        real_(analysis::Arithmetic::Real),
        least_lights_(least_lights),
        most_lights_(most_lights),
        limit_(limit) {}

  /// The class of a node on classes; what is known of it beforehand narrows its ranges. kNoRef where the
  /// graph is full or the node can be no finite number.
  Ref add(Node node, const Facts* known = nullptr);
  Ref constant(ir::Type type, double x);
  Ref constant(ir::Type type, const ir::Components& components);
  /// The node of operands that are there, with its type and rate; kNoRef where their types do not fit.
  Ref make(ir::Op op, std::initializer_list<Ref> operands, uint32_t payload = 0);
  /// A component of a class.
  Ref component(Ref of, int index);
  /// `of` as a value of that type: a Float in all components. kNoRef where it is none.
  Ref as(ir::Type type, Ref of);

  /// States that two classes are equal. False where they are one already, or cannot be.
  bool merge(Ref a, Ref b);
  /// Restores what congruence asks for after merges.
  void rebuild();

  Ref find(Ref id) const;
  /// The node with that content, or ~0.
  NodeId nodeOf(const Node& node) const { return lookup(canonical(node)); }
  const Class& operator[](Ref id) const { return classes_[find(id)]; }
  void setOrigin(Ref id, ir::ValueId origin) { classes_[find(id)].origin = origin; }
  const Node& node(NodeId id) const { return nodes_[id]; }
  Ref classOf(NodeId id) const { return find(class_of_[id]); }
  /// False for a node that is a copy of another.
  bool live(NodeId id) const { return !dead_[id]; }
  size_t nodeCount() const { return nodes_.size(); }
  size_t classCount() const { return classes_.size(); }
  bool full() const { return nodes_.size() >= limit_; }
  Constants& constants() { return constants_; }
  const Constants& constants() const { return constants_; }
  const analysis::RangeMath& math() const { return math_; }

  /// Of a component, in real arithmetic.
  const Range& range(Ref id, int c) const {
    const Class& of = (*this)[id];
    return optimize::component(of.facts.real, of.type, c);
  }
  /// In float32, with light of at most 1.
  const Range& floatRange(Ref id, int c) const {
    const Class& of = (*this)[id];
    return optimize::component(of.facts.lit, of.type, c);
  }
  int width(Ref id) const { return ir::componentCount((*this)[id].type); }
  /// True when every component of the class is that number.
  bool isNumber(Ref id, double x) const;

private:
  Node canonical(Node node) const;
  Ref folded(const Node& node);
  Ref simpler(const Node& node);
  void insert(NodeId id);
  NodeId lookup(const Node& node) const;
  std::optional<ir::Type> typeOf(const Node& node) const;

  Constants& constants_;
  analysis::RangeMath math_, real_;
  double least_lights_, most_lights_;
  size_t limit_;
  std::vector<Node> nodes_;
  std::vector<Ref> class_of_;
  std::vector<bool> dead_;
  std::vector<Class> classes_;
  mutable std::vector<Ref> leader_;
  std::vector<NodeId> table_;  ///< open addressing by content; a power of two
  size_t filled_ = 0;
  std::vector<Ref> changed_;  ///< classes whose parents may have become equal
};

}  // namespace lacquer::optimize
