// Polynomials in the place of functions of one number, with errors that are proved: by intervals over boxes
// that are halved until each keeps what is claimed.
#pragma once

#include <optional>
#include <vector>

#include "optimize/ranges.h"

namespace lacquer::optimize {

/// A node of a plan as a function of another one, a Float, with nothing but constants beside.
class Curve {
public:
  /// `nodes`: those that depend on `variable`, in the plan's order, the function last.
  Curve(const Plan& plan, const Constants& constants, Ref variable, std::vector<Ref> nodes);

  /// Values and derivatives for all numbers of a range, in real arithmetic.
  struct Box {
    Ranges value, slope;
  };
  const Box& over(const Range& x);
  /// Components of the function.
  int width() const;

private:
  Range slope(const Node& node, int c, const Ranges& result) const;

  const Plan& plan_;
  const Constants& constants_;
  Ref variable_;
  std::vector<Ref> nodes_;
  analysis::RangeMath math_;
  std::vector<Box> boxes_;  ///< by node of the plan
};

struct Fit {
  std::vector<ir::Components> coefficients;  ///< of each power, floats, the constant first
  double error = 0;                          ///< of a component, at most, evaluated by Horner in float32
  double rounding = 0;                       ///< the part of it that is rounding
  Range reached{};                           ///< of all components, in real arithmetic
};

/// A polynomial of that degree over a domain that is finite. Where the function is never below `least` the
/// polynomial is not either. Nothing where an error of at most `most` cannot be proved.
std::optional<Fit> fit(Curve& curve, const Range& domain, size_t degree, double most,
                       std::optional<double> least);

/// The largest error of the polynomial that fit() begins with, at some points: no proof.
double sampledError(Curve& curve, const Range& domain, size_t degree);

/// For an error of these coefficients over the domain: whether it is at most `most` everywhere. What the
/// polynomial can be is added to `reached`.
bool prove(Curve& curve, const Range& domain, const std::vector<ir::Components>& coefficients, double most,
           Range& reached);

}  // namespace lacquer::optimize
