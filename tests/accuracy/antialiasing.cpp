#include "accuracy/antialiasing.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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

/// A place of the ball, seen from far away along z, and its bumpy normal.
struct Place {
  eval::Point point;
  Vec3 bumpy;
};

Place placeAt(double x, double y) {
  const Vec3 ball{x, y, std::sqrt(std::max(0.0, 1 - x * x - y * y))};
  const Vec3 wave{kSlope * std::cos(kFrequency * ball[0]), kSlope * std::cos(kFrequency * ball[1]),
                  kSlope * std::cos(kFrequency * ball[2])};
  const double along = dot(wave, ball);
  Place place;
  place.bumpy = unit({ball[0] - wave[0] + along * ball[0], ball[1] - wave[1] + along * ball[1],
                      ball[2] - wave[2] + along * ball[2]});
  const Vec3 t = unit({ball[2], 0, -ball[0]});
  place.point.n = ball;
  place.point.t = {t[0], t[1], t[2], 1};
  place.point.l = unit({0.4, 0.5, 0.8});
  place.point.light = {3, 3, 3};
  place.point.position = ball;
  return place;
}

/// A normal in the place's tangent space.
Vec3 texelOf(const Place& place) {
  const Vec3& n = place.point.n;
  const Vec3 t{place.point.t[0], place.point.t[1], place.point.t[2]};
  const Vec3 b{n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0]};
  return {dot(place.bumpy, t), dot(place.bumpy, b), dot(place.bumpy, n)};
}

/// Points in fours, and what the normal map has there.
struct Points {
  std::vector<eval::Point> points;
  std::vector<Vec3> texels;

  void add(const Place& place, const Vec3& texel, bool mapped) {
    points.push_back(place.point);
    if (!mapped) points.back().n = place.bumpy;
    texels.push_back(texel);
  }
};

class Drawn {
public:
  Drawn(const Bumpy& material, bool antialiased) {
    static const lang::Library kLibrary = lang::Library::embedded();
    const Result<material::Document> document = test::materialsOf(material.gltf, "bumpy.gltf");
    EXPECT_TRUE(document);
    if (!document) return;
    test::BuildSetup setup;
    setup.ibl = false;
    setup.switches["specular_antialiasing"] = antialiased;
    Diagnostics warnings;
    const graph::Graph graph =
        test::buildGraph(document->materials.at(0), {true, true, false, {0}}, setup, warnings);
    Result<ir::Module> module = lower::lower(graph, kLibrary, {.evaluable = true});
    EXPECT_TRUE(module);
    if (module) module_ = std::move(*module);
  }

  /// Green of each point.
  std::vector<double> at(const Points& drawn) const {
    const std::vector<eval::Point>& points = drawn.points;
    eval::Bindings bindings;
    eval::bindPoints(module_, points, bindings);
    bindings.quads = true;
    for (const ir::TextureSlot& slot : module_.textures) {
      bindings.textures[slot.name] = [&drawn](size_t i, const Vec3&, double) {
        const Vec3& n = drawn.texels[i];
        return std::array<double, 4>{0.5 + 0.5 * n[0], 0.5 + 0.5 * n[1], 0.5 + 0.5 * n[2], 1};
      };
    }
    std::vector<double> result(points.size(), std::nan(""));
    for (const ir::Output& output : module_.outputs) {
      if (output.kind != ir::OutputKind::Color) continue;
      const auto values = eval::evaluate<double>(module_, {{output.value}}, bindings, points.size());
      EXPECT_TRUE(values) << (values ? "" : format(values.error()[0]));
      for (size_t i = 0; values && i < result.size(); ++i) result[i] = (*values)[0][4 * i + 1];
    }
    return result;
  }

private:
  ir::Module module_;
};

double shown(double radiance) { return radiance / (1 + radiance); }

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
      {"coat, 0.15, over a metal, 0.5", gltf(1, 0.5, coat)},
      {"anisotropic metal, 0.3, strength 0.6", gltf(1, 0.3, grooves)},
      {"mapped dielectric, 0.3", gltf(0, 0.3, map), true},
      {"mapped metal, 0.2", gltf(1, 0.2, map), true},
      {"mapped coat, 0.15, over a metal, 0.5", gltf(1, 0.5, map + mapped_coat), true},
      {"mapped anisotropic metal, 0.3, strength 0.6", gltf(1, 0.3, map + grooves), true},
  };
}

Aliasing aliasing(const Bumpy& material, double pixels_to_a_bump) {
  const double wave = 2 * 3.14159265358979323846 / kFrequency;
  const int radius = static_cast<int>(std::lround(pixels_to_a_bump / wave));
  const double pixel = 1.0 / radius;
  Points quads;
  Points fine;
  for (int y = -radius; y < radius; y += 2) {
    for (int x = -radius; x < radius; x += 2) {
      // The whole quad lies on the ball, where its slope is at most 3.
      const double far = std::hypot(std::max(x + 2, -x), std::max(y + 2, -y));
      if (far * pixel > 0.95) continue;
      for (int i = 0; i < 4; ++i) {
        const double left = x + i % 2;
        const double top = y + i / 2;
        Vec3 mean{};
        for (int s = 0; s < kAcross * kAcross; ++s) {
          const Place place = placeAt((left + (s % kAcross + 0.5) / kAcross) * pixel,
                                      (top + (s / kAcross + 0.5) / kAcross) * pixel);
          const Vec3 texel = texelOf(place);
          for (size_t c = 0; c < 3; ++c) mean[c] += texel[c] / (kAcross * kAcross);
          fine.add(place, texel, material.mapped);
        }
        quads.add(placeAt((left + 0.5) * pixel, (top + 0.5) * pixel), mean, material.mapped);
      }
    }
  }
  const Drawn off(material, false);
  const Drawn on(material, true);
  const std::vector<double> exact = off.at(fine);
  const std::vector<double> without = off.at(quads);
  const std::vector<double> with = on.at(quads);
  Aliasing errors;
  for (size_t i = 0; i < quads.points.size(); ++i) {
    double mean = 0;
    for (int s = 0; s < kAcross * kAcross; ++s) mean += exact[i * kAcross * kAcross + s];
    const double right = shown(mean / (kAcross * kAcross));
    errors.without += std::pow(shown(without[i]) - right, 2) / static_cast<double>(quads.points.size());
    errors.with += std::pow(shown(with[i]) - right, 2) / static_cast<double>(quads.points.size());
  }
  return {std::sqrt(errors.without), std::sqrt(errors.with)};
}

std::array<double, 2> flatBrightness(const Bumpy& material) {
  Points points;
  for (double x = -0.9; x < 0.9; x += 0.05) {
    const Place place = placeAt(x, 0.3 * x + 0.1);
    // As eight bits have it.
    Vec3 texel = texelOf(place);
    for (double& c : texel) c = std::round((0.5 + 0.5 * c) * 255) / 255 * 2 - 1;
    for (int i = 0; i < 4; ++i) points.add(place, texel, material.mapped);
  }
  const std::vector<double> off = Drawn(material, false).at(points);
  const std::vector<double> on = Drawn(material, true).at(points);
  std::array<double, 2> range = {1e9, 0};
  for (size_t i = 0; i < off.size(); ++i) {
    if (off[i] <= 0) continue;
    range[0] = std::min(range[0], on[i] / off[i]);
    range[1] = std::max(range[1], on[i] / off[i]);
  }
  return range;
}

std::string antialiasingTable() {
  std::string text =
      "| ball | pixels to a bump | error without | with | of it |\n"
      "|---|---|---|---|---|\n";
  for (const Bumpy& material : bumpyMaterials()) {
    for (const double bump : kBumps) {
      const Aliasing errors = aliasing(material, bump);
      text += fmt::format("| {} | {} | {:.3f} | {:.3f} | {:.0f} % |\n", material.name, bump, errors.without,
                          errors.with, 100 * errors.with / errors.without);
    }
  }
  return text;
}

}  // namespace lacquer::accuracy
