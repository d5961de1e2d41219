// The template bsdf as a path tracer uses it: what it samples comes with the density that it says, that
// density is there wherever there is light, and the light on both sides of the surface adds up.
//
// Every statistical test has fixed seeds, so that it holds or fails for good; the bound is the deviation that
// chance alone would pass once in thirty thousand tests.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "eval/evaluate.h"
#include "physics/subject.h"
#include "support/chi_squared.h"

namespace lacquer::physics::sampling_test {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// In standard deviations of a normal distribution, on both sides: chance passes it once in 31574 times.
constexpr double kSignificance = 4;

/// What the shader gives for one point.
struct Scattering {
  Vec3 f{};          ///< BSDF times the light's cosine
  Vec3 direction{};  ///< zero where the sample is lost
  double pdf = 0;    ///< of the point's light

  double mean() const { return (f[0] + f[1] + f[2]) / 3; }
  bool lost() const { return dot(direction, direction) == 0; }
};

/// A material under the template bsdf, with what its textures hold.
class Surface {
public:
  Surface(const std::string& body, const std::map<std::string, Vec4>& texels) : texels_(texels) {
    std::string textures, images;
    for (size_t i = 0; i < texels.size(); ++i) {
      textures += fmt::format(R"({}{{"source": {}}})", i == 0 ? "" : ", ", i);
      images += fmt::format(R"({}{{"uri": "{}.png"}})", i == 0 ? "" : ", ", i);
    }
    std::string text = R"({"asset": {"version": "2.0"}, "materials": [{"name": "M", )" + body + "}]";
    if (!texels.empty()) text += fmt::format(R"(, "textures": [{}], "images": [{}])", textures, images);
    Configuration setup;
    setup.template_name = "bsdf";
    subject_.emplace(text + "}", 0, texels, setup);
  }

  template <class T = double>
  std::vector<Scattering> operator()(std::span<const eval::Point> points) const {
    const ir::Module& module = subject_->module();
    eval::Bindings bindings;
    eval::bindPoints(module, points, bindings);
    for (const ir::TextureSlot& slot : module.textures) {
      const Vec4 texel = texels_.at(slot.pointer.substr(slot.pointer.rfind('/') + 1));
      bindings.textures[slot.name] = [texel](size_t, const Vec3&, double) { return texel; };
    }
    std::vector<ir::ValueId> roots;
    for (const ir::Output& output : module.outputs) {
      if (output.location == 0 || output.location == 2) roots.push_back(output.value);
    }
    std::vector<Scattering> result(points.size());
    const auto values = eval::evaluate<T>(module, roots, bindings, points.size());
    EXPECT_TRUE(values && roots.size() == 2);
    if (!values || roots.size() != 2) return result;
    const std::vector<T>& f = (*values)[0];
    const std::vector<T>& sample = (*values)[1];
    for (size_t i = 0; i < points.size(); ++i) {
      for (size_t c = 0; c < 3; ++c) {
        result[i].f[c] = static_cast<double>(f[4 * i + c]);
        result[i].direction[c] = static_cast<double>(sample[4 * i + c]);
      }
      result[i].pdf = static_cast<double>(sample[4 * i + 3]);
    }
    return result;
  }

  explicit operator bool() const { return subject_ && static_cast<bool>(*subject_); }

private:
  std::map<std::string, Vec4> texels_;
  std::optional<Subject> subject_;
};

struct Row {
  const char* name;
  std::string body;
  bool inside = false;
  double surrounding_ior = 1, channel = -1;
  std::map<std::string, Vec4> texels{};
};

std::string pbr(double metallic, double roughness, const std::string& extensions = "",
                const std::string& color = "[0.9, 0.6, 0.3, 1]") {
  return fmt::format(
      R"("pbrMetallicRoughness": {{"baseColorFactor": {}, "metallicFactor": {}, "roughnessFactor": {}}},
         "extensions": {{{}}})",
      color, metallic, roughness, extensions);
}

const std::string kClear = R"("KHR_materials_transmission": {"transmissionFactor": 0.8})";
const std::string kBody = kClear + R"(, "KHR_materials_volume": {"thicknessFactor": 1})";
const std::string kLeaf =
    R"("KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.4,
       "diffuseTransmissionColorFactor": [0.2, 0.9, 0.5]})";
const std::string kScatter =
    R"("KHR_materials_scatter": {"scatterStrengthFactor": 0.5, "scatterAnisotropy": 0.3,
       "multiscatterColorFactor": [0.5, 0.9, 0.8]})";
const std::string kGrooves =
    R"("KHR_materials_anisotropy": {"anisotropyStrength": 0.7, "anisotropyRotation": 0.6})";
const std::string kBack = R"("KHR_materials_retroreflection": {"retroreflectionFactor": 0.4})";
const std::string kHaze =
    R"("LACQUER_materials_specular_haze": {"specularHazeFactor": 0.4, "specularHazeSpread": 0.6})";
const std::string kFilm = R"("KHR_materials_iridescence": {"iridescenceFactor": 0.8})";
const std::string kCoat =
    R"("KHR_materials_coat": {"coatFactor": 0.9, "coatRoughnessFactor": 0.5, "coatColorFactor": [0.9, 0.7, 0.8],
       "coatAnisotropyStrength": 0.6})";
const std::string kDense = kBody + R"(, "KHR_materials_ior": {"ior": 1.8},
       "KHR_materials_dispersion": {"dispersion": 2})";

/// Each lobe by itself, and stacks of them. Lobes are wide enough for the quadrature's grid.
const std::vector<Row>& rows() {
  static const std::vector<Row> kRows = {
      {"plastic", pbr(0, 0.6)},
      {"metal", pbr(1, 0.7)},
      {"grooved metal", pbr(1, 0.8, kGrooves)},
      {"clear sheet", pbr(0, 0.7, kClear)},
      {"leaf", pbr(0, 0.6, kLeaf)},
      {"wax sheet", pbr(0, 0.7, kClear + ", " + kScatter)},
      {"retroreflector", pbr(0.5, 0.7, kBack)},
      {"haze", pbr(0.5, 0.5, kHaze)},
      {"grooved haze, both ways", pbr(1, 0.6, kHaze + ", " + kBack + ", " + kGrooves)},
      {"hazy sheet", pbr(0, 0.6, kHaze + ", " + kClear)},
      {"hazy body from inside", pbr(0, 0.7, kHaze + ", " + kBody), true},
      {"haze under a coat", pbr(1, 0.6, kHaze + ", " + kCoat)},
      {"grooved retroreflector", pbr(1, 0.8, kBack + ", " + kGrooves)},
      {"coat", pbr(0, 0.8, kCoat)},
      {"cloth",
       pbr(0, 0.8,
           R"("KHR_materials_sheen": {"sheenColorFactor": [0.9, 0.8, 0.6], "sheenRoughnessFactor": 0.5})")},
      {"fuzz over a coat", pbr(1, 0.8, R"("KHR_materials_fuzz": {"fuzzFactor": 0.7}, )" + kCoat)},
      {"body", pbr(0, 0.8, kBody)},
      {"body from inside", pbr(0, 0.8, kBody), true},
      {"dense body, blue", pbr(0, 0.8, kDense), false, 1, 2},
      {"dense body from inside, red", pbr(0, 0.8, kDense), true, 1.33, 0},
      {"air in glass", pbr(0, 0.8, kBody + R"(, "KHR_materials_ior": {"ior": 1})"), false, 1.5},
      {"bent normals",
       pbr(0.3, 0.7, kCoat.substr(0, kCoat.size() - 1) + R"(, "coatNormalTexture": {"index": 0}})") +
           R"(, "normalTexture": {"index": 1})",
       false,
       1,
       -1,
       {{"coatNormalTexture", {0.7, 0.5, 0.9, 1}}, {"normalTexture", {0.4, 0.75, 0.8, 1}}}},
      {"everything, thin",
       pbr(0.2, 0.7, kClear + ", " + kLeaf + ", " + kGrooves + ", " + kBack + ", " + kFilm + ", " + kCoat)},
      {"everything, a body",
       pbr(0.2, 0.8, kDense + ", " + kLeaf + ", " + kGrooves + ", " + kBack + ", " + kFilm + ", " + kCoat)},
      {"everything, from inside",
       pbr(0.2, 0.8, kDense + ", " + kLeaf + ", " + kGrooves + ", " + kBack + ", " + kFilm + ", " + kCoat),
       true},
  };
  return kRows;
}

/// A point of the row with a view; inside of a body the view is below the normal.
eval::Point pointOf(const Row& row, double cosine) {
  eval::Point point;
  point.v = tilted(row.inside ? -cosine : cosine, 0.4);
  point.inside = row.inside;
  point.surrounding_ior = row.surrounding_ior;
  point.channel = row.channel;
  return point;
}

/// The sphere in cells of equal area, each looked at in a finer grid.
constexpr size_t kRings = 24, kSectors = 36, kFine = 6;
constexpr size_t kCells = kRings * kSectors;

size_t cellOf(const Vec3& d) {
  const auto at = [](double x, size_t n) {
    return std::min(static_cast<size_t>(std::max(x, 0.0) * static_cast<double>(n)), n - 1);
  };
  return at((d[2] + 1) / 2, kRings) * kSectors + at(std::atan2(d[1], d[0]) / (2 * kPi) + 0.5, kSectors);
}

struct Quadrature {
  std::vector<double> pdf = std::vector<double>(kCells);  ///< over each cell
  double f = 0;                                           ///< over the sphere, the channels' mean
  double total() const { return std::accumulate(pdf.begin(), pdf.end(), 0.0); }
};

/// By the midpoint rule.
Quadrature integrate(const Surface& surface, const eval::Point& at) {
  constexpr size_t kHigh = kRings * kFine, kWide = kSectors * kFine;
  std::vector<eval::Point> points;
  points.reserve(kHigh * kWide);
  for (size_t i = 0; i < kHigh; ++i) {
    for (size_t k = 0; k < kWide; ++k) {
      const double z = -1 + 2 * (static_cast<double>(i) + 0.5) / kHigh;
      const double azimuth = 2 * kPi * ((static_cast<double>(k) + 0.5) / kWide - 0.5);
      points.push_back(at);
      points.back().l = tilted(z, azimuth);
    }
  }
  const std::vector<Scattering> values = surface(points);
  constexpr double kArea = 4 * kPi / (kHigh * kWide);
  Quadrature sum;
  for (size_t i = 0; i < values.size(); ++i) {
    sum.pdf[i / kWide / kFine * kSectors + i % kWide / kFine] += values[i].pdf * kArea;
    sum.f += values[i].mean() * kArea;
  }
  return sum;
}

std::vector<eval::Point> drawn(const eval::Point& at, size_t count, uint64_t seed) {
  Random random(seed);
  std::vector<eval::Point> points(count, at);
  for (eval::Point& point : points) point.random = {uniform(random), uniform(random), uniform(random)};
  return points;
}

TEST(Sampling, SamplesComeAsOftenAsTheirDensitySays) {
  constexpr size_t kCount = 1 << 16;
  uint64_t seed = 1;
  for (const Row& row : rows()) {
    const Surface surface(row.body, row.texels);
    ASSERT_TRUE(surface) << row.name;
    for (const double cosine : {0.9, 0.35}) {
      const eval::Point at = pointOf(row, cosine);
      const Quadrature exact = integrate(surface, at);
      std::vector<double> counts(kCells + 1), expected(kCells + 1);
      for (const Scattering& s : surface(drawn(at, kCount, ++seed)))
        counts[s.lost() ? kCells : cellOf(s.direction)] += 1;
      for (size_t i = 0; i < kCells; ++i) expected[i] = exact.pdf[i] * kCount;
      expected[kCells] = std::max(1 - exact.total(), 0.0) * kCount;
      EXPECT_LT(exact.total(), 1.001) << row.name << " " << cosine;
      const double off = test::goodnessOfFit(counts, expected);
      EXPECT_LT(off, kSignificance) << row.name << " " << cosine << ", integral " << exact.total()
                                    << ", lost " << counts[kCells] / kCount;
    }
  }
}

/// f / pdf over the samples has the mean that f has over the sphere.
TEST(Sampling, TheEstimateIsTheIntegral) {
  constexpr size_t kCount = 1 << 14;
  uint64_t seed = 1000;
  for (const Row& row : rows()) {
    const Surface surface(row.body, row.texels);
    ASSERT_TRUE(surface) << row.name;
    for (const double cosine : {0.9, 0.35, 0.05}) {
      const eval::Point at = pointOf(row, cosine);
      std::vector<eval::Point> points = drawn(at, kCount, ++seed);
      const std::vector<Scattering> samples = surface(points);
      for (size_t i = 0; i < kCount; ++i) points[i].l = samples[i].lost() ? at.v : samples[i].direction;
      const std::vector<Scattering> lit = surface(points);
      double sum = 0, squares = 0, most = 0;
      for (size_t i = 0; i < kCount; ++i) {
        if (samples[i].lost()) continue;
        EXPECT_GT(lit[i].pdf, 0) << row.name;
        const double weight = lit[i].mean() / lit[i].pdf;
        sum += weight;
        squares += weight * weight;
        most = std::max(most, weight);
      }
      const double mean = sum / kCount;
      const double error = std::sqrt((squares / kCount - mean * mean) / kCount);
      const double exact = integrate(surface, at).f;
      EXPECT_NEAR(mean, exact, kSignificance * error + 0.002 * exact) << row.name << " " << cosine;
      EXPECT_LT(most, 20) << row.name << " " << cosine;
      fmt::print("{:<32} {:.2f}: {:.4f} of {:.4f}, error of one sample {:.3f}, heaviest {:.2f}\n", row.name,
                 cosine, mean, exact, error * std::sqrt(kCount), most);
    }
  }
}

/// Of what comes in nothing is gained. A dielectric whose body scatters may pass 1 by what Schlick's Fresnel
/// at V.H gives back at grazing angles, which is the text's; what is mirrored or bent alone may not.
TEST(Sampling, NothingIsGained) {
  const std::string white = "[1, 1, 1, 1]";
  const std::string clear = R"("KHR_materials_transmission": {"transmissionFactor": 1})";
  const std::string body = clear + R"(, "KHR_materials_volume": {"thicknessFactor": 1})";
  const Row strict[] = {
      {"sheet", pbr(0, 0.7, clear, white)},
      {"body", pbr(0, 0.8, body, white)},
      {"body from inside", pbr(0, 0.8, body, white), true},
      {"half a metal", pbr(0.5, 0.8, body, white), true},
      {"diamond", pbr(0, 0.8, body + R"(, "KHR_materials_ior": {"ior": 2.4})", white)},
      {"diamond from inside", pbr(0, 0.8, body + R"(, "KHR_materials_ior": {"ior": 2.4})", white), true},
      {"weak reflection, from inside",
       pbr(0, 0.8, body + R"(, "KHR_materials_specular": {"specularFactor": 0.1})", white), true},
  };
  for (const Row& row : strict) {
    const Surface surface(row.body, row.texels);
    ASSERT_TRUE(surface) << row.name;
    for (const double cosine : {1.0, 0.7, 0.4, 0.2, 0.05}) {
      const double share = integrate(surface, pointOf(row, cosine)).f;
      EXPECT_LT(share, 1.001) << row.name << " " << cosine;
      EXPECT_GT(share, 0.5) << row.name << " " << cosine;
    }
  }
  for (const Row& row : rows()) {
    const Surface surface(row.body, row.texels);
    for (const double cosine : {1.0, 0.4, 0.1})
      EXPECT_LT(integrate(surface, pointOf(row, cosine)).f, 1.001) << row.name << " " << cosine;
  }
}

/// The refractive lobe as Walter et al. 2007 write it (equations 16, 21 and 34), times the light's cosine,
/// with Schlick's Fresnel on the side of the smaller index. `eta_V` and `eta_L` are the indices on the two
/// sides.
double walter(const Vec3& V, const Vec3& L, double eta_V, double eta_L, double alpha) {
  Vec3 h;
  for (size_t c = 0; c < 3; ++c) h[c] = -(eta_V * V[c] + eta_L * L[c]);
  h = normalized(h);
  const double n = V[2] > 0 ? 1 : -1;  // the normal on the view's side
  if (h[2] * n < 0)
    for (double& x : h) x = -x;
  const double VH = dot(V, h), LH = dot(L, h), NH = h[2] * n, NV = std::abs(V[2]), NL = std::abs(L[2]);
  if (VH <= 0 || LH >= 0 || V[2] * L[2] >= 0) return 0;
  const double tan2 = (1 - NH * NH) / (NH * NH);
  const double D = alpha * alpha / (kPi * std::pow(NH, 4) * std::pow(alpha * alpha + tan2, 2));
  const auto G1 = [&](double x) { return 2 / (1 + std::sqrt(1 + alpha * alpha * (1 - x * x) / (x * x))); };
  const double f0 = std::pow((eta_V - eta_L) / (eta_V + eta_L), 2);
  const double cosine = eta_V < eta_L ? VH : -LH;
  const double F = f0 + (1 - f0) * std::pow(1 - cosine, 5);
  const double both = eta_V * VH + eta_L * LH;
  return VH * -LH / (NV * NL) * eta_L * eta_L * (1 - F) * G1(NV) * G1(NL) * D / (both * both) * NL;
}

struct Pane {
  double ior, surrounding, roughness;
  Surface surface() const {
    return Surface(pbr(0, roughness,
                       fmt::format(R"("KHR_materials_transmission": {{"transmissionFactor": 1}},
                                      "KHR_materials_volume": {{"thicknessFactor": 1}},
                                      "KHR_materials_ior": {{"ior": {}}})",
                                   ior),
                       "[1, 1, 1, 1]"),
                   {});
  }
};

constexpr Pane kPanes[] = {{1.5, 1, 0.5}, {2.4, 1, 0.9}, {1.1, 1, 0.3}, {1.2, 1.7, 0.6}};

TEST(Sampling, BentLightIsThatOfWalter) {
  Random random(3);
  for (const Pane& pane : kPanes) {
    const Surface surface = pane.surface();
    ASSERT_TRUE(surface);
    std::vector<eval::Point> points(2000);
    for (eval::Point& point : points) {
      point.inside = uniform(random) < 0.5;
      point.surrounding_ior = pane.surrounding;
      const double side = point.inside ? -1 : 1;
      point.v = tilted(side * uniform(random, 0.01, 1), uniform(random, 0, 6));
      point.l = tilted(-side * uniform(random, 0.01, 1), uniform(random, 0, 6));
    }
    const std::vector<Scattering> values = surface(points);
    int lit = 0;
    for (size_t i = 0; i < points.size(); ++i) {
      const double near = points[i].inside ? pane.ior : pane.surrounding;
      const double far = points[i].inside ? pane.surrounding : pane.ior;
      const double expected = walter(points[i].v, points[i].l, near, far, std::pow(pane.roughness, 2));
      EXPECT_NEAR(values[i].f[1], expected, 1e-9 * (1 + expected)) << pane.ior << " " << pane.surrounding;
      lit += expected > 0;
    }
    EXPECT_GT(lit, 50);
  }
}

/// Both ways, over the square of the index on the light's side; on one side as it is.
TEST(Sampling, BentLightIsReciprocal) {
  Random random(4);
  for (const Pane& pane : kPanes) {
    const Surface surface = pane.surface();
    ASSERT_TRUE(surface);
    std::vector<eval::Point> forth(1000), back(1000);
    for (size_t i = 0; i < forth.size(); ++i) {
      forth[i].surrounding_ior = back[i].surrounding_ior = pane.surrounding;
      forth[i].v = back[i].l = tilted(uniform(random, 0.05, 1), uniform(random, 0, 6));
      forth[i].l = back[i].v = tilted(uniform(random, -1, 1), uniform(random, 0, 6));
      back[i].inside = back[i].v[2] < 0;
      if (i % 4 != 0) continue;
      // Both inside.
      forth[i].v[2] = back[i].l[2] = -forth[i].v[2];
      forth[i].l[2] = back[i].v[2] = -std::abs(back[i].v[2]);
      forth[i].inside = back[i].inside = true;
    }
    const std::vector<Scattering> a = surface(forth), b = surface(back);
    const auto index2 = [&](double side) { return std::pow(side < 0 ? pane.ior : pane.surrounding, 2); };
    int lit = 0;
    for (size_t i = 0; i < a.size(); ++i) {
      const Vec3 V = forth[i].v, L = forth[i].l;
      const double one = a[i].f[0] / (std::abs(L[2]) * index2(L[2]));
      const double other = b[i].f[0] / (std::abs(V[2]) * index2(V[2]));
      EXPECT_NEAR(one, other, 1e-9 * (1 + one)) << pane.ior << " " << V[2] << " " << L[2];
      lit += V[2] * L[2] < 0 && one > 0;
    }
    EXPECT_GT(lit, 10);
  }
}

/// Beyond the critical angle a body's boundary is a perfect mirror, however weak its reflection is said to
/// be: as bright as a white metal.
TEST(Sampling, NothingLeavesBeyondTheCriticalAngle) {
  const std::string weak = kBody + R"(, "KHR_materials_specular": {"specularFactor": 0.1}, )" + kFilm;
  const Surface body(pbr(0, 0.5, weak, "[0, 0, 0, 1]"), {}), metal(pbr(1, 0.5, "", "[1, 1, 1, 1]"), {});
  ASSERT_TRUE(body && metal);
  std::vector<eval::Point> inside(2), outside(2);
  const double cosines[] = {0.7, 0.8};  // the critical angle's is 0.745
  for (size_t i = 0; i < 2; ++i) {
    inside[i].inside = true;
    inside[i].v = tilted(-cosines[i]);
    inside[i].l = tilted(-cosines[i], kPi);
    outside[i].v = tilted(cosines[i]);
    outside[i].l = tilted(cosines[i], kPi);
  }
  const std::vector<Scattering> in = body(inside), out = metal(outside);
  EXPECT_NEAR(in[0].f[0], out[0].f[0], 1e-9 * out[0].f[0]);
  EXPECT_LT(in[1].f[0], 0.9 * out[1].f[0]);
}

/// A number of a list, or between 0 and 1.
double edgy(Random& random, std::initializer_list<double> edges) {
  const double choice = uniform(random, 0, 2 * static_cast<double>(edges.size()));
  const auto index = static_cast<size_t>(choice);
  return index < edges.size() ? edges.begin()[index] : uniform(random);
}

std::string edgyMaterial(Random& random) {
  const auto factor = [&] { return edgy(random, {0, 1}); };
  std::string list;
  const auto add = [&](double chance, const std::string& text) {
    if (uniform(random) < chance) list += (list.empty() ? "" : ", ") + text;
  };
  add(1, fmt::format(R"("KHR_materials_ior": {{"ior": {}}})",
                     edgy(random, {0, 1, 1.0001, 1.5, 1e6}) == 0 ? 0 : 1 + factor()));
  if (uniform(random) < 0.7) {
    add(1, fmt::format(R"("KHR_materials_transmission": {{"transmissionFactor": {}}})", factor()));
    add(0.6, R"("KHR_materials_volume": {"thicknessFactor": 1})");
    add(0.3,
        fmt::format(R"("KHR_materials_scatter": {{"scatterStrengthFactor": {}, "scatterAnisotropy": {}}})",
                    factor(), edgy(random, {-1, 1})));
  } else {
    add(1, fmt::format(R"("KHR_materials_diffuse_transmission": {{"diffuseTransmissionFactor": {}}})",
                       factor()));
  }
  add(0.3, fmt::format(R"("KHR_materials_dispersion": {{"dispersion": {}}})", 100 * factor()));
  add(0.3, fmt::format(R"("KHR_materials_specular": {{"specularFactor": {}}})", factor()));
  add(0.3, fmt::format(R"("KHR_materials_anisotropy": {{"anisotropyStrength": {}}})", factor()));
  add(0.3, fmt::format(R"("KHR_materials_retroreflection": {{"retroreflectionFactor": {}}})", factor()));
  add(0.3, fmt::format(
               R"("LACQUER_materials_specular_haze": {{"specularHazeFactor": {}, "specularHazeSpread": {}}})",
               factor(), factor()));
  add(0.3, fmt::format(R"("KHR_materials_iridescence": {{"iridescenceFactor": {}}})", factor()));
  add(0.4,
      fmt::format(R"("KHR_materials_coat": {{"coatFactor": {}, "coatRoughnessFactor": {}, "coatIor": {},
                          "coatAnisotropyStrength": {}, "coatColorFactor": [{}, 1, 0.5]}})",
                  factor(), factor(), edgy(random, {0, 1.5}) == 0 ? 0 : 1 + factor(), factor(), factor()));
  return pbr(factor(), factor(), list, fmt::format("[{}, {}, {}, 1]", factor(), factor(), factor()));
}

eval::Point edgyPoint(Random& random) {
  const auto direction = [&] {
    return tilted(edgy(random, {-1, 1, 0, 1e-7, -1e-7, 1e-3}) * (uniform(random) < 0.5 ? -1 : 1),
                  uniform(random, 0, 7));
  };
  eval::Point point;
  point.v = direction();
  point.l = direction();
  const double choice = uniform(random);
  for (size_t c = 0; c < 3; ++c) {
    if (choice < 0.1) point.l[c] = -point.v[c];
    if (choice > 0.9) point.l[c] = (c == 2 ? 1 : -1) * point.v[c];
    point.random[c] = edgy(random, {0, 1 - 0x1p-24});
  }
  point.inside = uniform(random) < 0.5;
  point.channel = edgy(random, {-1, 0, 1, 2});
  point.surrounding_ior = edgy(random, {1, 1.5, 0}) + 1;
  return point;
}

template <class T>
void expectFinite(const Surface& surface, std::span<const eval::Point> points, const std::string& what) {
  const std::vector<Scattering> values = surface.operator()<T>(points);
  for (size_t i = 0; i < values.size(); ++i) {
    const Scattering& s = values[i];
    const double length = std::sqrt(dot(s.direction, s.direction));
    const bool good = std::isfinite(s.f[0] + s.f[1] + s.f[2] + s.pdf) && s.pdf >= 0 &&
                      std::min({s.f[0], s.f[1], s.f[2]}) >= 0 && (length == 0 || std::abs(length - 1) < 1e-5);
    EXPECT_TRUE(good) << what << (sizeof(T) == 4 ? " float" : " double") << " f " << s.f[0] << " pdf "
                      << s.pdf << " length " << length << " v.z " << points[i].v[2] << " l.z "
                      << points[i].l[2];
    if (!good) return;
  }
}

TEST(Sampling, EverythingIsFiniteAtTheEdges) {
  Random random(17);
  for (int k = 0; k < 80; ++k) {
    const std::string body = edgyMaterial(random);
    const Surface surface(body, {});
    ASSERT_TRUE(surface) << body;
    std::vector<eval::Point> points;
    for (int i = 0; i < 512; ++i) points.push_back(edgyPoint(random));
    expectFinite<double>(surface, points, body);
    expectFinite<float>(surface, points, body);
  }
}

/// No lobe that has light is left out, and none is tried so rarely that a sample of it weighs a lot.
TEST(Sampling, LightIsTriedWhereverItIs) {
  Random random(18);
  double heaviest = 0;
  for (int k = 0; k < 120; ++k) {
    const std::string body = edgyMaterial(random);
    const Surface surface(body, {});
    ASSERT_TRUE(surface) << body;
    std::vector<eval::Point> points;
    for (int i = 0; i < 512; ++i) {
      points.push_back(edgyPoint(random));
      points.back().v = tilted((points.back().inside ? -1 : 1) * uniform(random, 0.05, 1), 0.4);
      // A surface that bounds no body has its normal on the side of the eye.
      if (body.find("KHR_materials_volume") == std::string::npos)
        points.back().v[2] = std::abs(points.back().v[2]);
    }
    const std::vector<Scattering> values = surface(points);
    for (size_t i = 0; i < values.size(); ++i) {
      if (values[i].mean() <= 0) continue;
      ASSERT_GT(values[i].pdf, 0) << body << points[i].v[2] << " " << points[i].l[2];
      heaviest = std::max(heaviest, values[i].mean() / values[i].pdf);
      ASSERT_LT(values[i].mean() / values[i].pdf, 50) << body << points[i].v[2] << " " << points[i].l[2];
    }
  }
  fmt::print("the heaviest sample {:.1f}\n", heaviest);
}

}  // namespace
}  // namespace lacquer::physics::sampling_test
