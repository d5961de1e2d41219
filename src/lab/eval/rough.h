// One of the results that Vulkan allows an operation in float32, drawn at random.
#pragma once

#include <cstdint>

#include "ir/dag.h"

namespace lacquer::eval {

class Rough {
public:
  explicit Rough(uint64_t seed) : state_(seed) {}

  /// `x` is the operation's result on the operands `a` and `b` in double, which are floats. The answer is a
  /// float (in a double) within twice the error that Vulkan allows; a sum or a product that is a float stays
  /// as it is, since every device rounds that right. Subnormal numbers may become 0.
  double operator()(ir::Op op, double a, double b, double x);
  /// Whether the next operations are sums of sums or products: a device that regroups them, or fuses a
  /// product with the sum, rounds what is as large as the operands elsewhere, however little is left of their
  /// sum.
  bool fuses = false;
  /// What a device makes of a number from outside.
  double input(double x);
  uint32_t anything();

private:
  double symmetric();  ///< in [-1, 1], the ends often
  double wave();       ///< the same, 0 often, too

  uint64_t state_;
};

/// What half precision may make of numbers, drawn at random: the number itself or one of its neighbours of 11
/// bits, and what is below 2^-14 may become 0.
class Halves {
public:
  explicit Halves(uint64_t seed) : state_(seed) {}

  double operator()(double x);

private:
  uint64_t state_;
};

}  // namespace lacquer::eval
