#include "optimize/extract.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace lacquer::optimize {

using ir::Op;
using ir::Rate;

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
/// What an operation counts for beside its cycles, so that of equally fast plans the short one is taken: all
/// of a shader's together are less than one instruction.
constexpr double kNode = 1e-4;
constexpr double kLoad = 1e-3;
constexpr double kGain = 1e-6;

}  // namespace

double planCost(Counter& counter, const Plan& plan, const Constants& constants, const Family& family) {
  const Tally tally = counter.count(plan, constants);
  const double cost = cyclesOf(tally, family) + kLoad * tally[static_cast<size_t>(Count::Loads)];
  return cost + kNode * static_cast<double>(plan.nodes.size());
}

Extractor::Extractor(const EGraph& graph, const ir::Module& module, const Family& family,
                     std::vector<Ref> roots, std::vector<NodeId> start)
    : graph_(graph), family_(family), counter_(module), roots_(std::move(roots)), choice_(std::move(start)) {
  choice_.resize(graph.classCount(), kNoNode);
  own_.resize(graph.nodeCount(), 0);
  for (NodeId id = 0; id < graph.nodeCount(); ++id) {
    if (!graph.live(id)) continue;
    nodes_.push_back(id);
    own_[id] = ownPrice(graph.node(id));
  }
  prices_.resize(graph.classCount());
  price();
  if (!build(choice_, current_)) {
    // Classes that became one have closed a ring: the cheapest nodes have none.
    std::fill(choice_.begin(), choice_.end(), kNoNode);
    price();
    build(choice_, current_);
  }
  current_.cost = planCost(counter_, current_.plan, graph_.constants(), family_);
  choice_.assign(graph.classCount(), kNoNode);
  for (size_t i = 0; i < current_.classes.size(); ++i) choice_[current_.classes[i]] = current_.nodes[i];
  best_ = current_;
}

/// The nodes that a choice reaches from the roots, operands first. False where a class is made of itself.
bool Extractor::build(const std::vector<NodeId>& choice, Selection& into) {
  into.plan.nodes.clear();
  into.plan.origin.clear();
  into.plan.roots.clear();
  into.classes.clear();
  into.nodes.clear();
  // What is marked by an earlier epoch is not marked.
  marks_.resize(graph_.classCount(), {0, 0, kNoRef});
  ++epoch_;
  const auto markOf = [&](Ref id) -> Mark& {
    Mark& mark = marks_[id];
    if (mark.epoch != epoch_) mark = {epoch_, 0, kNoRef};
    return mark;
  };
  std::vector<std::pair<Ref, uint8_t>>& open = open_;
  open.clear();
  for (const Ref root : roots_) {
    open.emplace_back(graph_.find(root), 0);
    while (!open.empty()) {
      const auto [id, next] = open.back();
      Mark& mark = markOf(id);
      if (mark.state == 2) {
        open.pop_back();
        continue;
      }
      const NodeId chosen = this->chosen(choice, id);
      if (chosen == kNoNode) return false;
      const Node& node = graph_.node(chosen);
      if (next == 0) {
        if (mark.state == 1) return false;
        mark.state = 1;
      }
      if (next < node.count) {
        ++open.back().second;
        const Ref operand = graph_.find(node.args[next]);
        const uint8_t state = markOf(operand).state;
        if (state == 1) return false;
        if (state == 0) open.emplace_back(operand, 0);
        continue;
      }
      Node made = node;
      std::array<Rate, 4> rates{};
      for (size_t k = 0; k < made.count; ++k) {
        made.args[k] = marks_[graph_.find(node.args[k])].place;
        rates[k] = into.plan.nodes[made.args[k]].rate;
      }
      if (!made.opaque() && made.count > 0) made.rate = rateOf(made.op, {rates.data(), made.count});
      mark.place = static_cast<Ref>(into.plan.nodes.size());
      into.plan.nodes.push_back(made);
      into.plan.origin.push_back(graph_[id].origin);
      into.classes.push_back(id);
      into.nodes.push_back(chosen);
      mark.state = 2;
      open.pop_back();
    }
    into.plan.roots.push_back(marks_[graph_.find(root)].place);
  }
  return true;
}

/// About what a node adds to a plan.
double Extractor::ownPrice(const Node& node) const {
  if (node.rate <= Rate::Material || node.opaque()) return kNode;
  static constexpr Ops kNothing{Op::Constant, Op::Construct, Op::Swizzle, Op::Neg, Op::Abs};
  static constexpr Ops kRoots{Op::Div, Op::Sqrt, Op::InverseSqrt, Op::Exp2, Op::Log2, Op::Sin, Op::Cos};
  static constexpr Ops kReductions{Op::Dot, Op::Length, Op::Normalize};
  const double width = std::min(ir::componentCount(node.type), 4);
  const double sums = family_.weights[static_cast<size_t>(Count::Sums)];
  const double roots = family_.weights[static_cast<size_t>(Count::Roots)];
  const double times = node.rate == Rate::Light ? 8 : 1;
  double price = sums * width;
  if (kNothing.has(node.op)) price = 0;
  if (kRoots.has(node.op)) price = roots * width;
  if (node.op == Op::Pow) price = (2 * roots + sums) * width;
  if (node.op == Op::Mix || node.op == Op::Cross) price = 2 * sums * width;
  if (kReductions.has(node.op)) price = sums * ir::componentCount(graph_[node.args[0]].type);
  if (node.op == Op::Length || node.op == Op::Normalize) price += roots;
  if (node.op == Op::Normalize) price += sums * width;
  if (node.op == Op::Clamp) price = 0.25 * sums * width;
  if (node.op == Op::Mul && (graph_.isNumber(node.args[0], 2) || graph_.isNumber(node.args[1], 2)))
    price *= 0.25;
  return kNode + times * price;
}

double Extractor::priceOf(const Node& node, double own) const {
  const auto of = [&](size_t k) -> const Price& { return prices_[graph_.find(node.args[k])]; };
  double price = own;
  if (node.op == Op::Add && !node.opaque()) {
    return price +
           std::min({of(0).whole + of(1).whole, of(0).taken + of(1).whole, of(0).whole + of(1).taken});
  }
  for (size_t k = 0; k < node.count; ++k) price += of(k).whole;
  return price;
}

/// What each class would add to the plan, which costs nothing again.
void Extractor::price() {
  for (Price& price : prices_) price = {kNever, kNever, kNoNode};
  for (const Ref id : current_.classes) prices_[id] = {0, 0, choice_[id]};
  constexpr int kSweeps = 12;
  bool changed = true;
  for (int sweep = 0; changed && sweep < kSweeps; ++sweep) {
    changed = false;
    for (const NodeId id : nodes_) {
      const Node& node = graph_.node(id);
      Price& price = prices_[graph_.classOf(id)];
      if (price.whole == 0) continue;
      const double whole = priceOf(node, own_[id]);
      if (whole < price.whole) price.whole = whole, price.node = id, changed = true;
      double taken = kNever;
      if (!node.opaque() && node.op == Op::Mul) taken = whole - own_[id] + kNode;
      if (!node.opaque() && node.op == Op::Neg) taken = prices_[graph_.find(node.args[0])].taken;
      taken = std::min(taken, whole);
      if (taken < price.taken) price.taken = taken, changed = true;
    }
  }
}

bool Extractor::pass(const Effort& effort, const std::function<bool(const Selection&)>& allowed) {
  bool improved = false;
  // From the roots: what is exchanged there frees most.
  std::vector<Ref> classes = current_.classes;
  std::reverse(classes.begin(), classes.end());
  for (const Ref id : classes) {
    if (choice_[id] == kNoNode) continue;  // it left the plan on the way
    const Node& now = graph_.node(choice_[id]);
    double kept = own_[choice_[id]];
    for (const Ref operand : now.operands()) kept += prices_[graph_.find(operand)].whole;
    // A form that is dearer by itself may free others.
    for (const NodeId node : graph_[id].nodes) {
      if (node == choice_[id] || trials_ >= effort.trials) continue;
      if (!(priceOf(graph_.node(node), own_[node]) <= kept + effort.slack)) continue;
      if (!attempt(id, node, current_.cost - kGain, allowed)) continue;
      if (current_.cost < best_.cost - kGain) best_ = current_;
      price();
      improved = true;
      break;
    }
  }
  return improved;
}

/// Exchanges what stands for a class of the current plan, where the new one costs at most `limit`.
bool Extractor::attempt(Ref id, NodeId node, double limit,
                        const std::function<bool(const Selection&)>& allowed) {
  // Classes outside of the plan take what is cheapest now.
  const NodeId before = choice_[id];
  choice_[id] = node;
  ++trials_;
  bool taken = build(choice_, trial_);
  if (taken) trial_.cost = planCost(counter_, trial_.plan, graph_.constants(), family_);
  taken = taken && trial_.cost <= limit && allowed(trial_);
  if (!taken) {
    choice_[id] = before;
    return false;
  }
  for (const Ref each : current_.classes) choice_[each] = kNoNode;
  for (size_t i = 0; i < trial_.classes.size(); ++i) choice_[trial_.classes[i]] = trial_.nodes[i];
  std::swap(current_, trial_);
  return true;
}

void Extractor::improve(const Effort& effort, const std::function<bool(const Selection&)>& allowed) {
  price();
  for (int i = 0; i < effort.passes && trials_ < effort.trials; ++i) {
    if (!pass(effort, allowed)) break;
  }
}

void Extractor::wander(size_t trials, double heat, double slack, uint64_t seed,
                       const std::function<bool(const Selection&)>& allowed) {
  uint64_t state = seed * 2 + 1;
  const auto drawn = [&] {
    state ^= state << 13U;
    state ^= state >> 7U;
    state ^= state << 17U;
    return state;
  };
  const size_t end = trials_ + trials;
  size_t taken = 0;
  for (size_t i = 0; trials_ < end && i < 8 * trials; ++i) {
    const Ref id = current_.classes[drawn() % current_.classes.size()];
    const std::vector<NodeId>& nodes = graph_[id].nodes;
    if (nodes.size() < 2 || graph_[id].rate <= Rate::Material) continue;
    const NodeId node = nodes[drawn() % nodes.size()];
    if (node == choice_[id]) continue;
    if (!(priceOf(graph_.node(node), own_[node]) <=
          slack + priceOf(graph_.node(choice_[id]), own_[choice_[id]])))
      continue;
    // The heat falls to nothing at the end. A half of the steps up is refused for each unit of it.
    const double now = heat * static_cast<double>(end - trials_) / static_cast<double>(trials);
    const double limit = current_.cost + now * std::countl_zero(drawn() | 1U);
    if (!attempt(id, node, limit, allowed)) continue;
    if (current_.cost < best_.cost - kGain) best_ = current_;
    constexpr size_t kStale = 24;
    if (++taken % kStale == 0) price();
  }
}

}  // namespace lacquer::optimize
