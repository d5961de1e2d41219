#include "materialx/closures_reference.h"

#include <algorithm>
#include <numbers>

namespace lacquer::test::closures {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kEps = 1e-8;

double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class F>
Vec each(F f) {
  return {f(size_t{0}), f(size_t{1}), f(size_t{2})};
}
Vec scaled(const Vec& a, double s) {
  return each([&](size_t i) { return a[i] * s; });
}
Vec minus(const Vec& a, const Vec& b) {
  return each([&](size_t i) { return a[i] - b[i]; });
}
Vec product(const Vec& a, const Vec& b) {
  return each([&](size_t i) { return a[i] * b[i]; });
}
Vec unit(const Vec& a) { return scaled(a, 1 / std::sqrt(dot(a, a))); }
Vec same(double x) { return {x, x, x}; }
double lerp(double a, double b, double t) { return a + (b - a) * t; }
Vec half(const Vec& a, const Vec& b) {
  return unit(each([&](size_t i) { return a[i] + b[i]; }));
}
double cosine(const Vec& a, const Vec& b) { return std::clamp(dot(a, b), kEps, 1.0); }
Vec facing(const Vec& N, const Vec& V) { return dot(N, V) < 0 ? scaled(N, -1) : N; }
Vec mirrored(const Vec& N, const Vec& V) { return minus(scaled(N, 2 * dot(N, V)), V); }
double square(double x) { return x * x; }

// -- Fresnel --

double dielectricF(double c, double ior) {
  const double g2 = ior * ior + c * c - 1;
  if (g2 < 0) return 1;
  const double g = std::sqrt(g2);
  return 0.5 * square((g - c) / (g + c)) * (1 + square(((g + c) * c - 1) / ((g - c) * c + 1)));
}

struct Polarized {
  double p, s;
};

/// Fresnel's equations with complex numbers avoided: Lagarde's memo.
Polarized conductorF(double c, double n, double k) {
  const double c2 = std::clamp(c, 0.0, 1.0) * std::clamp(c, 0.0, 1.0);
  const double s2 = 1 - c2;
  const double t0 = n * n - k * k - s2;
  const double ab = std::sqrt(t0 * t0 + 4 * n * n * k * k);
  const double t2 = 2 * std::sqrt(std::max(0.5 * (ab + t0), 0.0)) * c;
  const double s = (ab + c2 - t2) / (ab + c2 + t2);
  const double t3 = c2 * ab + s2 * s2;
  return {s * (t3 - t2 * s2) / (t3 + t2 * s2), s};
}

double schlickF(double c, double f0, double f82, double f90, double exponent) {
  const double most = 1.0 / 7;
  const double a = lerp(f0, f90, std::pow(1 - most, exponent)) * (1 - f82) / (most * std::pow(1 - most, 6));
  // MaterialX's curve can fall below 0.
  return std::max(lerp(f0, f90, std::pow(1 - c, exponent)) - a * c * std::pow(1 - c, 6), 0.0);
}

/// Belcour and Barla's Fourier transform of the eye's curves.
Vec sensitivity(double difference, const Vec& shift) {
  const double phase = 2 * kPi * difference;
  const Vec value{5.4856e-13, 4.4201e-13, 5.2481e-13}, position{1.6810e6, 1.7953e6, 2.2084e6},
      spread{4.3278e9, 9.3046e9, 6.6121e9};
  Vec xyz = each([&](size_t i) {
    return value[i] * std::sqrt(2 * kPi * spread[i]) * std::cos(position[i] * phase + shift[i]) *
           std::exp(-spread[i] * phase * phase);
  });
  xyz[0] += 9.7470e-14 * std::sqrt(2 * kPi * 4.5282e9) * std::cos(2.2399e6 * phase + shift[0]) *
            std::exp(-4.5282e9 * phase * phase);
  return scaled(xyz, 1 / 1.0685e-7);
}

struct Boundary {
  enum { Dielectric, Conductor, Schlick } model = Dielectric;
  Vec n{}, k{}, c0{}, c82{}, c90{};
  double exponent = 5;
  Film film;
};

Vec airy(double c, const Boundary& of) {
  const double e = std::max(of.film.ior, 1.0);
  const double inside = std::sqrt(1 - (1 - c * c) / (e * e));
  const Polarized first = inside <= 0 ? Polarized{1, 1} : conductorF(c, e, 0);
  Vec Rp, Rs, phase_p, phase_s;
  for (size_t i = 0; i < 3; ++i) {
    if (of.model == Boundary::Schlick) {
      Rp[i] = Rs[i] = 0.5 * schlickF(inside, of.c0[i], of.c82[i], of.c90[i], of.exponent);
      const double q = std::sqrt(std::clamp(of.c0[i], 0.01, 0.99));
      phase_p[i] = phase_s[i] = (1 + q) / (1 - q) < e ? kPi : 0;
      continue;
    }
    const Polarized second = conductorF(inside, of.n[i] / e, of.k[i] / e);
    Rp[i] = second.p;
    Rs[i] = second.s;
    const double n = of.n[i], k = of.k[i] / n;
    const double A = n * n * (1 - k * k) - e * e * (1 - inside * inside);
    const double B = std::sqrt(A * A + square(2 * n * n * k));
    const double U = std::sqrt((A + B) / 2), V = std::sqrt(std::max((B - A) / 2, 0.0));
    phase_s[i] = std::atan2(2 * e * V * inside, U * U + V * V - square(e * inside));
    phase_p[i] = std::atan2(2 * e * n * n * inside * (2 * k * U - (1 - k * k) * V),
                            square(n * n * (1 + k * k) * inside) - e * e * (U * U + V * V));
  }
  const double turn = c < std::cos(std::atan(e)) ? 0 : kPi;
  const double difference = 2 * e * inside * of.film.thickness * 1e-9;
  Vec xyz{};
  const auto polarization = [&](double R12, const Vec& R23, const Vec& phase) {
    const double T = 1 - R12;
    Vec shift1 = phase, shift2 = scaled(phase, 2);
    const Vec S1 = sensitivity(difference, shift1), S2 = sensitivity(2 * difference, shift2);
    for (size_t i = 0; i < 3; ++i) {
      const double r = std::sqrt(R12 * R23[i]);
      const double once = T * T * R23[i] / (1 - R12 * R23[i]);
      xyz[i] += 0.5 * (R12 + once + (once - T) * r * 2 * S1[i] + (once - T) * r * r * 2 * S2[i]);
    }
  };
  polarization(first.p, Rp, each([&](size_t i) { return phase_p[i] + turn; }));
  polarization(first.s, Rs, each([&](size_t i) { return phase_s[i] + kPi; }));
  const Vec rows[3] = {{2.3706743, -0.9000405, -0.4706338},
                       {-0.5138850, 1.4253036, 0.0885814},
                       {0.0052982, -0.0146949, 1.0093968}};
  return each([&](size_t i) { return std::clamp(dot(rows[i], xyz), 0.0, 1.0); });
}

Vec fresnel(double c, const Boundary& of) {
  if (of.film.thickness > 0) return airy(c, of);
  return each([&](size_t i) {
    if (of.model == Boundary::Dielectric) return dielectricF(c, of.n[i]);
    if (of.model == Boundary::Schlick) return schlickF(c, of.c0[i], of.c82[i], of.c90[i], of.exponent);
    const Polarized both = conductorF(c, of.n[i], of.k[i]);
    return 0.5 * (both.p + both.s);
  });
}

// -- the lobe --

struct Fit {
  double A, B;
};

Fit albedoFit(double x, double y) {
  const double terms[9] = {1, x, y, x * y, x * x, y * y, x * x * y, x * y * y, x * x * y * y};
  const double rows[4][9] = {{0.1003, -0.6303, 9.748, -2.038, 29.34, -8.245, -26.44, 19.99, -5.448},
                             {0.9345, -2.323, 2.229, -3.748, 1.424, -0.7684, 1.436, 0.2913, 0.6286},
                             {1, -1.765, 8.263, 11.53, 28.96, -7.507, -36.11, 15.86, 33.37},
                             {1, 0.2281, 15.94, -55.83, 13.08, 41.26, 54.9, 300.2, -285.1}};
  double r[4] = {};
  for (size_t k = 0; k < 4; ++k) {
    for (size_t i = 0; i < 9; ++i) r[k] += rows[k][i] * terms[i];
  }
  return {std::clamp(r[0] / r[2], 0.0, 1.0), std::clamp(r[1] / r[3], 0.0, 1.0)};
}

/// One bounce of white light from all around, what the other bounces gain, and what a layer takes by it.
struct Albedo {
  Vec once, gain, taken;
};

Albedo albedoOf(double NdotV, double alpha, const Boundary& of) {
  const Fit fit = albedoFit(NdotV, alpha);
  const bool film = of.film.thickness > 0;
  const Vec straight = film || of.model != Boundary::Schlick ? fresnel(1, of) : of.c0;
  const Vec end = of.model == Boundary::Schlick && !film ? of.c90 : same(1);
  const double E = fit.A + fit.B;
  Albedo made;
  const Vec plain = each([&](size_t i) {
    if (of.model == Boundary::Schlick) return of.c0[i] * fit.A + of.c90[i] * fit.B;
    if (of.model == Boundary::Dielectric) return square((of.n[i] - 1) / (of.n[i] + 1)) * fit.A + fit.B;
    return straight[i] * fit.A + fit.B;
  });
  const Vec mirror = film ? airy(NdotV, of) : same(0);
  for (size_t i = 0; i < 3; ++i) {
    made.gain[i] = 1 + (straight[i] + (end[i] - straight[i]) / 21) * (1 - E) / E;
    made.once[i] = film ? lerp(mirror[i], straight[i] * fit.A + fit.B, std::sqrt(alpha)) : plain[i];
    made.taken[i] = plain[i] * made.gain[i];
  }
  return made;
}

struct Lobe {
  double height, VdotH, NdotV, alpha;
};

Lobe lobeOf(const Place& at, const Vec& N, const Vec& V, double ax, double ay) {
  ax = std::clamp(ax, kEps, 1.0);
  ay = std::clamp(ay, kEps, 1.0);
  const double NdotV = cosine(N, V), NdotL = cosine(N, at.L);
  const Vec X = unit(minus(at.T, scaled(N, dot(at.T, N))));
  const Vec Y = cross(N, X);
  const Vec H = half(at.L, V);
  const double alpha = std::sqrt(ax * ay);
  const double q = square(dot(H, X) / ax) + square(dot(H, Y) / ay) + square(dot(H, N));
  const double D = 1 / (kPi * ax * ay * q * q);
  const auto lambda = [&](double c) { return std::sqrt(alpha * alpha + (1 - alpha * alpha) * c * c); };
  const double G = 2 * NdotL * NdotV / (lambda(NdotL) * NdotV + lambda(NdotV) * NdotL);
  return {D * G / (4 * NdotV), cosine(V, H), NdotV, alpha};
}

Bsdf facets(const Place& at, double weight, const Vec& tint, const Boundary& of, double ax, double ay,
            bool retro, int mode) {
  const Vec V = retro ? mirrored(at.N, at.V) : at.V;
  const Vec N = facing(at.N, V);
  const Lobe lobe = lobeOf(at, N, V, ax, ay);
  const auto taken = [&](const Albedo& a) {
    if (of.model != Boundary::Schlick) return a.taken;
    return same((a.taken[0] + a.taken[1] + a.taken[2]) / 3);
  };
  Bsdf made;
  if (mode != 1) {
    const Albedo a = albedoOf(lobe.NdotV, lobe.alpha, of);
    const Vec F = fresnel(lobe.VdotH, of);
    for (size_t i = 0; i < 3; ++i) {
      made.direct[i] = lobe.height * F[i] * a.gain[i] * tint[i] * weight;
      made.indirect[i] = at.around[i] * a.once[i] * a.gain[i] * tint[i] * weight;
      made.through[i] = 1 - taken(a)[i] * weight;
    }
  }
  const Vec onto = facing(at.N, at.V);
  const Albedo b = albedoOf(cosine(onto, at.V), lobe.alpha, of);
  for (size_t i = 0; i < 3; ++i) {
    if (mode != 0) made.transmitted[i] = at.behind[i] * std::max(1 - b.once[i], 0.0) * tint[i] * weight;
    made.passed[i] = 1 - taken(b)[i] * weight;
  }
  return made;
}

double fujiiDirectional(double c, double roughness) {
  const double A = 1 / (1 + (0.5 - 2 / (3 * kPi)) * roughness);
  const double s = std::sqrt(std::max(0.0, 1 - c * c));
  const double G = s * (std::acos(c) - s * c) + 2 * (s / c * (1 - s * s * s) - s) / 3;
  return A + roughness * A * G / kPi;
}

double fujiiMean(double roughness) {
  return (1 + (2.0 / 3 - 28 / (15 * kPi)) * roughness) / (1 + (0.5 - 2 / (3 * kPi)) * roughness);
}

}  // namespace

Bsdf orenNayar(const Place& at, double weight, const Vec& color, double roughness, bool compensated) {
  const Vec N = facing(at.N, at.V);
  const double NdotV = cosine(N, at.V), NdotL = cosine(N, at.L), LdotV = cosine(at.L, at.V);
  const double s = LdotV - NdotL * NdotV;
  const double s2 = roughness * roughness;
  Bsdf made{{}, {}, {}, same(0), same(0)};
  for (size_t i = 0; i < 3; ++i) {
    double lobe = 0, all = 0;
    if (compensated) {
      const double A = 1 / (1 + (0.5 - 2 / (3 * kPi)) * roughness), E = fujiiMean(roughness);
      const double many = color[i] * color[i] * E / (1 - color[i] * std::max(0.0, 1 - E));
      const double V = fujiiDirectional(NdotV, roughness), L = fujiiDirectional(NdotL, roughness);
      lobe = color[i] * A * (1 + roughness * (s > 0 ? s / std::max(NdotL, NdotV) : s)) +
             many * std::max(kEps, 1 - V) * std::max(kEps, 1 - L) / std::max(kEps, 1 - E);
      all = lerp(many, color[i], V);
    } else {
      lobe = color[i] * (1 - 0.5 * s2 / (s2 + 0.33) +
                         0.45 * s2 / (s2 + 0.09) * (s > 0 ? s / std::max(NdotL, NdotV) : 0));
      all = color[i] * std::clamp((1 - 0.4297 * roughness - 0.7632 * NdotV * roughness + 1.4385 * s2) /
                                      (1 - 0.6076 * roughness - 0.4993 * NdotV * roughness + 2.0315 * s2),
                                  0.0, 1.0);
    }
    made.direct[i] = lobe * weight * NdotL / kPi;
    made.indirect[i] = at.around[i] * all * weight;
  }
  return made;
}

Bsdf burley(const Place& at, double weight, const Vec& color, double roughness) {
  const Vec N = facing(at.N, at.V);
  const double NdotV = cosine(N, at.V), NdotL = cosine(N, at.L), LdotH = cosine(at.L, half(at.L, at.V));
  const double F90 = 0.5 + 2 * roughness * LdotH * LdotH;
  const double lobe =
      lerp(1, F90, std::pow(1 - NdotL, 5)) * lerp(1, F90, std::pow(1 - NdotV, 5)) * NdotL / kPi * weight;
  const double x = NdotV;
  const double all = lerp(0.97619 - 0.488095 * std::pow(1 - x, 5),
                          1.55754 + (-2.02221 + (2.56283 - 1.06244 * x) * x) * x, roughness);
  return {scaled(color, lobe), product(at.around, scaled(color, all * weight)), {}, same(0), same(0)};
}

Bsdf translucent(const Place& at, double weight, const Vec& color) {
  const double NdotL = std::clamp(-dot(at.N, at.L), 0.0, 1.0);
  return {
      scaled(color, weight * NdotL / kPi), product(at.around, scaled(color, weight)), {}, same(0), same(0)};
}

Bsdf dielectric(const Place& at, double weight, const Vec& tint, double ior, double ax, double ay, bool retro,
                const Film& film, int mode) {
  Boundary of;
  of.n = same(ior);
  of.film = film;
  return facets(at, weight, tint, of, ax, ay, retro, mode);
}

Bsdf conductor(const Place& at, double weight, const Vec& n, const Vec& k, double ax, double ay, bool retro,
               const Film& film) {
  Boundary of;
  of.model = Boundary::Conductor;
  of.n = n;
  of.k = k;
  of.film = film;
  Bsdf made = facets(at, weight, same(1), of, ax, ay, retro, 0);
  made.through = made.passed = same(0);
  return made;
}

Bsdf schlick(const Place& at, double weight, const Vec& c0, const Vec& c82, const Vec& c90, double exponent,
             double ax, double ay, bool retro, const Film& film, int mode) {
  Boundary of;
  of.model = Boundary::Schlick;
  of.c0 = c0;
  of.c82 = c82;
  of.c90 = c90;
  of.exponent = exponent;
  of.film = film;
  return facets(at, weight, same(1), of, ax, ay, retro, mode);
}

Bsdf sheen(const Place& at, double weight, const Vec& color, double roughness, bool zeltner) {
  const Vec N = facing(at.N, at.V);
  const double x = cosine(N, at.V);
  double lobe = 0, all = 0;
  if (zeltner) {
    const double y = std::clamp(roughness, 0.01, 1.0);
    const double s = y * (0.0206607 + 1.58491 * y) / (0.0379424 + y * (1.32227 + y));
    const double m = y * (-0.193854 + y * (-1.14885 + y * (1.7932 - 0.95943 * y * y))) / (0.046391 + y);
    const double o = y * (0.000654023 + (-0.0207818 + 0.119681 * y) * y) / (1.26264 + y * (-1.92021 + y));
    // The fit is below 0 by less than 1e-4 for smooth fibres.
    all = std::max(std::exp(-0.5 * square((x - m) / s)) / (s * std::sqrt(2 * kPi)) + o, 0.0);
    const Vec X = unit(minus(at.V, scaled(N, x)));
    const Vec Y = cross(N, X);
    const double a = (2.58126 * x + 0.813703 * y) * y / (1 + 0.310327 * x * x + 2.60994 * x * y);
    const double b = std::sqrt(1 - x) * (y - 1) * y * y * y /
                     (0.0000254053 + 1.71228 * x - 1.71506 * x * y + 1.34174 * y * y);
    const Vec o3{a * dot(X, at.L) + b * dot(N, at.L), a * dot(Y, at.L), dot(N, at.L)};
    lobe = all * std::max(o3[2], 0.0) / kPi * square(a / dot(o3, o3));
  } else {
    const double NdotL = cosine(N, at.L), NdotH = cosine(N, half(at.L, at.V));
    const double i = 1 / std::max(roughness, 0.005);
    const double D = (2 + i) * std::pow(1 - NdotH * NdotH, i / 2) / (2 * kPi);
    lobe = D * NdotL / (4 * (NdotL + x - NdotL * x));
    const double y = roughness;
    all = std::clamp(
        (13.673 - 68.78018 * x + 799.08825 * y - 905.00061 * x * y + 60.28956 * x * x + 1086.96473 * y * y) /
            (1 + 61.57746 * x + 442.78211 * y + 2597.49308 * x * y + 121.81241 * x * x + 3045.55075 * y * y),
        0.0, 1.0);
  }
  return {scaled(color, lobe * weight),
          product(at.around, scaled(color, all * weight)),
          {},
          same(1 - all * weight),
          same(1)};
}

Bsdf subsurface(const Place& at, double weight, const Vec& color, const Vec& radius, double sphere) {
  const Vec N = facing(at.N, at.V);
  const double theta = std::acos(std::clamp(dot(N, at.L), -1.0, 1.0));
  Vec lit{}, all{};
  for (int i = 0; i < 32; ++i) {
    const double x = -kPi + (i + 0.5) * (2 * kPi / 32);
    const double way = sphere * std::abs(2 * std::sin(x / 2));
    for (size_t c = 0; c < 3; ++c) {
      const double shape = 1 / std::max(radius[c], 0.1);
      const double R = (std::exp(-shape * way) + std::exp(-shape * way / 3)) / std::max(way, kEps);
      lit[c] += R * std::max(std::cos(theta + x), 0.0);
      all[c] += R;
    }
  }
  return {each([&](size_t c) { return color[c] * lit[c] / all[c] / kPi * weight; }),
          product(at.around, scaled(color, weight)),
          {},
          same(0),
          same(0)};
}

Vec schlickEdf(const Place& at, const Vec& c0, const Vec& c90, double exponent, const Vec& base) {
  const double t = std::pow(1 - cosine(facing(at.N, at.V), at.V), exponent);
  return each([&](size_t i) { return base[i] * lerp(c0[i], c90[i], t); });
}

Bsdf layer(const Bsdf& top, const Bsdf& base) {
  Bsdf made;
  for (size_t i = 0; i < 3; ++i) {
    made.direct[i] = top.direct[i] + base.direct[i] * top.through[i];
    made.indirect[i] = top.indirect[i] + base.indirect[i] * top.through[i];
    made.transmitted[i] = top.transmitted[i] + base.transmitted[i] * top.passed[i];
    made.through[i] = top.through[i] * base.through[i];
    made.passed[i] = top.passed[i] * base.passed[i];
  }
  return made;
}

Bsdf layerOver(const Bsdf& top, const Vec& medium) {
  Bsdf made = top;
  made.transmitted = product(top.transmitted, medium);
  made.passed = product(top.passed, medium);
  return made;
}

Bsdf mixed(const Bsdf& fg, const Bsdf& bg, double t) {
  const auto of = [&](Vec Bsdf::*part) {
    return each([&](size_t i) { return lerp((bg.*part)[i], (fg.*part)[i], t); });
  };
  return {of(&Bsdf::direct), of(&Bsdf::indirect), of(&Bsdf::transmitted), of(&Bsdf::through),
          of(&Bsdf::passed)};
}

Bsdf sum(const Bsdf& a, const Bsdf& b) {
  const auto of = [&](Vec Bsdf::*part, double less) {
    return each([&](size_t i) { return std::max((a.*part)[i] + (b.*part)[i] - less, 0.0); });
  };
  return {of(&Bsdf::direct, 0), of(&Bsdf::indirect, 0), of(&Bsdf::transmitted, 0), of(&Bsdf::through, 1),
          of(&Bsdf::passed, 1)};
}

Bsdf times(const Bsdf& a, const Vec& b) {
  const Vec part = each([&](size_t i) { return std::clamp(b[i], 0.0, 1.0); });
  return {product(a.direct, part), product(a.indirect, part), product(a.transmitted, part), a.through,
          a.passed};
}

}  // namespace lacquer::test::closures
