// Profiles: the readings of how a coat layers over its base. A profile is a choice of nodes and of what goes
// into them; another reading is another row of the table.
#pragma once

#include <string_view>
#include <vector>

namespace lacquer::graph {

/// A term that a profile chooses. `inputs` are the names of the node's parameters; what each is connected to
/// follows from its name alone (coat_terms.h).
struct Term {
  std::string_view id;    ///< of the graph's node: "coat.darkening_ibl"
  std::string_view node;  ///< the library's: "coat_darkening_ibl"
  std::vector<std::string_view> inputs;
};

struct Profile {
  std::string_view name;          ///< as `--profile` takes it
  std::string_view prose;         ///< what it follows
  Term fresnel;                   ///< of the coat, along the view
  std::string_view fresnel_from;  ///< "F0" when that term and the darkening build on it, else "ior"
  // Of a colour that depends on the view; a term that two of them share has one id.
  Term absorption_direct, absorption_ibl, absorption_emission;
  Term darkening_direct, darkening_ibl;
  std::string_view transmission;  ///< of a coat that absorbs or darkens
};

/// All of them, the default one first.
const std::vector<Profile>& profiles();

/// Null when there is none of that name.
const Profile* findProfile(std::string_view name);

}  // namespace lacquer::graph
