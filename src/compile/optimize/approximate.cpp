#include "optimize/approximate.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "optimize/extract.h"
#include "optimize/facts.h"
#include "optimize/fit.h"
#include "optimize/rounding.h"

namespace lacquer::optimize {

namespace {

using ir::Op;
using ir::Rate;

constexpr int kMostRounds = 16;
/// Functions that are tried in a round, those first that may save most.
constexpr size_t kMostTried = 24;
/// Cycles that an approximation saves at least.
constexpr double kLeastSaving = 0.9;

/// Cycles that a quotient saves beside a polynomial, at least.
constexpr double kCheaperForm = 0.5;

/// In the order of what they cost.
constexpr Shape kPolynomials[] = {{2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}, {6, 0, 0}, {7, 0, 0}};
constexpr Shape kQuotients[] = {{0, 0, 1}, {0, 0, 2}, {1, 0, 1}, {2, 0, 1}, {0, 1, 2}, {1, 1, 2}};

/// A plan that differs from the module's by approximations.
struct State {
  Found found;
  std::vector<double> own;  ///< of each node: what it is off beside what its operands are
};

/// What stands for a node: a function of another one.
struct Change {
  Ref at = kNoRef, variable = kNoRef;
  Fit fit;
  bool clamped = false;  ///< to [0, 1]
  double error = 0;      ///< of the outputs with it
  double cost = 0;
};

class Approximation {
public:
  Approximation(const ir::Module& module, const Family& family, double error, bool quotients)
      : module_(module),
        family_(family),
        most_(error),
        quotients_(quotients),
        counter_(module),
        proved_(module),
        faults_(ir::verify(module).size()) {
    Plain plain = plainOf(module, constants_);
    least_lights_ = plain.least_lights;
    most_lights_ = plain.most_lights;
    state_.found = std::move(plain.found);
    state_.own.assign(state_.found.plan.nodes.size(), 0);
  }

  std::optional<Approximated> run() {
    Approximated made;
    for (int round = 0; round < kMostRounds; ++round) {
      std::vector<Change> changes = this->changes();
      // What saves most, of equals what is off least.
      std::stable_sort(changes.begin(), changes.end(),
                       [&](const Change& a, const Change& b) { return worth(a) < worth(b); });
      bool taken = false;
      for (const Change& change : changes) {
        State next = changed(state_, change);
        ir::Module module = module_;
        replaceFragment(module, next.found.plan, constants_);
        if (ir::verify(module).size() > faults_ || !Proved(module).keeps(proved_)) {
          refused_.insert(keyOf(change.at));
          continue;
        }
        state_ = std::move(next);
        divides_ |= !change.fit.divisor.empty();
        made = {std::move(module), change.error, change.cost, made.count + 1};
        taken = true;
        break;
      }
      if (!taken) break;
    }
    if (made.count == 0) return std::nullopt;
    return made;
  }

  /// Whether what was made has a quotient.
  bool divides() const { return divides_; }

private:
  const Plan& plan() const { return state_.found.plan; }
  double costOf(const Plan& plan) { return planCost(counter_, plan, constants_, family_); }

  /// The cost, with what is spent of the error as a part of what is saved.
  double worth(const Change& change) const { return change.cost + 4 * change.error / most_; }

  bool off(Ref at) const { return !plan().off.empty() && plan().off[at]; }

  /// What names a node in all rounds.
  std::pair<ir::ValueId, int> keyOf(Ref at) const {
    return {plan().origin[at], static_cast<int>(plan().nodes[at].op)};
  }

  bool candidate(Ref at) const {
    const Node& node = plan().nodes[at];
    const bool number = node.type == ir::Type::Float || ir::isFloatVector(node.type);
    return node.rate > Rate::Material && !node.opaque() && number && node.count > 0 &&
           plan().origin[at] != ir::kNoValue && state_.own[at] == 0 && refused_.count(keyOf(at)) == 0;
  }

  std::vector<Change> changes() {
    std::vector<Change> all;
    const double now = costOf(plan());
    std::vector<double> bare(plan().nodes.size(), now);
    for (Ref at = 0; at < plan().nodes.size(); ++at) {
      if (!candidate(at)) continue;
      Change change;
      change.at = at;
      change.fit.coefficients = {ir::Components{}};
      bare[at] = costOf(changed(state_, change).found.plan);
      if (now - bare[at] < kLeastSaving) continue;
      constant(change, all);
    }
    std::vector<Pair> pairs;
    for (Ref x = 0; x < plan().nodes.size(); ++x) collect(x, now, bare, pairs);
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& a, const Pair& b) { return a.cost < b.cost; });
    double best = now;
    for (const Change& change : all) best = std::min(best, change.cost);
    size_t tried = 0;
    for (const Pair& pair : pairs) {
      // None of those behind it saves more than what is there.
      if (pair.cost > best || tried++ >= kMostTried) break;
      const size_t before = all.size();
      forms(pair.x, pair.at, all);
      if (all.size() == before)
        hopeless_.insert({plan().origin[pair.x], plan().origin[pair.at]});
      else
        best = std::min(best, all.back().cost);
    }
    return all;
  }

  /// What hardly changes.
  void constant(Change change, std::vector<Change>& all) {
    const Ranges& real = state_.found.facts[change.at].real;
    ir::Components middle{};
    double off = 0;
    for (size_t c = 0; c < 4; ++c) {
      if (!real[c].finite()) return;
      middle[c] = static_cast<double>(static_cast<float>((real[c].lo + real[c].hi) / 2));
      off = std::max({off, real[c].hi - middle[c], middle[c] - real[c].lo});
    }
    change.fit.coefficients = {middle};
    change.fit.error = off;
    change.fit.reached = {middle[0], middle[0], false};
    for (const double x : middle) change.fit.reached = hull(change.fit.reached, Range{x, x, false});
    add(std::move(change), all);
  }

  void add(Change change, std::vector<Change>& all) {
    const State next = changed(state_, change);
    change.error = errorOfOutputs(next.found.plan, next.found.facts, constants_, most_lights_, next.own);
    if (!(change.error <= most_)) return;
    change.cost = costOf(next.found.plan);
    if (change.cost > costOf(plan()) - kLeastSaving) return;
    all.push_back(std::move(change));
  }

  /// A node that is a function of another one alone, and what the plan costs at least with a polynomial.
  struct Pair {
    Ref x, at;
    double cost;
  };

  Range domainOf(Ref x) const {
    const Facts& facts = state_.found.facts[x];
    return hull(facts.real[0], facts.lit[0]);
  }

  void collect(Ref x, double now, const std::vector<double>& bare, std::vector<Pair>& pairs) const {
    const Node& variable = plan().nodes[x];
    // What is known of a value that is off is known of what it stands for.
    if (variable.type != ir::Type::Float || variable.rate <= Rate::Material || off(x)) return;
    const Range domain = domainOf(x);
    if (!domain.finite() || domain.nan || !(domain.hi > domain.lo) || domain.hi - domain.lo > 1e4) return;
    std::vector<bool> in(plan().nodes.size(), false);
    for (Ref at = x + 1; at < plan().nodes.size(); ++at) {
      const Node& node = plan().nodes[at];
      if (node.opaque() || off(at) || node.count == 0 || node.op == Op::SumOverLights ||
          !ir::isFloating(node.type) || ir::componentCount(node.type) > 4)
        continue;
      bool reads = false;
      bool only = true;
      for (const Ref operand : node.operands()) {
        const bool inside = operand == x || in[operand];
        reads |= inside;
        only = only && (inside || plan().nodes[operand].op == Op::Constant);
      }
      if (!reads || !only) continue;
      in[at] = true;
      // A sum and a product at least.
      const double least = bare[at] + cyclesOf(Count::Sums, family_);
      if (!candidate(at) || now - least < kLeastSaving ||
          hopeless_.count({plan().origin[x], plan().origin[at]}) != 0)
        continue;
      pairs.push_back({x, at, least});
    }
  }

  /// Those nodes between that a node is made of.
  std::vector<Ref> needed(Ref at, Ref x) const {
    std::vector<bool> in(at + size_t{1}, false);
    in[at] = true;
    std::vector<Ref> nodes;
    for (Ref id = at; id > x; --id) {
      if (!in[id]) continue;
      nodes.push_back(id);
      for (const Ref operand : plan().nodes[id].operands()) {
        if (operand != x && plan().nodes[operand].op != Op::Constant) in[operand] = true;
      }
    }
    std::reverse(nodes.begin(), nodes.end());
    return nodes;
  }

  /// What is known of a function, which forms of it must keep to.
  struct Kept {
    bool unit, positive;
  };

  void forms(Ref x, Ref at, std::vector<Change>& all) {
    Curve curve(plan(), constants_, x, needed(at, x));
    const Ranges& real = state_.found.facts[at].real;
    const auto width = static_cast<size_t>(curve.width());
    const auto every = [&](auto holds) {
      return std::all_of(real.begin(), real.begin() + static_cast<ptrdiff_t>(width), holds);
    };
    const Kept kept{every([](const Range& r) { return r.lo >= 0 && r.hi <= 1; }),
                    every([](const Range& r) { return r.lo >= 0; })};
    // The cheapest polynomial that keeps to the error, and a quotient where one is cheaper still.
    const size_t before = all.size();
    for (const std::span<const Shape> shapes :
         {std::span<const Shape>(kPolynomials), std::span<const Shape>(kQuotients)}) {
      for (const Shape& shape : shapes) {
        if (shape.divisor > 0 && !quotients_) continue;
        const double limit =
            all.size() > before ? all.back().cost - kCheaperForm : costOf(plan()) - kLeastSaving;
        Change change;
        change.at = at;
        change.variable = x;
        // Powers that are not there cost nothing, and signs are free: these show what the sums take.
        constexpr ir::Components kSome{0.75, 0.75, 0.75, 0.75};
        change.fit.coefficients.assign(shape.terms, kSome);
        if (shape.divisor > 0) {
          change.fit.dividend.assign(shape.dividend + 1, kSome);
          change.fit.dividend.back() = {1, 1, 1, 1};
          change.fit.divisor.assign(shape.divisor + 1, kSome);
          change.fit.divided = {0.5, 2, false};
        }
        if (costOf(changed(state_, change).found.plan) > limit) continue;
        if (form(curve, shape, std::move(change), kept, all)) break;
      }
    }
  }

  /// Adds a form of that shape where it keeps to the error.
  bool form(Curve& curve, const Shape& shape, Change change, const Kept& kept, std::vector<Change>& all) {
    const Range domain = domainOf(change.variable);
    change.fit.error = sampledError(curve, domain, shape);
    const State next = changed(state_, change);
    if (!(errorOfOutputs(next.found.plan, next.found.facts, constants_, most_lights_, next.own) <= most_))
      return false;
    const std::optional<double> least = kept.positive ? std::optional<double>(0) : std::nullopt;
    std::optional<Fit> made = fit(curve, domain, shape, 1.2 * change.fit.error + 0x1p-20, std::nullopt);
    if (!made) return false;
    if (made->reached.lo < 0 && kept.positive) {
      change.clamped = kept.unit;
      if (!kept.unit) made = fit(curve, domain, shape, 4 * change.fit.error + 0x1p-18, least);
      if (!made) return false;
    }
    if (kept.unit && made->reached.hi > 1) change.clamped = true;
    change.fit = std::move(*made);
    const size_t before = all.size();
    add(std::move(change), all);
    return all.size() > before;
  }

  /// A state with a change.
  State changed(const State& from, const Change& change) const {
    Rebuild build(*this, from);
    return build.run(change);
  }

  class Rebuild {
  public:
    Rebuild(const Approximation& of, const State& from) : of_(of), from_(from) {}

    State run(const Change& change) {
      const Plan& plan = from_.found.plan;
      markLive(change);
      place_.assign(plan.nodes.size(), kNoRef);
      for (Ref at = 0; at < plan.nodes.size(); ++at) {
        if (!live_[at]) continue;
        if (at == change.at) {
          approximation(change);
          continue;
        }
        Node node = plan.nodes[at];
        bool off = from_.own[at] > 0;
        for (size_t k = 0; k < node.count; ++k) {
          node.args[k] = place_[node.args[k]];
          off = off || to_.found.plan.off[node.args[k]];
        }
        place_[at] = push(node, from_.found.facts[at], plan.origin[at], from_.own[at], off);
        if (const auto there = plan.proved.find(at); there != plan.proved.end())
          to_.found.plan.proved[place_[at]] = there->second;
      }
      for (const Ref root : plan.roots) to_.found.plan.roots.push_back(place_[root]);
      return std::move(to_);
    }

  private:
    void markLive(const Change& change) {
      const Plan& plan = from_.found.plan;
      live_.assign(plan.nodes.size(), false);
      for (const Ref root : plan.roots) live_[root] = true;
      for (size_t at = plan.nodes.size(); at-- > 0;) {
        if (!live_[at]) continue;
        if (at == change.at) {
          if (change.variable != kNoRef) live_[change.variable] = true;
          continue;
        }
        for (const Ref operand : plan.nodes[at].operands()) live_[operand] = true;
      }
    }

    Ref push(const Node& node, const Facts& facts, ir::ValueId origin, double own, bool off) {
      to_.found.plan.nodes.push_back(node);
      to_.found.plan.origin.push_back(origin);
      to_.found.plan.off.push_back(off);
      to_.found.facts.push_back(facts);
      to_.found.known.push_back(true);
      to_.own.push_back(own);
      return static_cast<Ref>(to_.found.plan.nodes.size() - 1);
    }

    Ref number(ir::Type type, const ir::Components& components) {
      const Node node{Op::Constant, type,        Rate::Constant, 0, of_.constants_.place(type, components),
                      {},           ir::kNoValue};
      return push(node, factsOf(node), ir::kNoValue, 0, false);
    }

    Facts factsOf(const Node& node) const {
      static const analysis::RangeMath kReal(analysis::Arithmetic::Real),
          kFloat(analysis::Arithmetic::Vulkan);
      std::array<Known, 4> real{}, lit{};
      for (size_t k = 0; k < node.count; ++k) {
        const ir::Type type = to_.found.plan.nodes[node.args[k]].type;
        real[k] = {type, &to_.found.facts[node.args[k]].real};
        lit[k] = {type, &to_.found.facts[node.args[k]].lit};
      }
      return {rangesOf(kReal, node, {real.data(), node.count}, of_.constants_, of_.least_lights_,
                       of_.most_lights_),
              rangesOf(kFloat, node, {lit.data(), node.count}, of_.constants_, of_.least_lights_,
                       of_.most_lights_)};
    }

    Ref operation(Op op, ir::Type type, std::initializer_list<Ref> operands) {
      Node node{op, type, Rate::Constant, static_cast<uint8_t>(operands.size()), 0, {}, ir::kNoValue};
      std::copy(operands.begin(), operands.end(), node.args.begin());
      bool off = false;
      for (const Ref operand : operands) {
        node.rate = std::max(node.rate, to_.found.plan.nodes[operand].rate);
        off = off || to_.found.plan.off[operand];
      }
      return push(node, factsOf(node), ir::kNoValue, 0, off);
    }

    /// By Horner. A last number that is 1 is no product.
    Ref horner(ir::Type type, const std::vector<ir::Components>& powers, Ref variable) {
      const bool one = powers.size() > 1 && powers.back() == ir::Components{1, 1, 1, 1};
      Ref sum = one ? variable : number(type, powers.back());
      for (size_t k = powers.size() - 1; k-- > 0;) {
        if (!one || k + 2 < powers.size()) sum = operation(Op::Mul, type, {sum, variable});
        sum = operation(Op::Add, type, {sum, number(type, powers[k])});
      }
      return sum;
    }

    /// The quotient of a form, whose divisor has the facts that are proved.
    Ref quotient(ir::Type type, const Fit& fit, Ref variable) {
      const Ref divisor = horner(type, fit.divisor, variable);
      to_.found.plan.proved[divisor] = {fit.divided.lo, fit.divided.hi};
      Facts& facts = to_.found.facts[divisor];
      for (size_t c = 0; c < 4; ++c) {
        facts.real[c] = fit.divided;
        facts.lit[c] = fit.divided;
      }
      const Ref reciprocal = operation(Op::Div, type, {divisor});
      if (fit.dividend.size() == 1) return reciprocal;
      return operation(Op::Mul, type, {horner(type, fit.dividend, variable), reciprocal});
    }

    /// What stands for the node has the facts of what it is nearly equal to.
    void approximation(const Change& change) {
      const Node& node = from_.found.plan.nodes[change.at];
      const Fit& fit = change.fit;
      const Ref variable = change.variable == kNoRef ? kNoRef : place_[change.variable];
      Ref sum = fit.coefficients.empty() ? kNoRef : horner(node.type, fit.coefficients, variable);
      if (!fit.divisor.empty()) {
        const Ref ratio = quotient(node.type, fit, variable);
        sum = sum == kNoRef ? ratio : operation(Op::Add, node.type, {ratio, sum});
      }
      ir::Interval reached{fit.reached.lo, fit.reached.hi};
      if (change.clamped) {
        sum = operation(Op::Clamp, node.type,
                        {sum, number(ir::Type::Float, {}), number(ir::Type::Float, {1, 1, 1, 1})});
        reached = {std::max(reached.lo, 0.0), std::min(reached.hi, 1.0)};
      }
      place_[change.at] = sum;
      Plan& plan = to_.found.plan;
      plan.origin[sum] = from_.found.plan.origin[change.at];
      plan.off[sum] = true;
      Facts facts = from_.found.facts[change.at];
      for (size_t c = 0; c < 4; ++c) facts.lit[c] = hull(facts.lit[c], {reached.lo, reached.hi, false});
      to_.found.facts[sum] = facts;
      to_.own[sum] = fit.error;
      // Clamps say what they are by themselves.
      if (change.variable != kNoRef && !change.clamped)
        plan.proved[sum] = {reached.lo - fit.rounding, reached.hi + fit.rounding};
    }

    const Approximation& of_;
    const State& from_;
    State to_;
    std::vector<bool> live_;
    std::vector<Ref> place_;
  };

  const ir::Module& module_;
  const Family& family_;
  double most_;
  bool quotients_;
  bool divides_ = false;
  Counter counter_;
  Proved proved_;
  size_t faults_;  ///< a node by itself has outputs of types that are no colours
  mutable Constants constants_;
  double least_lights_ = 0, most_lights_ = 1;
  State state_;
  std::set<std::pair<ir::ValueId, int>> refused_;
  std::set<std::pair<ir::ValueId, ir::ValueId>> hopeless_;  ///< variables and functions
};

}  // namespace

std::optional<Approximated> approximate(const ir::Module& module, const Family& family, double error) {
  Approximation any(module, family, error, true);
  std::optional<Approximated> made = any.run();
  if (!made || !any.divides()) return made;
  // What is taken first is not always what ends best: with quotients nothing is worse than without them.
  std::optional<Approximated> powers = Approximation(module, family, error, false).run();
  if (!powers) return made;
  const bool worse =
      powers->cycles != made->cycles ? powers->cycles < made->cycles : powers->error < made->error;
  return worse ? powers : made;
}

}  // namespace lacquer::optimize
