// Radiance over the sphere as a tree of cells: the texels of a cube map, and the squares that they make up.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "environment/faces.h"
#include "texture/cube.h"

namespace lacquer::environment {

/// What a cell sends and whence.
struct Cell {
  std::array<float, 3> flux{};    ///< radiance times solid angle
  float angle = 0;                ///< the solid angle, steradians
  std::array<float, 3> middle{};  ///< unit: the mean direction of the cell
  std::array<float, 3> light{};   ///< unit: the mean direction of its light, by its luminance; dark: `middle`
};

/// Levels of cells from one for each face to `size` by `size` for each.
class LightTree {
public:
  /// Each pixel of the panorama counts as a patch of one colour, cut so fine that no cell is without some of
  /// them: nothing of its light is lost, whatever `size` is. A power of two.
  LightTree(const Panorama& panorama, uint32_t size);
  /// The same of a cube map's texels.
  LightTree(const texture::CubeLevel& cube, uint32_t size);

  uint32_t size() const { return uint32_t{1} << (static_cast<uint32_t>(levels_.size()) - 1); }
  uint32_t levels() const { return static_cast<uint32_t>(levels_.size()); }
  /// Of a level with 2^level cells in a row, in the order of placeOf().
  const std::vector<Cell>& level(uint32_t level) const { return levels_[level]; }

private:
  std::vector<std::vector<Cell>> levels_;
};

/// Where the cell of a cube's texel stands, which are counted face by face and row by row, in a level of the
/// tree: those that cell i is cut into are 4 i to 4 i + 3 of the next level, so that what lies together is
/// read together.
size_t placeOf(size_t texel, uint32_t level);

/// A lobe about a direction, as a function of the cosine to it; only what is in front counts.
class Lobe {
public:
  /// GGX seen along its normal (N = V = R): D(h) N.L, with alpha = roughness squared.
  static Lobe ggx(double roughness);
  /// The fibres' lobe of KHR_materials_sheen in the same way.
  static Lobe charlie(double roughness);
  /// N.L: irradiance.
  static Lobe cosine();

  enum class Kind : uint8_t { Ggx, Charlie, Cosine };
  Kind kind() const { return kind_; }
  double alpha() const { return alpha_; }

  /// The squared distance over which the lobe hardly changes, of a chord on the unit sphere: the least of
  /// cosines from `low` to `high`.
  double scale2(double low, double high) const;
  /// The cosine from which on it is so small that nothing there counts: below 1e-8 of its most.
  double end() const;

private:
  Lobe(Kind kind, double alpha) : kind_(kind), alpha_(alpha) {}
  Kind kind_;
  double alpha_;
};

/// Directions that are filtered together: neighbours, whose lobes want nearly the same cells.
inline constexpr size_t kTogether = 16;

/// The mean of the radiance about a direction, weighted by a lobe: the integral of both over that of the
/// lobe.
class Filter {
public:
  using Run = std::function<void(std::span<const Vec3> directions, std::span<Rgb> means)>;

  /// Cells are cut until they are `fineness` of the distance over which the lobe changes, which makes about
  /// 64 / fineness^2 of them. The tree must outlive this.
  Filter(const LightTree& tree, const Lobe& lobe, double fineness);
  /// Of unit directions, at most kTogether of them: cells are as fine as any of them wants. Thread-safe.
  void operator()(std::span<const Vec3> directions, std::span<Rgb> means) const;

private:
  Run run_;
};

}  // namespace lacquer::environment
