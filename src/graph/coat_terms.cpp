#include "graph/coat_terms.h"

#include <cassert>

namespace lacquer::graph {

Source CoatTerms::node(const std::string& id, const std::string& type, Inputs inputs) {
  if (!graph_.find(id)) graph_.add(id, type, std::move(inputs));
  return ref(id);
}

Source CoatTerms::term(const Term& term) {
  Inputs inputs;
  for (const std::string_view name : term.inputs) inputs.emplace_back(name, input(name));
  return node(std::string(term.id), std::string(term.node), std::move(inputs));
}

Inputs CoatTerms::withDielectric(Inputs inputs) const {
  if (surface_.dielectric_f0) inputs.emplace_back("dielectric_f0", *surface_.dielectric_f0);
  return inputs;
}

Source CoatTerms::input(std::string_view name) {
  if (name == "F0") return coat_.F0;
  if (name == "ior") return coat_.ior;
  if (name == "cosine") return coat_.cosine;
  if (name == "fresnel_view") return coat_.fresnel;
  if (name == "roughness") return coat_.roughness;
  if (name == "tint") return *coat_.color;
  if (name == "amount") return *coat_.darkening;
  if (name == "cosine_light") {
    return node("coat.light_cosine", "view_cosine", {{"N", coat_.normal}, {"V", given("light_sample.L")}});
  }
  if (name == "base_albedo") {
    return node("coat.base_albedo", "coat_base_albedo",
                withDielectric({{"F0", ref("base.reflectance", "F0")},
                                {"diffuse", ref("base.reflectance", "diffuse")}}));
  }
  if (name == "base_roughness") {
    return node("coat.base_roughness", "coat_base_roughness",
                withDielectric({{"roughness", surface_.roughness}, {"metallic", surface_.metallic}}));
  }
  if (name == "internal_reflection") {
    return term(
        {"coat.internal_reflection", "coat_internal_reflection", {"ior", "fresnel_view", "base_roughness"}});
  }
  assert(false && "a profile's term has an input that nothing is known of");
  return number(0);
}

}  // namespace lacquer::graph
