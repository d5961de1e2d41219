#include "bench/error_colors.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>
#include <vector>

#include "eval/evaluate.h"
#include "eval/points.h"
#include "lower/lower.h"
#include "tests/support/materials.h"

namespace lacquer::bench {

namespace {

constexpr size_t kRandom = 40000;
constexpr size_t kParents = 48;
constexpr size_t kChildren = 40;  ///< of each parent
constexpr int kRounds = 14;

/// A material of that kind.
struct Setting {
  std::string profile;
  bool any_ior = true, anisotropic = false;
  bool textured = false;  ///< roughness changes with the pixel, and the shader decodes the base colour
};

std::string gltfOf(const Setting& setting) {
  const std::string texture = R"({"index": 0})";
  return fmt::format(
      R"({{"asset": {{"version": "2.0"}}, "images": [{{"uri": "a.png"}}],
"textures": [{{"source": 0}}], "materials": [{{
  "pbrMetallicRoughness": {{{}}},
  "extensions": {{ {}
    "KHR_materials_coat": {{"coatFactor": 0.5, "coatIor": {}, "coatColorFactor": [0.5, 0.5, 0.5], {}
      "coatAnisotropyStrength": {}}}}}}}]}})",
      setting.textured ? fmt::format(R"("baseColorTexture": {0}, "metallicRoughnessTexture": {0})", texture)
                       : "",
      setting.any_ior ? R"("KHR_materials_ior": {"ior": 1.4},)" : "", setting.any_ior ? 1.4 : 1.5,
      setting.textured ? fmt::format(R"("coatRoughnessTexture": {},)", texture) : "",
      setting.anisotropic ? 0.5 : 0);
}

/// The coordinates of a point, each in [0, 1]. Channels do not mix, so that one is enough.
enum Axis {
  BaseColor,
  Metallic,
  Roughness,
  Ior,
  Coat,
  CoatRoughness,
  CoatIor,
  CoatColor,
  Darkening,
  Anisotropy,
  View,
  LightCosine,
  Azimuth,
  kAxes
};
using Place = std::array<double, kAxes>;

/// The ends of an axis have a part of it.
double factor(double x) { return std::clamp((x - 0.05) / 0.9, 0.0, 1.0); }

double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

std::array<double, 3> direction(double x, double azimuth) {
  // Never quite at the horizon, where a light gives nothing.
  const double z = std::max(factor(x), 1e-3);
  const double s = std::sqrt(std::max(1 - z * z, 0.0));
  return {s * std::cos(azimuth), s * std::sin(azimuth), z};
}

/// What a shader is given at places. What its template gives follows from the module: colors() binds it.
struct Inputs {
  eval::Bindings bindings;
  std::vector<eval::Point> points;
};

Inputs inputsOf(const std::vector<Place>& places, bool environment) {
  Inputs inputs;
  eval::Bindings& bindings = inputs.bindings;
  std::vector<eval::Point>& points = inputs.points;
  const auto column = [&](const char* name, int components, auto value) {
    std::vector<double> values;
    for (const Place& p : places) values.insert(values.end(), static_cast<size_t>(components), value(p));
    bindings.columns[name] = eval::Column::perPoint(components, std::move(values));
  };
  column("base_color_factor", 4, [](const Place& p) { return factor(p[BaseColor]); });
  column("metallic_factor", 1, [](const Place& p) { return factor(p[Metallic]); });
  column("roughness_factor", 1, [](const Place& p) { return factor(p[Roughness]); });
  column("ior", 1, [](const Place& p) { return 1 + 3 * factor(p[Ior]); });
  column("coat_factor", 1, [](const Place& p) { return factor(p[Coat]); });
  column("coat_roughness_factor", 1, [](const Place& p) { return factor(p[CoatRoughness]); });
  column("coat_ior", 1, [](const Place& p) { return 1 + 3 * factor(p[CoatIor]); });
  column("coat_color_factor", 3, [](const Place& p) { return factor(p[CoatColor]); });
  column("coat_darkening_factor", 1, [](const Place& p) { return factor(p[Darkening]); });
  column("coat_anisotropy_strength", 1, [](const Place& p) { return factor(p[Anisotropy]); });
  for (const Place& p : places) {
    eval::Point point;
    point.v = direction(p[View], 0);
    // From the mirror direction to the view's own side.
    point.l = direction(p[LightCosine], 3.14159265358979323846 * (1 - factor(p[Azimuth])));
    if (environment) point.light = {0, 0, 0};
    points.push_back(point);
  }
  // Texels multiply the factors, which go over all their range all the same.
  const auto texel = [&](const char* name, Axis r, Axis g, Axis b) {
    bindings.textures[name] = [&places, r, g, b](size_t point, const std::array<double, 3>&, double) {
      const Place& p = places[point];
      return std::array<double, 4>{factor(p[r]), factor(p[g]), factor(p[b]), 1};
    };
  };
  texel("base_color_texture", BaseColor, BaseColor, BaseColor);
  texel("metallic_roughness_texture", Roughness, Roughness, Metallic);
  texel("coat_roughness_texture", CoatRoughness, CoatRoughness, CoatRoughness);
  const double sky = environment ? 1 : 0;
  for (const char* map : {"environment_specular", "environment_irradiance"}) {
    bindings.textures[map] = [sky](size_t, const std::array<double, 3>&, double) {
      return std::array<double, 4>{sky, sky, sky, 1};
    };
  }
  return inputs;
}

graph::Graph graphOf(const Setting& setting) {
  const Result<material::Document> document = test::materialsOf(gltfOf(setting), "bench.gltf");
  if (!document) throw std::runtime_error(format(document.error()[0]));
  test::BuildSetup options;
  options.profile = setting.profile;
  options.decode_srgb = setting.textured;
  options.dfg_table = false;  // the application's table is no variant
  Diagnostics warnings;
  return test::buildGraph(document->materials.at(0), {true, true, false, {true, false, false, false}},
                          options, warnings);
}

std::vector<double> colors(const graph::Graph& from, const lang::Library& library, const Inputs& inputs) {
  graph::Graph graph = from;
  for (const Diagnostic& d : graph::check(graph, library)) {
    if (d.severity == Severity::Error) throw std::runtime_error(format(d));
  }
  const Result<ir::Module> module = lower::lower(graph, library, {.evaluable = true});
  if (!module) throw std::runtime_error(format(module.error()[0]));
  const size_t points = inputs.points.size();
  eval::Bindings bindings = inputs.bindings;
  eval::bindPoints(*module, inputs.points, bindings);
  for (const ir::Output& output : module->outputs) {
    if (output.kind != ir::OutputKind::Color) continue;
    const auto values = eval::evaluate<double>(*module, {{output.value}}, bindings, points);
    if (!values) throw std::runtime_error(format(values.error()[0]));
    std::vector<double> channel;
    for (size_t i = 0; i < points; ++i) channel.push_back((*values)[0][4 * i]);
    return channel;
  }
  throw std::runtime_error("the template has no colour");
}

class Search {
public:
  Search(const lang::Library& library, graph::Graph reference, graph::Graph variant, bool environment)
      : library_(library),
        reference_(std::move(reference)),
        variant_(std::move(variant)),
        environment_(environment) {}

  double run() {
    std::vector<Place> places(kRandom);
    for (Place& place : places) {
      for (double& x : place) x = uniform(random_);
    }
    keepWorst(std::move(places));
    for (int round = 0; round < kRounds; ++round) {
      std::vector<Place> children = worst_;
      const double reach = 0.3 * std::pow(0.75, round);
      for (const Place& parent : worst_) {
        for (size_t i = 0; i < kChildren; ++i) children.push_back(moved(parent, reach));
      }
      keepWorst(std::move(children));
    }
    return error_;
  }

private:
  Place moved(Place place, double reach) {
    for (double& x : place) {
      // Some axes stay: a maximum is often at the end of several.
      if (uniform(random_) < 0.5) continue;
      x = std::clamp(x + reach * (2 * uniform(random_) - 1), 0.0, 1.0);
    }
    return place;
  }

  void keepWorst(std::vector<Place> places) {
    const Inputs inputs = inputsOf(places, environment_);
    const std::vector<double> exact = colors(reference_, library_, inputs);
    const std::vector<double> approximate = colors(variant_, library_, inputs);
    std::vector<double> errors;
    for (size_t i = 0; i < exact.size(); ++i) {
      errors.push_back(std::abs(approximate[i] - exact[i]) / std::max(exact[i], kDark));
    }
    std::vector<size_t> order(places.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::partial_sort(order.begin(), order.begin() + kParents, order.end(), [&](size_t a, size_t b) {
      return errors[a] != errors[b] ? errors[a] > errors[b] : a < b;
    });
    worst_.clear();
    for (size_t i = 0; i < kParents; ++i) worst_.push_back(places[order[i]]);
    error_ = std::max(error_, errors[order[0]]);
  }

  const lang::Library& library_;
  graph::Graph reference_, variant_;
  bool environment_;
  std::mt19937_64 random_{11};
  std::vector<Place> worst_;
  double error_ = 0;
};

}  // namespace

double worstColorError(const lang::Library& library, const std::string& node, const std::string& variant,
                       bool any_ior) {
  double worst = 0;
  std::vector<Setting> settings;
  for (const std::string_view profile : library.names(lang::DeclKind::Profile)) {
    settings.push_back({std::string(profile), any_ior, false, false});
    settings.push_back({std::string(profile), any_ior, true, false});
  }
  settings.push_back({"khr", any_ior, false, true});
  bool met = false;
  for (const Setting& setting : settings) {
    const graph::Graph reference = graphOf(setting);
    graph::Graph changed = reference;
    for (graph::Node& one : changed.nodes) {
      if (one.type == node) one.variant = variant;
    }
    // Textures are for what only they bring into the graph.
    if (changed.nodes == reference.nodes || (setting.textured && met)) continue;
    met = true;
    for (const bool environment : {false, true}) {
      worst = std::max(worst, Search(library, reference, changed, environment).run());
    }
  }
  return worst;
}

}  // namespace lacquer::bench
