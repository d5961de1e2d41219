#include "bench/error_wholes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <stdexcept>

#include "accuracy/exact.h"
#include "accuracy/profiles.h"
#include "bench/error_colors.h"
#include "eval/evaluate.h"
#include "eval/points.h"
#include "lower/lower.h"
#include "passes/pipeline.h"
#include "tests/support/materials.h"

namespace lacquer::bench {

namespace {

constexpr double kPi = 3.14159265358979323846;

double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

/// In a range, the ends among them.
double within(std::mt19937_64& random, double lo, double hi) {
  const double kind = uniform(random);
  const double u = uniform(random);
  return lo + (hi - lo) * (kind < 0.03 ? 0 : kind < 0.06 ? 1 : u);
}

std::array<double, 3> direction(double cosine, double azimuth) {
  const double sine = std::sqrt(std::max(1 - cosine * cosine, 0.0));
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

graph::Graph graphOf(const std::string& profile, bool anisotropic) {
  const std::string text = fmt::format(
      R"({{"asset": {{"version": "2.0"}}, "materials": [{{
  "pbrMetallicRoughness": {{"metallicFactor": 0.5}},
  "extensions": {{"KHR_materials_ior": {{"ior": 1.4}},
    "KHR_materials_coat": {{"coatFactor": 1, "coatIor": 1.4, "coatColorFactor": [0.5, 0.5, 0.5],
      "coatAnisotropyStrength": {}}}}}}}]}})",
      anisotropic ? 0.5 : 0);
  const Result<material::Document> document = test::materialsOf(text, "bench.gltf");
  if (!document) throw std::runtime_error(format(document.error()[0]));
  test::BuildSetup options;
  options.profile = profile;
  options.dfg_table = false;
  Diagnostics warnings;
  return test::buildGraph(document->materials.at(0), {true, true, false, {true, false, false, false}},
                          options, warnings);
}

ir::Module moduleOf(graph::Graph graph, const lang::Library& library) {
  for (const Diagnostic& d : graph::check(graph, library)) {
    if (d.severity == Severity::Error) throw std::runtime_error(format(d));
  }
  Result<ir::Module> module = lower::lower(graph, library, {.evaluable = true});
  if (!module) throw std::runtime_error(format(module.error()[0]));
  return std::move(*module);
}

ir::ValueId colorOf(const ir::Module& module) {
  for (const ir::Output& output : module.outputs) {
    if (output.kind == ir::OutputKind::Color) return output.value;
  }
  throw std::runtime_error("the template has no colour");
}

/// Red of each point.
template <class T>
std::vector<double> reds(const ir::Module& module, const eval::Bindings& bindings, size_t points) {
  const auto values = eval::evaluate<T>(module, {{colorOf(module)}}, bindings, points);
  if (!values) throw std::runtime_error(format(values.error()[0]));
  std::vector<double> red;
  for (size_t i = 0; i < points; ++i) red.push_back(static_cast<double>((*values)[0][4 * i]));
  return red;
}

/// Every point has a material of its own: the fields of its block, rounded to float.
void bindMaterials(const ir::Module& module, eval::Bindings& bindings, size_t points) {
  std::vector<ir::ValueId> roots;
  for (const ir::PreshaderField& field : module.preshader) roots.push_back(field.value);
  const auto values = eval::evaluate<double>(module, roots, bindings, points);
  if (!values) throw std::runtime_error(format(values.error()[0]));
  for (const ir::Block& block : module.blocks) {
    if (block.role != ir::BlockRole::Material) continue;
    for (size_t i = 0; i < roots.size(); ++i) {
      const ir::BlockField& field = block.fields[module.preshader[i].field];
      std::vector<double> rounded = (*values)[i];
      for (double& x : rounded) x = static_cast<double>(static_cast<float>(x));
      bindings.columns[block.instance + "." + field.name] =
          eval::Column::perPoint(ir::componentCount(field.type), std::move(rounded));
    }
  }
}

struct Inputs {
  eval::Columns columns;
  std::vector<eval::Point> points;
};

Inputs randomInputs(size_t count, bool environment) {
  std::mt19937_64 random(29);
  Inputs inputs;
  const auto column = [&](const char* name, int components, double lo, double hi) {
    std::vector<double> values;
    for (size_t i = 0; i < count; ++i) {
      const auto x = static_cast<double>(static_cast<float>(within(random, lo, hi)));
      values.insert(values.end(), static_cast<size_t>(components), x);
    }
    inputs.columns[name] = eval::Column::perPoint(components, std::move(values));
  };
  column("base_color_factor", 4, 0, 1);
  for (const char* name : {"metallic_factor", "roughness_factor", "coat_factor", "coat_roughness_factor",
                           "coat_darkening_factor", "coat_anisotropy_strength"})
    column(name, 1, 0, 1);
  column("coat_color_factor", 3, 0, 1);
  for (const char* name : {"ior", "coat_ior"}) column(name, 1, 1, 4);
  for (size_t i = 0; i < count; ++i) {
    eval::Point point;
    point.v = direction(within(random, 1e-3, 1), 0);
    point.l = direction(within(random, 1e-3, 1), within(random, 0, kPi));
    for (auto* d : {&point.v, &point.l}) {
      for (double& x : *d) x = static_cast<double>(static_cast<float>(x));
    }
    if (environment) point.light = {0, 0, 0};
    inputs.points.push_back(point);
  }
  return inputs;
}

eval::Bindings bound(const ir::Module& module, const Inputs& inputs, bool environment) {
  eval::Bindings bindings;
  bindings.columns = inputs.columns;
  eval::bindPoints(module, inputs.points, bindings);
  const double sky = environment ? 1 : 0;
  for (const char* map : {"environment_specular", "environment_irradiance"}) {
    bindings.textures[map] = [sky](size_t, const std::array<double, 3>&, double) {
      return std::array<double, 4>{sky, sky, sky, 1};
    };
  }
  return bindings;
}

/// Of each point, relative.
std::vector<double> roundings(const lang::Library& library, const std::string& profile, bool environment,
                              bool anisotropic, size_t points) {
  const ir::Module lowered = moduleOf(graphOf(profile, anisotropic), library);
  ir::Module placed = lowered;
  passes::PipelineOptions pipeline;
  pipeline.lights = {false, {{"directional", 1}}};
  passes::runPipeline(placed, pipeline);
  const Inputs inputs = randomInputs(points, environment);
  const std::vector<double> exact = reds<double>(lowered, bound(lowered, inputs, environment), points);
  eval::Bindings bindings = bound(placed, inputs, environment);
  bindMaterials(placed, bindings, points);
  if (!eval::bindVaryings<float>(placed, points, bindings)) throw std::runtime_error("varyings");
  const std::vector<double> floats = reds<float>(placed, bindings, points);
  std::vector<double> errors;
  for (size_t i = 0; i < points; ++i)
    errors.push_back(std::abs(floats[i] - exact[i]) / std::max(exact[i], kDark));
  return errors;
}

/// Coats, views and lights with the exact answers, the same for every profile. Of none is the base's own
/// light black, which the answers are parts of.
struct Coats {
  std::vector<accuracy::Query> queries;
  std::vector<double> exact;
};

Coats drawCoats(bool environment, size_t points) {
  constexpr double kLeast = 1e-3;
  std::mt19937_64 random(31);
  Coats coats;
  for (size_t i = 0; i < points; ++i) {
    const accuracy::Coating coating{within(random, 1, 4), within(random, kLeast, 1), within(random, 0, 1), 0};
    const double view = within(random, 0, 1);
    const double light = within(random, kLeast, 1);
    coats.queries.push_back({coating, view, light});
    coats.exact.push_back(environment ? accuracy::smoothEnvironment(coating, view)
                                      : accuracy::smoothDirect(coating, view, light));
  }
  return coats;
}

std::vector<double> physics(const std::string& profile, bool environment, const Coats& coats) {
  const accuracy::Light light = environment ? accuracy::Light::Environment : accuracy::Light::Direct;
  const std::vector<double> values = accuracy::transmissions(profile, light, coats.queries);
  std::vector<double> errors;
  for (size_t i = 0; i < values.size(); ++i) errors.push_back(std::abs(values[i] - coats.exact[i]));
  return errors;
}

}  // namespace

std::vector<Whole> wholes(const lang::Library& library, size_t points) {
  std::vector<Whole> all;
  const std::array<Coats, 2> coats = {drawCoats(false, points), drawCoats(true, points)};
  for (const std::string_view name : library.names(lang::DeclKind::Profile)) {
    for (const bool environment : {false, true}) {
      Whole whole{std::string(name), environment, {}, {}};
      std::vector<double> errors = roundings(library, whole.profile, environment, false, points / 2);
      const std::vector<double> more = roundings(library, whole.profile, environment, true, points / 2);
      errors.insert(errors.end(), more.begin(), more.end());
      whole.rounding = spreadOf(std::move(errors));
      whole.physics = spreadOf(physics(whole.profile, environment, coats[environment ? 1 : 0]));
      all.push_back(std::move(whole));
    }
  }
  return all;
}

}  // namespace lacquer::bench
