// What the driver's estimate leaves out: reciprocals, roots and what is transcendental run at a quarter of
// the rate of a sum. Mesa 22 counts them like one.
#pragma once

#include <cstdint>
#include <string_view>

namespace lacquer::cost {

/// The cycles that they add to the inverse throughput, by the GPU's instructions as text: 6 for each in a
/// wave of 64, and eightfold for each loop around it, as the estimate counts loops.
uint64_t quarterRateCycles(std::string_view disassembly);

}  // namespace lacquer::cost
