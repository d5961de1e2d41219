#include "accuracy/openpbr.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "lacquer/generate.h"
#include "lacquer/tools.h"

namespace lacquer::accuracy {

namespace {

using Vec3 = std::array<double, 3>;

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double square(double x) { return x * x; }
Vec3 unit(const Vec3& v) {
  const double length = std::sqrt(dot(v, v));
  return {v[0] / length, v[1] / length, v[2] / length};
}

/// Along the tangent, and across.
struct Alphas {
  double t, b;
};

Alphas alphasOf(double roughness, double anisotropy) {
  const double t = square(roughness) * std::sqrt(2 / (1 + square(1 - anisotropy)));
  return {t, t * (1 - anisotropy)};
}

/// GGX and Smith's masking over 4 cosines of the view, times the light's cosine.
double lobe(const Alphas& a, const Vec3& v, const Vec3& l, Masking masking) {
  const Vec3 h = unit({v[0] + l[0], v[1] + l[1], v[2] + l[2]});
  const double d =
      1 / (std::numbers::pi * a.t * a.b * square(square(h[0] / a.t) + square(h[1] / a.b) + square(h[2])));
  const auto lambda = [&](const Vec3& w) {
    return (std::sqrt(1 + (square(a.t * w[0]) + square(a.b * w[1])) / square(w[2])) - 1) / 2;
  };
  const double separable = 1 / ((1 + lambda(v)) * (1 + lambda(l)));
  const double correlated = 1 / (1 + lambda(v) + lambda(l));
  return d * (masking == Masking::Separable ? separable : correlated) / (4 * v[2]);
}

/// Of a dielectric of index 1.5 whose reflectance straight on has that weight.
double dielectric(double weight, double cosine) {
  const double root = std::sqrt(std::min(0.04 * weight, 0.9999));
  const double n = (1 + root) / (1 - root);
  const double through = std::sqrt(1 - (1 - square(cosine)) / square(n));
  const double s = (cosine - n * through) / (cosine + n * through);
  const double p = (through - n * cosine) / (through + n * cosine);
  return (s * s + p * p) / 2;
}

/// Schlick's with a tint at 82 degrees, cut off at 0 and at 1.
double metal(double f0, double tint, double cosine) {
  const double edge = 1.0 / 7;
  const double there = f0 + (1 - f0) * std::pow(1 - edge, 5);
  const double dip = there * (1 - tint) / (edge * std::pow(1 - edge, 6));
  const double u = 1 - cosine;
  return std::clamp(f0 + (1 - f0 - dip * cosine * u) * std::pow(u, 5), 0.0, 1.0);
}

std::string document(const OpenPbr& s) {
  const auto number = [](const char* name, double x) {
    return fmt::format(R"(<input name="{}" type="float" value="{}"/>)", name, x);
  };
  const auto color = [](const char* name, const Vec3& x) {
    return fmt::format(R"(<input name="{}" type="color3" value="{}, {}, {}"/>)", name, x[0], x[1], x[2]);
  };
  return R"(<materialx version="1.39"><open_pbr_surface name="s" type="surfaceshader">)" +
         number("base_metalness", s.metal ? 1 : 0) + color("base_color", s.base) +
         number("specular_weight", s.weight) + color("specular_color", s.color) +
         number("specular_roughness", s.roughness) + number("specular_roughness_anisotropy", s.anisotropy) +
         number("specular_haze", s.haze) + number("specular_haze_spread", s.spread) +
         number("specular_retroreflectivity", s.retroreflectivity) + number("coat_weight", s.coat) +
         number("coat_roughness", 0.4) + number("coat_darkening", 0) + "</open_pbr_surface></materialx>";
}

double error(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    for (size_t c = 0; c < 3; ++c) sum += square(a[i][c] / (1 + a[i][c]) - b[i][c] / (1 + b[i][c])) / 3;
  }
  return std::sqrt(sum / static_cast<double>(a.size()));
}

}  // namespace

std::vector<Lamp> lamps(size_t count) {
  std::mt19937_64 engine(17);
  const auto uniform = [&] { return static_cast<double>(engine() >> 11U) * 0x1p-53; };
  const auto above = [&] {
    const double z = 0.05 + 0.95 * uniform(), turn = 2 * std::numbers::pi * uniform();
    const double r = std::sqrt(1 - z * z);
    return Vec3{r * std::cos(turn), r * std::sin(turn), z};
  };
  std::vector<Lamp> made;
  while (made.size() < count) {
    const Vec3 v = above();
    Vec3 l = above();
    // Two of three are in the highlight, or in that of what is sent back.
    const double side = static_cast<double>(made.size() % 3) - 1;
    if (side != 0) {
      const double near = 0.3 * uniform();
      l = unit({side * v[0] + near * l[0], side * v[1] + near * l[1], v[2] + near * l[2]});
    }
    if (l[2] > 0.02) made.push_back({v, l});
  }
  return made;
}

std::array<double, 3> openPbrLobe(const OpenPbr& s, const Lamp& lamp, Masking masking) {
  const double wide = s.roughness + s.spread * (1 - s.roughness);
  const auto from = [&](const Vec3& v) {
    const double f = (1 - s.haze) * lobe(alphasOf(s.roughness, s.anisotropy), v, lamp.l, masking) +
                     s.haze * lobe(alphasOf(wide, s.anisotropy), v, lamp.l, masking);
    const double cosine = std::sqrt((1 + dot(v, lamp.l)) / 2);
    Vec3 result{};
    for (size_t c = 0; c < 3; ++c) {
      result[c] = f * (s.metal ? s.weight * metal(s.base[c], s.color[c], cosine)
                               : s.color[c] * dielectric(s.weight, cosine));
    }
    return result;
  };
  const Vec3 ahead = from(lamp.v), back = from({-lamp.v[0], -lamp.v[1], lamp.v[2]});
  Vec3 result{};
  for (size_t c = 0; c < 3; ++c) result[c] = ahead[c] + s.retroreflectivity * (back[c] - ahead[c]);
  return result;
}

std::vector<std::array<double, 3>> openPbrDrawn(const OpenPbr& surface, const std::vector<Lamp>& lamps,
                                                const char* profile, bool white) {
  std::string points = "[";
  for (const Lamp& lamp : lamps) {
    points += fmt::format(R"({}{{"v": [{}, {}, {}], "l": [{}, {}, {}]{}}})", points.size() == 1 ? "" : ",",
                          lamp.v[0], lamp.v[1], lamp.v[2], lamp.l[0], lamp.l[1], lamp.l[2],
                          white ? R"(, "light": [0, 0, 0], "env": [1, 1, 1])" : "");
  }
  Messages messages;
  Options options;
  options.profile = profile;
  const Scene scene = Scene::fromMemory(document(surface), "surface.mtlx", options, messages);
  std::vector<Vec3> colors;
  if (!scene) {
    ADD_FAILURE() << messages.at(0).text;
    return colors;
  }
  const auto drawn = evaluate(scene, 0, points + "]", Engine::Double, {}, options, messages);
  if (!drawn) {
    ADD_FAILURE() << messages.at(0).text;
    return colors;
  }
  for (const auto& c : drawn->rgba) colors.push_back({c[0], c[1], c[2]});
  return colors;
}

std::string openPbrTable() {
  const std::array<double, 3> gold{0.9, 0.6, 0.3}, tint{0.95, 0.9, 0.8};
  const std::vector<OpenPbr> surfaces = {
      {.name = "plastic"},
      {.name = "plastic, haze 0.5", .haze = 0.5},
      {.name = "plastic, weight 0.5", .weight = 0.5},
      {.name = "plastic, weight 4", .weight = 4},
      {.name = "plastic, retroreflectivity 0.5", .retroreflectivity = 0.5},
      {.name = "metal", .metal = true, .base = gold, .color = tint},
      {.name = "metal, haze 0.5", .metal = true, .haze = 0.5, .base = gold, .color = tint},
      {.name = "grooved metal, haze 0.5, spread 0.6",
       .metal = true,
       .anisotropy = 0.6,
       .haze = 0.5,
       .spread = 0.6,
       .base = gold,
       .color = tint},
      {.name = "metal, weight 0.5", .metal = true, .weight = 0.5, .base = gold, .color = tint},
      {.name = "metal, weight 1.5", .metal = true, .weight = 1.5, .base = gold, .color = tint},
      {.name = "metal, retroreflectivity 0.5",
       .metal = true,
       .retroreflectivity = 0.5,
       .base = gold,
       .color = tint},
      {.name = "metal, haze and retroreflectivity 0.5",
       .metal = true,
       .haze = 0.5,
       .retroreflectivity = 0.5,
       .base = gold,
       .color = tint},
  };
  constexpr size_t kLamps = 200;
  const std::vector<Lamp> all = lamps(kLamps);
  std::string text =
      "| surface | MaterialX's formulas | with their masking | glTF's | with their masking |\n"
      "|---|---|---|---|---|\n";
  for (const OpenPbr& surface : surfaces) {
    text += "| " + surface.name + " |";
    for (const char* profile : {"materialx", "khr"}) {
      const std::vector<Vec3> ours = openPbrDrawn(surface, all, profile);
      for (const Masking masking : {Masking::Separable, Masking::Correlated}) {
        std::vector<Vec3> theirs;
        for (const Lamp& lamp : all) theirs.push_back(openPbrLobe(surface, lamp, masking));
        text += fmt::format(" {:.4f} |", ours.size() == all.size() ? error(ours, theirs) : NAN);
      }
    }
    text += "\n";
  }
  return text;
}

}  // namespace lacquer::accuracy
