#include "physics/film_reference.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lacquer::physics {

namespace {

double sq(double x) { return x * x; }

double schlickOf(double F0, double cosine) { return F0 + (1 - F0) * std::pow(1 - cosine, 5); }

double f0Of(double transmitted_ior, double incident_ior) {
  return sq((transmitted_ior - incident_ior) / (transmitted_ior + incident_ior));
}

Vec3 rgbOf(const Vec3& xyz) {
  return {3.2404542 * xyz[0] - 1.5371385 * xyz[1] - 0.4985314 * xyz[2],
          -0.9692660 * xyz[0] + 1.8760108 * xyz[1] + 0.0415560 * xyz[2],
          0.0556434 * xyz[0] - 0.2040259 * xyz[1] + 1.0572252 * xyz[2]};
}

/// The text's evalSensitivity. The path is in nanometres.
Vec3 sensitivityOf(double path, const Vec3& shift) {
  const double phase = 2 * std::numbers::pi * path * 1e-9;
  const Vec3 val{5.4856e-13, 4.4201e-13, 5.2481e-13};
  const Vec3 pos{1.6810e6, 1.7953e6, 2.2084e6};
  const Vec3 var{4.3278e9, 9.3046e9, 6.6121e9};
  Vec3 xyz{};
  for (size_t i = 0; i < 3; ++i) {
    xyz[i] = val[i] * std::sqrt(2 * std::numbers::pi * var[i]) * std::cos(pos[i] * phase + shift[i]) *
             std::exp(-sq(phase) * var[i]);
  }
  xyz[0] += 9.7470e-14 * std::sqrt(2 * std::numbers::pi * 4.5282e9) * std::cos(2.2399e6 * phase + shift[0]) *
            std::exp(-4.5282e9 * sq(phase));
  for (double& x : xyz) x /= 1.0685e-7;
  return rgbOf(xyz);
}

/// The same where each of R, G and B has a turn of its own.
Vec3 sensitivityOfTurnedColors(double path, const Vec3& shift) {
  Vec3 result{};
  for (size_t i = 0; i < 3; ++i) result[i] = sensitivityOf(path, {shift[i], shift[i], shift[i]})[i];
  return result;
}

}  // namespace

Vec3 filmFresnel(double cosine, const Vec3& F0, double ior, double thickness, const FilmReadings& readings) {
  const double R12 = schlickOf(f0Of(ior, 1), cosine);
  const double T121 = 1 - R12;
  const double cos2_t = 1 - sq(1 / ior) * (1 - sq(cosine));
  if (cos2_t < 0) return {1, 1, 1};
  const double cos_t = std::sqrt(cos2_t);
  const double path = 2 * ior * thickness * cos_t;

  Vec3 R23{};
  Vec3 phi{};
  for (size_t i = 0; i < 3; ++i) {
    const double guarded = F0[i] + 0.0001;
    const double root = std::sqrt(readings.bounded_guard ? std::min(guarded, 0.9999) : guarded);
    const double base_ior = (1 + root) / (1 - root);
    R23[i] = schlickOf(f0Of(base_ior, ior), cos_t);
    phi[i] = std::numbers::pi + (base_ior < ior ? std::numbers::pi : 0);
  }
  const auto sensitivity = readings.turns_of_waves ? sensitivityOf : sensitivityOfTurnedColors;
  const Vec3 S1 = sensitivity(path, phi);
  const Vec3 S2 = sensitivity(2 * path, {2 * phi[0], 2 * phi[1], 2 * phi[2]});

  Vec3 I{};
  for (size_t i = 0; i < 3; ++i) {
    const double R123 = std::clamp(R12 * R23[i], 1e-5, 0.9999);
    const double r123 = std::sqrt(R123);
    const double Rs = sq(T121) * R23[i] / (1 - R123);
    const double C1 = (Rs - T121) * r123;
    I[i] = std::max(R12 + Rs + C1 * 2 * S1[i] + C1 * r123 * 2 * S2[i], 0.0);
    if (readings.bounded_sum) I[i] = std::min(I[i], 1.0);
  }
  return I;
}

}  // namespace lacquer::physics
