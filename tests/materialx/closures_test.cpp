// The closures of nodes/materialx/ against MaterialX's formulas in double, at random directions and inputs;
// and what they reflect of white light from all around.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "materialx/closures_reference.h"
#include "patterns/run.h"

namespace lacquer::test::closures_test {
namespace {

using closures::Bsdf;
using closures::Film;
using closures::Place;
using closures::Vec;

constexpr size_t kPoints = 20000;

/// Random inputs of one closure: the arguments of its node, and each point's for the reference.
class Drawn {
public:
  explicit Drawn(uint64_t seed) : engine_(seed) {
    places.resize(kPoints);
    for (Place& at : places) {
      at.N = direction();
      at.V = direction();
      at.L = direction();
      at.T = direction();
      // Most lights and views are on the normal's side.
      const auto onto = [&](Vec& v) {
        const double c = v[0] * at.N[0] + v[1] * at.N[1] + v[2] * at.N[2];
        if (c < 0 && unit() < 0.8) v = {-v[0], -v[1], -v[2]};
      };
      onto(at.V);
      onto(at.L);
      at.around = {unit(), unit(), unit()};
      at.behind = {unit(), unit(), unit()};
    }
    vectors("normal", &Place::N);
    vectors("view", &Place::V);
    vectors("L", &Place::L);
  }

  void vectors(const std::string& name, Vec Place::*of) {
    std::vector<double>& all = arguments[name];
    all.clear();
    // What the node is given is a float.
    for (Place& at : places) {
      for (double& x : at.*of) x = static_cast<float>(x);
      all.insert(all.end(), (at.*of).begin(), (at.*of).end());
    }
  }
  std::vector<double> numbers(const std::string& name, double lo, double hi) {
    std::vector<double> all(kPoints);
    for (double& x : all) x = static_cast<float>(lo + (hi - lo) * unit());
    arguments[name] = all;
    return all;
  }
  std::vector<Vec> colors(const std::string& name, double lo = 0, double hi = 1) {
    std::vector<Vec> all(kPoints);
    std::vector<double>& flat = arguments[name];
    flat.clear();
    for (Vec& c : all) {
      for (double& x : c) flat.push_back(x = static_cast<float>(lo + (hi - lo) * unit()));
    }
    return all;
  }
  /// Two alphas of roughnesses from `least` on.
  std::vector<std::array<double, 2>> alphas(double least) {
    std::vector<std::array<double, 2>> all(kPoints);
    std::vector<double>& flat = arguments["roughness"];
    flat.clear();
    for (auto& a : all) {
      for (double& x : a) {
        const double roughness = least + (1 - least) * unit();
        flat.push_back(x = static_cast<float>(roughness * roughness));
      }
    }
    return all;
  }
  void number(const std::string& name, double value) { arguments[name] = {value}; }
  double unit() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }

  std::vector<Place> places;
  Arguments arguments;

private:
  Vec direction() {
    const double z = 2 * unit() - 1, phi = 2 * M_PI * unit(), r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }
  std::mt19937_64 engine_;
};

using Expected = std::function<Bsdf(size_t)>;

/// In float the median is within 1e-5 of the reference and 97 % within 1e-3; in double all of them are
/// `allowed` away at most. Differences are of the value, or of 1e-3 where it is less.
void compare(const std::string& node, const Drawn& drawn, const Expected& expected, double allowed = 1e-6) {
  const auto in_float = runNode<float>(node, drawn.arguments, kPoints);
  const auto in_double = runNode<double>(node, drawn.arguments, kPoints);
  ASSERT_EQ(in_float.size(), 5U);
  const char* const names[] = {"direct", "indirect", "transmitted", "through", "passed"};
  for (size_t part = 0; part < 5; ++part) {
    std::vector<double> off;
    double worst = 0;
    std::string where;
    for (size_t i = 0; i < kPoints; ++i) {
      const Bsdf is = expected(i);
      const Vec parts[] = {is.direct, is.indirect, is.transmitted, is.through, is.passed};
      for (size_t c = 0; c < 3; ++c) {
        const double want = part >= 3 ? std::clamp(parts[part][c], 0.0, 1.0) : parts[part][c];
        const double scale = std::max(std::abs(want), 1e-3);
        const double got = static_cast<double>(in_float[part][i * 3 + c]);
        ASSERT_TRUE(std::isfinite(got) && got >= 0)
            << node << " " << names[part] << " at " << i << ": " << got;
        off.push_back(std::abs(got - want) / scale);
        const double by = std::abs(in_double[part][i * 3 + c] - want) / scale;
        if (by > worst) where = fmt::format("point {}: {} for {}", i, in_double[part][i * 3 + c], want);
        worst = std::max(worst, by);
      }
    }
    std::sort(off.begin(), off.end());
    EXPECT_LT(off[off.size() / 2], 1e-5) << node << " " << names[part];
    EXPECT_LT(off[off.size() * 97 / 100], 1e-3) << node << " " << names[part];
    EXPECT_LT(worst, allowed) << node << " " << names[part] << ", " << where;
  }
}

TEST(Closures, orenNayar) {
  for (const bool compensated : {false, true}) {
    Drawn d(1);
    const auto weight = d.numbers("weight", 0, 1), roughness = d.numbers("roughness", 0, 1);
    const auto color = d.colors("color");
    d.vectors("facing_irradiance", &Place::around);
    d.number("energy_compensation", compensated);
    compare("oren_nayar_diffuse_bsdf", d, [&](size_t i) {
      return closures::orenNayar(d.places[i], weight[i], color[i], roughness[i], compensated);
    });
  }
}

TEST(Closures, burley) {
  Drawn d(2);
  const auto weight = d.numbers("weight", 0, 1), roughness = d.numbers("roughness", 0, 1);
  const auto color = d.colors("color");
  d.vectors("facing_irradiance", &Place::around);
  compare("burley_diffuse_bsdf", d,
          [&](size_t i) { return closures::burley(d.places[i], weight[i], color[i], roughness[i]); });
}

TEST(Closures, translucent) {
  Drawn d(3);
  const auto weight = d.numbers("weight", 0, 1);
  const auto color = d.colors("color");
  d.vectors("behind_irradiance", &Place::around);
  d.arguments.erase("view");
  compare("translucent_bsdf", d,
          [&](size_t i) { return closures::translucent(d.places[i], weight[i], color[i]); });
}

std::vector<Film> films(Drawn& d, bool film) {
  std::vector<Film> all(kPoints);
  if (!film) return all;
  const auto thickness = d.numbers("thinfilm_thickness", 1, 1000), ior = d.numbers("thinfilm_ior", 1.05, 2);
  for (size_t i = 0; i < kPoints; ++i) all[i] = {thickness[i], ior[i]};
  return all;
}

TEST(Closures, dielectric) {
  for (int mode = 0; mode < 3; ++mode) {
    for (const bool film : {false, true}) {
      for (const bool retro : {false, true}) {
        Drawn d(4);
        const auto weight = d.numbers("weight", 0, 1), ior = d.numbers("ior", 1.01, 3);
        const auto tint = d.colors("tint");
        const auto alpha = d.alphas(0.1);
        const auto film_of = films(d, film);
        d.vectors("tangent", &Place::T);
        d.vectors("lobe_radiance", &Place::around);
        d.vectors("refracted_radiance", &Place::behind);
        d.number("retroreflective", retro);
        d.number("scatter_mode", mode);
        compare("dielectric_bsdf", d, [&](size_t i) {
          return closures::dielectric(d.places[i], weight[i], tint[i], ior[i], alpha[i][0], alpha[i][1],
                                      retro, film_of[i], mode);
        });
      }
    }
  }
}

TEST(Closures, conductor) {
  for (const bool film : {false, true}) {
    for (const bool retro : {false, true}) {
      Drawn d(5);
      const auto weight = d.numbers("weight", 0, 1);
      const auto n = d.colors("ior", 0.1, 4), k = d.colors("extinction", 0.1, 6);
      const auto alpha = d.alphas(0.1);
      const auto film_of = films(d, film);
      d.vectors("tangent", &Place::T);
      d.vectors("lobe_radiance", &Place::around);
      d.number("retroreflective", retro);
      compare("conductor_bsdf", d, [&](size_t i) {
        return closures::conductor(d.places[i], weight[i], n[i], k[i], alpha[i][0], alpha[i][1], retro,
                                   film_of[i]);
      });
    }
  }
}

TEST(Closures, schlick) {
  for (int mode = 0; mode < 3; ++mode) {
    for (const bool film : {false, true}) {
      Drawn d(6);
      const auto weight = d.numbers("weight", 0, 1), exponent = d.numbers("exponent", 1, 8);
      const auto c0 = d.colors("color0"), c82 = d.colors("color82"), c90 = d.colors("color90");
      const auto alpha = d.alphas(0.1);
      const auto film_of = films(d, film);
      d.vectors("tangent", &Place::T);
      d.vectors("lobe_radiance", &Place::around);
      d.vectors("refracted_radiance_schlick", &Place::behind);
      d.number("scatter_mode", mode);
      compare("generalized_schlick_bsdf", d, [&](size_t i) {
        return closures::schlick(d.places[i], weight[i], c0[i], c82[i], c90[i], exponent[i], alpha[i][0],
                                 alpha[i][1], false, film_of[i], mode);
      });
    }
  }
}

/// One alpha needs no tangent. The normal is a unit vector to the last bit of a float alone, which the cross
/// product in place of a frame tells.
TEST(Closures, withoutDirection) {
  Drawn d(7);
  d.arguments["roughness"] = {0.125, 0.125};
  const auto weight = d.numbers("weight", 0, 1);
  d.vectors("lobe_radiance", &Place::around);
  compare(
      "dielectric_bsdf", d,
      [&](size_t i) {
        return closures::dielectric(d.places[i], weight[i], {1, 1, 1}, 1.5, 0.125, 0.125, false, {}, 0);
      },
      1e-4);
}

TEST(Closures, sheen) {
  for (const bool zeltner : {false, true}) {
    Drawn d(8);
    const auto weight = d.numbers("weight", 0, 1), roughness = d.numbers("roughness", 0.05, 1);
    const auto color = d.colors("color");
    d.vectors("facing_irradiance", &Place::around);
    d.number("mode", zeltner);
    compare("sheen_bsdf", d, [&](size_t i) {
      return closures::sheen(d.places[i], weight[i], color[i], roughness[i], zeltner);
    });
  }
}

TEST(Closures, subsurface) {
  Drawn d(9);
  const auto weight = d.numbers("weight", 0, 1);
  const auto color = d.colors("color"), radius = d.colors("radius");
  d.vectors("facing_irradiance", &Place::around);
  d.number("anisotropy", 0);
  d.arguments["position"] = {0, 0, 0};
  // Without neighbours the surface is flat, and the sphere is the largest.
  compare("subsurface_bsdf", d,
          [&](size_t i) { return closures::subsurface(d.places[i], weight[i], color[i], radius[i], 100); });
}

TEST(Closures, schlickEdf) {
  Drawn d(10);
  d.arguments.erase("L");
  const auto c0 = d.colors("color0"), c90 = d.colors("color90"), base = d.colors("base_emission");
  const auto exponent = d.numbers("exponent", 1, 8);
  const auto got = runNode<double>("generalized_schlick_edf", d.arguments, kPoints);
  for (size_t i = 0; i < kPoints; ++i) {
    const Vec want = closures::schlickEdf(d.places[i], c0[i], c90[i], exponent[i], base[i]);
    for (size_t c = 0; c < 3; ++c) ASSERT_NEAR(got[0][i * 3 + c], want[c], 1e-9);
  }
}

/// Random closures as inputs of a combinator.
struct Inputs {
  explicit Inputs(uint64_t seed) : d(seed) { d.arguments.clear(); }
  std::vector<Bsdf> bsdf(const std::string& name) {
    std::vector<Bsdf> all(kPoints);
    const auto part = [&](const char* of, Vec Bsdf::*member, double hi) {
      const auto values = d.colors(fmt::format("{}_{}", name, of), 0, hi);
      for (size_t i = 0; i < kPoints; ++i) all[i].*member = values[i];
    };
    part("direct", &Bsdf::direct, 3);
    part("indirect", &Bsdf::indirect, 3);
    part("transmitted", &Bsdf::transmitted, 3);
    part("through", &Bsdf::through, 1);
    part("passed", &Bsdf::passed, 1);
    return all;
  }
  Drawn d;
};

TEST(Closures, combinators) {
  {
    Inputs in(11);
    const auto a = in.bsdf("top"), b = in.bsdf("base");
    compare("layer_bsdf", in.d, [&](size_t i) { return closures::layer(a[i], b[i]); });
  }
  {
    Inputs in(12);
    const auto a = in.bsdf("top");
    const auto medium = in.d.colors("base_passed");
    compare("layer_vdf", in.d, [&](size_t i) { return closures::layerOver(a[i], medium[i]); });
  }
  {
    Inputs in(13);
    const auto a = in.bsdf("fg"), b = in.bsdf("bg");
    const auto t = in.d.numbers("mix", 0, 1);
    compare("mix_bsdf", in.d, [&](size_t i) { return closures::mixed(a[i], b[i], t[i]); });
  }
  {
    Inputs in(14);
    const auto a = in.bsdf("in1"), b = in.bsdf("in2");
    compare("add_bsdf", in.d, [&](size_t i) { return closures::sum(a[i], b[i]); });
  }
  {
    Inputs in(15);
    const auto a = in.bsdf("in1");
    const auto part = in.d.colors("in2", -0.5, 1.5);
    compare("multiply_bsdf<vec3>", in.d, [&](size_t i) { return closures::times(a[i], part[i]); });
  }
  {
    Inputs in(16);
    const auto a = in.bsdf("in1");
    const auto part = in.d.numbers("in2", -0.5, 1.5);
    compare("multiply_bsdf<float>", in.d, [&](size_t i) {
      return closures::times(a[i], {part[i], part[i], part[i]});
    });
  }
}

}  // namespace
}  // namespace lacquer::test::closures_test
