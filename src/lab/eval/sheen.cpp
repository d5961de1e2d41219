#include "eval/sheen.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lacquer::eval {

namespace {

/// SHEEN_ALPHA_MIN of nodes/sheen.node.
constexpr double kSheenAlphaMin = 0.002;

/// Samples over the light's cosine and around the normal. With twice as many what comes out moves by 1e-3.
constexpr int kCosines = 64;
constexpr int kSheenTurns = 48;

/// Conty and Kulla's fit to Smith's integral, with its coefficients for one alpha.
class Masking {
public:
  explicit Masking(double alpha) : smooth_((1 - alpha) * (1 - alpha)) { twice_half_ = 2 * curve(0.5); }
  double operator()(double cosine) const {
    return std::exp(cosine < 0.5 ? curve(cosine) : twice_half_ - curve(1 - cosine));
  }

private:
  double mix(double rough, double smooth) const { return rough + (smooth - rough) * smooth_; }
  double curve(double x) const {
    return mix(21.5473, 25.3245) / (1 + mix(3.82987, 3.32435) * std::pow(x, mix(0.19823, 0.16801))) +
           mix(-1.97760, -1.27393) * x + mix(-4.32054, -4.85967);
  }

  double smooth_, twice_half_ = 0;
};

/// The lobe of one roughness, with what the integrals over the light share.
class Lobe {
public:
  explicit Lobe(double roughness)
      : alpha_(std::max(roughness * roughness, kSheenAlphaMin)), masking_(alpha_) {
    for (int i = 0; i < kCosines; ++i) {
      // The cosine is t^3: the lobe's detail is at grazing.
      const double t = (i + 0.5) / kCosines;
      lights_.push_back({t * t * t, 3 * t * t / kCosines, 0, 1});
      lights_.back().masked = masking_(lights_.back().cosine);
    }
    for (int k = 0; k < kSheenTurns; ++k)
      turns_.push_back(std::cos((k + 0.5) / kSheenTurns * std::numbers::pi));
    std::vector<double> compensation;
    for (const Light& light : lights_) compensation.push_back(1 / std::max(albedos(light.cosine)[1], 1.0));
    for (size_t i = 0; i < lights_.size(); ++i) lights_[i].compensation = compensation[i];
  }

  /// What D V reflects with what the lights' cosines take from it, and without.
  std::array<double, 2> albedos(double NdotV) const {
    const double masked = masking_(NdotV);
    const double sine = std::sqrt(std::max(1 - NdotV * NdotV, 0.0));
    const double peak = (2 + 1 / alpha_) / (2 * std::numbers::pi);
    double kept = 0;
    double single = 0;
    for (const Light& light : lights_) {
      const double light_sine = std::sqrt(1 - light.cosine * light.cosine);
      const double up = (NdotV + light.cosine) * (NdotV + light.cosine);
      const double apart = sine * sine + light_sine * light_sine;
      double turned = 0;
      for (const double turn : turns_) {
        const double planar2 = std::max(apart + 2 * sine * light_sine * turn, 0.0);
        turned += std::pow(planar2 / (planar2 + up), 0.5 / alpha_);
      }
      const double share = turned * light.weight / (4 * NdotV * (1 + masked + light.masked));
      kept += share * light.compensation;
      single += share;
    }
    const double all_around = peak * 2 * std::numbers::pi / kSheenTurns;
    return {kept * all_around, single * all_around};
  }

private:
  struct Light {
    double cosine, weight, masked, compensation;
  };

  double alpha_;
  Masking masking_;
  std::vector<Light> lights_;
  std::vector<double> turns_;
};

}  // namespace

std::vector<std::array<double, 2>> environmentSheen(const std::vector<double>& cosines, double roughness) {
  const Lobe lobe(roughness);
  std::vector<std::array<double, 2>> factors;
  for (const double cosine : cosines) {
    const auto [kept, single] = lobe.albedos(cosine);
    const double compensation = 1 / std::max(single, 1.0);
    factors.push_back({std::clamp(kept * compensation, 0.0, 1.0), compensation});
  }
  return factors;
}

std::vector<float> environmentSheenTable(uint32_t size) {
  std::vector<double> cosines;
  for (uint32_t x = 0; x < size; ++x) cosines.push_back((x + 0.5) / size);
  std::vector<float> texels;
  texels.reserve(size_t{2} * size * size);
  for (uint32_t y = 0; y < size; ++y) {
    for (const auto& factors : environmentSheen(cosines, (y + 0.5) / size)) {
      for (const double factor : factors) texels.push_back(static_cast<float>(factor));
    }
  }
  return texels;
}

}  // namespace lacquer::eval
