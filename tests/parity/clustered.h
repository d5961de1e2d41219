// A thousand lights in clusters, at points that lie in many of them.
#pragma once

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "parity/subject.h"

namespace lacquer::parity {

inline constexpr size_t kClusteredLights = 1000;
inline constexpr size_t kClusteredPoints = 512;

struct ClusteredScene {
  Subject clustered;
  ir::Module forward;  ///< the same material with a loop over all lights
  std::vector<size_t>
      cluster_of;  ///< of each point; none where nothing in the material asks where a light is

  /// What the loop over all gives, in double.
  std::vector<double> expected() const;
};

/// A material of examples/ by its number.
ClusteredScene thousandLightsInClusters(size_t graph, std::map<std::string, bool, std::less<>> switches = {});

/// The same with all that dims a light: shadow map, cookies, profiles, masks, of one texel each, since where
/// filters look is what other tests are about.
ClusteredScene dimmedLightsInClusters();

/// Those, in a browser: what the CPU gives.
void expectDimmedLights(const char* program, const std::function<nlohmann::json(const Subject&)>& work_of);

/// The first colour of each point, in double.
std::vector<double> firstColors(const ir::Module& module, const eval::Bindings& bindings);

/// How many numbers are further apart than floats in another order make them.
template <class T>
size_t apart(const std::vector<T>& a, const std::vector<double>& b, double tolerance) {
  size_t wrong = std::max(a.size(), b.size()) - std::min(a.size(), b.size());
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    const double x = static_cast<double>(a[i]);
    if (!(std::abs(x - b[i]) <= tolerance * std::max(1.0, std::abs(b[i])))) ++wrong;
  }
  return wrong;
}

}  // namespace lacquer::parity
