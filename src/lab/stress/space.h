// The inputs of what is attacked, as numbers side by side: how they are drawn, and what lies between two
// drawings.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ir/types.h"
#include "support/random.h"

namespace lacquer::stress {

enum class Nature : uint8_t {
  Number,     ///< anything in the range
  Direction,  ///< three components of any length but 0; related to the directions before it
  Flag,       ///< 0 or 1
  Texel,      ///< in [0, 1], mostly eight bits
  Index,      ///< of refraction: 0, which stands for an infinite one, or 1 and more
  Whole,      ///< an integer: a whole number of the range
  Step,  ///< from a pixel to its neighbour, of few bits; often 0, along an axis, or along the step before it
};

struct Variable {
  std::string name;
  int components = 1;
  ir::Interval range;
  Nature nature = Nature::Number;
  size_t first = 0;  ///< of its components, in a sample
};

class Space {
public:
  /// Open ends of a range are cut at `limit`. Returns the place of the first component.
  size_t add(std::string name, int components, ir::Interval range, Nature nature, double limit);

  /// A texture's texels. Where a variable has the texture's name, theirs has "_texel" behind it. They come
  /// after all others.
  size_t addTexel(std::string_view texture, int components, ir::Interval range, Nature nature, double limit);
  /// Those of a texture; null for none.
  const Variable* texel(std::string_view texture) const;

  std::span<const Variable> variables() const { return variables_; }
  const Variable* find(std::string_view name) const;
  size_t width() const { return width_; }  ///< numbers of a sample

  /// One sample, every number exact in float32, edges over-represented. A function of `seed`.
  void draw(uint64_t seed, std::span<double> sample) const;
  /// From `a` at 0 to `b` at 1, in double. Flags, whole numbers, opposite directions, and an index where one
  /// of both is 0, are those of `a`.
  void between(std::span<const double> a, std::span<const double> b, double t,
               std::span<double> sample) const;

private:
  std::vector<Variable> variables_;
  std::map<std::string, size_t, std::less<>> texels_;  ///< their variables, by texture
  size_t width_ = 0;
};

/// What a number is, by the name and the range of a parameter: an index of refraction that may be 0, or any
/// number.
Nature natureOf(std::string_view name, const ir::Interval& range);

/// The nature of a parameter by its type: a flag, a whole number, or one by its name and range.
Nature natureOf(ir::Type type, std::string_view name, const ir::Interval& range);

/// A number of the range, exact in float32.
double drawNumber(Random& random, const ir::Interval& range);

}  // namespace lacquer::stress
