#include "exchange/kept.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>
#include <vector>

#include "exchange/pattern_out.h"
#include "materialx/patterns.h"
#include "mtlx/looks.h"
#include "mtlx/models.h"
#include "mtlx/values.h"

namespace lacquer::exchange {

using materialx::Element;

namespace {

/// They may speak of materials that go.
constexpr std::array<std::string_view, 7> kOfMaterials = {
    "look", "lookgroup", "materialassign", "property", "propertyset", "variantset", "propertysetassign"};
/// What has a type, and is neither a node nor an output.
constexpr std::array<std::string_view, 4> kOfTypes = {"nodedef", "typedef", "geompropdef", "tokendefault"};

/// The elements beside it that an element names.
void addTaken(const Element& element, std::vector<std::string_view>& taken) {
  bool connected = false;
  for (const std::string_view attribute : {"nodename", "nodegraph", "output"}) {
    const std::string_view name = element.get(attribute);
    if (name.empty() || (connected && attribute == "output"))
      continue;  // of what was named, and not beside it
    taken.push_back(name);
    connected = true;
  }
  for (const Element& child : element.children) addTaken(child, taken);
}

/// Whether an element is a node, a nodegraph, an output or a material, and no definition. `bodies`:
/// nodegraphs that an implementation names.
bool isNode(const Element& element, const std::set<std::string, std::less<>>& bodies) {
  if (std::find(kOfTypes.begin(), kOfTypes.end(), element.category) != kOfTypes.end()) return false;
  if (element.category == "nodegraph")
    return element.get("nodedef").empty() && !bodies.contains(element.name());
  return !element.get("type").empty();
}

/// Names of materials with a variant's values have slashes, which MaterialX has not.
void nameVariants(Element& root) {
  materialx::NameSet taken;
  std::map<std::string, std::string, std::less<>> names;
  for (const Element& child : root.children) taken.take(std::string(child.name()));
  for (const Element& child : root.children) {
    const std::string name(child.name());
    if (name.find('/') == std::string::npos || names.contains(name)) continue;
    names[name] = taken.free(materialx::graphName(name));
  }
  const auto rename = [&](auto& self, Element& element) -> void {
    std::erase_if(element.attributes, [](const auto& one) { return one.first == materialx::kOfVariant; });
    for (auto& [attribute, value] : element.attributes) {
      const auto at = names.find(value);
      if (at == names.end()) continue;
      if (attribute == "name" || attribute == "nodename" || attribute == "nodegraph") value = at->second;
    }
    for (Element& child : element.children) self(self, child);
  };
  if (names.empty()) return;
  for (Element& child : root.children) {
    const bool shown = child.category == "surfacematerial" && names.contains(child.name());
    if (shown && child.get("uiname").empty()) child.set("uiname", std::string(child.name()));
  }
  rename(rename, root);
}

/// The element that a pointer such as /marble/noise/amplitude leads to; null for none.
Element* elementAt(Element& root, std::string_view pointer) {
  Element* found = &root;
  while (!pointer.empty()) {
    pointer.remove_prefix(1);
    const std::string_view name = pointer.substr(0, pointer.find('/'));
    pointer.remove_prefix(name.size());
    const auto child = std::find_if(found->children.begin(), found->children.end(),
                                    [&](const Element& one) { return one.name() == name; });
    if (child == found->children.end()) return nullptr;
    found = &*child;
  }
  return found;
}

void putNumber(Element& input, const graph::Parameter& parameter, const materialx::Units& units,
               std::string_view unit) {
  const std::vector<double> numbers = parameter.numbers();
  if (ir::isMatrix(parameter.type)) {
    if (materialx::numbersOf(input.get("value")) != numbers)
      input.set("value", fmt::format("{}", fmt::join(numbers, ", ")));
    return;
  }
  const std::optional<ir::Type> type = materialx::typeOf(input.get("type"));
  if (!type) return;
  const auto count = static_cast<ptrdiff_t>(numbers.size());
  const Result<ir::Components> read = materialx::valueOf(input, *type, units, unit);
  if (read && std::equal(numbers.begin(), numbers.begin() + count, read->begin())) return;
  ir::Components value{};
  std::copy(numbers.begin(), numbers.end(), value.begin());
  std::erase_if(input.attributes,
                [](const auto& had) { return had.first == "unit" || had.first == "unittype"; });
  if (!unit.empty()) input.set("unit", std::string(unit));
  if (input.get("type").starts_with("color")) input.set("colorspace", "lin_rec709");
  input.set("value", valueText(*type, value));
}

}  // namespace

void putNumbers(Element& root, const graph::Graph& edited) {
  Diagnostics said;  // where the document is read
  materialx::Units units;
  units.add(root, said);
  for (const graph::Parameter& parameter : edited.parameters) {
    if (parameter.pointer.empty()) continue;
    Element* input = elementAt(root, parameter.pointer);
    if (input == nullptr || input->find("value") == nullptr) continue;
    const Element* node = elementAt(root, parameter.pointer.substr(0, parameter.pointer.rfind('/')));
    putNumber(
        *input, parameter, units,
        node == nullptr ? std::string_view() : materialx::portUnit(root, node->category, input->name()));
  }
}

void keepMaterials(Element& root, const Strings& names) {
  Diagnostics said;
  materialx::addVariants(root, said);
  std::set<std::string, std::less<>> bodies;
  for (const Element& child : root.children) {
    if (child.category == "implementation") bodies.emplace(child.get("nodegraph"));
  }
  std::map<std::string_view, const Element*> nodes;
  for (const Element& child : root.children) {
    if (isNode(child, bodies)) nodes.emplace(child.name(), &child);
  }
  std::vector<std::string_view> pending;
  for (const auto& [name, element] : nodes) {
    const std::string_view shown = element->get("uiname");
    // A nodegraph's output is a pattern of its own where it has several: marble/color.
    const std::string_view material = shown.empty() ? name : shown;
    const std::string outputs = element->category == "nodegraph" ? fmt::format("{}/", name) : std::string();
    const bool wanted = std::any_of(names.begin(), names.end(), [&](const std::string& one) {
      return one == material || (!outputs.empty() && one.starts_with(outputs));
    });
    if (wanted) pending.push_back(name);
  }
  std::set<std::string, std::less<>> kept;
  while (!pending.empty()) {
    const std::string_view name = pending.back();
    pending.pop_back();
    const auto at = nodes.find(name);
    if (at == nodes.end() || !kept.emplace(name).second) continue;
    addTaken(*at->second, pending);
  }
  std::erase_if(root.children, [&](const Element& child) {
    if (isNode(child, bodies)) return !kept.contains(child.name());
    return std::find(kOfMaterials.begin(), kOfMaterials.end(), child.category) != kOfMaterials.end();
  });
  nameVariants(root);
}

}  // namespace lacquer::exchange
