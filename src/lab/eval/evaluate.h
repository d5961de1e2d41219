// The evaluator of a module's DAG on the CPU: the meaning that every target's code must have, over many
// points at once, in float (each operation rounded to float, as a GPU's exact operations are) or in double.
#pragma once

#include "eval/program.h"

namespace lacquer::eval {

/// Lanes that are computed together. A multiple of 4, so that a quad is never torn.
inline constexpr size_t kBatch = 256;

/// The roots' values: one vector per root with the components of each point side by side (Bools are 0 and 1).
/// T is float or double. The meaning of the component-wise ops is the fold column of ir/ops.def in the
/// arithmetic of T; dot sums from x to w, length is the square root of a dot, normalize divides by it.
template <class T>
std::vector<std::vector<T>> run(const Program& program, const Bindings& bindings, size_t points);

/// run<float>() with inputs, texels and the result of every operation rounded to half precision: what a GPU
/// may do with `mediump` at its worst.
std::vector<std::vector<float>> runHalf(const Program& program, const Bindings& bindings, size_t points);

/// run<float>() as a device may do it: each operation gives one of the results that Vulkan allows it, chosen
/// by `seed`, which is not 0 (eval/rough.h).
std::vector<std::vector<double>> runRough(const Program& program, const Bindings& bindings, size_t points,
                                          uint64_t seed);

/// run<double>() with half precision where the Dag says that an operation is relaxed: operands and results
/// become what it may make of them, chosen by `seed`, which is not 0.
std::vector<std::vector<double>> runRelaxed(const Program& program, const Bindings& bindings, size_t points,
                                            uint64_t seed);

/// compile() and run().
template <class T>
Result<std::vector<std::vector<T>>> evaluate(const ir::Module& module, std::span<const ir::ValueId> roots,
                                             const Bindings& bindings, size_t points);

}  // namespace lacquer::eval
