// MaterialX 1.36 and 1.37 as 1.38 says them.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>

#include "mtlx/names.h"
#include "mtlx/upgrade.h"
#include "mtlx/values.h"
#include "support/say_once.h"
#include "support/text.h"

namespace lacquer::materialx {

namespace {

struct Renamed {
  std::string_view old, now;
};

std::string_view nowOf(std::string_view name, std::span<const Renamed> table) {
  for (const Renamed& row : table) {
    if (row.old == name) return row.now;
  }
  return name;
}

constexpr Renamed kElementsOf37[] = {{"parameter", "input"},
                                     {"bindparam", "input"},
                                     {"bindinput", "input"},
                                     {"bindtoken", "token"},
                                     {"opgraph", "nodegraph"}};
constexpr Renamed kAttributesOf37[] = {{"opgraph", "nodegraph"}, {"graphoutput", "output"}};
constexpr Renamed kTypesOf37[] = {{"color2", "vector2"}, {"geomname", "string"}};
constexpr Renamed kClosuresOf37[] = {{"diffuse_brdf", "oren_nayar_diffuse_bsdf"},
                                     {"burley_diffuse_brdf", "burley_diffuse_bsdf"},
                                     {"diffuse_btdf", "translucent_bsdf"},
                                     {"dielectric_brdf", "dielectric_bsdf"},
                                     {"dielectric_btdf", "dielectric_bsdf"},
                                     {"conductor_brdf", "conductor_bsdf"},
                                     {"generalized_schlick_brdf", "generalized_schlick_bsdf"},
                                     {"sheen_brdf", "sheen_bsdf"},
                                     {"subsurface_brdf", "subsurface_bsdf"},
                                     {"thin_film_brdf", "thin_film_bsdf"}};

/// What is called otherwise, at every depth.
void renameAll(Element& element, bool definition) {
  if (element.category == "swizzle") {
    const Element* in = element.child("input", "in");
    for (Element& child : element.children) {  // the second channel of a color2 was its alpha
      if (in == nullptr || in->get("type") != "color2" || child.name() != "channels") continue;
      std::string channels(child.get("value"));
      std::replace(channels.begin(), channels.end(), 'a', 'g');
      child.set("value", std::move(channels));
    }
  }
  if (definition && element.category == "parameter") element.set("uniform", "true");
  element.category = nowOf(element.category, kElementsOf37);
  for (auto& [name, value] : element.attributes) {
    name = nowOf(name, kAttributesOf37);
    if (name == "type") value = nowOf(value, kTypesOf37);
  }
  for (Element& child : element.children) {
    if (element.category != "backdrop") renameAll(child, element.category == "nodedef");
  }
}

void renameInput(Element& node, std::string_view old, std::string_view now) {
  if (Element* in = inputOf(node, old)) in->set("name", std::string(now));
}

/// Nodes of 1.36 that 1.37 calls otherwise.
void from36(Element& node) {
  const auto inType = [&](std::string_view name) {
    const Element* in = node.child("input", name);
    return in == nullptr ? std::string_view() : in->get("type");
  };
  const std::string_view type = node.get("type");
  if (node.category == "invert" && type.starts_with("matrix")) node.category = "invertmatrix";
  if (node.category == "rotate") node.category = type == "vector2" ? "rotate2d" : "rotate3d";
  if (node.category.starts_with("transform") && !inType("mat").empty()) node.category = "transformmatrix";
  if (node.category == "combine")
    node.category = node.child("input", "in4") != nullptr   ? "combine4"
                    : node.child("input", "in3") != nullptr ? "combine3"
                                                            : "combine2";
  if (node.category == "separate")
    node.category =
        fmt::format("separate{}", ir::componentCount(typeOf(inType("in")).value_or(ir::Type::Vec2)));
  if (node.category == "compare") {
    node.category = "ifgreatereq";
    renameInput(node, "intest", "value1");
    renameInput(node, "cutoff", "value2");
    Element* first = inputOf(node, "in1");
    Element* second = inputOf(node, "in2");
    if (first != nullptr) first->set("name", "in2");
    if (second != nullptr) second->set("name", "in1");
  }
  if (node.category == "geomattrvalue") {
    node.category = "geompropvalue";
    renameInput(node, "attrname", "geomprop");
    if (const std::string* name = node.find("attrname")) addInput(node, "geomprop", "string", *name);
  }
  for (Element& child : node.children) {
    if (node.category == "geominfo" && child.category == "geomattr") child.category = "geomprop";
  }
}

/// Closures and angles of 1.37. What they need beside them goes to `more`.
void from37(Element& node, NameSet& names, std::vector<Element>& more) {
  if (node.category == "atan2") {
    renameInput(node, "in1", "inx");
    renameInput(node, "in2", "iny");
  }
  const std::string old = node.category;
  node.category = nowOf(old, kClosuresOf37);
  if (node.category == old) return;
  std::erase_if(node.attributes, [](const auto& one) { return one.first == "nodedef"; });
  const std::string name(node.name());
  if (old == "dielectric_btdf") addInput(node, "scatter_mode", "string", "T");
  if (old == "conductor_brdf") {
    const std::string ior = names.free(name + "_ior");
    Element artistic = nodeAt(node.place, "artistic_ior", ior, "multioutput");
    const auto isArtistic = [](const Element& e) {
      return e.name() == "reflectivity" || e.name() == "edge_color";
    };
    std::copy_if(node.children.begin(), node.children.end(), std::back_inserter(artistic.children),
                 isArtistic);
    std::erase_if(node.children, isArtistic);
    connectInput(node, "ior", "color3", ior, "ior");
    connectInput(node, "extinction", "color3", ior, "extinction");
    more.push_back(std::move(artistic));
  }
  const Element* interior = old == "dielectric_btdf" ? node.child("input", "interior") : nullptr;
  const Element* base = interior != nullptr ? interior : node.child("input", "base");
  if (base == nullptr) return;
  // What lay below is a layer's.
  Element layer = nodeAt(node.place, "layer", name, "BSDF");
  Element below = *base;
  below.set("name", "base");
  const std::string inner(base->name());
  std::erase_if(node.children, [&](const Element& e) { return e.name() == inner || e.name() == "base"; });
  const std::string top = names.free(name + "_top");
  connectInput(layer, "top", "BSDF", top);
  layer.children.push_back(std::move(below));
  Element moved = std::exchange(node, std::move(layer));
  moved.set("name", top);
  more.push_back(std::move(moved));
}

/// Materials that refer to shaders, as surfaces and materials of these.
class Materials37 {
public:
  Materials37(Element& root, size_t first, Diagnostics& said) : root_(root), first_(first), said_(said) {
    for (const Element& child : root.children) {
      names_.take(std::string(child.name()));
      if (child.category == "material" || child.category == "nodedef") named_.emplace(child.name(), &child);
    }
  }

  void run() {
    std::vector<std::pair<size_t, std::vector<Element>>> materials;
    for (size_t i = first_; i < root_.children.size(); ++i) {
      if (root_.children[i].category == "material") materials.emplace_back(i, refsOf(root_.children[i], 0));
    }
    for (auto& [place, refs] : materials) material(root_.children[place], std::move(refs));
    for (Element& one : more_) root_.children.push_back(std::move(one));
  }

private:
  const Element* named(std::string_view category, std::string_view name) const {
    const auto it = named_.find(name);
    return it == named_.end() || it->second->category != category ? nullptr : it->second;
  }

  /// Those of what it inherits from, with its own values over them.
  std::vector<Element> refsOf(const Element& material, size_t depth) {
    constexpr size_t kDeepest = 16;
    constexpr size_t kMostCopied = size_t{1} << 20;
    std::string_view base = material.get("inherit");
    for (const Element& old : material.children) {
      if (old.category == "materialinherit") base = old.get("material");
    }
    std::vector<Element> refs;
    const Element* from = base.empty() ? nullptr : named("material", base);
    if (from != nullptr && depth < kDeepest) refs = refsOf(*from, depth + 1);
    std::map<std::string, size_t> places;
    for (size_t i = 0; i < refs.size(); ++i) places.emplace(refs[i].name(), i);
    for (const Element& own : material.children) {
      if (own.category != "shaderref") continue;
      copied_ += 1 + own.children.size();
      if (copied_ > kMostCopied) {
        addBoundedOnce(said_, {"xml-too-many",
                               Severity::Error,
                               own.place,
                               fmt::format("the materials inherit more than {} elements", kMostCopied),
                               {},
                               {}});
        return {};
      }
      const auto [at, fresh] = places.try_emplace(std::string(own.name()), refs.size());
      if (fresh) {
        refs.push_back(own);
        continue;
      }
      Element& had = refs[at->second];
      for (const auto& [name, value] : own.attributes) had.set(name, value);
      std::set<std::string_view> names;
      for (const Element& input : own.children) names.insert(input.name());
      std::erase_if(had.children, [&](const Element& e) { return names.contains(e.name()); });
      had.children.insert(had.children.end(), own.children.begin(), own.children.end());
    }
    return refs;
  }

  std::string categoryOf(const Element& ref) const {
    if (!ref.get("node").empty()) return std::string(ref.get("node"));
    const std::string_view nodedef = ref.get("nodedef");
    const Element* known = named("nodedef", nodedef);
    if (known != nullptr) return std::string(known->get("node"));
    constexpr std::string_view kBefore = "ND_", kBehind = "_surfaceshader";
    if (nodedef.starts_with(kBefore) && nodedef.ends_with(kBehind))
      return std::string(nodedef.substr(kBefore.size(), nodedef.size() - kBefore.size() - kBehind.size()));
    return {};
  }

  void material(Element& element, std::vector<Element> refs) {
    Element made = nodeAt(element.place, "surfacematerial", element.name(), "material");
    for (Element& ref : refs) {
      const std::string category = categoryOf(ref);
      if (category.empty()) {
        addBounded(said_, {"not-upgraded",
                           Severity::Error,
                           ref.place,
                           fmt::format("the shaderref {} does not say which node it is", quote(ref.name())),
                           "its attribute \"node\" names one, such as standard_surface",
                           {}});
        continue;
      }
      const std::string type = category == "displacement" ? "displacementshader"
                               : category == "volume"     ? "volumeshader"
                                                          : "surfaceshader";
      Element shader = nodeAt(ref.place, category, names_.free(std::string(ref.name())), type);
      shader.children = std::move(ref.children);
      connectInput(made, type, type, shader.name());
      more_.push_back(std::move(shader));
    }
    if (const std::string* shown = element.find("uiname")) made.set("uiname", *shown);
    element = std::move(made);
  }

  Element& root_;
  size_t first_;
  Diagnostics& said_;
  NameSet names_;
  std::map<std::string, const Element*, std::less<>> named_;  ///< materials and definitions
  size_t copied_ = 0;
  std::vector<Element> more_;
};

void scopeTo38(Element& scope, size_t first, int minor) {
  NameSet names;
  for (const Element& child : scope.children) names.take(std::string(child.name()));
  std::vector<Element> more;
  for (size_t i = first; i < scope.children.size(); ++i) {
    Element& child = scope.children[i];
    if (child.category == "nodegraph") scopeTo38(child, 0, minor);
    if (minor <= 36) from36(child);
    from37(child, names, more);
  }
  for (Element& one : more) scope.children.push_back(std::move(one));
}

}  // namespace

void upgradeTo38(Element& root, size_t first, int minor, Diagnostics& said) {
  for (size_t i = first; i < root.children.size(); ++i) renameAll(root.children[i], false);
  scopeTo38(root, first, minor);
  Materials37(root, first, said).run();
}

}  // namespace lacquer::materialx
