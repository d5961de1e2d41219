// FLIP: how different two pictures look to somebody who flips between them. Andersson, Nilsson,
// Akenine-Möller, Oskarsson, Åström and Fairchild 2020, "FLIP: A Difference Evaluator for Alternating
// Images".
#pragma once

#include <cstdint>
#include <vector>

#include "picture/color.h"

namespace lacquer::picture {

struct Pixels {
  uint32_t width = 0, height = 0;
  std::vector<Color> colors;  ///< linear light, row by row
};

/// 3840 pixels, 0.7 m wide, seen from 0.7 m: pixels per degree of the view, as the paper has it.
inline constexpr double kPixelsPerDegree = 67.0206432765823;

/// The difference at each pixel, in [0, 1]. Both have one size; their edges go on outside.
/// `pixels_per_degree` is above 0.
std::vector<double> flip(const Pixels& a, const Pixels& b, double pixels_per_degree = kPixelsPerDegree);

}  // namespace lacquer::picture
