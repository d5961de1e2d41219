// What the algebra that makes the shaders faster does to the rounding: each rewrite in float32 beside the
// text's form in float32, both against the text's form in double.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace lacquer::physics::rewrites_test {
namespace {

template <class T>
using Vec = std::array<T, 3>;

template <class T>
T dot(const Vec<T>& a, const Vec<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class T>
Vec<T> unit(const Vec<T>& v) {
  const T s = 1 / std::sqrt(dot(v, v));
  return {v[0] * s, v[1] * s, v[2] * s};
}

/// One light over one lobe. Directions are unit vectors as rounded to float.
struct Draw {
  Vec<double> N, V, L;
  double alpha, weight, F0, diffuse;
};

Draw draw(std::mt19937_64& random) {
  std::uniform_real_distribution<double> u(0, 1);
  const auto direction = [&] {
    Vec<double> v{2 * u(random) - 1, 2 * u(random) - 1, u(random) + 1e-3};
    v = unit(v);
    return Vec<double>{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
  };
  Draw d{{0, 0, 1}, direction(), direction(), 0, 0, 0, 0};
  // Half of the draws lie near the lobe's peak, as narrow as the lobe is.
  d.alpha = static_cast<float>(std::exp(std::log(0.001) * u(random)));
  if (random() % 2 == 0) {
    Vec<double> l{-d.V[0] + d.alpha * (u(random) - 0.5), -d.V[1] + d.alpha * (u(random) - 0.5), d.V[2]};
    l = unit(l);
    d.L = {static_cast<float>(l[0]), static_cast<float>(l[1]), static_cast<float>(l[2])};
  }
  d.weight = static_cast<float>(u(random));
  d.F0 = static_cast<float>(u(random));
  d.diffuse = static_cast<float>(u(random));
  return d;
}

template <class T>
struct Cosines {
  Vec<T> N, V, L;
  T NdotL, NdotV;
  explicit Cosines(const Draw& d) {
    for (size_t i = 0; i < 3; ++i) N[i] = T(d.N[i]), V[i] = T(d.V[i]), L[i] = T(d.L[i]);
    NdotL = std::clamp(dot(N, L), T(0), T(1));
    NdotV = std::abs(dot(N, V));
  }
};

template <class T>
T fifth(T x) {
  return x * x * x * x * x;
}

// D with N.H of a normalized half vector, as Appendix B writes it.
template <class T>
T distributionOfTheText(const Draw& d) {
  const Cosines<T> c(d);
  const Vec<T> H = unit(Vec<T>{c.V[0] + c.L[0], c.V[1] + c.L[1], c.V[2] + c.L[2]});
  const T NdotH = dot(c.N, H);
  const T a2 = T(d.alpha) * T(d.alpha);
  const T f = NdotH * NdotH * (a2 - 1) + 1;
  return a2 / (T(3.14159265358979) * f * f);
}

// ggx_distribution: the half vector is never normalized, the sine is what N leaves of it.
template <class T>
T distributionOfOurs(const Draw& d) {
  const Cosines<T> c(d);
  const Vec<T> sum{c.V[0] + c.L[0], c.V[1] + c.L[1], c.V[2] + c.L[2]};
  const T NdotSum = c.NdotL + dot(c.N, c.V);
  const Vec<T> planar{sum[0] - c.N[0] * NdotSum, sum[1] - c.N[1] * NdotSum, sum[2] - c.N[2] * NdotSum};
  const T length2 = dot(sum, sum);
  const T a2 = T(d.alpha) * T(d.alpha);
  const T spread = dot(planar, planar) + a2 * (NdotSum * NdotSum);
  return length2 * length2 * (a2 / T(3.14159265358979)) / (spread * spread);
}

template <class T>
T visibilityOfTheText(const Draw& d) {
  const Cosines<T> c(d);
  const T a2 = T(d.alpha) * T(d.alpha);
  return T(0.5) / (c.NdotL * std::sqrt(c.NdotV * c.NdotV * (1 - a2) + a2) +
                   c.NdotV * std::sqrt(c.NdotL * c.NdotL * (1 - a2) + a2));
}

// smith_visibility_split; the preshader computes in double and rounds its results.
template <class T>
T visibilityOfOurs(const Draw& d) {
  const Cosines<T> c(d);
  const double a2 = d.alpha * d.alpha;
  const double rest = std::max(1 - a2, 1e-12);
  const T ratio = T(a2 / rest);
  const T weight = T(0.5 / std::sqrt(rest));
  return weight /
         (c.NdotL * std::sqrt(ratio + c.NdotV * c.NdotV) + c.NdotV * std::sqrt(ratio + c.NdotL * c.NdotL));
}

// Base under coat, each with its cosine, weighted where they meet.
template <class T>
T layersOfTheText(const Draw& d) {
  const Cosines<T> c(d);
  const T F = T(0.04) + T(0.96) * fifth(1 - c.NdotV);
  const T base = T(d.diffuse) * c.NdotL;
  const T coat = T(d.F0) * c.NdotL;
  return base * (1 - T(d.weight) * F) + coat * (T(d.weight) * F);
}

// coat_split: the cosine is divided, nothing else is weighted; w F0 and w (1 - F0) come from the preshader.
template <class T>
T layersOfOurs(const Draw& d) {
  const Cosines<T> c(d);
  const T covered = T(d.weight * 0.04) + T(d.weight * 0.96) * fifth(1 - c.NdotV);
  const T reflected = c.NdotL * covered;
  const T transmitted = std::clamp(c.NdotL - reflected, T(0), T(1));
  return T(d.diffuse) * transmitted + T(d.F0) * reflected;
}

// Lambert under 1 - F, and F over a lobe of 1.
template <class T>
T baseOfTheText(const Draw& d) {
  const Cosines<T> c(d);
  const T w = fifth(1 - c.NdotV);
  const T F = T(d.F0) + (1 - T(d.F0)) * w;
  const T f = T(0.04) + T(0.96) * w;
  return ((1 - f) * (T(d.diffuse) / T(3.14159265358979)) + F) * c.NdotL;
}

// base_direct: gathered by Schlick's weight.
template <class T>
T baseOfOurs(const Draw& d) {
  const Cosines<T> c(d);
  const T lambert = T(d.diffuse * (0.96 / 3.14159265358979));
  const T glancing = fifth(1 - c.NdotV) * c.NdotL;
  return (lambert + T(d.F0)) * (c.NdotL - glancing) + glancing;
}

struct Rewrite {
  const char* name;
  double (*exact)(const Draw&);
  float (*text)(const Draw&);
  float (*ours)(const Draw&);
};

constexpr std::array kRewrites{
    Rewrite{"D without a half vector", distributionOfTheText<double>, distributionOfTheText<float>,
            distributionOfOurs<float>},
    Rewrite{"Smith as a quotient", visibilityOfTheText<double>, visibilityOfTheText<float>,
            visibilityOfOurs<float>},
    Rewrite{"the cosine divided by the coat", layersOfTheText<double>, layersOfTheText<float>,
            layersOfOurs<float>},
    Rewrite{"the base gathered by Schlick's weight", baseOfTheText<double>, baseOfTheText<float>,
            baseOfOurs<float>},
};

struct Errors {
  double most, thousandth, rms;
};

Errors errorsOf(const Rewrite& rewrite, float (*form)(const Draw&)) {
  std::mt19937_64 random(1);
  std::vector<double> errors;
  double squares = 0;
  for (int i = 0; i < 200000; ++i) {
    const Draw d = draw(random);
    const double exact = rewrite.exact(d);
    const double error = std::abs(static_cast<double>(form(d)) - exact) / std::abs(exact);
    errors.push_back(error);
    squares += error * error;
  }
  std::sort(errors.begin(), errors.end());
  return {errors.back(), errors[errors.size() * 999 / 1000],
          std::sqrt(squares / static_cast<double>(errors.size()))};
}

TEST(Rewrites, RoundNoWorseThanTheText) {
  fmt::print("{:40} {:>30} {:>30}\n", "", "the text's form", "ours");
  for (const Rewrite& rewrite : kRewrites) {
    const Errors text = errorsOf(rewrite, rewrite.text);
    const Errors ours = errorsOf(rewrite, rewrite.ours);
    fmt::print("{:40} {:>10.1e}{:>10.1e}{:>10.1e} {:>10.1e}{:>10.1e}{:>10.1e}\n", rewrite.name, text.most,
               text.thousandth, text.rms, ours.most, ours.thousandth, ours.rms);
    EXPECT_LE(ours.rms, 1.25 * text.rms) << rewrite.name;
    EXPECT_LE(ours.thousandth, 1.25 * text.thousandth) << rewrite.name;
  }
}

}  // namespace
}  // namespace lacquer::physics::rewrites_test
