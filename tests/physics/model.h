// The subject of these tests and their yardstick: a material as plain numbers, its glTF text, and what the
// specifications say that it looks like.
//
// reference() is written from the texts (glTF 2.0 Appendix B, KHR_materials_coat, KHR_materials_clearcoat,
// EXT_materials_clearcoat_color, EXT_materials_clearcoat_darkening, ADOBE_materials_clearcoat_tint,
// KHR_materials_ior, KHR_materials_emissive_strength, KHR_materials_anisotropy's visibility) in their own
// form, in long double, where a cancellation costs nothing. It shares nothing with nodes/, on purpose: do not
// make it do so.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <random>
#include <string>

namespace lacquer::physics {

using Vec2 = std::array<double, 2>;
using Vec3 = std::array<double, 3>;
using Vec4 = std::array<double, 4>;

struct Clearcoat {
  double factor = 0, roughness = 0;
  std::optional<Vec3> color;        ///< EXT_materials_clearcoat_color
  std::optional<double> darkening;  ///< EXT_materials_clearcoat_darkening
};

struct Coat {
  double factor = 0, roughness = 0, ior = 1.5, darkening = 1, anisotropy = 0, rotation = 0;
  Vec3 color{1, 1, 1};
};

struct Material {
  Vec4 base_color{1, 1, 1, 1};
  double metallic = 1, roughness = 1;
  Vec3 emissive{0, 0, 0};
  std::optional<double> emissive_strength, ior;
  bool blend = false;
  bool double_sided = false;
  bool unlit = false;
  double normal_scale = 1, coat_normal_scale = 1;
  std::optional<Clearcoat> clearcoat;
  std::optional<Vec3> tint;  ///< ADOBE_materials_clearcoat_tint
  std::optional<Coat> coat;
  /// Constant textures by glTF property name ("coatTexture"), as linear RGBA. One without its extension is
  /// left out.
  std::map<std::string, Vec4> texels;
};

struct Sample {
  Vec3 n{0, 0, 1};
  Vec4 t{1, 0, 0, 1};
  Vec3 v{0, 0, 1}, l{0, 0, 1};
  Vec4 color0{1, 1, 1, 1};
  Vec3 light{1, 1, 1};
  bool front_facing = true;
  Vec3 position{};
  Vec2 uv{};  ///< of every set
};

/// Readings that a test may switch to the other one, to see that it would notice.
struct Readings {
  double alpha_min = 0.001;  ///< reading 11
};

/// Direct light of one directional light, and emission; alpha.
Vec4 reference(const Material& material, const Sample& sample, const Readings& readings = {});

/// A .gltf with that one material, "M".
std::string gltfOf(const Material& material);

using Random = std::mt19937_64;

double uniform(Random& random, double lo = 0, double hi = 1);
Vec3 unitVector(Random& random);
/// In the hemisphere around n, uniform in the cosine.
Vec3 unitVectorAbove(Random& random, const Vec3& n);

/// A material of every kind with factors all over their ranges, ends included now and then.
Material randomMaterial(Random& random);
/// A random frame, view and light; `upper` keeps view and light above the surface.
Sample randomSample(Random& random, bool upper);

// Small vector algebra of the tests.
double dot(const Vec3& a, const Vec3& b);
Vec3 cross(const Vec3& a, const Vec3& b);
Vec3 normalized(const Vec3& a);
/// A unit vector in the x-z plane, `cosine` from z.
Vec3 tilted(double cosine, double azimuth = 0);

}  // namespace lacquer::physics
