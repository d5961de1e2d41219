#include "lod/estimate.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lacquer::lod {

namespace {

// In cycles of inverse throughput, fitted by least squares to RADV's for shaders of this tree's works and
// examples
// (`./dev bench estimate`; docs/lod.md has the error). A product that is added to takes nothing beside the
// sum, which is why a sum is less than the two cycles of an instruction.
constexpr std::array<double, 7> kCycles{5.89, 1.54, 1.37, 0.729, 0, 3.6, 0};
constexpr double kInstructions = 0.621;  // for each cycle, with loads and waits
constexpr double kRounds = 8;
constexpr double kQuarter = 6;

/// What a value takes of a GPU.
Counts workOf(const ir::Dag& dag, ir::ValueId id) {
  const ir::Value& value = dag[id];
  const double w = ir::componentCount(value.type);
  const auto wide = [&](size_t k) { return ir::componentCount(dag[value.args[k]].type); };
  Counts work;
  work.always = 0;
  const auto nothing = [] {};
  const auto sums = [&](double count) { work.sums = count; };
  const auto roots = [&](double count) { work.roots = count; };
  const auto read = [&] {
    const ir::InputKind kind = dag.inputOf(id).kind;
    if (kind == ir::InputKind::Varying) work.varyings = w;
    if (kind == ir::InputKind::BlockField) work.loads = w;
  };
  const auto lookup = [&] {
    (dag[value.args[0]].type == ir::Type::TextureCube ? work.cubes : work.pictures) = 1;
  };
  switch (value.op) {
#define FACTS(e, kind, domain, scaling, linear, range, slope, vulkan, half, error, operations, statements) \
  case ir::Op::e:                                                                                          \
    statements;                                                                                            \
    break;
#include "ir/facts.def"
#undef FACTS
  }
  return work;
}

double cyclesOf(const Counts& counts) {
  const std::array<double, 7> all = counts.all();
  return std::inner_product(all.begin(), all.end(), kCycles.begin(), 0.0);
}

/// Calls `each(id, work)` for what a stage computes; what is in a loop counts for all its rounds.
template <class Each>
void eachWork(const ir::Module& module, ir::Stage stage, Each each) {
  for (const ir::ValueId id : ir::reachable(module, stage)) {
    const ir::Value& value = module.dag[id];
    if (value.rate <= ir::Rate::Material) continue;
    bool looped = value.rate == ir::Rate::Light;
    for (const ir::LightGroup& group : module.light_groups) looped = looped && group.count < 0;
    each(id, workOf(module.dag, id), looped ? kRounds : 1.0);
  }
}

}  // namespace

Counts countsOf(const ir::Module& module, ir::Stage stage) {
  Counts counts;
  eachWork(module, stage, [&](ir::ValueId, const Counts& work, double times) {
    counts.sums += times * work.sums;
    counts.roots += times * work.roots;
    counts.cubes += times * work.cubes;
    counts.pictures += times * work.pictures;
    counts.varyings += work.varyings;
    counts.loads += times * work.loads;
  });
  return counts;
}

Estimate estimate(const ir::Module& module) {
  const Counts counts = countsOf(module, ir::Stage::Fragment);
  const double cycles = cyclesOf(counts);
  const auto whole = [](double x) { return static_cast<uint64_t>(std::lround(std::max(x, 0.0))); };
  Estimate result;
  result.cycles = whole(cycles);
  result.quarter_cycles = whole(cycles + kQuarter * (counts.roots + counts.cubes));
  result.instructions = whole(kInstructions * cycles);
  result.vertex_cycles = whole(cyclesOf(countsOf(module, ir::Stage::Vertex)));
  return result;
}

std::vector<double> cyclesByTerm(const ir::Module& module) {
  std::vector<double> cycles(module.dag.terms().size());
  eachWork(module, ir::Stage::Fragment, [&](ir::ValueId id, const Counts& work, double times) {
    cycles[module.dag.termOf(id)] += times * cyclesOf(work);
  });
  return cycles;
}

}  // namespace lacquer::lod
