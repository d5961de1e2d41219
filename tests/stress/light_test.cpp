// Energy, reciprocity and the drawing of inputs, on subjects made up for it.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "stress/attack.h"
#include "stress/directions.h"

namespace lacquer::stress::light_test {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// What the CPU alone evaluates.
class Shown : public Subject {
public:
  Values evaluateRough(std::span<const double> samples, size_t count, uint64_t) const override {
    return evaluate(Arithmetic::Float, samples, count);
  }
  const ir::Module& module() const override { return module_; }
  eval::Bindings inputs(std::span<const double>, size_t) const override { return {}; }
  std::vector<bool> defined(std::span<const double>, size_t count) const override {
    return std::vector<bool>(count, true);
  }

private:
  ir::Module module_;
};

/// A Lambertian base of albedo `base`, a factor `coat` for what its coat makes of it, and a weight for the
/// view.
class Painted final : public Shown {
public:
  Painted(double base, double coat, double view) : base_(base), coat_(coat), view_(view) {
    is_node = false;
    for (const char* direction : {"n", "v", "l", "t"}) space.add(direction, 3, {}, Nature::Direction, 1);
    space.add("light", 3, {0, 10}, Nature::Number, 10);
    space.add("coat_factor", 1, {0, 1}, Nature::Number, 1);
    layers = {{"coat_factor", {0}}};
    roots.push_back({Root::Kind::Result, "color", 4, false, {0, 1e9, false}});
  }

  Values evaluate(Arithmetic, std::span<const double> samples, size_t count) const override {
    Values values(1);
    for (size_t i = 0; i < count; ++i) {
      const double* s = samples.data() + i * space.width();
      const double n_dot_l = std::max(s[8], 0.0);
      const double coat = 1 + (coat_ - 1) * s[space.find("coat_factor")->first];
      const double x =
          s[space.find("light")->first] * base_ * coat * std::pow(std::abs(s[5]), view_) * n_dot_l / kPi;
      values[0].insert(values[0].end(), {x, x, x, 1});
    }
    return values;
  }

private:
  double base_, coat_, view_;
};

Report lit(const Subject& subject) {
  Report report;
  measureLight(subject, {}, report);
  return report;
}

TEST(Light, TheFurnaceOfALambertianIsItsAlbedo) {
  const Report report = lit(Painted(0.8, 1, 0));
  EXPECT_NEAR(report.energy->largest, 0.8, 0.001);
  EXPECT_LT(report.energy->asymmetry, 1e-12);
  EXPECT_TRUE(report.findings.empty());
}

TEST(Light, ABaseThatGainsIsReportedAndACoatThatGainsIsAFault) {
  const Report base = lit(Painted(1.1, 0.5, 0));
  EXPECT_NEAR(base.energy->largest_base, 1.1, 0.001);
  EXPECT_TRUE(base.findings.empty());
  const Report coat = lit(Painted(0.9, 1.5, 0));
  ASSERT_EQ(coat.findings.size(), 1U);
  EXPECT_EQ(coat.findings[0].fault, Fault::Energy);
  EXPECT_GT(coat.findings[0].value, 1.01);
}

TEST(Light, ABaseThatIsNotReciprocalIsAFault) {
  const Report report = lit(Painted(0.5, 1, 0.5));
  ASSERT_EQ(report.findings.size(), 1U);
  EXPECT_EQ(report.findings[0].fault, Fault::Reciprocity);
  EXPECT_EQ(faultName(report.findings[0].fault), "reciprocity");
}

double ggx(const Lobe& lobe, const Vec3& h) {
  const double x = h[0] / lobe.alpha_t;
  const double y = h[1] / lobe.alpha_b;
  return 1 / (kPi * lobe.alpha_t * lobe.alpha_b * std::pow(x * x + y * y + h[2] * h[2], 2));
}

/// What is smooth, and lobes of any width together with it. Straight on a lobe of a white mirror gives
/// everything back but for what it sends below the horizon, which is nothing where it is narrow.
TEST(Directions, ResolveWhatIsSmoothAndNarrowLobes) {
  const Lobe lobes[] = {{1, 1}, {0.09, 0.09}, {0.001, 0.001}, {0.3, 0.001}, {0.001, 0.05}};
  for (const Lobe& one : lobes) {
    for (const Lobe& other : lobes) {
      for (const double z : {1.0, 0.5, 0.05}) {
        const Vec3 v{0.6 * std::sqrt(1 - z * z), 0.8 * std::sqrt(1 - z * z), z};
        double area = 0;
        double mirrored = 0;
        for (const Direction& d : directions(v, {{one, other}}, 1600)) {
          EXPECT_GT(d.l[2], 0);
          area += d.weight * d.l[2];
          const Vec3 h{d.l[0] / 2, d.l[1] / 2, (d.l[2] + 1) / 2};
          const double length = std::sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
          mirrored += d.weight * ggx(one, {h[0] / length, h[1] / length, h[2] / length}) / 4;
        }
        EXPECT_NEAR(area, kPi, 0.005 * kPi) << one.alpha_t << " " << other.alpha_b << " " << z;
        if (z < 1 || std::max(one.alpha_t, one.alpha_b) > 0.1) continue;
        EXPECT_NEAR(mirrored, 1, 0.01) << one.alpha_t << " " << other.alpha_b;
      }
    }
  }
}

/// A narrow lobe about the view itself sends all light back that there is for it.
TEST(Directions, ResolveWhatIsSentBack) {
  const Vec3 v{0.48, 0.64, 0.6};
  for (const double alpha : {0.001, 0.02}) {
    const Lobe plain{alpha, alpha};
    const Lobe back{alpha, alpha, true};
    double sent = 0;
    for (const Direction& d : directions(v, {{plain, back}}, 1600)) {
      Vec3 h{v[0] - d.l[0], v[1] - d.l[1], v[2] + d.l[2]};
      const double length = std::sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
      for (double& x : h) x /= length;
      sent += d.weight * ggx(plain, h) / (4 * (v[0] * h[0] + v[1] * h[1] + v[2] * h[2]));
    }
    EXPECT_NEAR(sent, 1, 0.01) << alpha;
  }
}

/// A Lambertian base under a coat that is a perfect mirror of any roughness and takes `taken` of the base.
class Polished final : public Shown {
public:
  explicit Polished(double taken) : taken_(taken) {
    is_node = false;
    for (const char* direction : {"n", "v", "l", "t"}) space.add(direction, 3, {}, Nature::Direction, 1);
    space.add("light", 3, {0, 10}, Nature::Number, 10);
    space.add("coat_factor", 1, {0, 1}, Nature::Number, 1);
    layers = {{"coat_factor", {0}}};
    space.add("coat_roughness_factor", 1, {0, 0.1}, Nature::Number, 1);
    roots.push_back({Root::Kind::Result, "color", 4, false, {0, 1e9, false}});
  }

  Values evaluate(Arithmetic, std::span<const double> samples, size_t count) const override {
    Values values(1);
    for (size_t i = 0; i < count; ++i) {
      const double* s = samples.data() + i * space.width();
      const auto of = [&](const char* name) { return s[space.find(name)->first]; };
      const double alpha = std::max(std::pow(of("coat_roughness_factor"), 2), 0.001);
      Vec3 h{s[3] + s[6], s[4] + s[7], s[5] + s[8]};
      const double length = std::sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
      for (double& x : h) x /= length;
      // So narrow that masking and the way to the mirror direction do not matter.
      const double lobe = ggx({alpha, alpha}, h) / (4 * std::abs(s[5]));
      const double base = 0.9 * (1 - taken_ * of("coat_factor")) * std::max(s[8], 0.0) / kPi;
      const double x = s[space.find("light")->first] * (base + of("coat_factor") * lobe);
      values[0].insert(values[0].end(), {x, x, x, 1});
    }
    return values;
  }

private:
  double taken_;
};

TEST(Light, ANarrowCoatThatTakesNothingFromItsBaseIsAFault) {
  const Report report = lit(Polished(0));
  ASSERT_GE(report.findings.size(), 1U);
  EXPECT_EQ(report.findings[0].fault, Fault::Energy);
  EXPECT_GT(report.findings[0].value, 1.01);
  EXPECT_TRUE(lit(Polished(1)).findings.empty());
}

TEST(Space, DrawsEdgesAndKeepsRanges) {
  Space space;
  const size_t x = space.add("x", 1, {0.25, 4}, Nature::Number, 1e9);
  const size_t open = space.add("open", 1, {0, INFINITY}, Nature::Number, 1e6);
  const size_t flag = space.add("flag", 1, {}, Nature::Flag, 1);
  const size_t texel = space.add("texel", 3, {}, Nature::Texel, 1);
  const size_t n = space.add("n", 3, {}, Nature::Direction, 1);
  const size_t v = space.add("v", 3, {}, Nature::Direction, 1);
  size_t low = 0, high = 0, one = 0, subnormal = 0, middle = 0, same = 0, opposite = 0, across = 0;
  std::set<double> flags;
  std::vector<double> s(space.width());
  for (uint64_t i = 0; i < 20000; ++i) {
    space.draw(i, s);
    for (size_t k = 0; k < s.size(); ++k) EXPECT_EQ(s[k], static_cast<double>(static_cast<float>(s[k])));
    ASSERT_GE(s[x], 0.25);
    ASSERT_LE(s[x], 4);
    ASSERT_GE(s[open], 0);
    ASSERT_LE(s[open], 1e6);
    low += s[x] == 0.25;
    high += s[x] == 4;
    one += s[x] == 1;
    subnormal += s[open] > 0 && s[open] < 1e-38;
    middle += s[texel] == 0.5 && s[texel + 1] == 0.5 && s[texel + 2] == 0.5;
    flags.insert(s[flag]);
    const double cosine = s[n] * s[v] + s[n + 1] * s[v + 1] + s[n + 2] * s[v + 2];
    same += s[n] == s[v] && s[n + 2] == s[v + 2];
    opposite += s[n] == -s[v] && s[n + 2] == -s[v + 2];
    across += std::abs(cosine) < 1e-6;
  }
  for (const size_t count : {low, high, one, subnormal, middle, same, opposite, across})
    EXPECT_GT(count, 100U);
  EXPECT_EQ(flags, (std::set<double>{0, 1}));
}

TEST(Space, AnIndexIsZeroOrOneAndMore) {
  EXPECT_EQ(natureOf("coat_ior", {0, 1e9}), Nature::Index);
  EXPECT_EQ(natureOf("coat_ior", {1, 4}), Nature::Number);
  EXPECT_EQ(natureOf("weight", {0, 4}), Nature::Number);
  Space space;
  space.add("ior", 1, {0, 4}, Nature::Index, 1e9);
  std::vector<double> s(1);
  size_t zeros = 0;
  for (uint64_t i = 0; i < 2000; ++i) {
    space.draw(i, s);
    zeros += s[0] == 0;
    EXPECT_TRUE(s[0] == 0 || (s[0] >= 1 && s[0] <= 4)) << s[0];
  }
  EXPECT_GT(zeros, 100U);
  EXPECT_LT(zeros, 1000U);
  space.between(std::vector<double>{2}, std::vector<double>{0}, 0.75, s);
  EXPECT_EQ(s[0], 2);
  space.between(std::vector<double>{2}, std::vector<double>{4}, 0.75, s);
  EXPECT_EQ(s[0], 3.5);
}

TEST(Space, KeepsFlagsOnTheWay) {
  Space space;
  space.add("flag", 1, {}, Nature::Flag, 1);
  space.add("x", 1, {0, 8}, Nature::Number, 8);
  std::vector<double> s(2);
  space.between(std::vector<double>{0, 2}, std::vector<double>{1, 6}, 0.75, s);
  EXPECT_EQ(s, (std::vector<double>{0, 5}));
}

}  // namespace
}  // namespace lacquer::stress::light_test
