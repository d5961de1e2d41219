#include "graph/neutral.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "gltf/table.h"

namespace lacquer::graph {

namespace {

/// "coat_color_factor" of "coatColorFactor".
std::string spelled(std::string_view property) {
  std::string name;
  for (const char c : property) {
    const bool upper = std::isupper(static_cast<unsigned char>(c)) != 0;
    if (upper) name += '_';
    name += upper ? static_cast<char>(std::tolower(static_cast<unsigned char>(c))) : c;
  }
  return name;
}

/// The table's rows by the names of parameters.
struct Facts {
  std::vector<gltf::TableRow> rows = gltf::tableRows();
  std::map<std::string, const gltf::PropertyFacts*, std::less<>> of_material;
  std::vector<std::pair<std::string, const gltf::PropertyFacts*>> of_texture;  ///< "_scale"

  Facts() {
    for (const gltf::TableRow& row : rows) {
      if (gltf::elementCount(row.facts.kind) == 0) continue;
      const std::string property = spelled(row.facts.name);
      of_material.emplace(property, &row.facts);
      const bool texture = row.object == "KHR_texture_transform" || row.object.ends_with("extureInfo");
      if (texture) of_texture.emplace_back("_" + property, &row.facts);
    }
  }
};

/// The row whose property is called so, or else the one of a texture that the name ends in.
const gltf::PropertyFacts* factsOf(std::string_view name) {
  static const Facts kFacts;
  const auto it = kFacts.of_material.find(name);
  if (it != kFacts.of_material.end()) return it->second;
  const gltf::PropertyFacts* found = nullptr;
  for (const auto& [ending, facts] : kFacts.of_texture) {
    if (name.ends_with(ending)) found = facts;
  }
  return found;
}

}  // namespace

ir::Components neutralValue(const ir::Parameter& parameter) {
  const auto count = static_cast<size_t>(ir::componentCount(parameter.type));
  const gltf::PropertyFacts* facts = factsOf(parameter.name);
  ir::Components value{};
  for (size_t i = 0; i < count; ++i) {
    double x = 0;
    if (facts != nullptr) x = facts->by_default[std::min(i, gltf::elementCount(facts->kind) - 1)];
    // Not std::clamp: a range of a graph by hand may be empty until it has been checked.
    value[i] = std::min(std::max(x, parameter.range.lo), parameter.range.hi);
  }
  return value;
}

}  // namespace lacquer::graph
