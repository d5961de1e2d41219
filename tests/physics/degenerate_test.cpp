// A coat whose grooves have no direction: tangents of no length, tangents along the normal, texture
// coordinates that do not change. Any direction across the normal will do, but it must be one: without a
// direction D grows without bound.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "physics/subject.h"

namespace lacquer::physics::degenerate_test {
namespace {

constexpr double kPi = 3.14159265358979323846;

Material grooved() {
  Material m;
  m.base_color = {0, 0, 0, 1};
  m.coat = Coat{.factor = 1, .roughness = 0, .ior = 1.5, .darkening = 1, .anisotropy = 0.1};
  return m;
}

/// Axes, diagonals of planes and of space, those near an axis, and any.
std::vector<Vec3> normals() {
  std::vector<Vec3> all;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (x != 0 || y != 0 || z != 0) all.push_back(normalized({double(x), double(y), double(z)}));
      }
    }
  }
  for (const double x : {0.8, 0.79999, 0.80001, 0.9999999}) {
    for (const double turn : {0.0, 0.25, 0.4, 0.5, 1.0, 1.5}) {
      const double s = std::sqrt(1 - x * x);
      all.push_back({x, s * std::cos(turn * kPi), s * std::sin(turn * kPi)});
      all.push_back({-x, s * std::cos(turn * kPi), s * std::sin(turn * kPi)});
    }
  }
  Random random(3);
  for (int i = 0; i < 20; ++i) all.push_back(unitVector(random));
  return all;
}

/// A view, and a light near its mirror image, `off` away.
Sample glint(const Vec3& n, double off) {
  Sample s;
  s.n = n;
  const Vec3 side = normalized(cross(n, std::abs(n[0]) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
  const Vec3 other = cross(n, side);
  for (size_t c = 0; c < 3; ++c) {
    s.v[c] = 0.8 * n[c] + 0.6 * side[c];
    s.l[c] = 0.8 * n[c] - 0.6 * side[c] + off * other[c] + 0.5 * off * side[c];
  }
  s.l = normalized(s.l);
  return s;
}

struct Span {
  double least = 1e30, most = 0;
};

/// What tangents all around the normal give.
Span aroundTheNormal(const Subject& subject, Sample s) {
  const Vec3 side = normalized(cross(s.n, std::abs(s.n[0]) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
  const Vec3 other = cross(s.n, side);
  std::vector<Sample> samples;
  for (int k = 0; k < 180; ++k) {
    const double a = k * kPi / 180;
    for (size_t c = 0; c < 3; ++c) s.t[c] = side[c] * std::cos(a) + other[c] * std::sin(a);
    samples.push_back(s);
  }
  Span span;
  for (const Vec4& color : subject.colors<double>(samples)) {
    span.least = std::min(span.least, color[0]);
    span.most = std::max(span.most, color[0]);
  }
  return span;
}

/// No brighter than with some direction.
void expectNoBrighter(const Span& span, const Vec4& color, const std::string& what) {
  EXPECT_TRUE(std::isfinite(color[0])) << what;
  EXPECT_GE(color[0], 0) << what;
  EXPECT_LE(color[0], 1.01 * span.most) << what;
}

/// The highlight is there where all directions have it.
void expectHighlight(const Span& span, const Vec4& color, const std::string& what) {
  if (span.least > 0.9 * span.most) {
    EXPECT_GE(color[0], 0.01 * span.most) << what;
  }
}

TEST(Degenerate, WithoutATangentACoatIsNoBrighter) {
  const Subject subject(grooved());
  for (const Vec3& n : normals()) {
    for (const double off : {0.0, 0.003, 0.05, 0.5}) {
      Sample s = glint(n, off);
      const Span span = aroundTheNormal(subject, s);
      // None, and along the normal, of which rounding leaves something.
      for (const double length : {0.0, 1.0, -1.0, 0.1, 1e-9}) {
        s.t = {length * n[0], length * n[1], length * n[2], 1};
        const std::string what = fmt::format("tangent {} off {} n {}", length, off, fmt::join(n, " "));
        expectNoBrighter(span, subject.color<float>(s), what + " float");
        expectNoBrighter(span, subject.color<double>(s), what + " double");
        if (length == 0) expectHighlight(span, subject.color<float>(s), what);
      }
    }
  }
}

TEST(Degenerate, TextureCoordinatesThatDoNotChangeAreNoTangent) {
  Configuration setup;
  setup.tangents = false;
  setup.quads = true;
  const Subject derived(grooved(), setup);
  const Subject subject(grooved());
  for (const Vec3& n : normals()) {
    const Sample s = glint(n, 0.003);
    const Span span = aroundTheNormal(subject, s);
    const Vec3 side = normalized(cross(n, std::abs(n[0]) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
    const Vec3 other = cross(n, side);
    std::vector<Sample> quad(4, s);
    for (size_t i = 0; i < 4; ++i) {
      for (size_t c = 0; c < 3; ++c)
        quad[i].position[c] = double(i % 2) * 0.01 * side[c] + double(i / 2) * 0.01 * other[c];
      quad[i].uv = {0.25, 0.75};
    }
    expectNoBrighter(span, derived.colors<float>(quad)[0], "float");
    expectNoBrighter(span, derived.colors<double>(quad)[0], "double");
  }
}

}  // namespace
}  // namespace lacquer::physics::degenerate_test
