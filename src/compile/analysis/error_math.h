// Bounds of errors: how far a computed number may be from the one that it stands for, carried forward through
// operations. Every rule holds for errors of any size, not to first order only.
#pragma once

#include "analysis/interval_math.h"

namespace lacquer::analysis {

/// A number x may be off by at most `part` |x| + `amount`.
struct Error {
  double part = 0, amount = 0;
  bool none() const { return part == 0 && amount == 0; }
  bool finite() const;
};

inline constexpr double kHalfUnit = 0x1p-10;   ///< a number rounded to half is off by at most this part
inline constexpr double kHalfLeast = 0x1p-14;  ///< what is smaller may become 0
inline constexpr double kHalfMost = 0x1p14;    ///< GLSL ES 3.00, 4.5.2: beyond it `mediump` holds nothing

Error unknownError();
/// `units` roundings of a number in the range that is off by `e` already. Unknown where half precision may
/// not hold it.
Error roundedError(const Range& x, const Error& e, double units = 1);

Error errorOfSum(const Range& x, const Error& ex, const Range& y, const Error& ey);
Error errorOfProduct(const Range& x, const Error& ex, const Range& y, const Error& ey);
Error errorOfQuotient(const Error& ex, const Range& y, const Error& ey);
/// Of a minimum, a maximum, a choice that is sure: whichever it is.
Error errorOfEither(const Error& x, const Error& y);
Error errorOfRoot(const Range& x, const Error& e);
Error errorOfInverseRoot(const Range& x, const Error& e);
/// Of 2 to the x.
Error errorOfPower(const Range& x, const Error& e);

}  // namespace lacquer::analysis
