// Bumpy balls that are drawn with one sample a pixel, against 64: what specular_antialiasing takes off the
// error of highlights that are smaller than a pixel.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace lacquer::accuracy {

struct Bumpy {
  std::string name, gltf;
  bool mapped = false;  ///< the bumps are a normal map's, filtered over the pixel, not the vertices'
};
std::vector<Bumpy> bumpyMaterials();

/// Pixels from one bump to the next, at four distances.
constexpr std::array<double, 4> kBumps = {8, 5, 3, 2};

/// RMS of x / (1 + x), over the ball's pixels.
struct Aliasing {
  double without = 0, with = 0;
};
Aliasing aliasing(const Bumpy& material, double pixels_to_a_bump);

/// How bright pixels without any change of the normal are with the switch, over without it: the least and the
/// most of them.
std::array<double, 2> flatBrightness(const Bumpy& material);

std::string antialiasingTable();

}  // namespace lacquer::accuracy
