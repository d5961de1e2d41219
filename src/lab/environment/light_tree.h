// Radiance over the sphere as a tree of cells: the texels of a cube map, and the squares that they make up.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "environment/faces.h"
#include "environment/four.h"
#include "texture/cube.h"

namespace lacquer::environment {

/// What a cell sends and whence.
struct Cell {
  std::array<float, 3> flux{};    ///< radiance times solid angle
  float angle = 0;                ///< the solid angle, steradians
  std::array<float, 3> middle{};  ///< unit: the mean direction of the cell
  std::array<float, 3>
      offset{};  ///< from there to the mean direction of its light, by its luminance: unit, too
};

/// The four cells that one is cut into, number by number, as a processor's lanes take them.
struct Quad {
  std::array<Four, 3> middle{}, offset{}, flux{};
  Four angle{};
};

/// Levels of cells from one for each face to `size` by `size` for each.
class LightTree {
public:
  /// Each pixel of the panorama counts as a patch of one colour, cut so fine that no cell is without some of
  /// them: nothing of its light is lost, whatever `size` is. A power of two from 2 on.
  LightTree(const Panorama& panorama, uint32_t size);
  /// The same of a cube map's texels.
  LightTree(const texture::CubeLevel& cube, uint32_t size);

  uint32_t size() const { return uint32_t{1} << (levels() - 1); }
  uint32_t levels() const { return static_cast<uint32_t>(levels_.size()); }
  /// Of a level with 2^level cells in a row, in the order of placeOf(). Of the faces' own level the last
  /// quad has two cells that send nothing.
  const std::vector<Quad>& level(uint32_t level) const { return levels_[level]; }
  Cell cell(uint32_t level, size_t place) const;

private:
  std::vector<std::vector<Quad>> levels_;
};

/// Where the cell of a cube's texel stands, which are counted face by face and row by row, in a level of the
/// tree: cell i is cut into those of quad i of the next level, so that what lies together is read together.
size_t placeOf(size_t texel, uint32_t level);

}  // namespace lacquer::environment
