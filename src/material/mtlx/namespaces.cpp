#include "mtlx/namespaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mtlx/looks.h"

namespace lacquer::materialx {

namespace {

using KnownNames = std::set<std::string, std::less<>>;

/// Attributes that name what stands beside the nodegraphs, one or several.
constexpr std::string_view kOne[] = {"nodename",    "nodegraph",       "nodedef",          "inherit",
                                     "material",    "collection",      "viewercollection", "variantset",
                                     "propertyset", "propertysetname", "active",           "default"};
constexpr std::string_view kSeveral[] = {"looks", "includecollection", "node", "nodedef"};

/// What is called by its name alone wherever it stands.
bool isGlobal(const Element& element) {
  constexpr std::string_view kGlobal[] = {"geompropdef",  "typedef",   "unitdef",      "unittypedef",
                                          "attributedef", "targetdef", "tokendefault", "comment"};
  return std::find(std::begin(kGlobal), std::end(kGlobal), element.category) != std::end(kGlobal);
}

bool isOneOf(std::string_view name, std::span<const std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

class NameQualifier {
public:
  explicit NameQualifier(Element& root) : root_(root), top_(root.get("namespace")) {}

  void all();

private:
  std::string meant(std::string_view name, std::string_view space) const;
  void references(Element& element, const KnownNames* graph, std::string_view space) const;

  void mark(Element& element, const std::string& space) const;

  Element& root_;
  const std::string top_;
  KnownNames known_;
  std::set<std::pair<std::string_view, std::string_view>> nodes_;  ///< namespaces, and nodes defined in them
};

/// The name of what a reference within a namespace names.
std::string NameQualifier::meant(std::string_view name, std::string_view space) const {
  if (!top_.empty() && name.starts_with(top_ + ":")) {
    const std::string_view own = name.substr(top_.size() + 1);
    if (known_.contains(own)) return std::string(own);
  }
  std::string whole = fmt::format("{}:{}", space, name);
  return !space.empty() && known_.contains(whole) ? whole : std::string(name);
}

/// `graph`: nodes of the nodegraph that the element stands in, which are meant first; null for none.
void NameQualifier::references(Element& element, const KnownNames* graph, std::string_view space) const {
  for (auto& pair : element.attributes) {
    const std::string& attribute = pair.first;
    std::string& value = pair.second;
    const bool set = element.category == "variantset";
    if (isOneOf(attribute, kSeveral) && (set || (attribute != "node" && attribute != "nodedef"))) {
      std::string list;
      for (const std::string& one : geometryNames(value))
        list += (list.empty() ? "" : ", ") + meant(one, space);
      if (!list.empty()) value = list;
    } else if (isOneOf(attribute, kOne)) {
      const bool within =
          graph != nullptr && (attribute == "nodename" || attribute == "nodegraph") && graph->contains(value);
      if (!within) value = meant(value, space);
    } else if (graph == nullptr && (attribute == "output" || attribute == "interfacename") &&
               element.find("nodename") == nullptr && element.find("nodegraph") == nullptr) {
      value = meant(value, space);
    }
  }
  const bool own = element.category == "nodegraph" && graph == nullptr;
  KnownNames nodes;
  for (const Element& child : element.children)
    if (own && isNodeElement(child)) nodes.emplace(child.name());
  for (Element& child : element.children) {
    // What a nodegraph itself takes stands beside it.
    const bool beside = own && child.category == "input";
    references(child, beside ? nullptr : own ? &nodes : graph, space);
  }
}

/// Says at the nodes of a nodegraph in which namespace they stand.
void NameQualifier::mark(Element& element, const std::string& space) const {
  for (Element& child : element.children) {
    if (!isNodeElement(child)) continue;
    child.set("namespace", space);
    mark(child, space);
  }
}

void NameQualifier::all() {
  const auto of = [&](const Element& element) -> std::string {
    const std::string_view space = element.get("namespace");
    return space == top_ ? std::string() : std::string(space);
  };
  if (top_.empty() && std::all_of(root_.children.begin(), root_.children.end(),
                                  [](const Element& child) { return child.get("namespace").empty(); }))
    return;
  std::vector<std::string> spaces;
  for (Element& child : root_.children) {
    spaces.push_back(of(child));
    const std::string prefix = spaces.back() + ":";
    if (!spaces.back().empty() && !child.name().empty() && !isGlobal(child) &&
        !child.name().starts_with(prefix))
      child.set("name", prefix + std::string(child.name()));
    known_.emplace(child.name());
    if (child.category == "nodedef")
      nodes_.emplace(child.get("namespace"), withoutNamespace(child.get("node")));
  }
  for (size_t i = 0; i < root_.children.size(); ++i) {
    Element& child = root_.children[i];
    references(child, nullptr, spaces[i]);
    const std::string space(child.get("namespace"));
    if (child.category == "nodegraph" && !space.empty()) mark(child, space);
    // A node beside the nodegraphs may be one that its namespace defines.
    const bool own = !space.empty() && isNodeElement(child) &&
                     (space == top_ || nodes_.contains({space, std::string_view(child.category)}));
    if (child.category == "nodedef" || child.category == "nodegraph" || own) continue;
    std::erase_if(child.attributes, [](const auto& one) { return one.first == "namespace"; });
  }
}

}  // namespace

void qualifyNames(Element& root) { NameQualifier(root).all(); }

}  // namespace lacquer::materialx
