// Colours of pictures, and how different two of them look.
#pragma once

#include <array>

namespace lacquer::picture {

/// Linear light of sRGB's primaries as a display emits it, each channel in [0, 1]; or three coordinates of
/// another space.
using Color = std::array<double, 3>;

/// CIE XYZ, white at (0.9505, 1, 1.0889), from linear light and back.
Color xyzOf(const Color& linear);
Color linearOf(const Color& xyz);

/// CIE L*a*b* for sRGB's white.
Color labOf(const Color& linear);

/// YCxCz: CIE L*a*b* without its cube root, so that a filter of it is one of light. And back.
Color ycxczOf(const Color& linear);
Color linearOfYcxcz(const Color& ycxcz);

/// CIEDE2000, of two colours in CIE L*a*b*: about 1 is just seen. Sharma, Wu and Dalal 2005, "The CIEDE2000
/// Color-Difference Formula".
double deltaE2000(const Color& a, const Color& b);

}  // namespace lacquer::picture
