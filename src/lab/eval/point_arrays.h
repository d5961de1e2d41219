// Points of an evaluation from the arrays of a caller.
#pragma once

#include "eval/points_file.h"
#include "lacquer/tools.h"

namespace lacquer {

/// The arrays as readPoints() would give them, checked alike. Errors: "wrong-type" for a number of components
/// that the name does not have, "not-finite", "zero-length", "not-unit", "out-of-range", "duplicate-name",
/// "too-many-points" above 2^26.
/// The place is the array's name and the point's number, as in "/v/17". Of the points `count` from `first` on
/// are read.
Result<EvalPoints> pointsOf(const PointArrays& arrays, size_t first, size_t count);

}  // namespace lacquer
