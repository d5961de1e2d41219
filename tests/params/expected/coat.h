// forward-coat-3156e1436f5327df
// Lacquer 0.2.0, template forward
//
// The material's uniform block from its parameters. C++11; for the bytes of the library's own pack(), compile
// without contraction of products and sums (-ffp-contract=off) and without -ffast-math.
#ifndef LACQUER_FORWARD_COAT_3156E1436F5327DF_H
#define LACQUER_FORWARD_COAT_3156E1436F5327DF_H

#include <cmath>
#include <cstddef>
#include <cstring>

namespace lacquer_shaders {
namespace forward_coat_3156e1436f5327df {

/// What can be edited. The values here are glTF's defaults and belong to no material.
struct Parameters {
  double base_color_factor[4] = {1.0, 1.0, 1.0, 1.0};
  double coat_factor = 0.0;
  double coat_roughness_factor = 0.0;
  double metallic_factor = 1.0;
  double roughness_factor = 1.0;
};

/// The uniform block `Material` as the GPU reads it: std140.
struct Block {
  float base_color_factor[3];
  float metallic_factor;
  float base_color_complement[3];
  float roughness_factor;
  float metal_repeated[3];
  float coat_factor;
  float F0[3];
  float coat_roughness_factor;
  float alpha2;
  float alpha2_ratio;
  float weight_times_ggx_peak;
  float lambert;
  float least_f0;
  float inverse_metallic;
  float inverse_clear;
  float dielectric_repeated;
  float white_F0;
  float lacquer_padding_0[3];
};
static_assert(offsetof(Block, base_color_factor) == 0, "std140");
static_assert(offsetof(Block, metallic_factor) == 12, "std140");
static_assert(offsetof(Block, base_color_complement) == 16, "std140");
static_assert(offsetof(Block, roughness_factor) == 28, "std140");
static_assert(offsetof(Block, metal_repeated) == 32, "std140");
static_assert(offsetof(Block, coat_factor) == 44, "std140");
static_assert(offsetof(Block, F0) == 48, "std140");
static_assert(offsetof(Block, coat_roughness_factor) == 60, "std140");
static_assert(offsetof(Block, alpha2) == 64, "std140");
static_assert(offsetof(Block, alpha2_ratio) == 68, "std140");
static_assert(offsetof(Block, weight_times_ggx_peak) == 72, "std140");
static_assert(offsetof(Block, lambert) == 76, "std140");
static_assert(offsetof(Block, least_f0) == 80, "std140");
static_assert(offsetof(Block, inverse_metallic) == 84, "std140");
static_assert(offsetof(Block, inverse_clear) == 88, "std140");
static_assert(offsetof(Block, dielectric_repeated) == 92, "std140");
static_assert(offsetof(Block, white_F0) == 96, "std140");
static_assert(sizeof(Block) == 112, "std140");

constexpr std::size_t kBlockSize = 112;

namespace detail {
// A value that is not finite becomes 0, and so does -0.
inline float to_float(double x) { return std::isfinite(x) && x != 0 ? static_cast<float>(x) : 0.0f; }
template <class T>
T inversesqrt(T a) {
  return T(1) / std::sqrt(a);
}
template <class T>
T max_of(T a, T b) {
  return (a < b ? b : a);
}
struct vec3 {
  double x, y, z;
  explicit vec3(double a) : x(a), y(a), z(a) {}
  vec3(double a, double b, double c) : x(a), y(b), z(c) {}
  explicit vec3(const double* from) : x(from[0]), y(from[1]), z(from[2]) {}
};
struct vec4 {
  double x, y, z, w;
  explicit vec4(double a) : x(a), y(a), z(a), w(a) {}
  vec4(double a, double b, double c, double d) : x(a), y(b), z(c), w(d) {}
  explicit vec4(const double* from) : x(from[0]), y(from[1]), z(from[2]), w(from[3]) {}
};
inline void store(float* to, const vec3& x) {
  to[0] = to_float(x.x);
  to[1] = to_float(x.y);
  to[2] = to_float(x.z);
}
inline void store(float* to, const vec4& x) {
  to[0] = to_float(x.x);
  to[1] = to_float(x.y);
  to[2] = to_float(x.z);
  to[3] = to_float(x.w);
}
inline vec3 operator+(const vec3& a, double b) { return vec3(a.x + b, a.y + b, a.z + b); }
inline vec3 operator-(double a, const vec3& b) { return vec3(a - b.x, a - b.y, a - b.z); }
inline vec3 operator*(const vec3& a, double b) { return vec3(a.x * b, a.y * b, a.z * b); }
}  // namespace detail

/// The block for these parameters.
inline Block pack(const Parameters& p) {
  using namespace detail;
  const vec4 base_color_factor(p.base_color_factor);
  // base.alpha: glTF 2.0, Appendix B, "Microfacet Surfaces" and "Specular BRDF" (note on alpha = 0)
  double alpha = max_of(p.roughness_factor * p.roughness_factor, 0.001);

  // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
  double alpha2 = alpha * alpha;
  double ggx_peak = alpha2 / 3.141592653589793;

  // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
  double alpha2_complement = max_of(1.0 - alpha2, 1e-12);
  double alpha2_ratio = alpha2 / alpha2_complement;
  double weight = 0.5 * inversesqrt(alpha2_complement);

  // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
  double dielectric = 1.0 - p.metallic_factor;
  double lambert = dielectric * 0.30557749073643903;
  double least_f0 = 0.04 * dielectric;

  // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based
  // Lighting"
  vec3 base_color_complement = 1.0 - vec3(base_color_factor.x, base_color_factor.y, base_color_factor.z);
  double inverse_metallic = 1.0 / max_of(p.metallic_factor, 1e-07);
  vec3 mean_fresnel = 0.999999 - base_color_complement * 0.9523809523809523;
  vec3 metal_repeated = mean_fresnel * inverse_metallic;
  double inverse_clear = 1.0 / max_of(dielectric * 0.96, 1e-07);
  double dielectric_repeated = 0.08571328571428583 * inverse_clear;
  vec3 F0 =
      vec3(base_color_factor.x, base_color_factor.y, base_color_factor.z) * p.metallic_factor + least_f0;
  double white_F0 = least_f0 + p.metallic_factor;

  Block block = {};
  store(block.base_color_factor, vec3(base_color_factor.x, base_color_factor.y, base_color_factor.z));
  block.metallic_factor = to_float(p.metallic_factor);
  store(block.base_color_complement, base_color_complement);
  block.roughness_factor = to_float(p.roughness_factor);
  store(block.metal_repeated, metal_repeated);
  block.coat_factor = to_float(p.coat_factor);
  store(block.F0, F0);
  block.coat_roughness_factor = to_float(p.coat_roughness_factor);
  block.alpha2 = to_float(alpha2);
  block.alpha2_ratio = to_float(alpha2_ratio);
  block.weight_times_ggx_peak = to_float(weight * ggx_peak);
  block.lambert = to_float(lambert);
  block.least_f0 = to_float(least_f0);
  block.inverse_metallic = to_float(inverse_metallic);
  block.inverse_clear = to_float(inverse_clear);
  block.dielectric_repeated = to_float(dielectric_repeated);
  block.white_F0 = to_float(white_F0);
  return block;
}

/// Writes the block: kBlockSize bytes, of any alignment.
inline void pack(const Parameters& p, void* bytes) {
  const Block block = pack(p);
  std::memcpy(bytes, &block, sizeof block);
}

/// Where something is bound: descriptor set and binding for Vulkan, `flat` where there are no sets.
struct Binding {
  unsigned set, binding, flat;
};
constexpr Binding kFrameBinding = {0, 0, 0};
constexpr Binding kLightBinding = {0, 1, 1};
constexpr Binding kObjectBinding = {2, 0, 3};
constexpr Binding kMaterialBinding = {1, 0, 2};

/// `srgb`: to be given an sRGB format. `environment`: the frame's, not the material's.
struct Texture {
  const char* name;
  Binding binding;
  bool cube, srgb, environment;
};
constexpr std::size_t kTextureCount = 4;
namespace textures {
constexpr Texture environment_specular = {"environment_specular", {0, 2, 0}, true, false, true};
constexpr Texture environment_irradiance = {"environment_irradiance", {0, 3, 1}, true, false, true};
constexpr Texture environment_dfg = {"environment_dfg", {0, 4, 2}, false, false, true};
constexpr Texture coat_texture = {"coat_texture", {1, 1, 3}, false, false, false};
}  // namespace textures
constexpr Texture kTextures[] = {textures::environment_specular, textures::environment_irradiance,
                                 textures::environment_dfg, textures::coat_texture};

}  // namespace forward_coat_3156e1436f5327df
}  // namespace lacquer_shaders

#endif
