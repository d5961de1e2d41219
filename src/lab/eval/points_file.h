// The points of `lacquer eval`, from JSON.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "eval/points.h"
#include "support/diagnostic.h"
#include "support/limits.h"

namespace lacquer {

struct EvalPoints {
  eval::PointColumns points;
  /// Of attributes by name, where the columns have more than were given: how many numbers those are.
  std::map<std::string, int, std::less<>> attribute_components;
  std::set<std::string>
      matrices;  ///< attributes that were given as matrices; the columns of points are theirs
  std::vector<std::array<double, 3>> environment;  ///< radiance, one per point; black where none is given
  bool has_environment = false;                    ///< a point names one
  std::map<std::string, eval::Column> parameters;  ///< by name or JSON pointer, in place of today's values
  std::map<std::string, std::vector<double>> uniforms;  ///< fields of the template's blocks: "frame.exposure"
};

/// The rows of a square matrix of so many numbers, 9 or 16; 0 for other counts.
constexpr size_t matrixSide(size_t numbers) { return numbers == 9 ? 3 : numbers == 16 ? 4 : 0; }

/// Reads an array of points, or an object whose "points" is one (docs/eval.md). `file` stands for the text in
/// diagnostics, which carry a JSON pointer each. Unit vectors come out normalized.
Result<EvalPoints> readPoints(std::string_view text, const std::string& file, const Limits& limits);

}  // namespace lacquer
