// What shaders bind of an environment: cube maps filtered for their lobes, and irradiance.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "environment/filter.h"
#include "texture/cube.h"

namespace lacquer::environment {

struct MapOptions {
  uint32_t size = 256;      ///< of environment_specular's faces: a power of two from 32 on
  uint32_t samples = 1024;  ///< about how many parts of the environment each texel is made of
  bool draft = false;       ///< no part is finer than a texel of the mirror
};

/// For a first look: at most 64 texels in a row, of about 64 parts each.
MapOptions draftOf(const MapOptions& options);

/// The nine real spherical harmonics up to the second order, at a unit direction.
std::array<double, 9> harmonicsAt(const Vec3& direction);

struct Maps {
  /// Each level has half the size; the roughness of level i is i over the last one's number, which both have
  /// in common. `charlie` has a quarter of the size: nothing in it is sharp.
  std::vector<texture::CubeLevel> specular, charlie;
  texture::CubeLevel irradiance;  ///< divided by pi
  /// The same as the factors of harmonicsAt(); up to 3 % of it are lost (Ramamoorthi and Hanrahan 2001).
  std::array<Vec3, 9> harmonics{};

  uint32_t lastLevel() const { return static_cast<uint32_t>(specular.size()) - 1; }
};

inline constexpr uint32_t kIrradianceSize = 32;

/// Called with the finished rows of texels and all of them, from one thread at a time.
using MapProgress = std::function<void(size_t done, size_t known)>;

/// The finest cells that maps of this size are made of, for LightTree.
uint32_t treeSizeOf(const Panorama& panorama, const MapOptions& options);
uint32_t treeSizeOf(const texture::CubeLevel& cube, const MapOptions& options);

/// Uses threads; the numbers do not depend on how many.
Maps makeMaps(const LightTree& tree, const MapOptions& options, const MapProgress& progress = {});

/// Puts other harmonics in the place of the irradiance; where they are negative there is no light.
void setIrradiance(Maps& maps, const std::array<Vec3, 9>& harmonics);

/// A texel of a level's cube, as a unit direction from its middle.
Vec3 texelDirection(uint32_t face, uint32_t x, uint32_t y, uint32_t size);

/// What a sampler finds: linear between texels and between levels, seamless.
Rgb lookUp(std::span<const texture::CubeLevel> levels, const Vec3& direction, double level);

}  // namespace lacquer::environment
