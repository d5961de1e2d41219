// Between what an expression lies, as far as its text tells.
#pragma once

#include <functional>

#include "lang/ast.h"

namespace lacquer::lang {

/// Of a slot; unbounded where nothing is known.
using RangeOfSlot = std::function<ir::Interval(uint32_t slot)>;

/// Of an int or a float, which is checked; unbounded where nothing is known. What is known of are constants,
/// slots, results with a range, `+`, `-`, `*`, `min`, `max`, `clamp`, what rounds, `int(x)`, `float(x)` and
/// `?:`.
ir::Interval boundsOf(const Expr& expr, const RangeOfSlot& slot);

}  // namespace lacquer::lang
