// Interval analysis: for every value of a module, a range that holds whatever it can be while the inputs lie
// in theirs.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "analysis/interval_math.h"
#include "ir/loops.h"
#include "ir/module.h"

namespace lacquer::analysis {

using Ranges = std::array<Range, 4>;

struct IntervalOptions {
  Arithmetic arithmetic = Arithmetic::Vulkan;
  /// Stands for the ends that an input's range leaves open: positions, intensities.
  double unbounded = 3.4028234663852886e38;
  /// In floats, inputs may pass their ranges by RangeMath::slack(): those of a node are values that were
  /// computed.
  bool computed_inputs = false;
};

/// The ends of open ranges for proofs: 2^27, a hundred kilometres in millimetres. Scenes lie within it, and
/// with it no square or product of a shader overflows where infinity minus infinity or infinity times 0 could
/// follow. docs/intervals.md
inline constexpr double kSceneLimit = 134217728.0;

/// Ranges of values, by component. It starts from the inputs' declared ranges; textures in UNORM formats are
/// in [0, 1], what an environment map holds is only what nodes assume of it. Facts that the module's Dag
/// carries are used.
class Intervals {
public:
  explicit Intervals(const ir::Module& module, const IntervalOptions& options = {});

  /// A value whose ranges are given, not computed. Before run().
  void fix(ir::ValueId id, const Ranges& ranges) { fixed_[id] = ranges; }

  /// Evaluates everything that the module's outputs, varyings and preshader reach.
  void run();
  /// Evaluates these values, which are ascending and hold the operands of each. Where they are of a loop that
  /// the module has, what it carries is evaluated with them.
  void run(std::span<const ir::ValueId> ids);

  /// The range of a component; every component of a Float or a Mat4 has that of component 0.
  const Range& at(ir::ValueId id, int component) const {
    const Ranges& ranges = values_[facets_[id].place];
    return ranges[ir::isFloatVector(dag_[id].type) ? static_cast<size_t>(component) : 0];
  }
  /// All components at once.
  Range all(ir::ValueId id) const;
  bool known(ir::ValueId id) const { return facets_[id].done; }
  const RangeMath& math() const { return math_; }

private:
  /// What is known of a value beside its ranges. The last two spare the search for patterns that are not
  /// there.
  struct Facet {
    bool done = false;
    bool alike = false;       ///< all components are computed alike from components that are
    bool root = false;        ///< it may have a reciprocal square root among its factors
    bool difference = false;  ///< or a difference
    uint8_t addends = 0;      ///< constants among the terms of a sum of sums, at most 2
    uint8_t factors = 0;      ///< and among the factors of a product of products
    uint32_t place = 0;       ///< of its ranges; 0 while there are none
  };

  void evaluateOnce(ir::ValueId id);

  // loop_intervals.cpp
  struct LoopRun;
  void runWithLoops(std::span<const ir::ValueId> ids);
  std::vector<ir::ValueId> withLoops(std::span<const ir::ValueId> ids);
  void findLoops(std::span<const ir::ValueId> ids);
  void evaluateIn(std::span<const ir::ValueId> ids, int32_t loop);
  void evaluateLoop(int32_t loop, std::span<const ir::ValueId> ids);
  void round(LoopRun& run, double first, double last);
  void settle(LoopRun& run, double first, double last);
  void give(ir::ValueId id, const Ranges& ranges);

  Ranges& rangesOf(ir::ValueId id) { return values_[facets_[id].place]; }
  void look(ir::ValueId id);
  void evaluate(ir::ValueId id);
  Range input(const ir::Input& input) const;
  Range open(ir::Interval range) const;
  void materialField(ir::ValueId id, uint32_t block, uint32_t number);
  void varying(ir::ValueId id, const ir::Input& input);
  void vectorOp(ir::ValueId id);
  void matMul(ir::ValueId id);
  Range component(ir::ValueId id, int c) const;
  Range literal(ir::ValueId id, int c) const;
  Range stored(ir::ValueId id, int c) const;
  Range element(const ir::Value& value) const;
  Range comparison(ir::ValueId id) const;
  Range select(ir::ValueId id, int c) const;
  Range derivative(ir::ValueId id, int c) const;
  Range interpolated(const Range& a) const;
  Range lights(ir::ValueId id, int c) const;
  Range dot(ir::ValueId a, ir::ValueId b) const;
  Range product(ir::ValueId id, int c) const;

  // What a compiler may make of operations together.
  Range regrouped(ir::ValueId id, int c, const Range& as_written) const;
  Range regroupedSum(ir::ValueId id, int c) const;
  Range regroupedProduct(ir::ValueId id, int c) const;

  // What operations show only together.
  bool overflows(ir::ValueId id, int c) const;
  void pattern(ir::ValueId id, int c, Range& range) const;
  void fractionPattern(ir::ValueId x, ir::ValueId below, int c, Range& range) const;
  void smoothPattern(ir::ValueId squared, ir::ValueId slope, int c, Range& range) const;
  void blendPattern(ir::ValueId x, ir::ValueId rest, bool negative, int c, Range& range) const;
  void exchangePattern(ir::ValueId product, ir::ValueId difference, int c, Range& range) const;
  void ratioPattern(ir::ValueId id, int c, Range& range) const;
  void unitPattern(ir::ValueId id, int c, Range& range) const;
  bool holdsSquare(ir::ValueId sum, ir::ValueId v, int c, int depth) const;
  bool isComponent(ir::ValueId scalar, ir::ValueId v, int c) const;
  Range productOf(std::span<const ir::ValueId> factors, std::span<const ir::ValueId> divisors, int c,
                  bool& small) const;

  const ir::Module& module_;
  const ir::Dag& dag_;
  IntervalOptions options_;
  RangeMath math_;
  std::vector<Ranges> values_;  ///< of the values that were evaluated, in that order; the first is nobody's
  std::vector<Facet> facets_;
  std::map<ir::ValueId, Ranges> fixed_;
  std::optional<ir::Loops> loops_;  ///< of the module, once they are asked for
  std::vector<int32_t> loop_of_;    ///< by value, the loop in which it is evaluated; -1 where that is none
  std::vector<std::vector<Ranges>> left_by_;  ///< by loop, what is left of what it carries
};

}  // namespace lacquer::analysis
