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
  const auto paid = std::count_if(plan.nodes.begin(), plan.nodes.end(),
                                  [](const Node& node) { return node.rate > Rate::Material; });
  return cost + kNode * static_cast<double>(paid);
}

Extractor::Extractor(const EGraph& graph, const ir::Module& module, const Family& family,
                     std::vector<Ref> roots, std::vector<NodeId> start)
    : graph_(graph), family_(family), counter_(module), roots_(std::move(roots)), choice_(std::move(start)) {
  choice_.resize(graph.classCount(), kNoNode);
  for (Ref& root : roots_) root = graph.find(root);
  own_.resize(graph.nodeCount(), 0);
  home_.resize(graph.nodeCount(), kNoRef);
  for (NodeId id = 0; id < graph.nodeCount(); ++id) {
    if (!graph.live(id)) continue;
    nodes_.push_back(id);
    own_[id] = ownPrice(graph.node(id));
    home_[id] = graph.classOf(id);
  }
  prices_.resize(graph.classCount());
  price();
  if (!build(true, current_)) {
    // Classes that became one have closed a ring: the cheapest nodes have none.
    std::fill(choice_.begin(), choice_.end(), kNoNode);
    price();
    build(true, current_);
  }
  current_.cost = planCost(counter_, current_.plan, graph_.constants(), family_);
  choice_.assign(graph.classCount(), kNoNode);
  for (size_t i = 0; i < current_.classes.size(); ++i) choice_[current_.classes[i]] = current_.nodes[i];
  best_ = current_;
}

/// The nodes that the choice reaches from the roots, operands first, or of those that cost something: what is
/// of the material's rate is made of nothing then. False where a class is made of itself.
bool Extractor::build(bool whole, Selection& into) {
  Plan& plan = into.plan;
  plan.nodes.clear();
  plan.origin.clear();
  plan.roots.clear();
  into.classes.clear();
  into.nodes.clear();
  // What is marked by an earlier epoch is not marked.
  marks_.resize(graph_.classCount(), {0, 0, 0, kNoRef});
  ++epoch_;
  open_.clear();
  const auto visit = [&](Ref id) {
    Mark& mark = marks_[id];
    if (mark.epoch == epoch_) return mark.state == 2;
    mark = {epoch_, 1, 0, kNoRef};
    open_.push_back(id);
    return true;
  };
  for (const Ref root : roots_) {
    visit(root);
    while (!open_.empty()) {
      const Ref id = open_.back();
      Mark& mark = marks_[id];
      const NodeId chosen = this->chosen(id);
      if (chosen == kNoNode) return false;
      const Node& node = graph_.node(chosen);
      const uint8_t count = whole || node.rate > Rate::Material ? node.count : 0;
      if (mark.next < count) {
        if (!visit(node.args[mark.next++])) return false;
        continue;
      }
      Node& made = plan.nodes.emplace_back(node);
      made.count = count;
      Rate rate = Rate::Constant;
      for (size_t k = 0; k < count; ++k) {
        const Ref place = marks_[node.args[k]].place;
        made.args[k] = place;
        rate = std::max(rate, plan.nodes[place].rate);
      }
      if (!made.opaque() && count > 0) made.rate = made.op == Op::SumOverLights ? Rate::Fragment : rate;
      mark.place = static_cast<Ref>(plan.nodes.size() - 1);
      mark.state = 2;
      if (whole) plan.origin.push_back(graph_[id].origin);
      into.classes.push_back(id);
      into.nodes.push_back(chosen);
      open_.pop_back();
    }
    plan.roots.push_back(marks_[root].place);
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
  const double sums = cyclesOf(Count::Sums, family_);
  const double roots = cyclesOf(Count::Roots, family_);
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
  const auto of = [&](size_t k) -> const Price& { return prices_[node.args[k]]; };
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
      Price& price = prices_[home_[id]];
      if (price.whole == 0) continue;
      const double whole = priceOf(node, own_[id]);
      if (whole < price.whole) price.whole = whole, price.node = id, changed = true;
      double taken = kNever;
      if (!node.opaque() && node.op == Op::Mul) taken = whole - own_[id] + kNode;
      if (!node.opaque() && node.op == Op::Neg) taken = prices_[node.args[0]].taken;
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
    for (const Ref operand : now.operands()) kept += prices_[operand].whole;
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
  bool taken = true;
  // What does not pay without the material's part does not with it.
  for (const bool whole : {false, true}) {
    taken = taken && build(whole, trial_);
    if (taken) trial_.cost = planCost(counter_, trial_.plan, graph_.constants(), family_);
    taken = taken && trial_.cost <= limit;
  }
  taken = taken && allowed(trial_);
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
