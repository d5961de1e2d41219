#include "graph/build.h"

#include <fmt/format.h>

#include "graph/coat_model.h"
#include "graph/coat_terms.h"
#include "graph/surface_builder.h"

namespace lacquer::graph {

namespace {

using gltf::AlphaMode;

/// The BRDF terms over a surface, for one light and for the environment.
class LightingBuilder {
public:
  LightingBuilder(Graph& graph, const Surface& surface, const BuildOptions& options)
      : graph_(graph), surface_(surface), options_(options) {}

  void direct() {
    graph_.add("half", "half_vector", {{"V", given("view")}, {"L", given("light_sample.L")}});
    Lobe base = isotropicLobe("base", surface_.normal, surface_.alpha, surface_.textured_alpha);
    std::optional<Lobe> coat;
    if (surface_.coat) coat = coatLobe();
    const bool clear = coat && clearCoat();
    if (clear) splitCosine(base, *coat);
    Node& node = graph_.add("base.direct", "base_direct",
                            {{"base_color", baseColor()},
                             {"metallic", surface_.metallic},
                             {"VdotH", ref("half", "VdotH")},
                             {"NdotL", base.NdotL},
                             {"lobe", base.lobe}});
    if (surface_.dielectric_f0) Graph::connect(node, "dielectric_f0", *surface_.dielectric_f0);
    Source result = ref("base.direct");
    if (options_.direct_multiple_scattering) result = withScatteringGain(result, base);
    if (coat) {
      graph_.add("coat.lobe", "coat_lobe", {{"lobe", coat->lobe}, {"NdotL", coat->NdotL}});
      if (clear) {
        graph_.add("coat.layer_direct", "coat_sum", {{"base", result}, {"layer", ref("coat.lobe")}});
        result = ref("coat.layer_direct");
      } else {
        const Profile& profile = *options_.profile;
        const Through through = terms(profile.absorption_direct, profile.darkening_direct);
        result = layer("direct", result, through, ref("coat.lobe"));
      }
    }
    graph_.outputs.emplace_back("direct", result);
  }

  void indirect() {
    graph_.add("base.reflection", "reflection", {{"V", given("view")}, {"N", surface_.normal}});
    graph_.add("base.radiance", "prefiltered_environment",
               {{"environment_specular", Source{TextureRef{"environment_specular"}, {}}},
                {"R", ref("base.reflection")},
                {"roughness", surface_.roughness},
                {"max_lod", given("environment_max_lod")}});
    graph_.add("base.irradiance", "irradiance",
               {{"environment_irradiance", Source{TextureRef{"environment_irradiance"}, {}}},
                {"N", surface_.normal}});
    baseEnvironmentBrdf();
    const bool compensated = options_.multiple_scattering;
    Node& node =
        graph_.add("base.indirect", compensated ? "base_indirect_multiple_scattering" : "base_indirect",
                   {{"base_color", baseColor()},
                    {"metallic", surface_.metallic},
                    {"radiance", ref("base.radiance")},
                    {"irradiance", ref("base.irradiance")},
                    {"scale", ref("base.environment_brdf", "scale")},
                    {"bias", ref("base.environment_brdf", "bias")}});
    if (compensated && !surface_.textured_base) node.variant = "factors";
    if (surface_.dielectric_f0) Graph::connect(node, "dielectric_f0", *surface_.dielectric_f0);
    Source result = ref("base.indirect");
    if (surface_.coat) result = coatIndirect(result);
    if (surface_.occlusion) {
      graph_.add("occlusion.indirect", "occluded", {{"light", result}, {"visible", *surface_.occlusion}});
      result = ref("occlusion.indirect");
    }
    graph_.outputs.emplace_back("indirect", result);
  }

private:
  struct Lobe {
    Source NdotL, lobe;
  };

  Source baseColor() const {
    Source color = surface_.base_color;
    color.swizzle = "rgb";
    return color;
  }

  Source cosines(const std::string& layer, const Source& normal) {
    graph_.add(layer + ".cosines", "lobe_cosines",
               {{"N", normal}, {"V", given("view")}, {"L", given("light_sample.L")}});
    return ref(layer + ".cosines", "NdotL");
  }

  /// D and V of a layer, which are there, become its lobe.
  Lobe lobe(const std::string& layer, bool split = false) {
    const std::string visibility = layer + ".visibility";
    Node& node = graph_.add(layer + ".specular", "specular_lobe",
                            {{"numerator", ref(layer + ".distribution", "numerator")},
                             {"denominator", ref(layer + ".distribution", "denominator")},
                             {"inverse_visibility", split ? ref(visibility, "sum") : ref(visibility)}});
    if (split) Graph::connect(node, "weight", ref(visibility, "weight"));
    return {ref(layer + ".cosines", "NdotL"), ref(layer + ".specular")};
  }

  /// `textured`: alpha changes from pixel to pixel.
  Lobe isotropicLobe(const std::string& layer, const Source& normal, const Source& alpha, bool textured) {
    const Source NdotL = cosines(layer, normal);
    graph_.add(layer + ".distribution", "ggx_distribution",
               {{"N", normal},
                {"sum", ref("half", "sum")},
                {"length2", ref("half", "length2")},
                {"NdotSum", ref(layer + ".cosines", "NdotSum")},
                {"alpha", alpha}});
    graph_.add(layer + ".visibility", textured ? "smith_visibility" : "smith_visibility_split",
               {{"NdotL", NdotL}, {"NdotV", ref(layer + ".cosines", "NdotV")}, {"alpha", alpha}});
    return lobe(layer, !textured);
  }

  Lobe anisotropicLobe(const CoatSources& coat) {
    const Anisotropy& a = *coat.anisotropy;
    const Source NdotL = cosines("coat", coat.normal);
    graph_.add("coat.anisotropy_cosines", "anisotropy_cosines",
               {{"B", a.B}, {"V", given("view")}, {"L", given("light_sample.L")}});
    std::vector<std::pair<std::string, Source>> shared;
    for (const char* name : {"BdotV", "BdotL"}) {
      shared.emplace_back(name, ref("coat.anisotropy_cosines", name));
    }
    shared.emplace_back("alpha_t", a.alpha_t);
    shared.emplace_back("alpha_b", a.alpha_b);
    Node& distribution = graph_.add("coat.distribution", "ggx_distribution_anisotropic", shared);
    Graph::connect(distribution, "N", coat.normal);
    Graph::connect(distribution, "sum", ref("half", "sum"));
    Graph::connect(distribution, "NdotSum", ref("coat.cosines", "NdotSum"));
    Graph::connect(distribution, "length2", ref("half", "length2"));
    Node& visibility = graph_.add("coat.visibility", "smith_visibility_anisotropic", shared);
    Graph::connect(visibility, "NdotL", NdotL);
    Graph::connect(visibility, "NdotV", ref("coat.cosines", "NdotV"));
    return lobe("coat");
  }

  Lobe coatLobe() {
    const CoatSources& coat = *surface_.coat;
    if (coat.anisotropy) return anisotropicLobe(coat);
    return isotropicLobe("coat", coat.normal, coat.alpha, coat.textured_alpha);
  }

  /// The coat takes nothing from the base's light but what it reflects.
  bool clearCoat() const {
    const CoatSources& coat = *surface_.coat;
    return !coat.tint && !coat.absorbs && !coat.darkening;
  }

  /// Divides the light's cosine between a clear coat and the base.
  void splitCosine(Lobe& base, Lobe& lobe) {
    const CoatSources& coat = *surface_.coat;
    const std::string split = "coat.transmission_direct";
    Node& node = graph_.add(split, coat.normal == surface_.normal ? "coat_split" : "coat_split_normals",
                            {{"NdotL", base.NdotL}, {"weight", coat.weight}, {"fresnel", coat.fresnel}});
    if (!(coat.normal == surface_.normal)) Graph::connect(node, "coat_NdotL", lobe.NdotL);
    base.NdotL = ref(split, "transmitted");
    lobe.NdotL = ref(split, "reflected");
  }

  void baseEnvironmentBrdf() {
    if (graph_.find("base.view_cosine") != nullptr) return;
    graph_.add("base.view_cosine", "view_cosine", {{"N", surface_.normal}, {"V", given("view")}});
    environmentBrdf("base", ref("base.view_cosine"), surface_.roughness);
  }

  /// The base's direct light and what it gains by bouncing more than once.
  Source withScatteringGain(const Source& direct, const Lobe& base) {
    baseEnvironmentBrdf();
    Node& gain = graph_.add("base.scattering_gain", "base_scattering_gain",
                            {{"base_color", baseColor()},
                             {"metallic", surface_.metallic},
                             {"scale", ref("base.environment_brdf", "scale")},
                             {"bias", ref("base.environment_brdf", "bias")}});
    if (surface_.dielectric_f0) Graph::connect(gain, "dielectric_f0", *surface_.dielectric_f0);
    graph_.add("base.direct_compensated", "base_direct_multiple_scattering",
               {{"direct", direct}, {"gain", ref("base.scattering_gain")}, {"NdotL", base.NdotL}});
    return ref("base.direct_compensated");
  }

  void environmentBrdf(const std::string& layer, const Source& cosine, const Source& roughness) {
    Node& node = graph_.add(layer + ".environment_brdf",
                            options_.dfg_table ? "environment_brdf" : "environment_brdf_fit",
                            {{"NdotV", cosine}, {"roughness", roughness}});
    if (options_.dfg_table)
      Graph::connect(node, "environment_dfg", Source{TextureRef{"environment_dfg"}, {}});
  }

  Source coatIndirect(const Source& base) {
    const CoatSources& coat = *surface_.coat;
    Source bent = coat.normal;
    if (coat.anisotropy) {
      graph_.add("coat.bent_normal", "bent_normal",
                 {{"N", coat.normal},
                  {"B", coat.anisotropy->B},
                  {"V", given("view")},
                  {"strength", coat.anisotropy->strength},
                  {"roughness", coat.roughness}});
      bent = ref("coat.bent_normal");
    }
    graph_.add("coat.reflection", coat.anisotropy ? "reflection_unnormalized" : "reflection",
               {{"V", given("view")}, {"N", bent}});
    graph_.add("coat.radiance", "prefiltered_environment",
               {{"environment_specular", Source{TextureRef{"environment_specular"}, {}}},
                {"R", ref("coat.reflection")},
                {"roughness", coat.roughness},
                {"max_lod", given("environment_max_lod")}});
    environmentBrdf("coat", coat.cosine, coat.roughness);
    graph_.add("coat.lobe_indirect", "coat_lobe_indirect",
               {{"radiance", ref("coat.radiance")},
                {"scale", ref("coat.environment_brdf", "scale")},
                {"bias", ref("coat.environment_brdf", "bias")}});
    const Profile& profile = *options_.profile;
    return layer("ibl", base, terms(profile.absorption_ibl, profile.darkening_ibl),
                 ref("coat.lobe_indirect"));
  }

  /// What the coat takes from the base's light, the terms that are there.
  struct Through {
    std::optional<Source> absorption, darkening;
  };

  Through terms(const Term& absorption, const Term& darkening) {
    const CoatSources& coat = *surface_.coat;
    CoatTerms terms(graph_, surface_, coat);
    Through through{coat.tint, {}};
    if (coat.absorbs) through.absorption = terms.term(absorption);
    if (coat.darkening) through.darkening = terms.term(darkening);
    return through;
  }

  /// The base under the coat and the coat's own light over it; `light` is "direct" or "ibl".
  Source layer(const std::string& light, const Source& base, const Through& terms, const Source& lobe) {
    const CoatSources& coat = *surface_.coat;
    const std::string transmission = "coat.transmission_" + light;
    const bool clear = !terms.absorption && !terms.darkening;
    Node& through = graph_.add(
        transmission, clear ? "coat_transmission_clear" : std::string(options_.profile->transmission),
        {{"weight", coat.weight}, {"fresnel", coat.fresnel}});
    if (terms.absorption) Graph::connect(through, "absorption", *terms.absorption);
    if (terms.darkening) Graph::connect(through, "darkening", *terms.darkening);
    const std::string id = "coat.layer_" + light;
    graph_.add(id, "coat_layer",
               {{"base", base},
                {"transmission", ref(transmission)},
                {"layer", lobe},
                {"weight", coat.weight},
                {"fresnel", coat.fresnel}});
    return ref(id);
  }

  Graph& graph_;
  const Surface& surface_;
  const BuildOptions& options_;
};

void surfacePorts(Graph& graph, const Surface& surface) {
  auto& out = graph.outputs;
  out.emplace_back("base_color", surface.base_color);
  out.emplace_back("metallic", surface.metallic);
  out.emplace_back("roughness", surface.roughness);
  if (surface.occlusion) out.emplace_back("occlusion", *surface.occlusion);
  out.emplace_back("surface_normal", surface.normal);
  if (!surface.coat) return;
  const CoatSources& coat = *surface.coat;
  out.emplace_back("coat_weight", coat.weight);
  out.emplace_back("coat_roughness", coat.roughness);
  out.emplace_back("coat_f0", coat.F0);
  out.emplace_back("coat_normal", coat.normal);
  if (coat.darkening) out.emplace_back("coat_darkening", *coat.darkening);
  if (coat.color) out.emplace_back("coat_color", *coat.color);
  if (coat.anisotropy) out.emplace_back("coat_anisotropy", coat.anisotropy->strength);
}

}  // namespace

std::vector<std::string> liveTerms() {
  return {"base.f0", "base.normal_map", "coat",      "coat.absorption", "coat.anisotropy", "coat.darkening",
          "coat.f0", "coat.normal_map", "coat.tint", "emission",        "occlusion"};
}

Graph build(const gltf::Material& material, const gltf::VertexAttributes& attributes,
            const BuildOptions& options, Diagnostics& warnings) {
  Graph graph;
  graph.name = material.name;
  graph.template_name = options.template_name;
  // Room for a coat with all of its terms.
  graph.nodes.reserve(64);
  graph.parameters.reserve(48);
  SurfaceBuilder builder(graph, material, attributes, options, warnings);
  const Surface surface = builder.run();
  if (options.template_name == "surface") {
    surfacePorts(graph, surface);
  } else if (!surface.unlit) {
    LightingBuilder lighting(graph, surface, options);
    lighting.direct();
    if (options.template_name == "forward" && options.ibl) lighting.indirect();
    if (options.template_name == "forward" && !options.ibl) {
      graph.skipped.push_back({"base.indirect", "image-based lighting is off"});
    }
  }
  if (surface.emission) graph.outputs.emplace_back("emission", *surface.emission);
  if (surface.hidden && options.template_name != "bsdf")
    graph.outputs.emplace_back("hidden", *surface.hidden);
  if (surface.alpha_out && options.template_name != "surface")
    graph.outputs.emplace_back("alpha", *surface.alpha_out);
  return graph;
}

}  // namespace lacquer::graph
