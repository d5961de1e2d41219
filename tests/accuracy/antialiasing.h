// Bumpy balls that are drawn with one sample a pixel, against 64: what specular_antialiasing takes off the
// error of highlights that are smaller than a pixel.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace lacquer::accuracy {

struct Bumpy {
  std::string name, gltf;
  std::string roughness = "roughness_factor";  ///< of the lobe that the bumps shake
  bool mapped = false;  ///< the bumps are those of normal maps with levels, not the vertices'
};
std::vector<Bumpy> bumpyMaterials();

/// Pixels from one bump to the next, or texels to a pixel, at four distances.
constexpr std::array<double, 4> kBumps = {16, 8, 4, 2}, kTexels = {0.8, 1.6, 3.2, 6.4};
constexpr const std::array<double, 4>& distancesOf(const Bumpy& material) {
  return material.mapped ? kTexels : kBumps;
}

/// Without the switch, with it, and with pixel_lobes as well.
enum class Way { Without, With, Lobes };

/// RMS of x / (1 + x), over the balls' pixels. The best is that of lobes about the mean of the pixel's true
/// normals whose roughness is, pixel by pixel, the one that is closest.
struct Aliasing {
  double without = 0, with = 0, lobes = 0, best = 0;
};
/// Takes a second for the first who asks.
const Aliasing& aliasing(const Bumpy& material, double distance);

/// How bright pixels without any change of the normal are with the switch, over without it: the least and the
/// most of them.
std::array<double, 2> flatBrightness(const Bumpy& material, Way way);

std::string antialiasingTable();

}  // namespace lacquer::accuracy
