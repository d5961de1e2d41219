// The light of a lamp by its direction, and the table of it that shaders read.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "photometry/lm63.h"

namespace lacquer::photometry {

using Vec3 = std::array<double, 3>;

/// Who is alike to whom: all turns about the aim, four quarters, two halves, or none.
enum class Symmetry : uint8_t { Round, Quadrants, Halves, None };

/// Candela in every direction, linear in both angles between those of the file, 0 beyond them. Directions are
/// of the light's node in glTF: it aims at -z, the plane of the vertical angles is x and z. Horizontal
/// angles of C go from +x to +y; of A and B vertical angles rise to +x, and horizontal ones go to -y, which
/// is clockwise about +x.
/// source: EXT_lights_ies, "Coordinate System Mapping"; IES LM-75
class Distribution {
public:
  explicit Distribution(const Measured& measured);

  /// Of a unit direction.
  double at(const Vec3& direction) const;
  /// The greatest there is.
  double peak() const { return peak_; }
  /// The integral over all directions.
  double lumens() const;
  Symmetry symmetry() const { return symmetry_; }
  /// The directions at which the file has values, by itself or by symmetry.
  size_t nodes() const { return candela_.size(); }
  Vec3 node(size_t i) const;

private:
  void ofLatitudes();
  void ofTurns();
  void mirror(double plane);
  void mirrorRows();
  double inRow(size_t row, size_t cell, double part) const;

  Vec3 pole_{}, zero_{}, quarter_{};  ///< where the polar angle is 0, and at its middle the turns of 0 and 90
  std::vector<double> polar_, turn_;  ///< degrees, ascending; turns reach from the first once around at most
  std::vector<double> candela_;       ///< for each turn those of all polar angles
  double peak_ = 0;
  Symmetry symmetry_ = Symmetry::None;
};

/// What `light_profile` looks up: in each row the angle from the light's direction goes from 0 to 180 degrees
/// over the width, over the height the turn about it once around, from the node's +x to -y. Texels are parts
/// of the peak at their middles.
struct Table {
  uint32_t width = 0, height = 0;
  std::vector<float> texels;
};
Table tableOf(const Distribution& distribution, uint32_t width, uint32_t height);
/// What a sampler finds: linear, u clamped and v repeated.
double lookUp(const Table& table, double u, double v);
/// The direction of a lookup.
Vec3 directionAt(double u, double v);
/// Differences between lookups and the distribution, as parts of the peak.
struct Errors {
  double most = 0;  ///< at the file's own directions, and at texels' middles and edges
  double mean = 0;  ///< over all directions
};
Errors errorsOf(const Table& table, const Distribution& distribution);

}  // namespace lacquer::photometry
