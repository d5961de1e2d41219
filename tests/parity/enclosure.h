// What any conforming machine may compute at one point: the bound that all engines are held to.
//
// Every value of the DAG gets an interval. The inputs are exact floats; each operation's interval holds every
// result that Vulkan's precision for it allows, on any operands in theirs (passes/interval_math.h; Vulkan
// specification, "Precision and Operation of SPIR-V Instructions"):
//
//   *, dot, cross         each step correctly rounded, in either direction, sums in any order, fused or not
//   + -                   a ULP of the larger operand: nothing forbids a compiler to write a * (1 - t) + b *
//   t
//                         as a + (b - a) * t, and Mesa's does; alone, correctly rounded
//   /                     2.5 ULP
//   sqrt, inversesqrt     5 and 2 ULP
//   exp2, exp             3 + 2 |x| ULP
//   log2, log             3 ULP, within [0.5, 2] absolutely 2^-21
//   pow                   as exp2(y * log2(x))
//   normalize             x * inversesqrt(dot(x, x)) or x / sqrt(dot(x, x))
//   sin, cos              absolutely 2^-11 within [-pi, pi]
//   min, max, abs, neg,   exact; a comparison that its operands' intervals leave open may go both ways
//   floor, comparisons
//   dFdx, dFdy            differences of neighbours, in either row or column of the quad; there the inputs
//                         are interpolated, and off by 8 ULP of the largest of the four
//   texture               the filter's weights have `subTexelPrecisionBits`
//
// So the bound follows each point's own conditioning: a few ULP where the formula is well conditioned, more
// where a difference cancels. Nothing is added for luck, and the facts that nodes assume are not used.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "analysis/interval_math.h"
#include "eval/bindings.h"
#include "ir/loops.h"
#include "ir/module.h"

namespace lacquer::parity {

/// Texels of an image and the part of a texel that its filter tells apart; 1 by 1 for what is constant.
struct TextureSize {
  double width = 1, height = 1;
};

struct EnclosureOptions {
  uint32_t sub_texel_bits = 8;
  /// The material's numbers (fields of its block, specialization constants) may be off by a unit in the last
  /// place: they were rounded before the shader was given them.
  bool rounded_parameters = false;
  /// Sums may be regrouped. Otherwise they are correctly rounded in either direction, like products.
  bool regrouped = true;
};

class Enclosure {
public:
  Enclosure(const ir::Module& module, const eval::Bindings& bindings,
            const std::map<std::string, TextureSize>& sizes, const EnclosureOptions& options);

  /// The components of the values at a point, one after the other.
  std::vector<analysis::Range> at(size_t point, const std::vector<ir::ValueId>& roots);

private:
  using Ranges = std::array<analysis::Range, 4>;
  void value(ir::ValueId id);
  void value(ir::ValueId id, int32_t loop);
  void rounds(int32_t loop);
  void input(ir::ValueId id);
  void element(ir::ValueId id);
  void sumOverLights(ir::ValueId id);
  void texture(ir::ValueId id);
  void normalize(ir::ValueId id);
  void derivative(ir::ValueId id, size_t step);
  void matrixTimesVector(ir::ValueId id);
  void componentWise(ir::ValueId id);
  analysis::Range arithmetic(ir::Op op, const analysis::Range& a, const analysis::Range& b,
                             const analysis::Range& c) const;
  analysis::Range regrouped(const analysis::Range& sum, const analysis::Range& a,
                            const analysis::Range& b) const;
  analysis::Range wave(const analysis::Range& a, double (*f)(double)) const;
  analysis::Range dot(ir::ValueId a, ir::ValueId b) const;
  const analysis::Range& get(ir::ValueId id, size_t component) const;
  int width(ir::ValueId id) const;
  bool varies(ir::ValueId id) const;

  const ir::Module& module_;
  const ir::Dag& dag_;
  const eval::Bindings& bindings_;
  const std::map<std::string, TextureSize>& sizes_;
  EnclosureOptions options_;
  analysis::RangeMath math_;
  std::vector<Ranges> values_;
  std::map<ir::ValueId, std::vector<ir::ValueId>> bodies_;  ///< of the sums over lights
  ir::Loops loops_;
  std::map<std::pair<ir::ValueId, uint32_t>, Ranges> left_;  ///< what loops carried, by their chains' ends
  size_t point_ = 0;
  size_t light_ = 0;
};

}  // namespace lacquer::parity
