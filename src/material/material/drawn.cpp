#include "material/drawn.h"

#include <algorithm>
#include <cmath>

namespace lacquer::material {

namespace {

/// Open ranges of what is drawn end here.
constexpr double kLargest = 8;

bool names(const std::vector<std::string_view>& list, std::string_view name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

/// Whether either says that it is nothing beside the other.
bool clash(const lang::ExtensionDecl& a, const lang::ExtensionDecl& b) {
  const auto out = [](const lang::ExtensionDecl& x, const lang::ExtensionDecl& y) {
    return names(x.excludes, y.name) || names(x.yields_to, y.name) || names(x.loses_to, y.name);
  };
  return out(a, b) || out(b, a);
}

double drawn(const lang::PropertyDecl& decl, Random& random) {
  const double lo = decl.range.gap > 0 ? decl.range.gap : std::max(decl.range.lo, -kLargest);
  const double hi = std::min(decl.tested.value_or(decl.range.hi), std::max(lo, 0.0) + kLargest);
  // Inside of the range: its ends are often thresholds.
  return lo + (hi - lo) * (0.1 + 0.8 * random.unit());
}

}  // namespace

bool addExtension(const Schema& schema, uint16_t extension, std::vector<uint16_t>& to) {
  if (extension == 0 || std::find(to.begin(), to.end(), extension) != to.end()) return true;
  const lang::ExtensionDecl& decl = *schema.extensions[extension];
  for (const uint16_t other : to) {
    if (clash(decl, *schema.extensions[other])) return false;
  }
  to.push_back(extension);
  std::vector<std::string_view> needed = decl.needs;
  if (!decl.inside.empty()) needed.push_back(decl.inside);
  return std::all_of(needed.begin(), needed.end(), [&](std::string_view name) {
    const std::optional<uint16_t> found = schema.find(name);
    return found && addExtension(schema, *found, to);
  });
}

void setNumber(Material& material, uint16_t property, const ir::Components& value) {
  for (Material::Number& number : material.numbers) {
    if (number.property == property) {
      number.value = value;
      return;
    }
  }
  material.numbers.push_back({property, value});
}

void drawNumbers(const Schema& schema, const std::vector<uint16_t>& extensions, Random& random,
                 Material& material) {
  for (size_t i = 0; i < schema.properties.size(); ++i) {
    const material::Property& row = schema.properties[i];
    const auto property = static_cast<uint16_t>(i);
    const bool ours = std::find(extensions.begin(), extensions.end(), row.extension) != extensions.end();
    if (!ours || row.decl->kind == material::Kind::Texture || material.number(property) != nullptr) continue;
    ir::Components value{};
    if (row.decl->kind == material::Kind::Number) {
      for (int c = 0; c < ir::componentCount(row.decl->type); ++c)
        value[static_cast<size_t>(c)] = drawn(*row.decl, random);
    } else {
      const auto choices = static_cast<uint32_t>(std::max<size_t>(row.decl->choices.size(), 2));
      value[0] = random.below(choices);
    }
    setNumber(material, property, value);
  }
}

std::optional<Material> materialWith(const Schema& schema, uint16_t extension, uint64_t seed) {
  Material material;
  material.index = 0;
  material.name = schema.extensions[extension]->name;
  if (!addExtension(schema, extension, material.extensions)) return std::nullopt;
  std::sort(material.extensions.begin(), material.extensions.end());
  Random random(mixed(seed, material.name));
  std::vector<uint16_t> all = material.extensions;
  all.push_back(0);
  drawNumbers(schema, all, random, material);
  return material;
}

}  // namespace lacquer::material
