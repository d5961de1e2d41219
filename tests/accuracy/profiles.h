// What the profiles say: the transmission of the coat in the graph of a material, evaluated.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "accuracy/exact.h"

namespace lacquer::accuracy {

enum class Light { Direct, Environment };

struct Query {
  Coating coating;
  double cosine_view = 1;
  double cosine_light = 1;  ///< of direct light
};

/// Another body for every use of a node; none where `node` is empty.
struct Body {
  std::string node, variant;
};

/// By query, in double: what the profile multiplies the base's light with. The base is as nearly Lambertian
/// as glTF has one: a dielectric of roughness 1 with an IOR of 1.
std::vector<double> transmissions(const std::string& profile, Light light, std::span<const Query> queries,
                                  const Body& body = {});

}  // namespace lacquer::accuracy
