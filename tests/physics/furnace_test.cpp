// What a white sky makes of metal, dielectric and everything between: image-based light in a furnace.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "eval/dfg.h"
#include "physics/subject.h"

namespace lacquer::physics::furnace_test {
namespace {

/// How base colour and metalness reach the shader: as factors, or as texels that take the general form.
enum class From { Factors, Texels };

struct Furnace {
  bool multiple_scattering = true;
  From from = From::Factors;
  double ior = 1.5;

  /// What comes back of white light from all around, seen at a cosine of 0.7.
  Vec4 operator()(const Vec3& color, double metallic, double roughness) const {
    Material m;
    m.roughness = roughness;
    m.ior = ior;
    if (from == From::Factors) {
      m.base_color = {color[0], color[1], color[2], 1};
      m.metallic = metallic;
    } else {
      m.texels["baseColorTexture"] = {color[0], color[1], color[2], 1};
      m.texels["metallicRoughnessTexture"] = {0, 1, metallic, 1};
    }
    Configuration setup;
    setup.ibl = true;
    setup.multiple_scattering = multiple_scattering;
    const Subject subject(m, setup);
    Sample s;
    s.v = tilted(kCosine);
    s.light = {0, 0, 0};
    return subject.color<double>(s, {1, 1, 1});
  }

  static constexpr double kCosine = 0.7;
};

/// glTF 2.0, Appendix B, mixes two whole materials. Each with the split sum's single bounce F0 scale + bias
/// and, where it is wanted, Fdez-Aguera's geometric series of further ones; Lambert under all that the
/// dielectric's lobe leaves.
double mixOfTheText(double color, double metallic, double roughness, const Furnace& furnace) {
  const auto split = eval::environmentSampler("environment_dfg")(0, {Furnace::kCosine, roughness, 0}, 0);
  const auto lobe = [&](double f0) {
    const double single = f0 * split[0] + split[1];
    const double mean = f0 + (1 - f0) / 21;
    const double lost = 1 - split[0] - split[1];
    return furnace.multiple_scattering ? single / (1 - mean * lost) : single;
  };
  const double f0 = std::pow((furnace.ior - 1) / (furnace.ior + 1), 2);
  const double dielectric = lobe(f0) + color * (1 - lobe(f0));
  return (1 - metallic) * dielectric + metallic * lobe(color);
}

TEST(Furnace, ImageBasedLightIsTheMixOfADielectricAndAMetal) {
  for (const bool multiple : {true, false}) {
    for (const From from : {From::Factors, From::Texels}) {
      for (const double ior : {1.5, 2.4, 1.0}) {
        const Furnace furnace{multiple, from, ior};
        for (const double roughness : {0.05, 0.4, 0.7, 1.0}) {
          for (int sevenths = 0; sevenths <= 7; ++sevenths) {
            const double metallic = sevenths / 7.0;
            const Vec3 color{0.8, 0.2, sevenths % 2 == 0 ? 1.0 : 0.0};
            const Vec4 seen = furnace(color, metallic, roughness);
            for (size_t c = 0; c < 3; ++c) {
              EXPECT_NEAR(seen[c], mixOfTheText(color[c], metallic, roughness, furnace), 5e-6)
                  << "multiple scattering " << multiple << ", texels " << (from == From::Texels) << ", IOR "
                  << ior << ", roughness " << roughness << ", metallic " << metallic << ", colour "
                  << color[c];
            }
          }
        }
      }
    }
  }
}

TEST(Furnace, HalfMetalsAreNoDarkerThanTheirEnds) {
  std::string line;
  for (int sevenths = 0; sevenths <= 7; ++sevenths) {
    const double share = Furnace{}({0.8, 0.8, 0.8}, sevenths / 7.0, 0.4)[0];
    line += fmt::format(" {:.3f}", share);
    EXPECT_GT(share, 0.79) << sevenths << " / 7";
    EXPECT_LT(share, 0.81) << sevenths << " / 7";
  }
  fmt::print("furnace of 0.8 at a roughness of 0.4, metallic 0 to 1:{}\n", line);
}

/// White gives back all there is, metal, dielectric and half of each.
TEST(Furnace, WhiteIsWhite) {
  for (const From from : {From::Factors, From::Texels}) {
    for (const double roughness : {0.0, 0.3, 1.0}) {
      for (const double metallic : {0.0, 0.5, 1.0}) {
        const Furnace furnace{true, from};
        EXPECT_NEAR(furnace({1, 1, 1}, metallic, roughness)[0], 1, 5e-6) << roughness << " " << metallic;
      }
    }
  }
}

}  // namespace
}  // namespace lacquer::physics::furnace_test
