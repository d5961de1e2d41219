#include "optimize/egraph.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "ir/fold.h"

namespace lacquer::optimize {

using ir::Op;
using ir::Type;

namespace {

constexpr NodeId kEmpty = ~NodeId{0};

bool sameContent(const Node& a, const Node& b) {
  return a.op == b.op && a.type == b.type && a.count == b.count && a.payload == b.payload &&
         a.source == b.source && std::equal(a.args.begin(), a.args.begin() + a.count, b.args.begin());
}

size_t hashOf(const Node& node) {
  const auto mix = [](uint64_t hash, uint64_t word) {
    return (std::rotl(hash, 31) ^ word) * uint64_t{0xC2B2AE3D27D4EB4F};
  };
  uint64_t hash =
      mix(static_cast<uint64_t>(node.op) << 16U | static_cast<uint64_t>(node.type) << 8U | node.count,
          static_cast<uint64_t>(node.payload) << 32U | node.source);
  for (const Ref operand : node.operands()) hash = mix(hash, operand);
  return hash ^ hash >> 32U;
}

}  // namespace

Ref EGraph::find(Ref id) const {
  while (leader_[id] != id) {
    leader_[id] = leader_[leader_[id]];
    id = leader_[id];
  }
  return id;
}

Node EGraph::canonical(Node node) const {
  for (size_t k = 0; k < node.count; ++k) node.args[k] = find(node.args[k]);
  if (!node.opaque() && commutes(node.op) && node.args[0] > node.args[1])
    std::swap(node.args[0], node.args[1]);
  return node;
}

NodeId EGraph::lookup(const Node& node) const {
  if (table_.empty()) return kEmpty;
  for (size_t slot = hashOf(node) & (table_.size() - 1); table_[slot] != kEmpty;
       slot = (slot + 1) & (table_.size() - 1)) {
    if (!dead_[table_[slot]] && sameContent(nodes_[table_[slot]], node)) return table_[slot];
  }
  return kEmpty;
}

void EGraph::insert(NodeId id) {
  constexpr size_t kFirstSlots = 4096;
  if (2 * filled_ >= table_.size()) {
    table_.assign(std::max(kFirstSlots, std::bit_ceil(4 * (nodes_.size() + 1))), kEmpty);
    filled_ = 0;
    for (NodeId each = 0; each < nodes_.size(); ++each) {
      if (each == id || dead_[each]) continue;
      size_t slot = hashOf(nodes_[each]) & (table_.size() - 1);
      while (table_[slot] != kEmpty) slot = (slot + 1) & (table_.size() - 1);
      table_[slot] = each;
      ++filled_;
    }
  }
  size_t slot = hashOf(nodes_[id]) & (table_.size() - 1);
  while (table_[slot] != kEmpty) slot = (slot + 1) & (table_.size() - 1);
  table_[slot] = id;
  ++filled_;
}

Ref EGraph::constant(Type type, const ir::Components& components) {
  return add(
      {Op::Constant, type, ir::Rate::Constant, 0, constants_.place(type, components), {}, ir::kNoValue});
}

Ref EGraph::constant(Type type, double x) { return constant(type, ir::Components{x, x, x, x}); }

bool EGraph::isNumber(Ref id, double x) const {
  const Class& of = (*this)[id];
  if (of.constant == ~uint32_t{0}) return false;
  const ir::Components& components = constants_[of.constant];
  for (int c = 0; c < ir::componentCount(of.type); ++c) {
    if (components[static_cast<size_t>(c)] != x) return false;
  }
  return true;
}

std::optional<Type> EGraph::typeOf(const Node& node) const {
  std::array<Type, 4> types{};
  for (size_t k = 0; k < node.count; ++k) types[k] = (*this)[node.args[k]].type;
  if (node.op == Op::Div) return ir::isFloating(types[0]) ? std::optional(types[0]) : std::nullopt;
  return ir::resultType(node.op, {types.data(), node.count});
}

Ref EGraph::make(Op op, std::initializer_list<Ref> operands, uint32_t payload) {
  Node node{op,      Type::Float, ir::Rate::Constant, static_cast<uint8_t>(operands.size()),
            payload, {},          ir::kNoValue};
  std::array<ir::Rate, 4> rates{};
  size_t k = 0;
  for (const Ref operand : operands) {
    if (operand == kNoRef) return kNoRef;
    node.args[k] = operand;
    rates[k++] = (*this)[operand].rate;
  }
  const std::optional<Type> type = typeOf(node);
  if (!type) return kNoRef;
  node.type = *type;
  node.rate = rateOf(op, {rates.data(), k});
  return add(node);
}

Ref EGraph::component(Ref of, int index) {
  if (of == kNoRef) return kNoRef;
  const Class& from = (*this)[of];
  if (from.type == Type::Float) return of;
  const std::array<int, 1> picks{index};
  Node node{Op::Swizzle, Type::Float, from.rate, 1, ir::packSwizzle(picks), {of}, ir::kNoValue};
  return add(node);
}

Ref EGraph::as(Type type, Ref of) {
  if (of == kNoRef || (*this)[of].type == type) return of;
  if ((*this)[of].type != Type::Float || !ir::isFloatVector(type)) return kNoRef;
  if (const uint32_t constant = (*this)[of].constant; constant != ~uint32_t{0})
    return this->constant(type, constants_[constant][0]);
  return add({Op::Construct, type, (*this)[of].rate, 1, 0, {of}, ir::kNoValue});
}

/// A number where all operands are.
Ref EGraph::folded(const Node& node) {
  if (node.opaque() || node.count == 0 || node.op == Op::SumOverLights || !ir::isFloating(node.type))
    return kNoRef;
  std::array<ir::Operand, 4> in{};
  for (size_t k = 0; k < node.count; ++k) {
    const Class& operand = (*this)[node.args[k]];
    if (operand.constant == ~uint32_t{0}) return kNoRef;
    in[k] = {operand.type, constants_[operand.constant]};
  }
  ir::Components result{};
  if (node.op == Op::Div) {
    for (size_t c = 0; c < 4; ++c) result[c] = 1 / in[0].value[c];
  } else {
    result = ir::foldNumbers(node.op, node.type, node.payload, {in.data(), node.count});
  }
  for (int c = 0; c < ir::componentCount(node.type); ++c) {
    // What float32 does not hold stays an expression, and so does what is 0 by underflow.
    const double x = result[static_cast<size_t>(c)];
    if (!std::isfinite(x) || std::abs(x) > 3e38 || (x != 0 && std::abs(x) < 1e-37)) return kNoRef;
  }
  return constant(node.type, result);
}

/// Sums with 0, products with 0 and 1, signs of signs.
Ref EGraph::simpler(const Node& node) {
  if (node.opaque()) return kNoRef;
  const auto fits = [&](Ref of) { return (*this)[of].type == node.type ? of : as(node.type, of); };
  for (const size_t k : {size_t{0}, size_t{1}}) {
    if (node.count != 2) break;
    if (node.op == Op::Add && isNumber(node.args[k], 0)) return fits(node.args[1 - k]);
    if (node.op != Op::Mul) continue;
    if (isNumber(node.args[k], 1)) return fits(node.args[1 - k]);
    if (isNumber(node.args[k], 0)) return constant(node.type, 0);
  }
  if (node.op != Op::Neg) return kNoRef;
  for (const NodeId id : (*this)[node.args[0]].nodes) {
    if (!dead_[id] && nodes_[id].op == Op::Neg && !nodes_[id].opaque()) return find(nodes_[id].args[0]);
  }
  return kNoRef;
}

Ref EGraph::add(Node node, const Facts* known) {
  node = canonical(node);
  if (const NodeId there = lookup(node); there != kEmpty) return classOf(there);
  if (const Ref number = folded(node); number != kNoRef) return number;
  if (const Ref same = simpler(node); same != kNoRef) return find(same);
  if (full() && known == nullptr && node.op != Op::Constant) return kNoRef;

  Class fresh;
  fresh.type = node.type;
  fresh.rate = node.rate;
  if (node.op == Op::Constant) fresh.constant = node.payload;
  if (known != nullptr) {
    fresh.facts = *known;
  } else if (!node.opaque() && ir::componentCount(node.type) <= 4) {
    std::array<Known, 4> real{}, lit{};
    for (size_t k = 0; k < node.count; ++k) {
      const Class& operand = classes_[node.args[k]];
      real[k] = {operand.type, &operand.facts.real};
      lit[k] = {operand.type, &operand.facts.lit};
    }
    fresh.facts.real =
        rangesOf(real_, node, {real.data(), node.count}, constants_, least_lights_, most_lights_);
    fresh.facts.lit =
        rangesOf(math_, node, {lit.data(), node.count}, constants_, least_lights_, most_lights_);
  } else {
    fresh.facts.real.fill(real_.whole(true));
    fresh.facts.lit.fill(math_.whole(true));
  }
  const auto id = static_cast<NodeId>(nodes_.size());
  const auto made = static_cast<Ref>(classes_.size());
  fresh.nodes.push_back(id);
  nodes_.push_back(node);
  class_of_.push_back(made);
  dead_.push_back(false);
  classes_.push_back(std::move(fresh));
  leader_.push_back(made);
  for (size_t k = 0; k < node.count; ++k) {
    std::vector<NodeId>& parents = classes_[node.args[k]].parents;
    if (parents.empty() || parents.back() != id) parents.push_back(id);
  }
  insert(id);
  return made;
}

bool EGraph::merge(Ref a, Ref b) {
  if (a == kNoRef || b == kNoRef) return false;
  a = find(a), b = find(b);
  if (a == b || classes_[a].type != classes_[b].type) return false;
  // The one with more parents stays; of equal ones the earlier.
  if (classes_[a].parents.size() < classes_[b].parents.size() ||
      (classes_[a].parents.size() == classes_[b].parents.size() && b < a))
    std::swap(a, b);
  Class& into = classes_[a];
  Class& from = classes_[b];
  leader_[b] = a;
  into.rate = std::min(into.rate, from.rate);
  if (into.constant == ~uint32_t{0}) into.constant = from.constant;
  if (into.origin == ir::kNoValue || (from.origin != ir::kNoValue && from.origin < into.origin))
    into.origin = from.origin;
  for (size_t c = 0; c < 4; ++c) {
    into.facts.real[c] = meet(into.facts.real[c], from.facts.real[c]);
    into.facts.lit[c] = meet(into.facts.lit[c], from.facts.lit[c]);
  }
  into.nodes.insert(into.nodes.end(), from.nodes.begin(), from.nodes.end());
  into.parents.insert(into.parents.end(), from.parents.begin(), from.parents.end());
  from.nodes = {};
  from.parents = {};
  changed_.push_back(a);
  return true;
}

void EGraph::rebuild() {
  while (!changed_.empty()) {
    std::vector<Ref> todo;
    todo.swap(changed_);
    for (Ref& id : todo) id = find(id);
    std::sort(todo.begin(), todo.end());
    todo.erase(std::unique(todo.begin(), todo.end()), todo.end());
    for (const Ref id : todo) {
      // The lists may change while they are walked.
      std::vector<NodeId> parents = classes_[find(id)].parents;
      std::sort(parents.begin(), parents.end());
      parents.erase(std::unique(parents.begin(), parents.end()), parents.end());
      for (const NodeId parent : parents) {
        if (dead_[parent]) continue;
        const Node now = canonical(nodes_[parent]);
        if (!sameContent(now, nodes_[parent])) {
          const NodeId there = lookup(now);
          if (there != kEmpty && there != parent) {
            dead_[parent] = true;
            merge(class_of_[there], class_of_[parent]);
            continue;
          }
          nodes_[parent] = now;
          insert(parent);
        }
        if (const Ref number = folded(now); number != kNoRef) merge(number, class_of_[parent]);
      }
      std::vector<NodeId> left;
      for (const NodeId parent : parents) {
        if (!dead_[parent]) left.push_back(parent);
      }
      std::vector<NodeId>& stored = classes_[find(id)].parents;
      // What a merge on the way added stays.
      for (const NodeId parent : stored) {
        if (!dead_[parent] && !std::binary_search(parents.begin(), parents.end(), parent))
          left.push_back(parent);
      }
      stored = std::move(left);
    }
  }
  for (Class& each : classes_) {
    std::erase_if(each.nodes, [&](NodeId id) { return dead_[id]; });
    std::sort(each.nodes.begin(), each.nodes.end());
  }
}

}  // namespace lacquer::optimize
