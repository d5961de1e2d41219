#include "graph/profile.h"

#include <algorithm>

namespace lacquer::graph {

const std::vector<Profile>& profiles() {
  static const Term kAbsorption{"coat.absorption", "coat_absorption", {"tint", "ior", "cosine"}};
  static const auto darkening = [](std::string_view id) {
    return Term{id, "coat_darkening_layered", {"base_albedo", "internal_reflection", "amount"}};
  };
  static const std::vector<Profile> kProfiles = {
      {"khr",
       "the text of the glTF extensions",
       {"coat.fresnel", "schlick", {"F0", "cosine"}},
       "F0",
       kAbsorption,
       kAbsorption,
       kAbsorption,
       {"coat.darkening_direct",
        "coat_darkening_direct",
        {"F0", "fresnel_view", "cosine_light", "roughness", "amount"}},
       {"coat.darkening_ibl", "coat_darkening_ibl", {"F0", "fresnel_view", "roughness", "amount"}},
       "coat_transmission"},
      {"openpbr",
       "OpenPBR's coat",
       {"coat.fresnel", "fresnel_dielectric", {"ior", "cosine"}},
       "ior",
       {"coat.absorption_direct", "coat_absorption_two_ways", {"tint", "ior", "cosine", "cosine_light"}},
       {"coat.absorption_ibl", "coat_absorption_from_around", {"tint", "ior", "cosine", "base_roughness"}},
       {"coat.absorption_emission", "coat_absorption_one_way", {"tint", "ior", "cosine"}},
       darkening("coat.darkening"),
       darkening("coat.darkening"),
       "coat_transmission_layered"},
  };
  return kProfiles;
}

const Profile* findProfile(std::string_view name) {
  const std::vector<Profile>& all = profiles();
  const auto it = std::find_if(all.begin(), all.end(), [&](const Profile& p) { return p.name == name; });
  return it == all.end() ? nullptr : &*it;
}

}  // namespace lacquer::graph
