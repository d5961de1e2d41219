// MaterialX's noises from their published definitions, in integers and in double: what nodes/standard/ is
// compared with. Nothing here is shared with the nodes.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <string_view>

namespace lacquer::test {

using Place = std::array<float, 3>;  ///< of a plane's the third is not looked at

/// The hash of two to five whole numbers.
uint32_t hashOf(std::initializer_list<int32_t> numbers);
/// lookup3's hashlittle() of a text, made of the same two mixings.
uint32_t hashOfText(std::string_view text, uint32_t seed);

/// Perlin's noise: channel 0 to 2 of the three that share a hash, or -1 for the one with a hash of its own.
double perlin(int dimensions, const Place& place, int channel);

/// Noise in so many channels (1 to 4), of amplitude 1 about 0.
std::array<double, 4> noise(int dimensions, int channels, const Place& place);
std::array<double, 4> fractal(int dimensions, int channels, const Place& place, int octaves, float lacunarity,
                              float diminish);

double cellNoise(int dimensions, const Place& place);

struct Worley {
  std::array<double, 3> distances;
  std::array<double, 3> numbers;  ///< of the cell with the nearest point
  double number = 0;              ///< the one that the node of one channel gives
  double margin = 0;              ///< how far the point is from where another cell would be the nearest's
};
/// `metric`: 0 Euclid's, 1 its square, 2 Manhattan's, 3 Chebyshev's.
Worley worley(int dimensions, const Place& place, double jitter, int metric);

struct Flake {
  int32_t id = 0;
  double rand = 0, presence = 0;
  std::array<double, 3> normal{0, 0, 1};
  double margin = 0;  ///< how far from where the answer is another one
};
/// In the frame of the axes.
Flake flake(const Place& place, double size, double roughness, double coverage);

}  // namespace lacquer::test
