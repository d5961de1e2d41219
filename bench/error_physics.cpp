#include "bench/error_physics.h"

#include <cmath>
#include <functional>
#include <map>
#include <mutex>
#include <random>

#include "accuracy/exact.h"

namespace lacquer::bench {

namespace {

constexpr size_t kPoints = 100000;
constexpr double kPi = 3.14159265358979323846;

double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

/// In a range, its ends among them; near the lower one a model is worst.
double within(std::mt19937_64& random, double lo, double hi) {
  const double kind = uniform(random);
  const double u = uniform(random);
  return lo + (hi - lo) * (kind < 0.03 ? 0 : kind < 0.06 ? 1 : kind < 0.3 ? u * u * u : u);
}

/// Inputs by name, and the answer.
struct Sample {
  std::map<std::string, double> inputs;
  double value = 0;
};

double averageFresnel(double ior) {
  // Nothing comes back from a black base, so what gets in is the environment's transmission over what gets
  // out.
  const double in = accuracy::smoothEnvironment({ior, 0, 1, 0}, 1) * ior * ior;
  return 1 - in / (1 - accuracy::fresnel(ior, 1));
}

/// The part of a Lambertian base's light that the coat's underside returns.
double diffuseReflection(double ior) { return 1 - (1 - averageFresnel(ior)) / (ior * ior); }

/// A smooth clear coat over Lambert under an environment, without the Fresnel of the view: it is the same
/// from everywhere.
double darkening(double ior, double albedo) {
  const double K = diffuseReflection(ior);
  return (1 - K) / (1 - albedo * K);
}

double iorOf(double F0) { return (1 + std::sqrt(F0)) / (1 - std::sqrt(F0)); }

/// What a GGX lobe with Smith's height-correlated masking reflects; `weighted` by Schlick's (1 - V.H)^5.
/// Over facets drawn from the visible ones, at the middles of a grid (Heitz 2018).
double directionalAlbedo(double cosine, double roughness, bool weighted) {
  constexpr int kSide = 64;  // within 0.0004 of 400
  const double alpha = std::max(roughness * roughness, 0.001);
  const double sine = std::sqrt(1 - cosine * cosine);
  const double stretch = std::sqrt(alpha * alpha * sine * sine + cosine * cosine);
  const double wx = alpha * sine / stretch;
  const double wz = cosine / stretch;
  const auto lambda = [&](double c) {
    return 0.5 * (std::sqrt(1 + alpha * alpha * (1 - c * c) / (c * c)) - 1);
  };
  double sum = 0;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const double phi = 2 * kPi * (i + 0.5) / kSide;
      // Close together at the horizon, where facets send light down.
      const double left = 1 - (j + 0.5) / kSide;
      const double z = left * left * (1 + wz) - wz;
      const double s = std::sqrt(std::max(1 - z * z, 0.0));
      const double mx = alpha * (s * std::cos(phi) + wx);
      const double my = alpha * s * std::sin(phi);
      const double mz = std::max(z + wz, 1e-12);
      const double length = std::sqrt(mx * mx + my * my + mz * mz);
      const double c = (sine * mx + cosine * mz) / length;
      const double out = 2 * c * mz / length - cosine;
      if (out <= 0) continue;
      const double masked = (1 + lambda(cosine)) / (1 + lambda(cosine) + lambda(out));
      const double m = 1 - c;
      sum += 2 * left * masked * (weighted ? m * m * m * m * m : 1);
    }
  }
  return sum / (kSide * kSide);
}

using Draw = std::function<Sample(std::mt19937_64&)>;

struct Row {
  std::string what;
  Draw draw;
};

Sample drawAlbedo(std::mt19937_64& random, bool weighted) {
  const double cosine = within(random, 0.01, 1);
  const double roughness = within(random, 0, 1);
  return {{{"NdotV", cosine}, {"roughness", roughness}}, directionalAlbedo(cosine, roughness, weighted)};
}

/// A smooth clear coat with its darkening in full over a base of any albedo, as seen under an environment,
/// without the Fresnel of the view.
Sample drawDarkening(std::mt19937_64& random) {
  const double ior = within(random, 1, 4);
  const double cosine = within(random, 0.01, 1);
  const double F0 = std::pow((ior - 1) / (ior + 1), 2);
  const double schlick = F0 + (1 - F0) * std::pow(1 - cosine, 5);
  return {{{"F0", F0}, {"fresnel_view", schlick}, {"roughness", 0}, {"amount", 1}},
          darkening(ior, within(random, 0, 1))};
}

const std::map<std::string, Row>& rows() {
  static const std::map<std::string, Row> kRows = {
      {"schlick",
       {"Fresnel's equations for the IOR of that F0",
        [](std::mt19937_64& random) {
          const double F0 = within(random, 0, 0.36);
          const double c = within(random, 0, 1);
          return Sample{{{"F0", F0}, {"cosine", c}}, accuracy::fresnel(iorOf(F0), c)};
        }}},
      {"fresnel_dielectric",
       {"Fresnel's equations by Snell's law",
        [](std::mt19937_64& random) {
          const double ior = within(random, 1, 4);
          const double c = within(random, 0, 1);
          return Sample{{{"ior", ior}, {"cosine", c}}, accuracy::fresnel(ior, c)};
        }}},
      {"average_fresnel",
       {"quadrature of Fresnel's equations",
        [](std::mt19937_64& random) {
          const double ior = within(random, 1, 4);
          return Sample{{{"ior", ior}}, averageFresnel(ior)};
        }}},
      {"directional_albedo",
       {"quadrature of the lobe", [](std::mt19937_64& random) { return drawAlbedo(random, false); }}},
      {"directional_fresnel",
       {"quadrature of the lobe", [](std::mt19937_64& random) { return drawAlbedo(random, true); }}},
      {"coat_darkening_ibl",
       {"a smooth clear coat over Lambert of any albedo, by quadrature", drawDarkening}},
      {"coat_internal_reflection",
       {"quadrature of the underside's reflection under a rough base",
        [](std::mt19937_64& random) {
          const double ior = within(random, 1, 4);
          return Sample{{{"ior", ior}, {"fresnel_view", within(random, 0, 1)}, {"base_roughness", 1}},
                        diffuseReflection(ior)};
        }}},
  };
  return kRows;
}

}  // namespace

std::optional<Truth> truthOf(const Subject& subject) {
  static std::mutex guard;
  static std::map<std::string, Truth> known;  // one for all bodies of a node
  const auto row = rows().find(subject.node);
  if (row == rows().end()) return std::nullopt;
  {
    const std::lock_guard lock(guard);
    if (const auto it = known.find(subject.node); it != known.end()) return it->second;
  }
  Truth truth{row->second.what, {}, kPoints, {}};
  std::mt19937_64 random(7);
  std::map<std::string, std::vector<double>> inputs;
  for (size_t i = 0; i < kPoints; ++i) {
    const Sample sample = row->second.draw(random);
    for (const SubjectInput& input : subject.inputs)
      inputs[input.name].insert(inputs[input.name].end(), static_cast<size_t>(input.components),
                                sample.inputs.at(input.name));
    truth.values.insert(truth.values.end(), 3, sample.value);
  }
  for (const SubjectInput& input : subject.inputs) {
    truth.columns["AT_" + input.name] =
        eval::Column::perPoint(input.components, std::move(inputs[input.name]));
  }
  const std::lock_guard lock(guard);
  known[subject.node] = truth;
  return truth;
}

}  // namespace lacquer::bench
