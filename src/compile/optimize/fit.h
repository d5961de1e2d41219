// Polynomials and quotients of them in the place of functions of one number, with errors that are proved: by
// intervals over boxes that are halved until each keeps what is claimed.
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

/// How many terms a form has: a polynomial of `terms` coefficients, and where `divisor` is more than 0 a
/// quotient beside it, whose divisor is of that degree and whose dividend of a lower one, 0 or 1.
struct Shape {
  size_t terms = 1;
  size_t dividend = 0, divisor = 0;
};

/// A polynomial and a quotient, whose coefficients are floats, the constant first. The last one of a dividend
/// is 1, so that it costs nothing; a polynomial alone has no divisor.
struct Form {
  std::vector<ir::Components> coefficients;
  std::vector<ir::Components> dividend, divisor;
};

struct Fit : Form {
  double error = 0;     ///< of a component, at most, evaluated by Horner in float32
  double rounding = 0;  ///< the part of it that is rounding
  Range reached{};      ///< of all components, in real arithmetic
  Range divided{};      ///< what the divisor is in float32, never 0
};

/// A form of that shape over a domain that is finite. Where the function is never below `least` the form is
/// not either. Nothing where an error of at most `most` cannot be proved, or where the divisor may be 0.
std::optional<Fit> fit(Curve& curve, const Range& domain, const Shape& shape, double most,
                       std::optional<double> least);

/// The largest error of the form that fit() begins with, at some points: no proof.
double sampledError(Curve& curve, const Range& domain, const Shape& shape);

/// For an error of this form over the domain: whether it is at most `most` everywhere. What the form can be
/// is added to `reached`.
bool prove(Curve& curve, const Range& domain, const Form& form, double most, Range& reached);

/// The quotient of polynomials of that shape which is off least, nearly; its numbers are rounded to floats.
/// Nothing where none is found.
std::optional<Form> quotient(Curve& curve, const Range& domain, const Shape& shape);

}  // namespace lacquer::optimize
