#include "stress/attack.h"

namespace lacquer::stress {

namespace {

/// Steps that the texts have, or that no formula can avoid. A test sees that each still occurs.
struct Known {
  std::string_view node;       ///< of the library, or a part of its name; in a material of the term's, too
  std::string_view condition;  ///< as conditionName() writes it
  std::string_view why;
};

constexpr std::string_view kEdge =
    "a light has an edge: from its own plane, and at a corner, it is seen or not";

constexpr Known kKnown[] = {
    {"distribution", "0 < NdotSum",
     "Appendix B's D ends with a step at N.H = 0; it is seen past the horizon alone"},
    {"distribution", "0 < straight",
     "Appendix B's D ends with a step at N.H = 0; it is seen past the horizon alone"},
    {"anisotropy.decoded", "1e-12 < length2",
     "a texel of no length has no direction; the tangent stands for it"},
    {"anisotropy_texel", "1e-12 < length2",
     "a texel of no length has no direction; the tangent stands for it"},
    {"flat_normal", "dot < 0", "a triangle seen from its edge turns its other side"},
    {"tangent_frame_from_derivatives", "mul < mul", "texture coordinates without an area have no tangent"},
    // In a material its term is the frame's.
    {"frame: ", "mul < mul", "texture coordinates without an area have no tangent"},
    {"boundary", "around <= body", "a boundary of equal indices bends nothing, which no lobe can say"},
    {"total_reflection", "ratio < 1", "a boundary of equal indices bends nothing, which no lobe can say"},
    {"refracting_facets", "1 < ratio", "a boundary of equal indices bends nothing, which no lobe can say"},
    {"total_reflection", "cosine <= 0",
     "total reflection is whole, however weak the material says that it reflects"},
    {"refracting_facets", "0 < NdotHalf", "a facet that is seen from behind bends nothing"},
    {"refracting_facets", "0 < dot", "what is not on two sides of a surface is not bent by it"},
    {"refracting_facets", "dot < 0", "what is not on two sides of a surface is not bent by it"},
    {"facets_pdf", "0 < dot", "no mirror of the facets sends light from below the horizon"},
    {"_by_facet", "0 < dot", "a direction on the wrong side of the surface is lost"},
    {"_by_facet", "dot < 0", "a direction on the wrong side of the surface is lost"},
    {"_by_facet", "0 < cosine", "a direction on the wrong side of the facet is lost"},
    {"_by_facet", "0 < bent2", "nothing leaves beyond the critical angle"},
    {"layer_choice", "choice < share", "a choice"},
    {"gltf_alpha", "alpha_cutoff <= alpha", "a choice"},
    {"worley", "d < first", "another point is the nearest"},
    {"worley", "d < first_before", "another point is the nearest"},
    {"unifiednoise", "d < first", "another point is the nearest"},
    {"worley2", "d < 1e+06", "points that a jitter in the thousands throws out of reach are none"},
    {"height_normal", "size2 < 1e-37", "a slope that floats no longer hold is none"},
    {"hextile", "1 <= add", "a lattice's triangles have edges"},
    {"hextile", "falloff == 0.5",
     "MaterialX's falloff of a half is left out, where the weights are the distances"},
    {"hextile", "swizzle < 0.5", "each tile is turned by its own angle"},
    {"heighttonormal", "swizzle < 0", "texture coordinates that turn over turn the field over"},
    {"height_normal", "swizzle < 0", "texture coordinates that turn over turn the field over"},
    {"bump", "swizzle < 0", "texture coordinates that turn over turn the field over"},
    {"texel_channel", "", "a channel is one of four, or none"},
    {"density", "swizzle < 1e-30", "what is black at any distance is black at all of them"},
    {"extinction", "swizzle < 1e-30", "what is black at any distance is black at all of them"},
    {"light_", "layer < 0", "a light has a layer of a texture, or none"},
    {"scaled_normal", "mul < 0", "a scale that mirrors turns the surface over"},
    {"area_", "0 < dot", kEdge},
    {"area_", "0 < mul", kEdge},
    {"area_", "0 < w", kEdge},
    {"area_", "ab < 0", kEdge},
    {"area_", " < sphere", kEdge},
    {"area_", "swizzle < 0", kEdge},
    {"area_", "0.5 < disk", "a choice"},
    {"area_", "sine2 < 1e-10", "a view along the normal is on no side of it"},
    {"_among_lights", "0 < dot", kEdge},
    {"_among_lights", "0 < mul", kEdge},
    {"_among_lights", "0 < w", kEdge},
    {"_among_lights", "ab < 0", kEdge},
    {"_among_lights", " < sphere", kEdge},
    {"_among_lights", "swizzle < 0", kEdge},
    {"_among_lights", "0.5 < disk", "a choice"},
    {"_among_lights", "sine2 < 1e-10", "a view along the normal is on no side of it"},
    {"_among_lights", "swizzle == 0", "a tangent of no length has no direction"},
    {"_among_lights", "dot < 0", "a closure has two sides that are alike, and a normal on the view's"},
    {"_covers", "0 < dot", kEdge},
    {"_covers", "0 < mul", kEdge},
    {"_covers", "0 < w", kEdge},
    {"_covers", "ab < 0", kEdge},
    {"_covers", " < sphere", kEdge},
    {"_covers", "swizzle < 0", kEdge},
    {"edge_above", "end_z < 0", "an edge that ends at the horizon goes below it or does not"},
    {"edge_above", "swizzle < 0", "an edge that ends at the horizon goes below it or does not"},
    {"lobe_over_pixel", "5 < places", "a choice"},
    {"normal_turns", "swizzle < 0", "any axes in its plane will do"},
    {"normal_map_pixel", "swizzle < 0", "any axes in its plane will do"},
    {"film", " < 0", "a film's wave turns over where the base becomes the thinner medium"},
    // Of nodes/standard/, whose texts ask for steps.
    {"ifgreater", "value1", "a comparison"},
    {"ifequal", "value2", "a comparison"},
    {"switch<", "", "a choice"},
    {"atan2<", " < 0", "an angle begins anew where it has gone round"},
    {"power<", " == 0", "anything to the power of 0 is 1, 0 too"},
    {"power<", "", "powers of 0 and of what is below are 0"},
    {"range<", "", "powers of 0 and of what is below are 0"},
    {"colorcorrect<", "", "what is not brighter than black has no colour, and powers of 0 are 0"},
    {"hsvadjust<", "value <= swizzle", "hues begin anew where they have gone round, and greys have none"},
    {"rgbtohsv<", "", "hues begin anew where they have gone round, and greys have none"},
    {"refract", "k < 0", "beyond the critical angle nothing is refracted"},
    {"smoothstep<", "", "a ramp between equal ends is a step"},
    {"burn<", " < 1e-08", "MaterialX's burn by black is black"},
    {"dodge<", " < 1e-08", "MaterialX's dodge by white is black"},
    {"disjointover", " < 1e-08", "without the background's alpha nothing is left of it"},
    {"inverse<", "volume == 0", "a matrix that has no inverse stays what is given in its place"},
    {"invertmatrix<", "volume == 0", "a matrix that has no inverse stays what is given in its place"},
    {"divide<mat", "volume == 0", "a matrix that has no inverse stays what is given in its place"},
    {"unpremult", " == 0", "without an alpha a colour stays as it is"},
    {"ramp", "", "an interval without a length is a step, and so are ramps of steps"},
    {"standard_angle", " < 0", "an angle begins anew where it has gone round"},
    {"circle", "", "a shape has an edge"},
    {"cloverleaf", "", "a shape has an edge"},
    {"hexagon", "", "a shape has an edge"},
    {"line", "radius < length", "a shape has an edge"},
    {"grid", "", "a shape has an edge"},
    {"standard_staggered", "0.5 < fract", "a shape has an edge"},
    {"crosshatch", "", "a shape has an edge"},
    {"texture_within", "", "an image has an edge"},
    {"texel_within", "", "an image has an edge"},
    {"image<", "0 <= swizzle", "an image has an edge"},
    {"image<", "swizzle <= 1", "an image has an edge"},
    {"gltf_normalmap", "0 <= swizzle", "an image has an edge"},
    {"gltf_normalmap", "swizzle <= 1", "an image has an edge"},
    {"UsdUVTexture", "0 <= swizzle", "an image has an edge"},
    {"UsdUVTexture", "swizzle <= 1", "an image has an edge"},
    {"texture_tiles", "", "a tile has an edge, and what is beyond the last one is of another colour"},
    {"gooch_shade", "", "powers of 0 and of what is below are 0"},
    // Of nodes/materialx/, whose closures are alike on both sides.
    {"_bsdf", "dot < 0", "a closure has two sides that are alike, and a normal on the view's"},
    {"closure_", "dot < 0", "a closure has two sides that are alike, and a normal on the view's"},
    {"_bsdf", "0 < thinfilm_thickness", "a film has its colours, however thin it is"},
    {"closure_", "0 < thinfilm_thickness", "a film has its colours, however thin it is"},
    {"_bsdf", "swizzle == 0", "a tangent of no length has no direction"},
    {"dielectric_bsdf", "sub < 0", "a film's wave turns over where the base becomes the thinner medium"},
    {"dielectric_bsdf", "mul < 0", "a film's wave turns over where the base becomes the thinner medium"},
    {"closure_passing", "sub < 0", "a film's wave turns over where the base becomes the thinner medium"},
    {"conductor_bsdf", "swizzle < 0", "a film's wave turns over where the base becomes the thinner medium"},
    {"schlick", "swizzle < e", "a film's wave turns over where the base becomes the thinner medium"},
    {"closure_turn", " < 0", "an angle begins anew where it has gone round"},
    {"closure_refraction", "sub < 0", "beyond the critical angle nothing is refracted"},
    {"conical_edf", "inner <= cosine", "a ramp between equal ends is a step"},
    {"conical_edf", "outer < inner", "a ramp between equal ends is a step"},
    {"roughness_dual", "swizzle < 0", "a choice"},
    {"open_pbr_medium", "0 < transmission_depth", "a choice"},
    {"usd_closures", "opacityThreshold", "a choice"},
    {"usd_closures", "opacityThreshold <= opacity", "a choice"},
    {"surface_tangent", "anisotropy == 0", "a tangent of no length has no direction"},
};

constexpr KnownSurplus kSurpluses[] = {
    {"diffuse_roughness_factor", 0.02,
     "facets send light back to where the text's 1 - F(V.H) takes the least: its Lambert's gain, and up to "
     "0.0192 more at a roughness of 1"},
};

}  // namespace

std::span<const KnownSurplus> knownSurpluses() { return kSurpluses; }

std::string_view knownAsymmetry(const Subject& subject) {
  const bool closures = std::any_of(subject.terms.begin(), subject.terms.end(), [](const auto& term) {
    return term.second.own.find("_bsdf") != std::string::npos;
  });
  return closures ? "a layer and the compensation of energy look at the eye's direction alone" : "";
}

std::string_view knownJump(const Subject& subject, std::string_view condition) {
  const auto term = subject.terms.find(condition.substr(0, condition.find(": ")));
  const auto says = [](std::string_view text, const Known& known) {
    return text.find(known.node) != std::string_view::npos;
  };
  for (const Known& known : kKnown) {
    bool here = says(subject.name, known) || says(condition, known);
    if (!here && term != subject.terms.end()) {
      // A row for all conditions of a node does not hold for the nodes that call it.
      here = says(term->second.own, known) || (!known.condition.empty() && says(term->second.called, known));
    }
    if (here && condition.ends_with(known.condition)) return known.why;
  }
  return {};
}

}  // namespace lacquer::stress
