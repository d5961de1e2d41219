#include "accuracy/profiles.h"

#include <gtest/gtest.h>

#include <cmath>

#include "eval/evaluate.h"
#include "eval/points.h"
#include "lower/lower.h"
#include "support/materials.h"

namespace lacquer::accuracy {

namespace {

constexpr const char* kMaterial = R"({"asset": {"version": "2.0"}, "materials": [{
  "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 1}, "emissiveFactor": [1, 1, 1],
  "extensions": {
    "KHR_materials_ior": {"ior": 1},
    "KHR_materials_coat": {"coatFactor": 1, "coatIor": 1.4, "coatColorFactor": [0.5, 0.5, 0.5]}}}]})";

/// A module whose colour is the coat's transmission.
ir::Module moduleOf(const std::string& profile, Light light, const Body& body) {
  static const lang::Library kLibrary = lang::Library::embedded();
  const Result<material::Document> document = test::materialsOf(kMaterial, "coated.gltf");
  if (!document) return {};
  test::BuildSetup options;
  options.profile = profile;
  Diagnostics warnings;
  graph::Graph graph =
      test::buildGraph(document->materials.at(0), {true, true, false, {}}, options, warnings);
  const bool direct = light == Light::Direct;
  const std::string node = direct                        ? "coat.transmission_direct"
                           : light == Light::Environment ? "coat.transmission_ibl"
                                                         : "emission.transmission";
  graph.outputs = {{direct ? "direct" : "emission", {graph::NodeRef{node, {}}, {}}}};
  for (graph::Node& one : graph.nodes) {
    if (one.type == body.node) one.variant = body.variant;
  }
  for (const Diagnostic& d : graph::check(graph, kLibrary)) ADD_FAILURE() << format(d);
  Result<ir::Module> module = lower::lower(graph, kLibrary, {.evaluable = true});
  EXPECT_TRUE(module);
  return module ? std::move(*module) : ir::Module{};
}

std::array<double, 3> tilted(double cosine) { return {std::sqrt(1 - cosine * cosine), 0, cosine}; }

}  // namespace

bool isImmersed(const std::string& profile) { return profile == "physical" || profile == "openpbr"; }

std::vector<double> transmissions(const std::string& profile, Light light, std::span<const Query> queries,
                                  const Body& body) {
  const ir::Module module = moduleOf(profile, light, body);
  std::vector<eval::Point> points;
  std::vector<double> albedo;
  std::vector<double> tint;
  std::vector<double> ior;
  std::vector<double> roughness;
  for (const Query& q : queries) {
    eval::Point point;
    point.v = tilted(q.cosine_view);
    point.l = tilted(q.cosine_light);
    points.push_back(point);
    albedo.insert(albedo.end(), {q.coating.albedo, q.coating.albedo, q.coating.albedo, 1});
    tint.insert(tint.end(), 3, q.coating.tint);
    ior.push_back(q.coating.ior);
    roughness.push_back(q.coating.roughness);
  }
  eval::Bindings bindings;
  eval::bindPoints(module, points, bindings);
  bindings.columns["base_color_factor"] = eval::Column::perPoint(4, albedo);
  bindings.columns["coat_color_factor"] = eval::Column::perPoint(3, tint);
  bindings.columns["coat_ior"] = eval::Column::perPoint(1, ior);
  if (isImmersed(profile)) bindings.columns["ior"] = bindings.columns["coat_ior"];
  bindings.columns["coat_roughness_factor"] = eval::Column::perPoint(1, roughness);
  std::vector<double> result(queries.size(), std::nan(""));
  for (const ir::Output& output : module.outputs) {
    if (output.kind != ir::OutputKind::Color) continue;
    const auto values = eval::evaluate<double>(module, {{output.value}}, bindings, points.size());
    EXPECT_TRUE(values) << (values ? "" : format(values.error()[0]));
    for (size_t i = 0; values && i < result.size(); ++i) result[i] = (*values)[0][4 * i];
  }
  return result;
}

}  // namespace lacquer::accuracy
