// What programs cost, from one for each structure to as few as can be: for people and for tools.
#pragma once

#include <string>
#include <vector>

#include "programs/division.h"

namespace lacquer::programs {

/// A program's cycles by the model and by a driver.
struct Compared {
  double model = 0, driver = 0;
  size_t structures = 1;  ///< that share the program
};

/// How far the model may be off: its numbers beside those of a driver. Half of the programs say by how much
/// to scale it for the other half, and the other way round: none is compared with a fit that has seen it.
struct ModelError {
  size_t compared = 0;            ///< programs
  double scale = 1;               ///< the model's cycles are multiplied by it: of all programs
  double mean = 0, largest = 0;   ///< relative
  size_t largest_structures = 0;  ///< of the program that the model is off the most
};

/// The scale with the least squares of relative differences, and the differences that are left, every second
/// program's by the scale of the others. A single program has none.
ModelError fitModel(const std::vector<Compared>& programs);

struct Point {
  size_t programs = 0;
  double cost = 0;                  ///< cycles for each pixel, the mean over the materials by weight
  double largest_rise = 0;          ///< of one structure's cost, relative to that of its own program
  std::string worst;                ///< that structure
  std::string made, first, second;  ///< the merge that leads here; empty at the first point
};

struct Curve {
  size_t materials = 0, structures = 0;
  size_t made = 0;      ///< programs that the run writes
  size_t measured = 0;  ///< merged programs that were made for the search
  std::string driver;   ///< whose costs these are; empty: the model's
  ModelError error;     ///< of the model, where there was a driver to compare with
  std::vector<Point> points;
};

/// The points of a merging, of which each step has a division, the first that without a merge.
std::vector<Point> pointsOf(const std::vector<Item>& items, const Merging& merging,
                            const std::vector<Division>& divisions);

std::string toJson(const Curve& curve);
std::string toMarkdown(const Curve& curve);
std::string toSvg(const Curve& curve);

}  // namespace lacquer::programs
