#include "lod/estimate.h"

#include <cmath>

namespace lacquer::lod {

namespace {

/// What a value takes of a GPU: sums and the like of one component each, and roots and the like.
struct Work {
  double plain = 0, slow = 0;
};

Work workOf(const ir::Dag& dag, ir::ValueId id) {
  const ir::Value& value = dag[id];
  const double width = ir::componentCount(value.type);
  const double first = value.count > 0 ? ir::componentCount(dag[value.args[0]].type) : 0;
  switch (value.op) {
    case ir::Op::Constant:
    case ir::Op::Construct:
    case ir::Op::Swizzle:
    case ir::Op::Neg:
    case ir::Op::Abs:
    case ir::Op::SumOverLights: return {};
    case ir::Op::Input: return dag.inputOf(id).kind == ir::InputKind::Varying ? Work{2 * width, 0} : Work{};
    case ir::Op::Div: return {width, first};
    case ir::Op::Sqrt:
    case ir::Op::InverseSqrt:
    case ir::Op::Exp2:
    case ir::Op::Log2: return {0, width};
    case ir::Op::Pow: return {width, 2 * width};
    case ir::Op::Sin:
    case ir::Op::Cos: return {width, width};
    case ir::Op::Dot: return {first, 0};
    case ir::Op::Length: return {first, 1};
    case ir::Op::Normalize: return {2 * first, 1};
    case ir::Op::Cross: return {6, 0};
    case ir::Op::Texture:
    case ir::Op::TextureLod: {
      const bool cube = dag[value.args[0]].type == ir::Type::TextureCube;
      return cube ? Work{14, 1} : Work{2, 0};
    }
    default: return {width, 0};
  }
}

// Fitted by least squares to RADV's statistics of the levels of this tree's works; a product that is added
// to takes nothing beside the sum, which is why less than one instruction stands for an operation.
constexpr double kPlain = 0.80;
constexpr double kSlow = 1.0;
constexpr double kAlways = 8;
constexpr double kScalar = 1.2;  // instructions, with loads and waits, for one of vectors
constexpr double kRounds = 8;
constexpr double kCycles = 2;
constexpr double kQuarter = 6;

/// Calls `each(id, work)` for what the fragment stage computes; what is in a loop counts for all its rounds.
template <class Each>
void eachWork(const ir::Module& module, Each each) {
  for (const ir::ValueId id : ir::reachable(module, ir::Stage::Fragment)) {
    const ir::Value& value = module.dag[id];
    if (value.rate <= ir::Rate::Material) continue;
    bool looped = value.rate == ir::Rate::Light;
    for (const ir::LightGroup& group : module.light_groups) looped = looped && group.count < 0;
    const Work work = workOf(module.dag, id);
    each(id, Work{work.plain * (looped ? kRounds : 1), work.slow * (looped ? kRounds : 1)});
  }
}

}  // namespace

Estimate estimate(const ir::Module& module) {
  double plain = 0;
  double slow = 0;
  eachWork(module, [&](ir::ValueId, const Work& work) {
    plain += work.plain;
    slow += work.slow;
  });
  const double vector = kAlways + kPlain * plain + kSlow * slow;
  Estimate result;
  result.cycles = static_cast<uint64_t>(std::lround(kCycles * vector));
  result.quarter_cycles = static_cast<uint64_t>(std::lround(kCycles * vector + kQuarter * slow));
  result.instructions = static_cast<uint64_t>(std::lround(kScalar * vector));
  return result;
}

std::vector<double> cyclesByTerm(const ir::Module& module) {
  std::vector<double> cycles(module.dag.terms().size());
  eachWork(module, [&](ir::ValueId id, const Work& work) {
    cycles[module.dag.termOf(id)] += kCycles * (kPlain * work.plain + kSlow * work.slow);
  });
  return cycles;
}

}  // namespace lacquer::lod
