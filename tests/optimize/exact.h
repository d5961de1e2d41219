// Real numbers for tests: 256 bits by MPFR, and the operations of the DAG on them.
#pragma once

#include <mpfr.h>

#include <array>
#include <span>
#include <vector>

#include "optimize/egraph.h"

namespace lacquer::test {

class Exact {
public:
  static constexpr mpfr_prec_t kBits = 256;

  Exact() : Exact(0.0) {}
  explicit Exact(double x) {
    mpfr_init2(number_, kBits);
    mpfr_set_d(number_, x, MPFR_RNDN);
  }
  Exact(const Exact& other) {
    mpfr_init2(number_, kBits);
    mpfr_set(number_, other.number_, MPFR_RNDN);
  }
  Exact& operator=(const Exact& other) {
    mpfr_set(number_, other.number_, MPFR_RNDN);
    return *this;
  }
  ~Exact() { mpfr_clear(number_); }

  double rounded() const { return mpfr_get_d(number_, MPFR_RNDN); }
  bool finite() const { return mpfr_number_p(number_) != 0; }
  mpfr_ptr raw() { return number_; }
  mpfr_srcptr raw() const { return number_; }

private:
  mpfr_t number_;
};

/// One component of an operation; of Op::Div with one operand its reciprocal.
Exact apply(ir::Op op, std::span<const Exact> operands);

using ExactVector = std::array<Exact, 4>;

/// A node on operands.
ExactVector evaluate(const optimize::Node& node, std::span<const ExactVector* const> operands,
                     std::span<const ir::Type> types, const optimize::Constants& constants);

/// How far apart two numbers are, as a part of the larger one; infinite where one of them is no number.
double distance(const Exact& a, const Exact& b);

}  // namespace lacquer::test
