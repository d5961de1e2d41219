#include "ir/work.h"

#include <numeric>

namespace lacquer::ir {

Counts workOf(const Dag& dag, ValueId id) {
  const Value& value = dag[id];
  const double w = componentCount(value.type);
  const auto wide = [&](size_t k) { return componentCount(dag[value.args[k]].type); };
  Counts work;
  const auto nothing = [] {};
  const auto sums = [&](double count) { work.sums = count; };
  const auto roots = [&](double count) { work.roots = count; };
  const auto read = [&] {
    const InputKind kind = dag.inputOf(id).kind;
    if (kind == InputKind::Varying) work.varyings = w;
    if (kind == InputKind::BlockField) work.loads = w;
  };
  const auto lookup = [&] {
    (dag[value.args[0]].type == Type::TextureCube ? work.cubes : work.pictures) = 1;
  };
  switch (value.op) {
#define FACTS(e, kind, domain, scaling, linear, range, slope, vulkan, half, error, operations, statements) \
  case Op::e:                                                                                              \
    statements;                                                                                            \
    break;
#include "ir/facts.def"
#undef FACTS
  }
  return work;
}

double cyclesOf(const Counts& counts) {
  // Fitted by least squares to RADV's for shaders of this tree's works and examples (`./dev bench estimate`;
  // docs/lod.md has the error). A product that is added to takes nothing beside the sum, which is why a sum
  // is less than the two cycles of an instruction.
  constexpr std::array<double, 7> kCycles{5.89, 1.54, 1.37, 0.729, 0, 3.6, 0};
  const std::array<double, 7> all = counts.all();
  return std::inner_product(all.begin(), all.end(), kCycles.begin(), 0.0);
}

}  // namespace lacquer::ir
