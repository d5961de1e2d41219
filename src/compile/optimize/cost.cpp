#include "optimize/cost.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace lacquer::optimize {

using ir::Op;
using ir::Rate;
using ir::Type;

namespace {

// In cycles of inverse throughput, fitted by least squares to RADV's static estimate (`./dev bench optimize`;
// docs/optimize.md has the error).
constexpr Tally kNavi21{6, 2, 2, 2, 4, 14, 0, 2, 0, 1};

// Cycles that an engine of a core needs for its 16 threads, by the rates that Arm publishes: fused sums and
// products and conversions, with comparisons and choices, sixteen at a time, special functions four. Lookups
// and interpolants have units of their own, which no rule relieves.
constexpr Tally kValhallUnits[] = {
    {0, 1, 0, 0, 0, 0, 0, 0, 0, 0}, {0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, {0, 0, 0, 4, 0, 0, 0, 0, 0, 0}};

constexpr Family kFamilies[] = {
    {"navi21", "AMD RDNA 2: RADV's estimate of inverse throughput", kNavi21, {}},
    {"valhall", "Arm Mali-G77 and later: the longest of the arithmetic units", {}, kValhallUnits},
};

/// An operation of the vector units on numbers, whose result may be clamped or doubled for nothing.
bool hosts(const Node& node) {
  if (node.opaque() || node.rate <= Rate::Material) return false;
  static constexpr Ops kThese{Op::Add,  Op::Mul,    Op::Div, Op::Sqrt, Op::InverseSqrt, Op::Exp2,
                              Op::Log2, Op::Sin,    Op::Cos, Op::Min,  Op::Max,         Op::Dot,
                              Op::Mix,  Op::Length, Op::Pow, Op::Exp};
  return kThese.has(node.op);
}

/// An operation that takes its operands negated, or their magnitudes, for nothing.
bool takesSigns(const Node& node) {
  if (node.opaque()) return false;
  static constexpr Ops kThese{Op::Clamp, Op::Neg, Op::Abs, Op::Less, Op::LessEqual, Op::Cross, Op::Normalize};
  return hosts(node) || kThese.has(node.op);
}

bool isNumber(const Plan& plan, Ref at, const Constants& constants, std::initializer_list<double> among) {
  const Node& node = plan.nodes[at];
  if (node.op != Op::Constant) return false;
  const ir::Components& value = constants[node.payload];
  for (size_t c = 0; c < static_cast<size_t>(ir::componentCount(node.type)); ++c) {
    if (std::find(among.begin(), among.end(), value[c]) == among.end()) return false;
  }
  return true;
}

/// Moves components; costs nothing.
bool moves(Op op) { return op == Op::Swizzle || op == Op::Construct; }

/// How many components a mask has.
constexpr std::array<int, 16> kParts{0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};

constexpr double kRounds = 8;  // of a loop, as the driver's estimate takes it

}  // namespace

std::span<const Family> families() { return kFamilies; }

const Family* findFamily(std::string_view name) {
  for (const Family& family : kFamilies) {
    if (family.name == name) return &family;
  }
  return nullptr;
}

double cyclesOf(Count what, const Family& family) {
  const auto at = static_cast<size_t>(what);
  double longest = 0;
  for (const Tally& pipe : family.pipes) longest = std::max(longest, pipe[at]);
  return family.weights[at] + longest;
}

double cyclesOf(const Tally& tally, const Family& family) {
  const auto weighed = [&](const Tally& weights) {
    double sum = 0;
    for (size_t i = 0; i < kCounts; ++i) sum += weights[i] * tally[i];
    return sum;
  };
  double longest = 0;
  for (const Tally& pipe : family.pipes) longest = std::max(longest, weighed(pipe));
  return weighed(family.weights) + longest;
}

double cyclesOf(const ir::Module& module, const Family& family) {
  Constants constants;
  const Plan plan = planOf(module, constants);
  return cyclesOf(Counter(module).count(plan, constants), family);
}

Counter::Counter(const ir::Module& module) : dag_(module.dag), half_(module.half && module.half->used) {
  rounds_ = 1;
  for (const ir::LightGroup& group : module.light_groups) {
    const double rounds = group.count < 0 ? kRounds : std::max(1, group.count);
    rounds_ = std::max(rounds_, std::min(rounds, kRounds));
  }
}

Tally Counter::count(const Plan& plan, const Constants& constants) {
  tally_ = {};
  around_ = loopsAround(dag_, plan);
  add(Count::Always, 1);
  mark(plan);
  fuse(plan);
  modify(plan, constants);
  if (half_) halve(plan);
  for (Ref at = 0; at < plan.nodes.size(); ++at) {
    if (mask_[at] != 0) countNode(plan, at);
  }
  if (half_) convert(plan);
  return tally_;
}

/// Which nodes have types of 16 bits. What an operation is made of in the plan alone has those of the
/// operation.
void Counter::halve(const Plan& plan) {
  halved_.assign(plan.nodes.size(), 0);
  for (size_t at = plan.nodes.size(); at-- > 0;) {
    const ir::ValueId origin = plan.origin[at];
    if (origin != ir::kNoValue && dag_.relaxed(origin)) halved_[at] = 1;
    if (halved_[at] == 0) continue;
    for (const Ref operand : plan.nodes[at].operands()) {
      if (plan.origin[operand] == ir::kNoValue) halved_[operand] = 1;
    }
  }
}

/// Numbers that pass between types of 16 and of 32 bits, and those of 16 that are put into one register.
void Counter::convert(const Plan& plan) {
  std::vector<uint8_t> converted(plan.nodes.size(), 0);
  const auto pass = [&](Ref at, double times) {
    const Node& node = plan.nodes[at];
    if (converted[at] != 0 || node.op == Op::Constant || !ir::isFloating(node.type)) return;
    if (ir::componentCount(node.type) > 4) return;
    converted[at] = 1;
    add(Count::Picks, times * kParts[mask_[at] & 15U]);
  };
  for (Ref at = 0; at < plan.nodes.size(); ++at) {
    const Node& node = plan.nodes[at];
    if (mask_[at] == 0) continue;
    const double times = timesOf(at, node);
    if (halved_[at] != 0 && node.op == Op::Construct && node.count > 1)
      add(Count::Picks, times * ((kParts[mask_[at] & 15U] + 1) / 2));
    for (const Ref operand : node.operands()) {
      if (halved_[operand] != halved_[at]) pass(operand, times);
    }
  }
  for (const Ref root : plan.roots) {
    if (halved_[root] != 0) pass(root, 1);
  }
}

/// Which components of each value are read, and how often it is.
void Counter::mark(const Plan& plan) {
  mask_.assign(plan.nodes.size(), 0);
  uses_.assign(plan.nodes.size(), 0);
  reads_.assign(plan.nodes.size(), 0);
  fast_.assign(plan.nodes.size(), 0);
  asked_.assign(plan.nodes.size(), 0);
  const auto all = [&](Ref at) {
    const int width = std::min(ir::componentCount(plan.nodes[at].type), 4);
    return static_cast<uint8_t>((1U << static_cast<unsigned>(std::max(width, 1))) - 1);
  };
  for (const Ref root : plan.roots) {
    mask_[root] = all(root);
    ++uses_[root];
    ++reads_[root];
    fast_[root] = 1;
  }
  for (size_t at = plan.nodes.size(); at-- > 0;) {
    const Node& node = plan.nodes[at];
    const uint8_t mask = mask_[at];
    if (mask == 0) continue;
    const bool whole = node.opaque() || node.op == Op::Dot || node.op == Op::Length ||
                       node.op == Op::Normalize || node.op == Op::Cross;
    unsigned first = 0;
    for (const Ref operand : node.operands()) {
      ++uses_[operand];
      // What reads a negation reads what is negated.
      const bool sign = node.op == Op::Neg && !node.opaque();
      const int times = sign ? reads_[at] : timesOf(plan, node, mask, operand);
      reads_[operand] = static_cast<uint16_t>(reads_[operand] + times);
      if (node.rate > Rate::Material) fast_[operand] = 1;
      const auto width = static_cast<unsigned>(std::min(ir::componentCount(plan.nodes[operand].type), 4));
      if (whole || width <= 1) {
        const bool part = node.op == Op::Construct && !node.opaque() && node.count > 1;
        if (!part || (mask >> first & 1U) != 0)
          mask_[operand] = static_cast<uint8_t>(mask_[operand] | all(operand));
      } else if (node.op == Op::Swizzle) {
        for (int c = 0; c < ir::componentCount(node.type); ++c) {
          if ((mask >> c & 1) != 0)
            mask_[operand] =
                static_cast<uint8_t>(mask_[operand] | 1 << ir::swizzleComponent(node.payload, c));
        }
      } else if (node.op == Op::Construct) {
        mask_[operand] = static_cast<uint8_t>(mask_[operand] | ((mask >> first) & ((1U << width) - 1)));
      } else {
        mask_[operand] |= mask;
      }
      first += width;
    }
  }
}

/// How often a component of an operand is read: a Float beside a vector once for each of its components.
int Counter::timesOf(const Plan& plan, const Node& node, uint8_t mask, Ref operand) {
  const bool spread = plan.nodes[operand].type == Type::Float && ir::isFloatVector(node.type) &&
                      !node.opaque() && node.op != Op::Construct;
  return spread ? kParts[mask & 15U] : 1;
}

/// Each sum takes one product in, the one that is read least.
void Counter::fuse(const Plan& plan) {
  absorbed_.assign(plan.nodes.size(), 0);
  const auto product = [&](Ref at) {
    const Node* node = &plan.nodes[at];
    // A sign on the way costs nothing. The material's is no instruction, and may have no operand here.
    while (node->op == Op::Neg && !node->opaque() && node->rate > Rate::Material)
      at = node->args[0], node = &plan.nodes[at];
    return node->op == Op::Mul && !node->opaque() && node->rate > Rate::Material ? at : kNoRef;
  };
  for (Ref at = 0; at < plan.nodes.size(); ++at) {
    const Node& node = plan.nodes[at];
    if (mask_[at] == 0 || node.opaque() || node.op != Op::Add || node.rate <= Rate::Material) continue;
    const Ref a = product(node.args[0]);
    const Ref b = product(node.args[1]);
    const auto fits = [&](Ref p) {
      const bool together = around_.empty() || p == kNoRef || around_[p] == around_[at];
      return p != kNoRef && together && (plan.nodes[p].rate == Rate::Light) == (node.rate == Rate::Light);
    };
    Ref taken = fits(a) ? a : kNoRef;
    if (fits(b) && (taken == kNoRef || reads_[b] < reads_[a])) taken = b;
    if (taken != kNoRef)
      absorbed_[taken] = static_cast<uint16_t>(absorbed_[taken] + timesOf(plan, node, mask_[at], taken));
  }
}

/// Signs, clamps to [0, 1] and factors of 2, 4 and 1/2 that are part of another instruction.
void Counter::modify(const Plan& plan, const Constants& constants) {
  free_.assign(plan.nodes.size(), 0);
  for (Ref at = 0; at < plan.nodes.size(); ++at) {
    const Node& node = plan.nodes[at];
    if (mask_[at] == 0 || node.opaque() || node.rate <= Rate::Material) continue;
    if (moves(node.op)) free_[at] = 1;
    const Ref host = node.count > 0 ? node.args[0] : kNoRef;
    if (node.op == Op::Clamp) {
      const bool unit =
          isNumber(plan, node.args[1], constants, {0}) && isNumber(plan, node.args[2], constants, {1});
      free_[at] = unit && uses_[host] == 1 &&
                  (hosts(plan.nodes[host]) ||
                   (plan.nodes[host].op == Op::Neg && plan.nodes[host].rate > Rate::Material &&
                    uses_[plan.nodes[host].args[0]] == 1));
    }
    if (node.op == Op::Mul) {
      for (const size_t k : {size_t{0}, size_t{1}}) {
        const Ref other = node.args[1 - k];
        if (!isNumber(plan, node.args[k], constants, {2, 4, 0.5})) continue;
        if (uses_[other] == 1 && hosts(plan.nodes[other]) && plan.nodes[other].type == node.type)
          free_[at] = 1;
      }
    }
    // Of two of a kind one instruction, with three operands.
    if (node.op == Op::Max || node.op == Op::Min) {
      for (const Ref operand : node.operands()) {
        if (plan.nodes[operand].op == node.op && uses_[operand] == 1 && !plan.nodes[operand].opaque() &&
            plan.nodes[operand].rate > Rate::Material) {
          free_[at] = 1;
          break;
        }
      }
    }
  }
  // A sign goes into all that reads it, or into the one operation that it is of.
  std::vector<uint8_t>& free = free_;
  for (size_t at = plan.nodes.size(); at-- > 0;) {
    const Node& node = plan.nodes[at];
    if (mask_[at] == 0 || node.opaque() || node.rate <= Rate::Material) continue;
    if (node.op == Op::Neg || node.op == Op::Abs) free[at] |= 2;
  }
  const auto refuse = [&](Ref operand) {
    const Node& sign = plan.nodes[operand];
    if ((sign.op != Op::Neg && sign.op != Op::Abs) || sign.opaque() || sign.rate <= Rate::Material) return;
    const Ref of = sign.args[0];
    const bool folds = sign.op == Op::Neg && uses_[of] == 1 && hosts(plan.nodes[of]);
    if (!folds) free[operand] = static_cast<uint8_t>(free[operand] & ~2U);
  };
  for (const Node& node : plan.nodes) {
    if (takesSigns(node)) continue;
    for (const Ref operand : node.operands()) refuse(operand);
  }
  for (const Ref root : plan.roots) refuse(root);
}

/// A lookup, with what it wants of its coordinates, once for each.
void Counter::countLookup(const Plan& plan, const Node& node, double times) {
  const bool cube = plan.nodes[node.args[0]].type == Type::TextureCube;
  if (!cube) add(Count::Pictures, times);
  if (cube && (asked_[node.args[1]] & 1U) == 0) add(Count::Cubes, times);
  asked_[node.args[1]] |= 1;
  for (size_t k = 1; k < node.count; ++k) {
    const Node& coordinate = plan.nodes[node.args[k]];
    // Coordinates and levels that are uniform and stand in no vector register yet.
    const auto move = [&](Ref at) {
      if (!stored(plan.nodes[at]) || (asked_[at] & 2U) != 0) return;
      asked_[at] |= 2;
      add(Count::Moves, times * ir::componentCount(plan.nodes[at].type));
    };
    if (coordinate.op == Op::Construct && !coordinate.opaque()) {
      for (const Ref part : coordinate.operands()) move(part);
    } else {
      move(node.args[k]);
    }
  }
}

/// What ir/facts.def says that an operation takes.
void Counter::countFact(const Plan& plan, const Node& node, double parts, double times) {
  const double w = parts;
  const auto wide = [&](size_t k) {
    return static_cast<double>(ir::componentCount(plan.nodes[node.args[k]].type));
  };
  const auto nothing = [] {};
  const auto read = [] {};
  const auto sums = [&](double count) { add(Count::Sums, times * count); };
  const auto roots = [&](double count) { add(Count::Roots, times * count); };
  const auto lookup = [&] { countLookup(plan, node, times); };
  switch (node.op) {
#define FACTS(e, kind, domain, scaling, linear, range, slope, vulkan, half, error, operations, work) \
  case Op::e:                                                                                        \
    work;                                                                                            \
    break;
#include "ir/facts.def"
#undef FACTS
  }
}

/// The factor that the hardware wants of an argument goes into one that is there.
bool Counter::scaled(const Plan& plan, const Node& node) const {
  const Node& operand = plan.nodes[node.args[0]];
  if (operand.op != Op::Mul || operand.opaque() || uses_[node.args[0]] != 1) return false;
  return std::any_of(operand.operands().begin(), operand.operands().end(),
                     [&](Ref k) { return plan.nodes[k].rate == Rate::Constant; });
}

double Counter::timesOf(Ref at, const Node& node) const {
  double times = node.rate == Rate::Light ? rounds_ : 1;
  for (int loops = around_.empty() ? 0 : std::popcount(around_[at]); loops > 0; --loops) times *= kRounds;
  return times;
}

void Counter::countNode(const Plan& plan, Ref at) {
  const Node& node = plan.nodes[at];
  static constexpr Ops kPacked{Op::Add, Op::Mul, Op::Min, Op::Max};
  int count = kParts[mask_[at] & 15U];
  if (half_ && halved_[at] != 0 && kPacked.has(node.op)) count = (count + 1) / 2;
  const auto parts = static_cast<double>(count);
  const double times = timesOf(at, node);
  if (node.op == Op::Interpolate) return add(Count::Varyings, parts);
  if (node.rate <= Rate::Material) {
    if (node.rate == Rate::Material && fast_[at] != 0) add(Count::Loads, parts);
    return;
  }
  if (ir::makesLoop(node.op)) return;
  if (node.op == Op::Input && !around_.empty() && around_[at] != 0) return;
  if (node.op == Op::Input) {
    // Of a placed module a varying is an input.
    const bool varying = node.rate == Rate::Fragment && ir::isFloating(node.type);
    return add(varying ? Count::Varyings : Count::Loads, parts);
  }
  if (node.opaque()) {
    // Truths are kept in scalar registers, whose instructions run beside.
    if (node.type != Type::Bool) countFact(plan, node, parts, times);
    return;
  }
  if (free_[at] != 0) return;
  static constexpr Ops kSigns{Op::Neg, Op::Abs};
  static constexpr Ops kPicks{Op::Min, Op::Max, Op::Clamp, Op::Less, Op::LessEqual};
  static constexpr Ops kScaled{Op::Exp, Op::Log, Op::Sin, Op::Cos};
  if (kSigns.has(node.op)) return add(Count::Moves, times * parts);
  if (kPicks.has(node.op)) return add(Count::Picks, times * parts);
  if (node.op == Op::Select) return add(Count::Picks, node.type == Type::Bool ? 0 : times * parts);
  if (node.op == Op::Mul && absorbed_[at] >= reads_[at]) return;
  if (node.op == Op::Div) return add(Count::Roots, times * parts);
  if (kScaled.has(node.op)) {
    add(Count::Roots, times * parts);
    return add(Count::Sums, scaled(plan, node) ? 0 : times * parts);
  }
  if (node.op == Op::Mix) return add(Count::Sums, times * 2 * parts);
  if (node.op == Op::SumOverLights) return add(Count::Sums, rounds_ * parts);
  countFact(plan, node, parts, times);
}

}  // namespace lacquer::optimize
