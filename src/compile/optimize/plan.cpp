#include "optimize/plan.h"

#include <algorithm>
#include <cassert>
#include <tuple>

#include "ir/facts.h"
#include "ir/loops.h"

namespace lacquer::optimize {

using ir::Op;
using ir::Type;
using ir::ValueId;

uint32_t Constants::place(Type type, const ir::Components& value) {
  ir::Components key{};
  // +0 and -0 are one number, as in the Dag.
  for (size_t c = 0; c < static_cast<size_t>(ir::componentCount(type)) && c < key.size(); ++c)
    key[c] = value[c] == 0 ? 0 : value[c];
  const auto [at, fresh] = places_.try_emplace(key, static_cast<uint32_t>(all_.size()));
  if (fresh) all_.push_back(key);
  return at->second;
}

bool commutes(Op op) {
  static constexpr Ops kThese{Op::Add, Op::Mul, Op::Min, Op::Max, Op::Dot};
  return kThese.has(op);
}

bool algebraic(Op op) {
  // A list and no switch: an operation that is new is none of them until rules for it are written.
  static constexpr Ops kThese{Op::Constant, Op::Neg,    Op::Abs,    Op::Sqrt,      Op::InverseSqrt,
                              Op::Exp2,     Op::Log2,   Op::Exp,    Op::Log,       Op::Sin,
                              Op::Cos,      Op::Add,    Op::Sub,    Op::Mul,       Op::Div,
                              Op::Min,      Op::Max,    Op::Pow,    Op::Mix,       Op::Clamp,
                              Op::Dot,      Op::Cross,  Op::Length, Op::Normalize, Op::Construct,
                              Op::Swizzle,  Op::Select, Op::Less,   Op::LessEqual, Op::SumOverLights};
  return kThese.has(op);
}

ir::Rate rateOf(Op op, std::span<const ir::Rate> operands) {
  ir::Rate rate = ir::Rate::Constant;
  for (const ir::Rate operand : operands) rate = std::max(rate, operand);
  return op == Op::SumOverLights ? ir::Rate::Fragment : rate;
}

std::vector<uint64_t> loopsAround(const ir::Dag& dag, const Plan& plan) {
  if (!dag.hasLoops()) return {};
  std::vector<uint64_t> around(plan.nodes.size(), 0);
  std::vector<uint32_t> numbers;
  const auto bitOf = [&](ValueId input) {
    const uint32_t number = dag.inputOf(input).field;
    auto at = std::find(numbers.begin(), numbers.end(), number);
    if (at == numbers.end()) at = numbers.insert(at, number);
    return at - numbers.begin() < 64 ? uint64_t{1} << (at - numbers.begin()) : 0;
  };
  for (Ref at = 0; at < plan.nodes.size(); ++at) {
    const Node& node = plan.nodes[at];
    for (const Ref operand : node.operands()) around[at] |= around[operand];
    if (!node.opaque()) continue;
    if (node.op == Op::Input && ir::ofLoop(dag.inputOf(node.source).kind)) around[at] = bitOf(node.source);
    if (node.op == Op::Carried) around[at] &= ~bitOf(ir::loopOf(dag, dag[node.source].args[0]).index);
  }
  return around;
}

namespace {

class Import {
public:
  Import(const ir::Module& module, Constants& constants)
      : dag_(module.dag), constants_(constants), place_(module.dag.size(), kNoRef) {
    for (const ir::Output& output : module.outputs) {
      if (output.stage == ir::Stage::Fragment) outputs_.push_back(output.value);
    }
  }

  Plan run() {
    markLive();
    for (ValueId id = 0; id < dag_.size(); ++id) {
      if (live_[id]) place_[id] = import(id);
    }
    for (const ValueId output : outputs_) plan_.roots.push_back(place_[output]);
    return std::move(plan_);
  }

private:
  /// What the outputs reach; an Interpolate is a leaf.
  void markLive() {
    live_.assign(dag_.size(), false);
    for (const ValueId output : outputs_) live_[output] = true;
    for (size_t id = dag_.size(); id-- > 0;) {
      if (!live_[id] || dag_[static_cast<ValueId>(id)].op == Op::Interpolate) continue;
      for (const ValueId operand : dag_[static_cast<ValueId>(id)].operands()) live_[operand] = true;
    }
  }

  bool known(const ir::Value& value) const {
    const auto fits = [&](Type type) { return ir::isFloating(type) || type == Type::Bool; };
    if (!algebraic(value.op) || !fits(value.type)) return false;
    if (value.op == Op::SumOverLights && value.count != 1) return false;
    return std::all_of(value.operands().begin(), value.operands().end(),
                       [&](ValueId operand) { return fits(dag_[operand].type); });
  }

  Ref add(const Node& node, ValueId origin) {
    plan_.nodes.push_back(node);
    plan_.origin.push_back(origin);
    return static_cast<Ref>(plan_.nodes.size() - 1);
  }

  Ref make(Op op, Type type, std::initializer_list<Ref> args, ValueId origin, uint32_t payload = 0) {
    Node node{op, type, ir::Rate::Constant, static_cast<uint8_t>(args.size()), payload, {}, ir::kNoValue};
    std::array<ir::Rate, 4> rates{};
    std::copy(args.begin(), args.end(), node.args.begin());
    for (size_t k = 0; k < node.count; ++k) rates[k] = plan_.nodes[node.args[k]].rate;
    node.rate = rateOf(op, {rates.data(), node.count});
    return add(node, origin);
  }

  Ref number(Type type, ir::Components components, ValueId origin = ir::kNoValue) {
    const uint32_t place = constants_.place(type, components);
    const auto [at, fresh] = numbers_.try_emplace({type, place}, kNoRef);
    if (fresh) at->second = add({Op::Constant, type, ir::Rate::Constant, 0, place, {}, ir::kNoValue}, origin);
    return at->second;
  }

  /// A constant as something else of it; kNoRef where the value is none.
  template <class Map>
  Ref mapped(ValueId id, Map map) {
    if (!dag_.isConstant(id)) return kNoRef;
    ir::Components components = dag_.constantOf(id);
    for (int c = 0; c < ir::componentCount(dag_[id].type); ++c)
      components[static_cast<size_t>(c)] = map(components[static_cast<size_t>(c)]);
    return number(dag_[id].type, components);
  }

  Ref negated(ValueId id) {
    const Ref constant = mapped(id, [](double x) { return -x; });
    return constant != kNoRef ? constant : once(Op::Neg, id, ir::kNoValue);
  }

  Ref reciprocal(ValueId id, ValueId origin) {
    bool zero = false;
    const Ref constant = mapped(id, [&](double x) {
      zero |= x == 0;
      return 1 / x;
    });
    if (constant != kNoRef && !zero) return constant;
    return once(Op::Div, id, origin);
  }

  /// What the sums and products that are taken apart share.
  Ref once(Op op, ValueId id, ValueId origin) {
    const auto [at, fresh] = made_.try_emplace({op, id}, kNoRef);
    if (fresh) at->second = make(op, dag_[id].type, {place_[id]}, origin);
    return at->second;
  }

  Ref import(ValueId id) {
    const ir::Value& value = dag_[id];
    Node node{value.op, value.type, value.rate, 0, value.payload, {}, ir::kNoValue};
    if (value.op == Op::Constant) {
      return number(value.type, dag_.constantOf(id), id);
    }
    if (value.op != Op::Interpolate) {
      node.count = value.count;
      for (size_t k = 0; k < value.count; ++k) node.args[k] = place_[value.args[k]];
    }
    if (!known(value)) {
      node.source = id;
      return add(node, id);
    }
    if (value.op == Op::Neg && !dag_.isConstant(value.args[0])) return once(Op::Neg, value.args[0], id);
    if (value.op == Op::Sub) {
      const Ref minus = negated(value.args[1]);
      return make(Op::Add, value.type, {node.args[0], minus}, id);
    }
    if (value.op == Op::Div && dag_.isConstant(value.args[0], 1) && dag_[value.args[1]].type == value.type)
      return reciprocal(value.args[1], id);
    if (value.op == Op::Div) {
      const Ref inverse = reciprocal(value.args[1], ir::kNoValue);
      return make(Op::Mul, value.type, {node.args[0], inverse}, id);
    }
    return add(node, id);
  }

  const ir::Dag& dag_;
  Constants& constants_;
  std::vector<ValueId> outputs_;
  std::vector<bool> live_;
  std::vector<Ref> place_;
  std::map<std::pair<Type, uint32_t>, Ref> numbers_;
  std::map<std::pair<Op, ValueId>, Ref> made_;
  Plan plan_;
};

/// Makes the values of a plan in the module's Dag.
class Export {
public:
  Export(ir::Module& module, const Plan& plan, const Constants& constants)
      : module_(module), dag_(module.dag), plan_(plan), constants_(constants) {
    uses_.assign(plan.nodes.size(), 0);
    for (const Node& node : plan.nodes) {
      for (const Ref operand : node.operands()) ++uses_[operand];
    }
    for (const Ref root : plan.roots) ++uses_[root];
    around_ = loopsAround(dag_, plan);
  }

  void run() {
    place();
    findKept();
    made_.assign(plan_.nodes.size(), ir::kNoValue);
    for (Ref at = 0; at < plan_.nodes.size(); ++at) {
      if (kept_[at] != ir::kNoValue) {
        made_[at] = kept_[at];
        continue;
      }
      const ValueId home = home_[at];
      dag_.setTerm(home == ir::kNoValue ? 0 : dag_.termOf(home));
      dag_.setRank(home == ir::kNoValue ? ir::Dag::kOwnRank : dag_.rankOf(home));
      made_[at] = make(at);
      const ValueId origin = plan_.origin[at];
      const bool off = !plan_.off.empty() && plan_.off[at];
      if (origin != ir::kNoValue && made_[at] != origin && off) dag_.name(made_[at], dag_.nameOf(origin));
      if (origin != ir::kNoValue && made_[at] != origin && !off) dag_.inherit(made_[at], origin);
      if (const auto proved = plan_.proved.find(at); proved != plan_.proved.end())
        dag_.assume(made_[at], proved->second);
    }
    dag_.setTerm(0);
    dag_.setRank(ir::Dag::kOwnRank);
    size_t next = 0;
    for (ir::Output& output : module_.outputs) {
      if (output.stage == ir::Stage::Fragment) output.value = made_[plan_.roots[next++]];
    }
    ir::compact(module_);
  }

private:
  /// What is made as it was stays the value that it was, whatever a plan calls its operations.
  void findKept() {
    Constants same = constants_;
    const Plan before = planOf(module_, same);
    const auto keyOf = [](const Node& node, const std::array<Ref, 4>& args) {
      std::array<Ref, 4> sorted = args;
      if (!node.opaque() && commutes(node.op) && sorted[0] > sorted[1]) std::swap(sorted[0], sorted[1]);
      return std::tuple(node.op, node.type, node.payload, node.source, node.count, sorted);
    };
    std::map<decltype(keyOf(Node(), {})), Ref> there;
    for (Ref at = 0; at < before.nodes.size(); ++at)
      there.emplace(keyOf(before.nodes[at], before.nodes[at].args), at);
    std::vector<Ref> known(plan_.nodes.size(), kNoRef);
    kept_.assign(plan_.nodes.size(), ir::kNoValue);
    for (Ref at = 0; at < plan_.nodes.size(); ++at) {
      const Node& node = plan_.nodes[at];
      std::array<Ref, 4> args{};
      bool all = true;
      for (size_t k = 0; k < node.count; ++k) {
        args[k] = known[node.args[k]];
        all = all && args[k] != kNoRef;
      }
      const auto found = all ? there.find(keyOf(node, args)) : there.end();
      if (found == there.end()) continue;
      known[at] = found->second;
      kept_[at] = before.origin[found->second];
    }
  }

  /// Where each value belongs: where the one that it equals stood, or else where it is read first.
  void place() {
    home_ = plan_.origin;
    const auto earlier = [&](ValueId a, ValueId b) {
      if (a == ir::kNoValue) return b;
      return b == ir::kNoValue || dag_.rankOf(a) <= dag_.rankOf(b) ? a : b;
    };
    std::vector<ValueId> asked(plan_.nodes.size(), ir::kNoValue);
    for (size_t at = plan_.nodes.size(); at-- > 0;) {
      if (home_[at] == ir::kNoValue) home_[at] = asked[at];
      for (const Ref operand : plan_.nodes[at].operands())
        asked[operand] = earlier(asked[operand], home_[at]);
    }
  }

  ValueId splat(Type type, ValueId id) { return dag_[id].type == type ? id : dag_.construct(type, {id}); }

  ValueId make(Ref at) {
    const Node& node = plan_.nodes[at];
    std::array<ValueId, 4> args{};
    for (size_t k = 0; k < node.count; ++k) args[k] = made_[node.args[k]];
    const std::span<const ValueId> operands(args.data(), node.count);
    if (node.opaque()) {
      if (dag_[node.source].op == Op::Interpolate) return node.source;
      return dag_.remake(node.source, operands);
    }
    if (node.op == Op::Constant) return dag_.constant(node.type, constants_[node.payload]);
    if (node.op == Op::Add) return splat(node.type, sum(node));
    if (node.op == Op::Mul) return splat(node.type, product(at));
    if (node.op == Op::Div) return splat(node.type, dag_.div(dag_.constant(1), args[0]));
    if (node.op == Op::Construct) return dag_.construct(node.type, operands);
    if (node.op == Op::Swizzle) {
      std::array<int, 4> picks{};
      const int width = ir::componentCount(node.type);
      for (int c = 0; c < width; ++c) picks[static_cast<size_t>(c)] = ir::swizzleComponent(node.payload, c);
      return dag_.swizzle(args[0], {picks.data(), static_cast<size_t>(width)});
    }
    const uint32_t payload = node.op == Op::SumOverLights ? node.payload : 0;
    return splat(node.type, dag_.make(node.op, operands, payload));
  }

  bool negation(Ref at) const { return plan_.nodes[at].op == Op::Neg && !plan_.nodes[at].opaque(); }

  /// a + -b is a - b again.
  ValueId sum(const Node& node) {
    for (const size_t k : {size_t{1}, size_t{0}}) {
      const Ref operand = node.args[k];
      if (negation(operand)) return dag_.sub(made_[node.args[1 - k]], made_[plan_.nodes[operand].args[0]]);
    }
    for (const size_t k : {size_t{1}, size_t{0}}) {
      const Node& operand = plan_.nodes[node.args[k]];
      if (operand.op == Op::Constant && operand.type == Type::Float && constants_[operand.payload][0] < 0)
        return dag_.sub(made_[node.args[1 - k]], dag_.constant(-constants_[operand.payload][0]));
    }
    return dag_.add(made_[node.args[0]], made_[node.args[1]]);
  }

  /// A reciprocal that nothing else reads is a division. The preshader's are products for the GPU.
  ValueId product(Ref at) {
    const Node& node = plan_.nodes[at];
    for (const size_t k : {size_t{1}, size_t{0}}) {
      const Node& operand = plan_.nodes[node.args[k]];
      const bool reciprocal = operand.op == Op::Div && uses_[node.args[k]] == 1;
      if (!reciprocal || (operand.rate <= ir::Rate::Material && node.rate > ir::Rate::Material)) continue;
      // Out of a loop it is computed once.
      if (operand.rate != node.rate && node.rate == ir::Rate::Light) continue;
      if (!around_.empty() && around_[node.args[k]] != around_[at]) continue;
      return dag_.div(made_[node.args[1 - k]], made_[operand.args[0]]);
    }
    return dag_.mul(made_[node.args[0]], made_[node.args[1]]);
  }

  ir::Module& module_;
  ir::Dag& dag_;
  const Plan& plan_;
  const Constants& constants_;
  std::vector<ValueId> home_, made_;
  std::vector<ValueId> kept_;  ///< of a node that is made as it was: that value
  std::vector<int> uses_;
  std::vector<uint64_t> around_;
};

}  // namespace

Plan planOf(const ir::Module& module, Constants& constants) { return Import(module, constants).run(); }

void replaceFragment(ir::Module& module, const Plan& plan, const Constants& constants) {
  Export(module, plan, constants).run();
}

}  // namespace lacquer::optimize
