// What the profiles say: the transmission of the coat in the graph of a material, evaluated.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "accuracy/exact.h"

namespace lacquer::accuracy {

enum class Light { Direct, Environment, Emission };

struct Query {
  Coating coating;
  double cosine_view = 1;
  double cosine_light = 1;  ///< of direct light
};

/// Profiles in which the base lies in the coat's medium: a base without a boundary has the coat's IOR there,
/// 1 elsewhere.
bool isImmersed(const std::string& profile);

/// Another body for every use of a node; none where `node` is empty.
struct Body {
  std::string node, variant;
};

/// By query, in double: what the profile multiplies the base's light with. The base is as nearly Lambertian
/// as glTF has one: a dielectric of roughness 1 without a boundary. Emission is what `physical` alone has.
std::vector<double> transmissions(const std::string& profile, Light light, std::span<const Query> queries,
                                  const Body& body = {});

}  // namespace lacquer::accuracy
