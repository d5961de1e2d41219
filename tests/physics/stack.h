// A material of all extensions but the cloth, as numbers, and what the texts make of it in double: the
// yardstick of the layers below and with a clear coat.
//
// It is written from the extensions' texts, from Appendix B and from the table of readings in
// docs/specification.md, and shares nothing with nodes/ or src/, on purpose: do not make it do so. It reads a
// material's JSON by itself, too.
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "physics/film_reference.h"
#include "physics/model.h"

namespace lacquer::physics {

/// Stretched highlights; the direction is relative to the tangent and unit, or (1, 0).
struct StackAnisotropy {
  double strength = 0, rotation = 0;
  Vec2 direction{1, 0};
  bool openpbr = false;
};

/// A clear coat without colour.
struct StackCoat {
  double weight = 0, roughness = 0, ior = 1.5;
  double specular = 1;  ///< of F0 and F90 (ADOBE_materials_clearcoat_specular)
  StackAnisotropy anisotropy;
};

/// Factors times texels.
struct Stack {
  Vec3 base_color{1, 1, 1};
  double metallic = 1, roughness = 1, ior = 1.5;
  double specular = 1;
  Vec3 specular_color{1, 1, 1};
  bool edge_color = false;  ///< EXT_materials_specular_edge_color
  StackAnisotropy anisotropy;
  double film = 0, film_ior = 1.3, film_thickness = 0;  ///< nanometres
  double transmission = 0, dispersion = 0;
  double diffuse_transmission = 0;
  Vec3 diffuse_transmission_color{1, 1, 1};
  double diffuse_roughness = 0, retroreflection = 0;
  double haze = 0, haze_spread = 0;  ///< OpenPBR 1.2, "Specular haze"
  double scatter = 0, scatter_anisotropy = 0;
  Vec3 multiscatter_color{1, 1, 1};
  bool volume = false;   ///< thicknessFactor is not 0
  double thickness = 0;  ///< of the volume
  std::optional<double> attenuation_distance;
  Vec3 attenuation_color{1, 1, 1};
  /// KHR_materials_volume_scatter: its multi-scatter albedo, which acts in the medium alone.
  std::optional<Vec3> volume_scatter;
  StackCoat coat;
};

/// Readings that a test may switch to the other one, to see that it would notice. The names say the other
/// one; their numbers are those of the tests.
struct StackReadings {
  bool body_by_channel = false;               ///< E2
  bool clamp_behind_factor = false;           ///< E3: f0 is bounded after specularFactor
  bool metal_takes_f90 = false;               ///< E4
  bool infinite_ior_is_mirror = false;        ///< E5: ior 0 is F = 1 whatever specular says
  bool coat_takes_ior = false;                ///< E7
  bool film_at_half_vector = false;           ///< E19
  FilmReadings film;                          ///< E20, E21, E25
  bool film_without_thickness = false;        ///< E22
  bool film_is_weighted = false;              ///< E24: specularFactor scales the film's Fresnel
  bool bounded_visibility = false;            ///< E27
  bool centered_texel_is_half_turn = false;   ///< E28: the texel (1/2, 1/2) is along the bitangent
  bool plain_transmission_alpha = false;      ///< E30
  bool fresnel_of_frame_twice = false;        ///< E31
  bool fresnel_at_real_half_vector = false;   ///< E32
  bool zero_texel_is_thin = false;            ///< E34
  bool attenuates_without_distance = false;   ///< E36: a distance of 1
  bool factor_in_color = false;               ///< E39
  bool diffuse_transmission_beside = false;   ///< E40: not below the transmission
  bool lambert = false;                       ///< E46
  bool retro_moves_nothing_of_body = false;   ///< E47: the body's 1 - F keeps V
  bool specular_takes_diffuse_twice = false;  ///< E48
  bool facing_by_light = false;               ///< E53
  bool correlated_transmission = false;       ///< E54
  bool anisotropic_transmission = false;      ///< E55
  bool rough_diffuse_is_linear = false;       ///< E56
  bool retro_moves_rough_diffuse = false;     ///< E57
  bool scatter_at_volume = false;             ///< E58
};

/// A layer on what lies below it: below * factor + added.
struct StackLayer {
  Vec3 factor{1, 1, 1}, added{0, 0, 0};
};
/// Layers that others describe, at the sample: what lies between base and coat, and on the coat. `added` is
/// times the light's cosine.
struct StackHooks {
  std::function<StackLayer(const Sample&)> below_coat, above_coat;
};

/// Of a material's JSON; its texels by property name, as linear RGBA.
Stack readStack(const nlohmann::json& material, const std::map<std::string, Vec4>& texels = {},
                const StackReadings& readings = {});

/// Direct light of one directional light from either side: BSDF times the light's cosine and the light. The
/// view is above the normal.
Vec3 stackDirect(const Stack& stack, const Sample& sample, const StackReadings& readings = {},
                 const StackHooks& hooks = {});

/// The two parts of a directional albedo of a lobe of GGX: F0 scale + F90 bias.
struct SplitSum {
  double scale = 0, bias = 0;
};
using SplitSums = std::function<SplitSum(double cosine, double roughness)>;

/// What comes back and through of a white environment and a white frame behind, by the split sum.
Vec3 stackWhiteRoom(const Stack& stack, double cosine, const SplitSums& sums,
                    const StackReadings& readings = {});

/// Extinction, and scattering as a part of it; KHR_materials_scatter and KHR_materials_volume_scatter.
struct StackMedium {
  Vec3 extinction{}, scattering{};
  double anisotropy = 0;
};
StackMedium mediumOf(const Stack& stack);

/// Energy-conserving Oren-Nayar (Portsmouth, Kutz and Hill 2024), with the paper's fit of its albedo or with
/// the exact one. `cosine` is that between the two directions.
double orenNayar(double albedo, double roughness, double NdotV, double NdotL, double cosine,
                 bool exact = false);
/// Its directional albedo.
double orenNayarAlbedo(double albedo, double roughness, double NdotV, bool exact = false);

}  // namespace lacquer::physics
