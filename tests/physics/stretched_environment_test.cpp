// The lookups of an anisotropic lobe's environment against quadrature of the lobe: a small bright window and
// a sky.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

#include "physics/cloth.h"
#include "physics/documented.h"
#include "physics/lobe.h"
#include "physics/node_values.h"

namespace lacquer::physics::stretched_environment_test {
namespace {

constexpr double kMaxLod = 8;
constexpr double kInner = 6 * kPi / 180;  ///< the window's radius, where its soft edge begins
constexpr double kOuter = 8 * kPi / 180;  ///< and where it ends

// -- environments: each is the same all around one axis --

/// A round window in the dark, or a sky that is 0 at one pole and 1 at the other.
struct Environment {
  Vec3 axis;
  bool sky = false;
};

double window(double cosine) {
  if (cosine <= std::cos(kOuter)) return 0;
  const double t = std::clamp((std::acos(std::min(cosine, 1.0)) - kInner) / (kOuter - kInner), 0.0, 1.0);
  return 1 - t * t * (3 - 2 * t);
}
double radiance(const Environment& e, const Vec3& direction) {
  const double cosine = dot(e.axis, direction);
  return e.sky ? 0.5 + 0.5 * cosine : window(cosine);
}

/// What a prefiltered map has of both: means over GGX with V = N = R weighed by N.L, for any roughness.
class Prefiltered {
public:
  Prefiltered() {
    for (int r = 0; r <= kRoughnesses; ++r) addLevel(static_cast<double>(r) / kRoughnesses);
  }
  double at(const Environment& e, const Vec3& direction, double roughness) const {
    const double cosine = dot(normalized(direction), e.axis);
    const double x = std::clamp(roughness, 0.0, 1.0) * kRoughnesses;
    const auto level = std::min(static_cast<size_t>(x), static_cast<size_t>(kRoughnesses - 1));
    const double part = x - static_cast<double>(level);
    return of(e, cosine, level) * (1 - part) + of(e, cosine, level + 1) * part;
  }

private:
  static constexpr int kRoughnesses = 64, kAngles = 360;
  double of(const Environment& e, double cosine, size_t level) const {
    if (e.sky) return 0.5 + 0.5 * cosine * mean_cosines_[level];
    const double y = std::acos(std::clamp(cosine, -1.0, 1.0)) / kPi * kAngles;
    const auto angle = std::min(static_cast<size_t>(y), static_cast<size_t>(kAngles - 1));
    const double part = y - static_cast<double>(angle);
    return windows_[level][angle] * (1 - part) + windows_[level][angle + 1] * part;
  }
  void addLevel(double roughness) {
    constexpr int kSteps = 96;
    constexpr int kTurns = 64;
    const double alpha = std::max(roughness * roughness, 0.001);
    std::vector<Vec3> lights;
    double whole = 0;
    double cosines = 0;
    for (int i = 0; i < kSteps * kTurns; ++i) {
      const int turn = i / kSteps;
      const double u = (i % kSteps + 0.5) / kSteps;
      const double c = 1 / std::sqrt(1 + alpha * alpha * u / (1 - u));
      const Vec3 l = mirrored({0, 0, 1}, tilted(c, 2 * kPi * (turn + 0.5) / kTurns));
      if (l[2] <= 0) continue;
      lights.push_back(l);
      whole += l[2];
      cosines += l[2] * l[2];
    }
    mean_cosines_.push_back(cosines / whole);
    std::vector<double> angles;
    for (int k = 0; k <= kAngles; ++k) {
      const Vec3 axis = tilted(std::cos(kPi * k / kAngles));
      double seen = 0;
      for (const Vec3& l : lights) seen += l[2] * window(dot(l, axis));
      angles.push_back(seen / whole);
    }
    windows_.push_back(std::move(angles));
  }
  std::vector<double> mean_cosines_;
  std::vector<std::vector<double>> windows_;
};

const Prefiltered& prefiltered() {
  static const Prefiltered kMap;
  return kMap;
}

double seen(const Quadrature& quadrature, const Environment& e) {
  return quadrature.mean([&](const Vec3& l) { return radiance(e, l); });
}

/// A lobe under an environment, what quadrature sees of it and what the lookups do.
struct Query {
  Lobe lobe;
  Environment environment;
  double exact = 0, bent = 0, taps = 0;
};

std::vector<Environment> environmentsOf(const Lobe& k) {
  std::vector<Environment> all;
  const Vec3 mirror = mirrored(k.v, {0, 0, 1});
  const Vec3 along = normalized(cross({0, 1, 0}, mirror));
  const Vec3 across = normalized(cross(mirror, along));
  for (int x = -60; x <= 60; x += 20) {
    for (int y = -10; y <= 10; y += 10) {
      const Vec3 axis =
          normalized(sum(sum(mirror, along, std::tan(x * kPi / 180)), across, std::tan(y * kPi / 180)));
      if (axis[2] >= 0.05) all.push_back({axis});
    }
  }
  for (const Vec3& up : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{1, 1, 1}, Vec3{-1, 0, 1}})
    all.push_back({normalized(up), true});
  return all;
}

constexpr double kRoughnesses[] = {0.1, 0.2, 0.3, 0.45, 0.6};
constexpr double kStrengths[] = {0.3, 0.5, 0.7, 0.85, 1};
constexpr double kViews[] = {0.95, 0.7, 0.4, 0.2};

/// The parameters of the nodes, for each query.
eval::Columns columnsOf(const std::vector<Query>& queries) {
  std::vector<double> v;
  std::map<std::string, std::vector<double>> numbers;
  for (const Query& q : queries) {
    v.insert(v.end(), q.lobe.v.begin(), q.lobe.v.end());
    numbers["strength"].push_back(q.lobe.strength);
    numbers["roughness"].push_back(q.lobe.roughness);
    numbers["alpha_t"].push_back(q.lobe.alphaT());
    numbers["alpha_b"].push_back(q.lobe.alphaB());
  }
  eval::Columns columns = {{"N", eval::Column::constant({0, 0, 1})},
                           {"B", eval::Column::constant({0, 1, 0})},
                           {"V", eval::Column::perPoint(3, std::move(v))},
                           {"max_lod", eval::Column::constant({kMaxLod})}};
  for (auto& [name, values] : numbers) columns[name] = eval::Column::perPoint(1, std::move(values));
  return columns;
}

Vec3 vectorAt(const std::vector<double>& values, size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

/// What both ways see, by the library's own nodes.
void look(std::vector<Query>& queries) {
  eval::Columns columns = columnsOf(queries);
  const std::map<std::string, eval::Sampler, std::less<>> textures = {
      {"environment_specular", [&](size_t point, const Vec3& direction, double lod) {
         const double seen = prefiltered().at(queries[point].environment, direction, lod / kMaxLod);
         return Vec4{seen, seen, seen, 1};
       }}};
  const auto taps = nodeValues<double>("stretched_environment", "", columns, queries.size(), textures);
  const auto normals = nodeValues<double>("bent_normal", "", columns, queries.size());
  ASSERT_FALSE(taps.empty() || normals.empty());
  columns["N"] = eval::Column::perPoint(3, normals[0]);
  const auto bent = nodeValues<double>("reflection_unnormalized", "", columns, queries.size());
  ASSERT_FALSE(bent.empty());
  for (size_t i = 0; i < queries.size(); ++i) {
    Query& q = queries[i];
    q.taps = taps[0][3 * i];
    q.bent = prefiltered().at(q.environment, vectorAt(bent[0], i), q.lobe.roughness);
  }
}

const std::vector<Query>& queries() {
  static const std::vector<Query> kQueries = [] {
    std::vector<Query> all;
    for (const double roughness : kRoughnesses) {
      for (const double strength : kStrengths) {
        for (const double cosine : kViews) {
          for (const double azimuth : {0.0, 0.8, 1.57}) {
            const Lobe lobe{roughness, strength, tilted(cosine, azimuth)};
            const Quadrature quadrature(lobe);
            for (const Environment& e : environmentsOf(lobe)) all.push_back({lobe, e, seen(quadrature, e)});
          }
        }
      }
    }
    look(all);
    return all;
  }();
  return kQueries;
}

struct Errors {
  double rms = 0, mean = 0, largest = 0;
};
using Which = std::function<bool(const Query&)>;

Errors errorsOf(double Query::*way, bool sky, const Which& which = {}) {
  Errors errors;
  double count = 0;
  for (const Query& q : queries()) {
    if (q.environment.sky != sky || (which && !which(q))) continue;
    const double error = std::abs(q.*way - q.exact);
    errors.rms += error * error;
    errors.mean += error;
    errors.largest = std::max(errors.largest, error);
    ++count;
  }
  return {std::sqrt(errors.rms / count), errors.mean / count, errors.largest};
}

// -- the table --

cost::Subject work(const std::string& name, bool stretched) {
  Options options = workOptions({{"directional", 1}});
  options.switches["stretched_environment"] = stretched;
  return workOf(name, options);
}

std::string row(const std::string& name, double Query::*way, const std::string& costs) {
  const Errors w = errorsOf(way, false);
  const Errors s = errorsOf(way, true);
  return fmt::format("| {} | {:.4f} | {:.4f} | {:.3f} | {:.4f} | {:.4f} | {:.3f} | {} |\n", name, w.rms,
                     w.mean, w.largest, s.rms, s.mean, s.largest, costs);
}

/// One line for each value of one of the lobe's properties: the window's RMS, both ways.
std::string linesOf(const char* what, std::span<const double> values,
                    const std::function<double(const Lobe&)>& property) {
  std::string text;
  for (const double value : values) {
    const Which which = [&](const Query& q) { return std::abs(property(q.lobe) - value) < 1e-9; };
    text += fmt::format("| {} {} |", what, value);
    for (const bool sky : {false, true}) {
      text += fmt::format(" {:.4f} | {:.4f} |", errorsOf(&Query::bent, sky, which).rms,
                          errorsOf(&Query::taps, sky, which).rms);
    }
    text += "\n";
  }
  return text;
}

std::string tables(const cost::Measurement& measured) {
  const auto costs = [&](size_t first) {
    std::string text;
    for (const size_t i : {first, first + 1}) {
      const cost::Statistics& s = *measured.outcomes[i].statistics;
      text += fmt::format("{}{} / {}", i == first ? "" : " | ", s.instructions, s.inverse_throughput);
    }
    return text;
  };
  return fmt::format("{}, navi21.\n\n", measured.driver) +
         "| body | window: RMS | mean | largest | sky: RMS | mean | largest | W3 | C |\n"
         "|---|---|---|---|---|---|---|---|---|\n" +
         row("one lookup at a bent normal", &Query::bent, costs(0)) +
         row("`stretched_environment`, six lookups", &Query::taps, costs(2)) +
         "\n| RMS | window: bent | stretched | sky: bent | stretched |\n|---|---|---|---|---|\n" +
         linesOf("roughness", kRoughnesses, [](const Lobe& k) { return k.roughness; }) +
         linesOf("strength", kStrengths, [](const Lobe& k) { return k.strength; }) +
         linesOf("view's cosine", kViews, [](const Lobe& k) { return k.v[2]; });
}

// -- tests --

/// Anisotropic GGX and height-correlated Smith in the texts' own form, a lobe's weight of a direction of
/// light.
double weightOf(const Lobe& k, const Vec3& l) {
  const Vec3 h = normalized(sum(k.v, l, 1));
  const double x = h[0] / k.alphaT();
  const double y = h[1] / k.alphaB();
  const double inverse = x * x + y * y + h[2] * h[2];
  const double d = 1 / (kPi * k.alphaT() * k.alphaB() * inverse * inverse);
  return d / ((1 + lambda(k, k.v) + lambda(k, l)) * 4 * k.v[2]);
}

/// The mean of an environment by a weight over the hemisphere; the steps are wide about z, where no window
/// may be.
template <class Weight>
double meanOf(const Environment& e, const Weight& weight) {
  const double seen = overHemisphere(
      [&](double c, double azimuth) { return weight(tilted(c, azimuth)) * radiance(e, tilted(c, azimuth)); },
      512, 256);
  const double whole =
      overHemisphere([&](double c, double azimuth) { return weight(tilted(c, azimuth)); }, 512, 256);
  return seen / whole;
}

TEST(StretchedEnvironment, TheYardsticksAreTheTextsIntegrals) {
  for (const Lobe& lobe :
       {Lobe{0.5, 0.5, tilted(0.7, 0.8)}, Lobe{0.6, 1, tilted(0.4, 0)}, Lobe{0.5, 0, tilted(0.8)}}) {
    const Quadrature quadrature(lobe);
    for (const Environment& e : {Environment{mirrored(lobe.v, {0, 0, 1})}, Environment{{1, 0, 0}, true},
                                 Environment{{0, 0, 1}, true}}) {
      EXPECT_NEAR(seen(quadrature, e), meanOf(e, [&](const Vec3& l) { return weightOf(lobe, l); }), 0.002);
    }
    // A prefiltered map's: D N.L with V = N.
    const Lobe straight{lobe.roughness, 0};
    for (const bool sky : {false, true}) {
      const Environment e{tilted(0.9), sky};
      const double exact =
          meanOf(e, [&](const Vec3& l) { return weightOf(straight, l) * (1 + lambda(straight, l)) * l[2]; });
      EXPECT_NEAR(prefiltered().at(e, {0, 0, 1}, lobe.roughness), exact, 0.002);
    }
  }
}

TEST(StretchedEnvironment, AWindowIsStretchedAndNotDisplaced) {
  for (const bool sky : {false, true}) {
    const Errors bent = errorsOf(&Query::bent, sky);
    const Errors taps = errorsOf(&Query::taps, sky);
    fmt::print("{}: RMS {:.4f} bent, {:.4f} stretched; mean {:.4f}, {:.4f}\n", sky ? "sky" : "window",
               bent.rms, taps.rms, bent.mean, taps.mean);
    EXPECT_LT(taps.rms, 0.4 * bent.rms);
    EXPECT_LT(taps.mean, 0.5 * bent.mean);
    EXPECT_LE(taps.largest, bent.largest);
  }
}

TEST(StretchedEnvironment, IsNotWorseAtAnyRoughnessStrengthOrView) {
  const auto check = [](const std::string& what, double value, const Which& which) {
    const Errors bent = errorsOf(&Query::bent, false, which);
    const Errors taps = errorsOf(&Query::taps, false, which);
    EXPECT_LT(taps.rms, bent.rms) << what << " " << value;
    EXPECT_LT(taps.mean, bent.mean) << what << " " << value;
  };
  for (const double x : kRoughnesses)
    check("roughness", x, [x](const Query& q) { return q.lobe.roughness == x; });
  for (const double x : kStrengths)
    check("strength", x, [x](const Query& q) { return q.lobe.strength == x; });
  for (const double x : kViews)
    check("view", x, [x](const Query& q) { return std::abs(q.lobe.v[2] - x) < 1e-9; });
}

TEST(StretchedEnvironment, OfTwoEqualRoughnessesIsTheMirrorsLookup) {
  std::vector<Query> isotropic;
  for (const double roughness : kRoughnesses) {
    for (const double cosine : kViews) {
      const Lobe lobe{roughness, 0, tilted(cosine, 1)};
      const Vec3 mirror = mirrored(lobe.v, {0, 0, 1});
      for (const Environment& e : environmentsOf(lobe))
        isotropic.push_back({lobe, e, prefiltered().at(e, mirror, roughness)});
    }
  }
  look(isotropic);
  for (const Query& q : isotropic) EXPECT_NEAR(q.taps, q.exact, 1e-9);
}

Configuration stretched(bool on) {
  Configuration setup;
  setup.ibl = true;
  setup.switches["stretched_environment"] = on;
  return setup;
}

/// Coat and base, both anisotropic.
Subject grooved(double roughness, double strength, const Configuration& setup) {
  Material m = dielectric(0.5, roughness);
  m.metallic = 0.5;
  m.coat = Coat{.factor = 0.7, .roughness = roughness, .ior = 1.6, .anisotropy = strength, .rotation = 0.4};
  return subjectOf(m, {{"KHR_materials_anisotropy", {{"anisotropyStrength", strength}}}}, setup);
}

TEST(StretchedEnvironment, IsThereByTheSwitchAloneAndLeavesEvenLightAsItIs) {
  Random random(3);
  for (const double strength : {0.3, 1.0}) {
    const Subject off = grooved(0.3, strength, stretched(false));
    const Subject on = grooved(0.3, strength, stretched(true));
    for (const char* node : {"coat.stretched", "anisotropy.stretched"}) {
      EXPECT_FALSE(off.has(node)) << node;
      EXPECT_TRUE(on.has(node)) << node;
    }
    std::vector<Sample> samples;
    for (int i = 0; i < 200; ++i) samples.push_back(randomSample(random, true));
    const std::vector<Vec4> expected = off.colors<double>(samples, {1, 2, 3});
    const std::vector<Vec4> shown = on.colors<double>(samples, {1, 2, 3});
    for (size_t i = 0; i < samples.size(); ++i) {
      for (size_t c = 0; c < 4; ++c) EXPECT_NEAR(shown[i][c], expected[i][c], 1e-9 * (1 + expected[i][c]));
    }
  }
}

Vec3 turned(const Vec3& v, const Vec4& q) {
  const Vec3 axis = {q[0], q[1], q[2]};
  return sum(v, cross(axis, sum(cross(axis, v), v, q[3])), 2);
}

TEST(StretchedEnvironment, TurnsWithItsMaps) {
  const Vec4 q = {0.5, -0.1, 0.7, 0.5};
  const auto sky = [](const Vec3& d) {
    const Vec3 u = normalized(d);
    return Vec4{4 + u[0], 5 + 2 * u[1] - u[0] * u[2], 6 + 3 * u[2], 1};
  };
  const auto under = [&](bool turning, bool back) {
    Configuration setup = stretched(true);
    if (turning) setup.switches["turned_environment"] = true;
    if (turning)
      setup.columns["environment_turn.rotation"] = eval::Column::constant({q[0], q[1], q[2], q[3]});
    for (const char* map : {"environment_specular", "environment_irradiance"})
      setup.textures[map] = [=](size_t, const Vec3& d, double) { return sky(back ? turned(d, q) : d); };
    Random random(8);
    std::vector<Sample> samples;
    for (int i = 0; i < 100; ++i) samples.push_back(randomSample(random, true));
    return grooved(0.3, 0.8, setup).colors<double>(samples);
  };
  const std::vector<Vec4> expected = under(false, true);
  const std::vector<Vec4> shown = under(true, false);
  const std::vector<Vec4> unturned = under(false, false);
  size_t apart = 0;
  for (size_t i = 0; i < expected.size(); ++i) {
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(shown[i][c], expected[i][c], 1e-9 * (1 + expected[i][c]));
    apart += std::abs(unturned[i][0] - expected[i][0]) > 1e-3 ? 1 : 0;
  }
  EXPECT_GT(apart, expected.size() / 2);
}

TEST(StretchedEnvironment, IsFiniteAndNotNegativeWhateverTheFrame) {
  Random random(4);
  for (const double roughness : {0.0, 0.5, 1.0}) {
    for (const double strength : {1e-6, 0.5, 1.0}) {
      const Subject subject = grooved(roughness, strength, stretched(true));
      std::vector<Sample> samples;
      for (int i = 0; i < 2000; ++i) {
        Sample s = randomSample(random, false);
        if (i % 5 == 1) s.t = {0, 0, 0, 1};
        if (i % 5 == 2) s.t = {s.n[0], s.n[1], s.n[2], -1};
        if (i % 5 == 3) s.v = normalized(sum(cross(s.n, unitVector(random)), s.n, 1e-8));
        if (i % 5 == 4) s.v = normalized({-s.n[0], -s.n[1], -s.n[2]});
        samples.push_back(s);
      }
      for (const Vec4& color : subject.colors<float>(samples, {1, 65504, 0})) {
        for (const double x : color) ASSERT_TRUE(std::isfinite(x) && x >= 0) << roughness << " " << strength;
      }
    }
  }
}

TEST(StretchedEnvironment, TheTableIsTheDocumentations) {
  if (const std::string reason = cost::unavailable(); !reason.empty()) GTEST_SKIP() << reason;
  const cost::Measurement measured = cost::measure(
      {work("w3.gltf", false), work("c.gltf", false), work("w3.gltf", true), work("c.gltf", true)}, "navi21",
      false);
  for (const cost::Outcome& outcome : measured.outcomes) ASSERT_TRUE(outcome.statistics) << outcome.problem;
  expectOnPage("stretched", tables(measured), measured.driver);
}

}  // namespace
}  // namespace lacquer::physics::stretched_environment_test
