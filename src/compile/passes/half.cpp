// Types of 16 bits where they are cheaper: which of the relaxed operations have them. GPUs with packed
// arithmetic do sums and products of two such numbers at once, and each border costs conversions.
#include <algorithm>
#include <iterator>
#include <vector>

#include "analysis/relax.h"
#include "passes/passes.h"

namespace lacquer::passes {

namespace {

using ir::Op;
using ir::ValueId;

int widthOf(const ir::Value& value) { return ir::componentCount(value.type); }

/// Whether GPUs with packed arithmetic do the operation on two numbers of 16 bits at once.
bool packs(Op op) {
  return op == Op::Add || op == Op::Sub || op == Op::Mul || op == Op::Min || op == Op::Max;
}

/// Sets of relaxed operations, with what they save on paper.
class Halves {
public:
  explicit Halves(const ir::Module& module)
      : module_(module), dag_(module.dag), live_(ir::reachable(module, ir::Stage::Fragment)) {
    for (const ValueId id : live_) {
      if (dag_.relaxed(id) && !analysis::onlyMoves(dag_[id].op)) all_.push_back(id);
    }
    half_.assign(dag_.size(), false);
  }

  const std::vector<ValueId>& all() const { return all_; }

  /// Operations of 32 bits less those of 16, and less conversions, each at this price.
  double gain(const std::vector<ValueId>& chosen, double price) {
    spread(chosen);
    double saved = 0;
    converted_.assign(dag_.size(), false);
    const auto convert = [&](ValueId id) {
      if (converted_[id]) return;
      converted_[id] = true;
      saved -= price * widthOf(dag_[id]);
    };
    for (const ValueId id : live_) {
      const ir::Value& value = dag_[id];
      const int pairs = (widthOf(value) + 1) / 2;
      if (half_[id] && packs(value.op)) saved += widthOf(value) - pairs;
      // Two numbers are put into one register.
      if (half_[id] && value.op == Op::Construct && value.count > 1) saved -= pairs;
      for (const ValueId operand : value.operands()) {
        if (half_[operand] == half_[id] || dag_.isConstant(operand)) continue;
        if (ir::isFloating(dag_[operand].type) && widthOf(dag_[operand]) <= 4) convert(operand);
      }
    }
    for (const ir::Output& output : module_.outputs) {
      if (half_[output.value]) convert(output.value);
    }
    return saved;
  }

  /// Leaves out of all of them what is not worth its conversions.
  std::vector<ValueId> worth(double price) {
    std::vector<ValueId> chosen = all_;
    double best = gain(chosen, price);
    const auto attempt = [&](std::vector<ValueId> fewer) {
      const double saved = gain(fewer, price);
      if (saved < best || fewer.size() == chosen.size()) return false;
      best = saved;
      chosen = std::move(fewer);
      return true;
    };
    // An operation that pays only beside one that left is found in the next round. Each attempt walks the
    // whole shader: in large ones whole clusters are tried, no single operations.
    constexpr size_t kMostSingly = 1000;
    constexpr int kRounds = 8;
    bool changed = true;
    for (int round = 0; changed && round < kRounds; ++round) {
      changed = false;
      for (const ValueId id :
           chosen.size() <= kMostSingly ? std::vector<ValueId>(chosen) : std::vector<ValueId>()) {
        std::vector<ValueId> fewer;
        std::remove_copy(chosen.begin(), chosen.end(), std::back_inserter(fewer), id);
        changed |= attempt(std::move(fewer));
      }
      for (const std::vector<ValueId>& together : clusters(chosen)) {
        std::vector<ValueId> fewer;
        std::set_difference(chosen.begin(), chosen.end(), together.begin(), together.end(),
                            std::back_inserter(fewer));
        changed |= attempt(std::move(fewer));
      }
    }
    return chosen;
  }

  /// The chosen operations in groups that operands connect, also through swizzles and other moves.
  std::vector<std::vector<ValueId>> clusters(const std::vector<ValueId>& chosen) {
    spread(chosen);
    std::vector<ValueId> first(dag_.size());
    for (const ValueId id : live_) first[id] = id;
    const auto find = [&](ValueId id) {
      while (first[id] != id) id = first[id];
      return id;
    };
    for (const ValueId id : live_) {
      if (!half_[id]) continue;
      for (const ValueId operand : dag_[id].operands()) {
        if (half_[operand]) first[std::max(find(operand), find(id))] = std::min(find(operand), find(id));
      }
    }
    std::vector<std::vector<ValueId>> found;
    std::vector<size_t> number(dag_.size(), 0);
    for (const ValueId id : chosen) {
      size_t& of = number[find(id)];
      if (of == 0) found.emplace_back(), of = found.size();
      found[of - 1].push_back(id);
    }
    return found;
  }

private:
  /// A move has 16 bits where it is relaxed and all of its operands have 16 bits or are constants.
  void spread(const std::vector<ValueId>& chosen) {
    half_.assign(dag_.size(), false);
    for (const ValueId id : chosen) half_[id] = true;
    for (const ValueId id : live_) {
      if (!dag_.relaxed(id) || !analysis::onlyMoves(dag_[id].op)) continue;
      const auto operands = dag_[id].operands();
      half_[id] = std::all_of(operands.begin(), operands.end(),
                              [&](ValueId operand) { return half_[operand] || dag_.isConstant(operand); });
    }
  }

  const ir::Module& module_;
  const ir::Dag& dag_;
  std::vector<ValueId> live_, all_;
  std::vector<bool> half_, converted_;
};

}  // namespace

std::vector<ir::Module> halves(const ir::Module& module, double error) {
  std::vector<ir::Module> forms{module};
  Halves halves(module);
  std::vector<std::vector<ValueId>> tried{{}};
  const auto offer = [&](std::vector<ValueId> chosen) {
    if (std::find(tried.begin(), tried.end(), chosen) != tried.end()) return;
    tried.push_back(chosen);
    // Fewer roundings may be more of them: what is not rounded already is, where it is taken.
    const analysis::Relaxation relaxation = analysis::relaxationOf(module, chosen);
    if (!(relaxation.bound <= error)) return;
    ir::Module& form = forms.emplace_back(module);
    form.dag.relaxNothing();
    for (const ValueId id : relaxation.values) form.dag.relax(id);
    form.relaxed_bound = relaxation.bound;
    form.half = ir::Half{true, {}, 0, 0};
  };
  offer(halves.all());
  // Some conversions are part of the operation that asks for them: the price is not known.
  for (const double price : {0.0, 0.25, 0.5, 1.0, 2.0}) {
    const std::vector<ValueId> chosen = halves.worth(price);
    offer(chosen);
    const std::vector<std::vector<ValueId>> clusters = halves.clusters(chosen);
    constexpr size_t kMost = 4;
    for (size_t i = 0; clusters.size() > 1 && i < std::min(clusters.size(), kMost); ++i) offer(clusters[i]);
  }
  return forms;
}

}  // namespace lacquer::passes
