#include "lod/estimate.h"

#include <algorithm>
#include <cmath>

#include "ir/loops.h"

namespace lacquer::lod {

namespace {

constexpr double kInstructions = 0.621;  // for each cycle of ir::cyclesOf(), with loads and waits
constexpr double kRounds = 8;            // of a loop over lights
constexpr double kQuarter = 6;

/// How often the body of a loop runs; of a length that is not known, half of the most.
double roundsOf(const ir::Dag& dag, const ir::Loops& loops, int32_t loop) {
  double rounds = 1;
  for (; loop >= 0; loop = loops[loop].around) {
    const double most = ir::mostRounds(dag, loops[loop]);
    const ir::ValueId end = loops[loop].end;
    const double known =
        dag.isConstant(end) ? dag.constantOf(end)[0] - ir::firstRound(dag, loops[loop]) : most / 2;
    rounds *= std::clamp(known, 0.0, most);
  }
  return rounds;
}

/// Calls `each(id, work)` for what a stage computes; what is in a loop counts for all its rounds.
template <class Each>
void eachWork(const ir::Module& module, ir::Stage stage, Each each) {
  const std::vector<ir::ValueId> live = ir::reachable(module, stage);
  const ir::Loops loops(module.dag, live);
  for (const ir::ValueId id : live) {
    const ir::Value& value = module.dag[id];
    if (value.rate <= ir::Rate::Material) continue;
    bool looped = value.rate == ir::Rate::Light;
    for (const ir::LightGroup& group : module.light_groups) looped = looped && group.count < 0;
    each(id, ir::workOf(module.dag, id),
         (looped ? kRounds : 1.0) * roundsOf(module.dag, loops, loops.of(id)));
  }
}

}  // namespace

ir::Counts countsOf(const ir::Module& module, ir::Stage stage) {
  ir::Counts counts;
  counts.always = 1;
  eachWork(module, stage, [&](ir::ValueId, const ir::Counts& work, double times) {
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
  const ir::Counts counts = countsOf(module, ir::Stage::Fragment);
  const double cycles = ir::cyclesOf(counts);
  const auto whole = [](double x) { return static_cast<uint64_t>(std::lround(std::max(x, 0.0))); };
  Estimate result;
  result.cycles = whole(cycles);
  result.quarter_cycles = whole(cycles + kQuarter * (counts.roots + counts.cubes));
  result.instructions = whole(kInstructions * cycles);
  result.vertex_cycles = whole(ir::cyclesOf(countsOf(module, ir::Stage::Vertex)));
  return result;
}

std::vector<double> cyclesByTerm(const ir::Module& module) {
  std::vector<double> cycles(module.dag.terms().size());
  eachWork(module, ir::Stage::Fragment, [&](ir::ValueId id, const ir::Counts& work, double times) {
    cycles[module.dag.termOf(id)] += times * ir::cyclesOf(work);
  });
  return cycles;
}

}  // namespace lacquer::lod
