// Energy and reciprocity of whole materials, by quadrature in double.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "stress/attack.h"
#include "stress/directions.h"

namespace lacquer::stress {

namespace {

/// Directions for the diffuse part and for each lobe.
constexpr size_t kDirections = 1600;
/// Of ALPHA_MIN in nodes/: what a smaller roughness comes to.
constexpr double kLeastAlpha = 0.001;
/// What the quadrature itself may be off.
constexpr double kTolerance = 0.005;
constexpr double kReciprocal = 1e-5;  ///< relative; the preshader's fields are floats
constexpr size_t kMaterials = 4;
constexpr double kCosines[] = {1, 0.5, 0.2, 0.05};

class Light {
public:
  explicit Light(const Subject& subject) : subject_(subject), width_(subject.space.width()) {}

  bool has(std::string_view name) const { return subject_.space.find(name) != nullptr; }

  bool layered() const {
    return std::any_of(subject_.layers.begin(), subject_.layers.end(),
                       [&](const auto& layer) { return has(layer.first); });
  }

  void set(std::vector<double>& sample, const char* name, const std::vector<double>& values) const {
    const Variable* variable = subject_.space.find(name);
    if (variable == nullptr) return;
    std::copy(values.begin(), values.end(), sample.begin() + static_cast<ptrdiff_t>(variable->first));
  }

  /// Without any layer over the base.
  void strip(std::vector<double>& sample) const {
    for (const auto& [name, values] : subject_.layers) set(sample, name.c_str(), values);
  }

  double number(const std::vector<double>& sample, const char* name, double absent) const {
    const Variable* variable = subject_.space.find(name);
    return variable == nullptr ? absent : sample[variable->first];
  }

  /// A material of the space in its own light: flat maps, no emission, no environment.
  std::vector<double> material(uint64_t seed) const {
    std::vector<double> sample(width_);
    subject_.space.draw(seed, sample);
    for (const Variable& variable : subject_.space.variables()) {
      const auto begin = sample.begin() + static_cast<ptrdiff_t>(variable.first);
      const auto ends = [&](std::string_view end) { return variable.name.ends_with(end); };
      const bool environment = variable.name.starts_with("environment");
      if (variable.nature == Nature::Texel) std::fill_n(begin, variable.components, 1.0);
      if (variable.nature == Nature::Texel && ends("normal_texture")) *begin = *(begin + 1) = 0.5;
      if (environment || variable.name.starts_with("emissive")) std::fill_n(begin, variable.components, 0.0);
      // A stretched lobe is stretched along x, and the view comes from anywhere.
      if (ends("anisotropy_texture")) *(begin + 1) = 0.5;
      if (ends("anisotropy_rotation")) *begin = 0;
      // What makes the sum too bright is found where all else is bright.
      if (variable.name == "base_color_factor" || ends("color0"))
        std::fill_n(begin, variable.components, 1.0);
    }
    set(sample, "n", {0, 0, 1});
    set(sample, "t", {1, 0, 0});
    set(sample, "n_length", {1});
    set(sample, "t_length", {1});
    set(sample, "interpolated", {1});
    set(sample, "front_facing", {1});
    set(sample, "light", {1, 1, 1});
    return sample;
  }

  /// Red of each pair of directions; what does not come from the light, seen from there, is taken away.
  std::vector<double> colors(const std::vector<double>& material,
                             const std::vector<std::array<Vec3, 2>>& pairs) const {
    const std::vector<double> lit = reds(material, pairs, {1, 1, 1});
    std::vector<double> result = reds(material, pairs, {0, 0, 0});
    for (size_t i = 0; i < pairs.size(); ++i) result[i] = lit[i] - result[i];
    return result;
  }

  /// What a white sky's light comes to, seen along `v`.
  double furnace(const std::vector<double>& material, const Vec3& v) const {
    const std::vector<Direction> from = directions(v, lobes(material), kDirections);
    std::vector<std::array<Vec3, 2>> pairs;
    for (const Direction& direction : from) pairs.push_back({v, direction.l});
    const std::vector<double> reflected = colors(material, pairs);
    double sum = 0;
    for (size_t i = 0; i < reflected.size(); ++i) sum += reflected[i] * from[i].weight;
    return sum;
  }

  /// The largest relative difference of the BSDF when light and eye are exchanged.
  double asymmetry(const std::vector<double>& material, Random& random) const {
    std::vector<std::array<Vec3, 2>> pairs;
    const auto above = [&] {
      const double z = 0.02 + 0.98 * random.unit();
      const double angle = 2 * std::numbers::pi * random.unit();
      const double ring = std::sqrt(1 - z * z);
      return Vec3{ring * std::cos(angle), ring * std::sin(angle), z};
    };
    for (int i = 0; i < 128; ++i) {
      const Vec3 v = above();
      const Vec3 l = above();
      pairs.push_back({v, l});
      pairs.push_back({l, v});
    }
    const std::vector<double> values = colors(material, pairs);
    double worst = 0;
    for (size_t i = 0; i < values.size(); i += 2) {
      const double forth = values[i] / pairs[i][1][2];
      const double back = values[i + 1] / pairs[i + 1][1][2];
      worst = std::max(worst, std::abs(forth - back) / (1e-3 + std::max(forth, back)));
    }
    return worst;
  }

  /// Why so much beyond the bound is none of ours; empty when nothing is known of it.
  std::string_view known(double surplus) const {
    for (const KnownSurplus& one : knownSurpluses()) {
      if (has(one.parameter) && surplus <= one.most) return one.why;
    }
    return {};
  }

private:
  std::vector<double> reds(const std::vector<double>& material, const std::vector<std::array<Vec3, 2>>& pairs,
                           const std::vector<double>& light) const {
    std::vector<double> samples;
    samples.reserve(pairs.size() * width_);
    for (const auto& [v, l] : pairs) {
      std::vector<double> sample = material;
      set(sample, "v", {v[0], v[1], v[2]});
      set(sample, "l", {l[0], l[1], l[2]});
      set(sample, "light", light);
      samples.insert(samples.end(), sample.begin(), sample.end());
    }
    const Values values = subject_.evaluate(Arithmetic::Double, samples, pairs.size());
    std::vector<double> result(pairs.size());
    for (size_t i = 0; i < pairs.size(); ++i) result[i] = values[0][4 * i];
    return result;
  }

  /// Of the base and what lies over it: every roughness has one, stretched where there is a strength of the
  /// same name. A lobe that is not quite the material's own costs accuracy alone.
  std::vector<Lobe> lobes(const std::vector<double>& material) const {
    const auto alpha = [](double roughness) { return std::max(roughness * roughness, kLeastAlpha); };
    std::vector<Lobe> lobes;
    constexpr std::string_view kRoughness = "roughness_factor";
    for (const Variable& variable : subject_.space.variables()) {
      if (!variable.name.ends_with(kRoughness)) continue;
      const std::string layer = variable.name.substr(0, variable.name.size() - kRoughness.size());
      const double across = alpha(material[variable.first]);
      const double strength = number(material, (layer + "anisotropy_strength").c_str(), 0);
      lobes.push_back({across + (1 - across) * strength * strength, across});
      // The base's haze stands about its lobe.
      if (!layer.empty() || !has("specular_haze_factor")) continue;
      const double core = material[variable.first];
      const double wide = alpha(core + number(material, "specular_haze_spread", 0.3) * (1 - core));
      lobes.push_back({wide + (1 - wide) * strength * strength, wide});
    }
    if (!has("retroreflection_factor")) return lobes;
    // What is sent back stands about the view as the lobes stand about its mirror direction.
    std::vector<Lobe> both = lobes;
    for (Lobe& lobe : lobes) lobe.back = true;
    both.insert(both.end(), lobes.begin(), lobes.end());
    return both;
  }

  const Subject& subject_;
  size_t width_;
};

}  // namespace

void measureLight(const Subject& subject, const Plan& plan, Report& report) {
  const Light light(subject);
  StressEnergy& energy = report.energy.emplace();
  const auto tell = [&](Fault fault, const char* what, double value, const std::vector<double>& input,
                        std::string_view known = {}) {
    for (const Finding& finding : report.findings) {
      if (finding.fault == fault && (finding.known.empty() || !known.empty())) return;
    }
    report.findings.push_back({fault, what, 1, value, input, std::string(known)});
  };
  const bool layered = light.layered();
  for (size_t k = 0; k < kMaterials; ++k) {
    const uint64_t seed = mixed(mixed(plan.seed, subject.name), ~k);
    const std::vector<double> whole = light.material(seed);
    std::vector<double> base = whole;
    light.strip(base);
    const double azimuth = 2 * std::numbers::pi * Random(seed).unit();
    const auto view = [&](double cosine) {
      const double sine = std::sqrt(1 - cosine * cosine);
      return Vec3{sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
    };
    for (const double cosine : kCosines) {
      const Vec3 v = view(cosine);
      const double of_base = light.furnace(base, v);
      const double all = layered ? light.furnace(whole, v) : of_base;
      energy.largest = std::max(energy.largest, all);
      energy.largest_base = std::max(energy.largest_base, of_base);
      // A layer takes from the base what it reflects, so that it can only come nearer to 1. The base gains
      // where the text's Lambert under 1 - F(V.H) does.
      std::vector<double> at = whole;
      light.set(at, "v", {v[0], v[1], v[2]});
      const double bound = std::max(1.0, of_base) + kTolerance;
      if (!(all <= bound)) tell(Fault::Energy, "layers", all, at, light.known(all - bound));
    }
    if (light.has("metallic_factor")) {
      // Metal alone has nothing to gain from: one bounce of a perfect mirror at most.
      light.set(base, "metallic_factor", {1});
      for (const double cosine : kCosines) {
        const Vec3 v = view(cosine);
        const double metal = light.furnace(base, v);
        light.set(base, "v", {v[0], v[1], v[2]});
        if (!(metal <= 1 + kTolerance)) tell(Fault::Energy, "metal", metal, base);
      }
    }
    Random random(seed);
    const double of_base = light.asymmetry(base, random);
    if (!(of_base <= kReciprocal)) tell(Fault::Reciprocity, "base", of_base, base, knownAsymmetry(subject));
    energy.asymmetry = std::max(energy.asymmetry, layered ? light.asymmetry(whole, random) : of_base);
  }
}

}  // namespace lacquer::stress
