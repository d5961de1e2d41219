#include "accuracy/grid.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "accuracy/boundary.h"
#include "eval/dfg.h"
#include "eval/evaluate.h"
#include "eval/points.h"
#include "lower/lower.h"
#include "support/materials.h"

namespace lacquer::accuracy {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr size_t kMaterials = 500;
/// Widths of GGX below which glTF's lobes do not go.
constexpr double kLeastAlpha = 1e-3;

double within(Random& random, double lo, double hi) { return lo + (hi - lo) * uniform(random); }

Vec3 along(double cosine, double azimuth) {
  const double sine = std::sqrt(std::max(1 - cosine * cosine, 0.0));
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

Vec3 colorWithin(Random& random, double lo, double hi) {
  const double r = within(random, lo, hi);
  const double g = within(random, lo, hi);
  return {r, g, within(random, lo, hi)};
}

/// Where the eye and the lamps are: the first lamp near the mirror's direction, the others anywhere.
void place(GridMaterial& material, Random& random) {
  for (size_t v = 0; v < kViews; ++v) {
    const double cosine = v == 0 ? within(random, 0.65, 1) : within(random, 0.25, 0.65);
    const double azimuth = 2 * kPi * uniform(random);
    material.views[v] = along(cosine, azimuth);
    for (size_t k = 0; k < kLamps; ++k) {
      const double u = uniform(random);
      const double turn = uniform(random);
      material.lamps[v][k] =
          k == 0 ? along(std::clamp(cosine + 0.3 * (u - 0.5), 0.2, 1.0), azimuth + kPi + (turn - 0.5))
                 : along(std::sqrt(0.03 + 0.97 * u), 2 * kPi * turn);
    }
  }
}

GridMaterial materialAt(size_t index) {
  static constexpr std::array<std::string_view, 3> kBases = {"diffuse", "dielectric", "metal"};
  static constexpr std::array<std::string_view, 4> kCoats = {"smooth", "rough", "rough", "anisotropic"};
  Random random(0x9e3779b97f4a7c15u * (index + 1));
  GridMaterial m;
  m.base = kBases[index % 3];
  m.coat = kCoats[index / 3 % 4];
  m.tinted = index / 12 % 3 != 0;
  m.ior = within(random, 1.2, 2);
  const double roughness = within(random, 0.1, 0.6);
  const double strength = within(random, 0.2, 0.7);
  m.roughness = m.coat == "smooth" ? 0 : roughness;
  m.strength = m.coat == "anisotropic" ? strength : 0;
  const Vec3 tint = colorWithin(random, 0.2, 1);
  if (m.tinted) m.tint = tint;
  const double metal = m.base == "metal" ? 1 : 0;
  m.under.metallic = metal;
  m.under.color = colorWithin(random, metal == 1 ? 0.3 : 0.05, 0.95);
  const double base_roughness = within(random, 0.2, 0.8);
  const double base_ior = within(random, 1.3, 1.8);
  m.base_roughness = m.base == "diffuse" ? 1 : base_roughness;
  // A boundary that is none.
  m.under.ior = m.base == "diffuse" ? m.ior : base_ior;
  m.under.alpha = {m.base_roughness * m.base_roughness, m.base_roughness * m.base_roughness};
  place(m, random);
  return m;
}

Alphas coatAlphas(const GridMaterial& m) {
  const double alpha = std::max(m.roughness * m.roughness, kLeastAlpha);
  return {alpha + (1 - alpha) * m.strength * m.strength, alpha};
}

Layers layersOf(const GridMaterial& m) {
  Layers layers;
  layers.ior = m.ior;
  if (m.coat != "smooth") layers.alpha = coatAlphas(m);
  layers.tint = m.tint;
  layers.base = m.under;
  return layers;
}

/// The light of the coat's own lobe is of one bounce at its facets, as in every profile: the walk's part of
/// the comparison is what has been at the base.
double lobeOfCoat(const GridMaterial& m, const Vec3& view, const Vec3& light) {
  Layers lobe = layersOf(m);
  lobe.alpha = coatAlphas(m);
  return coatLobe(lobe, view, light);
}

/// A structure of the grid, every number of it a parameter.
ir::Module moduleOf(const std::string& profile, bool tinted, bool anisotropic) {
  const std::string text = fmt::format(
      R"({{"asset": {{"version": "2.0"}}, "materials": [{{
  "pbrMetallicRoughness": {{"metallicFactor": 0.5, "roughnessFactor": 0.5}},
  "extensions": {{"KHR_materials_ior": {{"ior": 1.4}},
    "KHR_materials_coat": {{"coatFactor": 1, "coatIor": 1.4, "coatRoughnessFactor": 0.3{}{}}}}}}}]}})",
      tinted ? R"(, "coatColorFactor": [0.5, 0.5, 0.5])" : "",
      anisotropic ? R"(, "coatAnisotropyStrength": 0.5)" : "");
  const Result<material::Document> document = test::materialsOf(text, "grid.gltf");
  if (!document) throw std::runtime_error(format(document.error()[0]));
  test::BuildSetup options;
  options.profile = profile;
  options.multiple_scattering = false;
  Diagnostics warnings;
  const graph::Graph graph =
      test::buildGraph(document->materials.at(0), {true, true, false, {}}, options, warnings);
  Result<ir::Module> module = lower::lower(graph, test::builtInLibrary(), {.evaluable = true});
  if (!module) throw std::runtime_error(format(module.error()[0]));
  return std::move(*module);
}

using Members = std::vector<const GridMaterial*>;

void bindMaterials(const Members& materials, size_t points_each, eval::Bindings& bindings) {
  std::map<std::string, std::pair<int, std::vector<double>>> columns;
  const auto add = [&](const char* name, std::initializer_list<double> values) {
    auto& [components, all] = columns[name];
    components = static_cast<int>(values.size());
    all.insert(all.end(), values);
  };
  for (const GridMaterial* m : materials) {
    for (size_t i = 0; i < points_each; ++i) {
      const Vec3& color = m->under.color;
      add("base_color_factor", {color[0], color[1], color[2], 1});
      add("metallic_factor", {m->under.metallic});
      add("roughness_factor", {m->base_roughness});
      add("ior", {m->under.ior});
      add("coat_ior", {m->ior});
      add("coat_roughness_factor", {m->roughness});
      add("coat_anisotropy_strength", {m->strength});
      add("coat_color_factor", {m->tint[0], m->tint[1], m->tint[2]});
    }
  }
  for (auto& [name, column] : columns)
    bindings.columns[name] = eval::Column::perPoint(column.first, std::move(column.second));
}

std::vector<double> colorsOf(const ir::Module& module, const Members& materials,
                             const std::vector<eval::Point>& points, double sky) {
  eval::Bindings bindings;
  eval::bindPoints(module, points, bindings);
  bindMaterials(materials, points.size() / materials.size(), bindings);
  for (const ir::TextureSlot& slot : module.textures) {
    if (slot.type == ir::Type::TextureCube) {
      bindings.textures[slot.name] = [sky](size_t, const std::array<double, 3>&, double) {
        return std::array<double, 4>{sky, sky, sky, 1};
      };
    } else {
      bindings.textures[slot.name] = eval::environmentSampler(slot.name);
    }
  }
  for (const ir::Output& output : module.outputs) {
    if (output.kind != ir::OutputKind::Color) continue;
    auto values = eval::evaluate<double>(module, {{output.value}}, bindings, points.size());
    if (!values) throw std::runtime_error(format(values.error()[0]));
    return std::move((*values)[0]);
  }
  return {};
}

/// Sees materials of one structure.
void see(const std::string& profile, const Members& materials, const std::vector<Seen*>& seen) {
  const ir::Module module = moduleOf(profile, materials[0]->tinted, materials[0]->coat == "anisotropic");
  std::vector<eval::Point> lit;
  std::vector<eval::Point> unlit;
  for (const GridMaterial* m : materials) {
    for (size_t v = 0; v < kViews; ++v) {
      eval::Point point;
      point.v = m->views[v];
      for (const Vec3& lamp : m->lamps[v]) {
        point.l = lamp;
        point.light = {kPi, kPi, kPi};
        lit.push_back(point);
      }
      point.light = {0, 0, 0};
      unlit.push_back(point);
    }
  }
  const std::vector<double> lamps = colorsOf(module, materials, lit, 0);
  const std::vector<double> sky = colorsOf(module, materials, unlit, 1);
  size_t at = 0;
  for (Seen* one : seen) {
    for (size_t v = 0; v < kViews; ++v, ++at) {
      for (size_t c = 0; c < 3; ++c) {
        one->sky[v][c] = sky[4 * at + c];
        for (size_t k = 0; k < kLamps; ++k) one->lamps[v][k][c] = lamps[4 * (at * kLamps + k) + c];
      }
    }
  }
}

}  // namespace

const std::vector<GridMaterial>& gridMaterials() {
  static const std::vector<GridMaterial> kAll = [] {
    std::vector<GridMaterial> all;
    for (size_t i = 0; i < kMaterials; ++i) all.push_back(materialAt(i));
    return all;
  }();
  return kAll;
}

WalkedSeen walkGrid(const GridMaterial& material, Paths paths, uint64_t seed) {
  const Layers layers = layersOf(material);
  WalkedSeen seen;
  for (size_t v = 0; v < kViews; ++v) {
    const Vec3& view = material.views[v];
    const std::vector<Estimate3> lamps = underCoat(layers, view, material.lamps[v], paths.lamps, seed + v);
    for (size_t k = 0; k < kLamps; ++k) {
      const double lobe = lobeOfCoat(material, view, material.lamps[v][k]);
      for (size_t c = 0; c < 3; ++c) {
        seen.mean.lamps[v][k][c] = kPi * (lamps[k].mean[c] + lobe);
        seen.deviation.lamps[v][k][c] = kPi * lamps[k].deviation[c];
      }
    }
    const Estimate3 sky = seenAround(layers, view, paths.sky, seed + kViews + v);
    seen.mean.sky[v] = sky.mean;
    seen.deviation.sky[v] = sky.deviation;
  }
  return seen;
}

std::vector<Seen> gridOf(const std::string& profile, const std::vector<GridMaterial>& materials) {
  std::vector<Seen> result(materials.size());
  for (const bool tinted : {false, true}) {
    for (const bool anisotropic : {false, true}) {
      Members members;
      std::vector<Seen*> seen;
      for (size_t i = 0; i < materials.size(); ++i) {
        if (materials[i].tinted != tinted || (materials[i].coat == "anisotropic") != anisotropic) continue;
        members.push_back(&materials[i]);
        seen.push_back(&result[i]);
      }
      if (!members.empty()) see(profile, members, seen);
    }
  }
  return result;
}

}  // namespace lacquer::accuracy
