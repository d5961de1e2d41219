#include "accuracy/antialiasing.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "accuracy/normal_maps.h"
#include "eval/evaluate.h"
#include "eval/points.h"
#include "lower/lower.h"
#include "support/materials.h"

namespace lacquer::accuracy {

namespace {

using Vec3 = std::array<double, 3>;

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3 unit(const Vec3& v) {
  const double length = std::sqrt(dot(v, v));
  return {v[0] / length, v[1] / length, v[2] / length};
}

constexpr double kFrequency = 25;  ///< of the bumps, on a ball of radius 1
constexpr double kSlope = 0.3;     ///< of each of the three waves that they are
constexpr int kAcross = 8;         ///< samples of the yardstick, along each side of a pixel
constexpr int kMappedRadius = 40;  ///< in pixels
constexpr double kMost = 3000;     ///< pixels of a ball that are looked at
constexpr size_t kAtOnce = 4096;   ///< places that are drawn together: more would not stay in the caches

/// A place of a smooth ball, seen from far away along z.
eval::Point placeAt(double x, double y) {
  const Vec3 ball{x, y, std::sqrt(std::max(0.0, 1 - x * x - y * y))};
  const Vec3 t = unit({ball[2], 0, -ball[0]});
  eval::Point point;
  point.n = ball;
  point.t = {t[0], t[1], t[2], 1};
  point.l = unit({0.4, 0.5, 0.8});
  point.light = {3, 3, 3};
  point.position = ball;
  return point;
}

Vec3 bumpy(const Vec3& ball) {
  const Vec3 wave{kSlope * std::cos(kFrequency * ball[0]), kSlope * std::cos(kFrequency * ball[1]),
                  kSlope * std::cos(kFrequency * ball[2])};
  const double along = dot(wave, ball);
  return unit({ball[0] - wave[0] + along * ball[0], ball[1] - wave[1] + along * ball[1],
               ball[2] - wave[2] + along * ball[2]});
}

/// The normal where a map has a texel.
Vec3 bent(const eval::Point& place, const Vec3& texel) {
  const Vec3& n = place.n;
  const Vec3 t{place.t[0], place.t[1], place.t[2]};
  const Vec3 b{n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0]};
  Vec3 sum{};
  for (size_t c = 0; c < 3; ++c)
    sum[c] = (2 * texel[0] - 1) * t[c] + (2 * texel[1] - 1) * b[c] + (2 * texel[2] - 1) * n[c];
  return unit(sum);
}

/// Points in fours, and the map that is read there.
struct Points {
  std::vector<eval::Point> points;
  const NormalMap* map = nullptr;  ///< null for one that is flat
  double lod = 0;                  ///< of what is read by derivatives
};

class Drawn {
public:
  Drawn(const Bumpy& material, Way way) {
    static const lang::Library kLibrary = lang::Library::embedded();
    const Result<material::Document> document = test::materialsOf(material.gltf, "bumpy.gltf");
    EXPECT_TRUE(document);
    if (!document) return;
    test::BuildSetup setup;
    setup.ibl = false;
    setup.switches["specular_antialiasing"] = way != Way::Without;
    setup.switches["pixel_lobes"] = way == Way::Lobes;
    Diagnostics warnings;
    const graph::Graph graph =
        test::buildGraph(document->materials.at(0), {true, true, false, {true}}, setup, warnings);
    Result<ir::Module> module = lower::lower(graph, kLibrary, {.evaluable = true});
    EXPECT_TRUE(module);
    if (module) module_ = std::move(*module);
  }

  /// Green of each point.
  std::vector<double> at(const Points& drawn) const { return greenOf(bound(drawn), drawn.points.size()); }

  /// The same at other roughnesses than the material's, one after the other.
  std::vector<std::vector<double>> at(const Points& drawn, const std::string& rough,
                                      const std::vector<double>& roughnesses) const {
    eval::Bindings bindings = bound(drawn);
    std::vector<std::vector<double>> all;
    for (const double roughness : roughnesses) {
      bindings.columns[rough] = eval::Column::constant({roughness});
      all.push_back(greenOf(bindings, drawn.points.size()));
    }
    return all;
  }

private:
  eval::Bindings bound(const Points& drawn) const {
    eval::Bindings bindings;
    eval::bindPoints(module_, drawn.points, bindings);
    bindings.quads = true;
    for (const ir::TextureSlot& slot : module_.textures) {
      eval::Sampler& sampler = bindings.textures[slot.name];
      sampler = eval::Sampler([&drawn](size_t, const Vec3& uv, double lod) {
        if (drawn.map == nullptr) return std::array<double, 4>{0.5, 0.5, 1, 1};
        const Vec3 texel = drawn.map->at(uv[0], uv[1], lod + drawn.lod);
        return std::array<double, 4>{texel[0], texel[1], texel[2], 1};
      });
      sampler.size = {NormalMap::kSize, NormalMap::kSize, 1};
    }
    return bindings;
  }

  std::vector<double> greenOf(const eval::Bindings& bindings, size_t count) const {
    std::vector<double> result(count, std::nan(""));
    for (const ir::Output& output : module_.outputs) {
      if (output.kind != ir::OutputKind::Color) continue;
      const auto values = eval::evaluate<double>(module_, {{output.value}}, bindings, count);
      EXPECT_TRUE(values) << (values ? "" : format(values.error()[0]));
      for (size_t i = 0; values && i < count; ++i) result[i] = (*values)[0][4 * i + 1];
    }
    return result;
  }

  ir::Module module_;
};

double shown(double radiance) { return radiance / (1 + radiance); }

/// A ball in pixels.
struct Ball {
  int radius = 0;
  const NormalMap* map = nullptr;
  double texels = 1;  ///< of the map, to a pixel

  eval::Point at(double x, double y) const {
    eval::Point point = placeAt(x / radius, y / radius);
    if (map == nullptr) point.n = bumpy(point.n);
    point.uv.fill({x * texels / NormalMap::kSize, y * texels / NormalMap::kSize});
    return point;
  }
};

/// What is drawn of a ball: quads of pixels, the radiance of 64 places in each pixel, in the mean, and the
/// mean of their normals.
struct Seen {
  Points quads, means;
  std::vector<double> exact;
};

/// Draws the places that are there, and empties them.
void drawFine(const Drawn& off, Points& fine, Seen& all) {
  const std::vector<double> radiance = off.at(fine);
  for (size_t i = 0; i < radiance.size(); i += kAcross * kAcross) {
    double sum = 0;
    for (size_t s = 0; s < kAcross * kAcross; ++s) sum += radiance[i + s];
    all.exact.push_back(sum / (kAcross * kAcross));
  }
  fine.points.clear();
}

Seen seen(const Ball& ball, const Drawn& off) {
  Seen all;
  Points fine;
  all.quads.map = fine.map = ball.map;
  all.quads.lod = std::log2(std::max(1.0, ball.texels));
  const int every = static_cast<int>(std::ceil(3.14 * ball.radius * ball.radius / kMost));
  for (int y = -ball.radius; y < ball.radius; y += 2) {
    for (int x = -ball.radius; x < ball.radius; x += 2) {
      // The whole quad lies on the ball, where its slope is at most 3.
      const double far = std::hypot(std::max(x + 2, -x), std::max(y + 2, -y));
      if (far > 0.95 * ball.radius || (x / 2 + 7 * (y / 2)) % every != 0) continue;
      for (int i = 0; i < 4; ++i) {
        const double left = x + i % 2;
        const double top = y + i / 2;
        Vec3 sum{};
        for (int s = 0; s < kAcross * kAcross; ++s) {
          const eval::Point& place = fine.points.emplace_back(
              ball.at(left + (s % kAcross + 0.5) / kAcross, top + (s / kAcross + 0.5) / kAcross));
          const Vec3 normal =
              ball.map == nullptr ? place.n : bent(place, ball.map->at(place.uv[0][0], place.uv[0][1], 0));
          for (size_t c = 0; c < 3; ++c) sum[c] += normal[c];
        }
        eval::Point& mean = all.means.points.emplace_back(ball.at(left + 0.5, top + 0.5));
        all.quads.points.push_back(mean);
        mean.n = unit(sum);
      }
      if (fine.points.size() >= kAtOnce) drawFine(off, fine, all);
    }
  }
  if (!fine.points.empty()) drawFine(off, fine, all);
  return all;
}

}  // namespace

std::vector<Bumpy> bumpyMaterials() {
  const auto gltf = [](double metallic, double roughness, const std::string& rest) {
    return fmt::format(
        R"({{"asset": {{"version": "2.0"}}, "images": [{{"uri": "absent.png"}}], "textures": [{{"source": 0}}],
           "materials": [{{"pbrMetallicRoughness": {{
           "baseColorFactor": [0.8, 0.6, 0.4, 1], "metallicFactor": {}, "roughnessFactor": {}}}{}}}]}})",
        metallic, roughness, rest);
  };
  const std::string map = R"(, "normalTexture": {"index": 0})";
  const std::string coat = R"(, "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1,
    "clearcoatRoughnessFactor": 0.15}})";
  const std::string mapped_coat = R"(, "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1,
    "clearcoatRoughnessFactor": 0.15, "clearcoatNormalTexture": {"index": 0}}})";
  const std::string grooves = R"(, "extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 0.6}})";
  return {
      {"dielectric, roughness 0.3", gltf(0, 0.3, "")},
      {"metal, 0.2", gltf(1, 0.2, "")},
      {"coat, 0.15, over a metal, 0.5", gltf(1, 0.5, coat), "clearcoat_roughness_factor"},
      {"anisotropic metal, 0.3, strength 0.6", gltf(1, 0.3, grooves)},
      {"mapped dielectric, 0.3", gltf(0, 0.3, map), "roughness_factor", true},
      {"mapped metal, 0.2", gltf(1, 0.2, map), "roughness_factor", true},
      {"mapped metal, 0.4", gltf(1, 0.4, map), "roughness_factor", true},
      {"mapped coat, 0.15, over a metal, 0.5", gltf(1, 0.5, map + mapped_coat), "clearcoat_roughness_factor",
       true},
      {"mapped anisotropic metal, 0.3, strength 0.6", gltf(1, 0.3, map + grooves), "roughness_factor", true},
  };
}

namespace {

Aliasing measured(const Bumpy& material, double distance) {
  const Drawn off(material, Way::Without);
  const Drawn on(material, Way::With);
  const Drawn lobes(material, Way::Lobes);
  std::vector<Ball> balls;
  if (material.mapped) {
    for (const Relief relief : kReliefs) balls.push_back({kMappedRadius, &NormalMap::of(relief), distance});
  } else {
    const double wave = 2 * 3.14159265358979323846 / kFrequency;
    balls.push_back({static_cast<int>(std::lround(distance / wave))});
  }
  Aliasing sum;
  size_t count = 0;
  for (const Ball& ball : balls) {
    const Seen all = seen(ball, off);
    const std::vector<double> without = off.at(all.quads);
    const std::vector<double> with = on.at(all.quads);
    Points by_footprint = all.quads;
    by_footprint.lod = 0;
    const std::vector<double> spread = lobes.at(material.mapped ? by_footprint : all.quads);
    std::vector<double> roughnesses;
    for (double roughness = 0.1; roughness < 1; roughness *= 1.08) roughnesses.push_back(roughness);
    const std::vector<std::vector<double>> wider = off.at(all.means, material.roughness, roughnesses);
    for (size_t i = 0; i < with.size(); ++i) {
      const double right = shown(all.exact[i]);
      const auto error = [&](double radiance) { return std::pow(shown(radiance) - right, 2); };
      double best = error(wider[0][i]);
      for (const std::vector<double>& width : wider) best = std::min(best, error(width[i]));
      sum.without += error(without[i]);
      sum.with += error(with[i]);
      sum.lobes += error(spread[i]);
      sum.best += best;
    }
    count += with.size();
  }
  for (double* error : {&sum.without, &sum.with, &sum.lobes, &sum.best})
    *error = std::sqrt(*error / static_cast<double>(count));
  return sum;
}

}  // namespace

const Aliasing& aliasing(const Bumpy& material, double distance) {
  static std::map<std::pair<std::string, double>, Aliasing> known;
  const auto [at, is_new] = known.try_emplace({material.name, distance});
  if (is_new) at->second = measured(material, distance);
  return at->second;
}

std::array<double, 2> flatBrightness(const Bumpy& material, Way way) {
  Points points;
  for (double x = -0.9; x < 0.9; x += 0.05) {
    for (int i = 0; i < 4; ++i) {
      // Through the highlight.
      eval::Point& point = points.points.emplace_back(placeAt(x, 0.3 * x + 0.2));
      point.uv.fill({0.01 * (i % 2), 0.01 * (i / 2)});
    }
  }
  // As eight bits have it, leaning to both sides: the least and the greatest that is missing from its length.
  std::array<double, 2> range = {1e9, 0};
  for (const Relief relief : kReliefs) {
    const NormalMap flat(NormalMap::of(relief).at(0.3, 0.7, 0));
    points.map = &flat;
    const std::vector<double> off = Drawn(material, Way::Without).at(points);
    const std::vector<double> on = Drawn(material, way).at(points);
    for (size_t i = 0; i < off.size(); ++i) {
      if (off[i] <= 0) continue;
      range[0] = std::min(range[0], on[i] / off[i]);
      range[1] = std::max(range[1], on[i] / off[i]);
    }
  }
  return range;
}

std::string antialiasingTable() {
  std::string text =
      "| ball | distance | error without | with | of it | with lobes | of it | best alpha |\n"
      "|---|---|---|---|---|---|---|---|\n";
  for (const Bumpy& material : bumpyMaterials()) {
    for (const double distance : distancesOf(material)) {
      const Aliasing& errors = aliasing(material, distance);
      const auto part = [&](double error) { return fmt::format("{:.0f} %", 100 * error / errors.without); };
      text += fmt::format("| {} | {} | {:.4f} | {:.4f} | {} |", material.name, distance, errors.without,
                          errors.with, part(errors.with));
      text += fmt::format(" {:.4f} | {} |", errors.lobes, part(errors.lobes));
      text += fmt::format(" {} |\n", part(errors.best));
    }
  }
  return text;
}

}  // namespace lacquer::accuracy
