// Intervals of integers, whose operations wrap. A UInt is the Int with its bits, as in ir/whole.h: an
// interval of UInts that holds numbers from 2^31 on is that of all Ints.
#pragma once

#include "analysis/interval_math.h"

namespace lacquer::analysis {

inline constexpr Range kWholes{-2147483648.0, 2147483647.0, false};

/// A size of a texture's level. The first is there, and no other surely.
Range textureSize(const Range& level);
Range wholeSum(const Range& a, const Range& b);
Range wholeDifference(const Range& a, const Range& b);
Range wholeProduct(const Range& a, const Range& b);
Range intQuotient(const Range& a, const Range& b);
Range uintQuotient(const Range& a, const Range& b);
Range bitAnd(const Range& a, const Range& b);
/// Of an exclusive or, too.
Range bitOr(const Range& a, const Range& b);
Range bitNot(const Range& a);
Range shiftLeft(const Range& a, const Range& count);
Range intShiftRight(const Range& a, const Range& count);
Range uintShiftRight(const Range& a, const Range& count);
Range wholeLess(const Range& a, const Range& b);
Range uintLess(const Range& a, const Range& b);
Range wholeEqual(const Range& a, const Range& b);
/// The integer of a number, towards zero.
Range intOf(const Range& x);
Range uintOf(const Range& x);
/// A UInt as the number that it is, and a range of such numbers as that of UInts.
Range uintNumber(const Range& a);
Range uintRange(const Range& numbers);

}  // namespace lacquer::analysis
