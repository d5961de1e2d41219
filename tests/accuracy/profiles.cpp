#include "accuracy/profiles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "eval/dfg.h"
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

/// Where light meets the base along other directions than without a coat, the transmission is not all that
/// the coat does to the base's light.
bool isBent(const std::string& profile, Light light) {
  return profile == "physical" && light != Light::Emission;
}

/// A node that gives the base's light as the coat lets it through, without what the coat itself reflects.
graph::NodeRef throughCoat(graph::Graph& graph, const std::string& layer) {
  graph::Node through{"test.under", "coat_light_through", {}, {}};
  for (const graph::Node& node : graph.nodes) {
    if (node.id != layer) continue;
    for (const auto& [name, source] : node.inputs) {
      if (name == "base") through.inputs.emplace_back("light", source);
      if (name == "transmission") through.inputs.emplace_back("transmission", source);
    }
  }
  graph.nodes.push_back(std::move(through));
  return {"test.under", {}};
}

/// A module whose colour is the coat's transmission, or the base's light under the coat.
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
  const graph::NodeRef shown = isBent(profile, light)
                                   ? throughCoat(graph, direct ? "coat.layer_direct" : "coat.layer_ibl")
                                   : graph::NodeRef{node, {}};
  graph.outputs = {{direct ? "direct" : "emission", {shown, {}}}};
  for (graph::Node& one : graph.nodes) {
    if (one.type == body.node) one.variant = body.variant;
  }
  for (const Diagnostic& d : graph::check(graph, kLibrary)) ADD_FAILURE() << format(d);
  Result<ir::Module> module = lower::lower(graph, kLibrary, {.evaluable = true});
  EXPECT_TRUE(module);
  return module ? std::move(*module) : ir::Module{};
}

/// The light of the base without a coat, which must not be black.
double bareLight(const Query& query, Light light) {
  const double albedo = query.coating.albedo;
  return light == Light::Direct ? albedo / std::numbers::pi * query.cosine_light : albedo;
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
  for (const ir::TextureSlot& slot : module.textures) {
    if (slot.type == ir::Type::TextureCube) {
      bindings.textures[slot.name] = [](size_t, const std::array<double, 3>&, double) {
        return std::array<double, 4>{1, 1, 1, 1};
      };
    } else {
      bindings.textures[slot.name] = eval::environmentSampler(slot.name);
    }
  }
  std::vector<double> result(queries.size(), std::nan(""));
  for (const ir::Output& output : module.outputs) {
    if (output.kind != ir::OutputKind::Color) continue;
    const auto values = eval::evaluate<double>(module, {{output.value}}, bindings, points.size());
    EXPECT_TRUE(values) << (values ? "" : format(values.error()[0]));
    for (size_t i = 0; values && i < result.size(); ++i) {
      result[i] = (*values)[0][4 * i] / (isBent(profile, light) ? bareLight(queries[i], light) : 1);
    }
  }
  return result;
}

}  // namespace lacquer::accuracy
