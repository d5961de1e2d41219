// Normal maps that look like real ones, made here: eight bits, with levels that are means of the one above.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lacquer::accuracy {

enum class Relief { Stone, Leather, Bricks };
constexpr std::array kReliefs = {Relief::Stone, Relief::Leather, Relief::Bricks};

class NormalMap {
public:
  using Texel = std::array<double, 3>;
  static constexpr int kSize = 512;

  explicit NormalMap(Relief relief);
  /// All of one texel.
  explicit NormalMap(const Texel& flat);
  static const NormalMap& of(Relief relief);

  /// Red, green and blue between texels and levels, as a sampler with linear filters has them; it repeats.
  Texel at(double u, double v, double lod) const;

private:
  Texel between(size_t level, double u, double v) const;

  std::vector<std::vector<std::array<uint8_t, 3>>> levels_;
};

}  // namespace lacquer::accuracy
