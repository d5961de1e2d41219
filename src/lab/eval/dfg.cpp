#include "eval/dfg.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "eval/sheen.h"

namespace lacquer::eval {

namespace {

/// ALPHA_MIN of nodes/constants.node.
constexpr double kAlphaMin = 0.001;

/// Samples over the half vector's angle and around the normal. With twice as many what comes out moves by
/// 2e-4, and by 2e-3 below N.V = 0.03.
constexpr int kAngles = 64;
constexpr int kTurns = 32;

constexpr int kTableSize = 128;

/// Cosines of the turns, which all integrals share.
const std::array<double, kTurns>& turns() {
  static const std::array<double, kTurns> kCosines = [] {
    std::array<double, kTurns> cosines{};
    for (size_t k = 0; k < kTurns; ++k) {
      cosines[k] = std::cos((static_cast<double>(k) + 0.5) / kTurns * std::numbers::pi);
    }
    return cosines;
  }();
  return kCosines;
}

std::shared_ptr<const Image> imageOf(const std::vector<float>& table) {
  Image image;
  image.width = image.height = kTableSize;
  Image::Texels<float> texels;
  for (size_t i = 0; i < table.size(); i += 2) texels.push_back({table[i], table[i + 1], 0, 1});
  image.texels = std::move(texels);
  return std::make_shared<const Image>(std::move(image));
}

}  // namespace

std::array<double, 2> environmentDfg(double NdotV, double roughness) {
  const double alpha = std::max(roughness * roughness, kAlphaMin);
  const double alpha2 = alpha * alpha;
  const double sine = std::sqrt(std::max(1 - NdotV * NdotV, 0.0));
  const double masked_view = std::sqrt(NdotV * NdotV * (1 - alpha2) + alpha2);
  double scale = 0;
  double bias = 0;
  for (int i = 0; i < kAngles; ++i) {
    // Half vectors are drawn from D N.H, which leaves V.H and the visibility to sum; 1 - u = t^2 takes away
    // the pole that 1 / N.H has where the half vector lies in the plane.
    const double t = (i + 0.5) / kAngles;
    const double u = 1 - t * t;
    const double NdotH = std::sqrt((1 - u) / (1 + (alpha2 - 1) * u));
    const double across = sine * std::sqrt(std::max(1 - NdotH * NdotH, 0.0));
    for (const double turn : turns()) {
      const double VdotH = NdotV * NdotH + across * turn;
      const double NdotL = 2 * VdotH * NdotH - NdotV;
      if (NdotL <= 0 || VdotH <= 0) continue;
      const double masked_light = std::sqrt(NdotL * NdotL * (1 - alpha2) + alpha2);
      const double visibility = 0.5 / (NdotV * masked_light + NdotL * masked_view);
      const double weight = 2 * t * visibility * 4 * NdotL * VdotH / NdotH;
      const double c = 1 - VdotH;
      const double fresnel = c * c * c * c * c;
      scale += weight * (1 - fresnel);
      bias += weight * fresnel;
    }
  }
  const double samples = kAngles * kTurns;
  return {std::clamp(scale / samples, 0.0, 1.0), std::clamp(bias / samples, 0.0, 1.0)};
}

std::vector<float> environmentDfgTable(uint32_t size) {
  std::vector<float> texels;
  texels.reserve(size_t{2} * size * size);
  for (uint32_t y = 0; y < size; ++y) {
    for (uint32_t x = 0; x < size; ++x) {
      for (const double factor : environmentDfg((x + 0.5) / size, (y + 0.5) / size)) {
        texels.push_back(static_cast<float>(factor));
      }
    }
  }
  return texels;
}

std::shared_ptr<const Image> environmentTable(std::string_view name) {
  if (name == "environment_dfg") {
    static const std::shared_ptr<const Image> kSplitSum = imageOf(environmentDfgTable(kTableSize));
    return kSplitSum;
  }
  if (name == "environment_sheen") {
    static const std::shared_ptr<const Image> kSheen = imageOf(environmentSheenTable(kTableSize));
    return kSheen;
  }
  return nullptr;
}

Sampler environmentSampler(std::string_view name) {
  std::shared_ptr<const Image> table = environmentTable(name);
  if (!table) return {};
  return makeSampler(std::move(table), {Wrap::Clamp, Wrap::Clamp, false, false});
}

}  // namespace lacquer::eval
