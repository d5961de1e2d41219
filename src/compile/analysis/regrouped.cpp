// What a compiler may make of sums and products whose order nothing fixes. GLSL, HLSL and SPIR-V without
// NoContraction let it regroup them so that constants meet, and Mesa does: of `(x * 2 - 1) + 1e-14` it makes
// `x * 2 - 1`, which may be 0. The ranges hold both, so that a guard counts only where it survives.
#include <algorithm>
#include <array>
#include <limits>

#include "analysis/intervals.h"

namespace lacquer::analysis {

using ir::Op;
using ir::ValueId;

namespace {

/// Terms that are followed; a part that has more stays as it is written, regrouped within itself.
constexpr size_t kMostTerms = 12;

struct Term {
  ValueId id;
  bool inverse;  ///< taken from the sum; or dividing the product
};

struct Terms {
  std::array<Term, kMostTerms> rest, constants;
  size_t rests = 0, constant_count = 0;
  size_t waiting = 0;  ///< operands that come later

  bool full() const { return rests + constant_count + waiting + 2 > kMostTerms; }
};

/// The leaves of sums of sums (`with` Add, `against` Sub), or of products and quotients.
void collect(const ir::Dag& dag, ValueId id, Op with, Op against, bool inverse, Terms& out, bool& negative) {
  const ir::Value& value = dag[id];
  const bool inner = value.op == with || value.op == against || value.op == Op::Neg;
  if (inner && !out.full()) {
    const bool sum = with == Op::Add;
    if (value.op == Op::Neg) {
      if (!sum) negative = !negative;
      return collect(dag, value.args[0], with, against, sum ? !inverse : inverse, out, negative);
    }
    ++out.waiting;
    collect(dag, value.args[0], with, against, inverse, out, negative);
    --out.waiting;
    return collect(dag, value.args[1], with, against, inverse != (value.op == against), out, negative);
  }
  if (value.op == Op::Constant)
    out.constants[out.constant_count++] = {id, inverse};
  else
    out.rest[out.rests++] = {id, inverse};
}

}  // namespace

/// `as_written`, and what comes out where the constants are put together first.
Range Intervals::regrouped(ValueId id, int c, const Range& as_written) const {
  const Facet& facet = facets_[id];
  if (facet.addends == 2) return hull(as_written, regroupedSum(id, c));
  if (facet.factors == 2) return hull(as_written, regroupedProduct(id, c));
  return as_written;
}

Range Intervals::regroupedSum(ValueId id, int c) const {
  Terms terms;
  bool negative = false;
  collect(dag_, id, Op::Add, Op::Sub, false, terms, negative);
  Range constant = math_.constant(0);
  for (size_t i = 0; i < terms.constant_count; ++i) {
    const Range& x = at(terms.constants[i].id, c);
    constant = math_.add(constant, terms.constants[i].inverse ? math_.neg(x) : x);
  }
  std::array<Range, kMostTerms + 1> all;
  size_t n = 0;
  for (; n < terms.rests; ++n) {
    const Range& x = at(terms.rest[n].id, c);
    all[n] = terms.rest[n].inverse ? math_.neg(x) : x;
  }
  all[n++] = constant;
  return math_.sum({all.data(), n});
}

Range Intervals::regroupedProduct(ValueId id, int c) const {
  Terms terms;
  bool negative = false;
  collect(dag_, id, Op::Mul, Op::Div, false, terms, negative);
  Range product = math_.constant(negative ? -1 : 1);
  const auto take = [&](const Term& term) {
    const Range& x = at(term.id, c);
    product = term.inverse ? math_.div(product, x) : math_.mul(product, x);
  };
  for (size_t i = 0; i < terms.constant_count; ++i) take(terms.constants[i]);
  for (size_t i = 0; i < terms.rests; ++i) {
    // A value times itself is not negative.
    const Term& term = terms.rest[i];
    const auto twin = std::find_if(terms.rest.begin() + i + 1, terms.rest.begin() + terms.rests,
                                   [&](const Term& other) { return other.id == term.id; });
    if (twin == terms.rest.begin() + terms.rests || twin->inverse != term.inverse) {
      take(term);
      continue;
    }
    const Range square = math_.square(at(term.id, c));
    product = term.inverse ? math_.div(product, square) : math_.mul(product, square);
    std::copy(twin + 1, terms.rest.begin() + terms.rests, twin);
    --terms.rests;
  }
  return product;
}

}  // namespace lacquer::analysis
