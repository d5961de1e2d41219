#include "run/fallbacks.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "shader/limits.h"
#include "shader/times.h"

namespace lacquer {

using programs::Places;

namespace {

/// Of more programs that cannot be one the halves are looked at by themselves.
constexpr size_t kMostOneByOne = 64;

class Dividing {
public:
  Dividing(const ProgramCosts& costs, const Setting& setting, Fallbacks& to)
      : costs_(costs), setting_(setting), to_(to) {}

  void domain(const Places& all) {
    divide(all);
    ++to_.domains;
  }

private:
  bool fits(const Places& group) {
    if (group.size() == 1) return true;
    const StageTimer timer(setting_.times, StageOfRun::Programs);
    const Result<ir::Module> module = costs_.moduleOfGroup(group);
    const Diagnostics wrong = module ? overLimits(*module, setting_.options.targets) : module.error();
    if (to_.apart.empty()) to_.apart = wrong;
    return wrong.empty();
  }

  void divide(const Places& all) {
    if (fits(all)) {
      to_.groups.push_back(all);
    } else if (all.size() <= kMostOneByOne) {
      oneByOne(all);
    } else {
      const auto middle = all.begin() + static_cast<ptrdiff_t>(all.size() / 2);
      divide(Places(all.begin(), middle));
      divide(Places(middle, all.end()));
    }
  }

  /// Each to the first group that takes it.
  void oneByOne(const Places& all) {
    std::vector<Places> groups;
    for (const uint32_t item : all) {
      const auto takes = [&](Places& group) {
        group.push_back(item);
        if (fits(group)) return true;
        group.pop_back();
        return false;
      };
      if (std::none_of(groups.begin(), groups.end(), takes)) groups.push_back({item});
    }
    to_.groups.insert(to_.groups.end(), groups.begin(), groups.end());
  }

  const ProgramCosts& costs_;
  const Setting& setting_;
  Fallbacks& to_;
};

}  // namespace

std::map<std::string, int> lightsOf(const OwnProgram& program) {
  const passes::LightFacts& lights = program.structures[0]->lights;
  std::map<std::string, int> counts(lights.counts.begin(), lights.counts.end());
  counts[""] = lights.any ? 1 : 0;
  return counts;
}

Fallbacks fallbacksOf(const std::vector<OwnProgram>& all, const ProgramCosts& costs, const Setting& setting) {
  // What reads scene_behind is drawn while that is bound: it has no part in the other passes.
  std::map<std::tuple<std::map<std::string, int>, Strings, bool>, Places> domains;
  for (uint32_t i = 0; i < all.size(); ++i) {
    const bool looks_through = all[i].structures[0]->looks_through;
    domains[{lightsOf(all[i]), all[i].graphs[0].attributes, looks_through}].push_back(i);
  }
  Fallbacks made;
  Dividing dividing(costs, setting, made);
  for (const auto& [domain, places] : domains) dividing.domain(places);
  return made;
}

Diagnostics about(const Fallbacks& fallbacks) {
  if (fallbacks.groups.size() <= fallbacks.domains || fallbacks.apart.empty()) return {};
  const Diagnostic& why = fallbacks.apart[0];
  return {{"fallbacks",
           Severity::Warning,
           {},
           fmt::format("there are {} fallbacks where {} would do: {}", fallbacks.groups.size(),
                       fallbacks.domains, why.message),
           "each use in the manifest names its own: make the pipelines of all of them first",
           {}}};
}

}  // namespace lacquer
