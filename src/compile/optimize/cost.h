// What a plan costs on a family of GPUs: its instructions, counted as the driver's compiler would select
// them, each kind with its weight. docs/optimize.md has the errors.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "optimize/plan.h"

namespace lacquer::optimize {

/// What is counted. What is in a loop counts for all its rounds.
enum class Count : uint8_t {
  Always,    ///< 1: what every shader has
  Sums,      ///< sums, products and fused pairs of them, of one component each
  Picks,     ///< minima, maxima, comparisons, choices and the like
  Roots,     ///< reciprocals, roots, exponentials, logarithms, sines and cosines
  Varyings,  ///< interpolated components
  Cubes,     ///< lookups of cube maps
  Pictures,  ///< other lookups
  Moves,     ///< uniform numbers that an instruction wants in a vector register
  Loads,     ///< components read of uniform blocks, the material's included
  Colors,    ///< components of outputs
};
inline constexpr size_t kCounts = 10;
using Tally = std::array<double, kCounts>;

struct Family {
  std::string_view name, does;
  /// Cycles of each thing that is counted.
  Tally weights;
  /// What works at the same time as the rest: the longest of these sums counts (docs/optimize.md). Of a
  /// family with one pipe there are none.
  std::span<const Tally> pipes;
};

/// "navi21" first, which is the default.
std::span<const Family> families();
/// Null when there is none of that name.
const Family* findFamily(std::string_view name);

double cyclesOf(const Tally& tally, const Family& family);
/// Of a module's fragment stage, placed or not. What has types of 16 bits is done by twos where GPUs with
/// packed arithmetic do so, and each number that passes between the types takes an instruction.
double cyclesOf(const ir::Module& module, const Family& family);
/// Of one by itself.
double cyclesOf(Count what, const Family& family);

/// Counts plans; keeps its memory from one to the next.
class Counter {
public:
  explicit Counter(const ir::Module& module);
  Tally count(const Plan& plan, const Constants& constants);

private:
  static int timesOf(const Plan& plan, const Node& node, uint8_t mask, Ref operand);
  void mark(const Plan& plan);
  void fuse(const Plan& plan);
  void modify(const Plan& plan, const Constants& constants);
  void add(Count what, double count) { tally_[static_cast<size_t>(what)] += count; }
  void countNode(const Plan& plan, Ref at);
  void countFact(const Plan& plan, const Node& node, double parts, double times);
  void countLookup(const Plan& plan, const Node& node, double times);
  bool scaled(const Plan& plan, const Node& node) const;
  /// A number that the GPU reads of a block.
  static bool stored(const Node& node) {
    return node.rate == ir::Rate::Material ||
           (node.rate > ir::Rate::Material && node.rate <= ir::Rate::Object && node.op == ir::Op::Input);
  }

  double timesOf(Ref at, const Node& node) const;
  void halve(const Plan& plan);
  void convert(const Plan& plan);

  const ir::Dag& dag_;
  bool half_;                     ///< what the Dag says is relaxed has types of 16 bits
  std::vector<uint8_t> halved_;   ///< nodes that have; empty where none may
  double rounds_;                 ///< of loops over lights
  std::vector<uint64_t> around_;  ///< the loops around each node (loopsAround())
  Tally tally_{};
  std::vector<uint8_t> mask_;       ///< which components are read
  std::vector<uint16_t> uses_;      ///< by how many operands, roots included
  std::vector<uint16_t> reads_;     ///< the same, through negations
  std::vector<uint8_t> fast_;       ///< by something that is not of the material's rate
  std::vector<uint8_t> asked_;      ///< of a lookup's coordinates: what is made of them already
  std::vector<uint16_t> absorbed_;  ///< by how many sums a product is taken in
  std::vector<uint8_t> free_;       ///< a modifier of what it is made of, or of what reads it
};

}  // namespace lacquer::optimize
