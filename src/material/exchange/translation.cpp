#include "exchange/translation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "exchange/formulas.h"
#include "materialx/patterns.h"
#include "mtlx/looks.h"
#include "mtlx/values.h"
#include "support/text.h"

namespace lacquer::exchange {

using materialx::Element;

namespace {
using namespace formulas;

/// MaterialX's standard_surface_to_open_pbr_surface.
void toOpenPbr(Formulas& f) {
  const Term coat = f.get("coat");
  const Term coat_color = f.get("coat_color");
  const Term metalness = f.get("metalness");
  f.put("base_weight", f.get("base"), 1);
  f.put("base_color", f.multiply(f.get("base_color"), f.mix(coat_color, grey(1), coat)), 0.8);
  f.put("base_diffuse_roughness", f.get("diffuse_roughness"), 0);
  f.put("base_metalness", metalness, 0);
  f.put("specular_weight", f.ifGreater(metalness, number(0), number(1), f.get("specular")), 1);
  const Term specular_color = f.get("specular_color");
  f.put("specular_color", f.ifEqual(number(0), f.sum(specular_color, 1), grey(1), specular_color), 1);
  f.put("specular_roughness", f.get("specular_roughness"), 0.3);
  f.put("specular_ior", f.get("specular_IOR"), 1.5);
  f.put("specular_roughness_anisotropy", f.get("specular_anisotropy"), 0);
  f.put("transmission_weight", f.get("transmission"), 0);
  f.put("transmission_color", f.get("transmission_color"), 1);
  f.put("transmission_depth", f.get("transmission_depth"), 0);
  f.put("transmission_scatter", f.get("transmission_scatter"), 0);
  f.put("transmission_scatter_anisotropy", f.get("transmission_scatter_anisotropy"), 0);
  f.put("transmission_dispersion_scale", f.get("transmission_dispersion"), 0);
  const Term subsurface = f.get("subsurface");
  const Term radius = f.get("subsurface_scale");
  const Term radius_scale = f.get("subsurface_radius");
  f.put("subsurface_weight", subsurface, 0);
  const Term subsurface_color = f.get("subsurface_color");
  const Term anisotropy = f.get("subsurface_anisotropy");
  if (!subsurface.is(0)) {
    f.put("subsurface_color", subsurface_color, 0.8);
    f.put("subsurface_radius", radius, 1);
    f.put("subsurface_radius_scale", radius_scale, Term{"color3", {1, 0.5, 0.25}});
    f.put("subsurface_scatter_anisotropy", anisotropy, 0);
  }
  const Term sheen = f.get("sheen");
  const Term sheen_color = f.get("sheen_color");
  const Term sheen_roughness = f.get("sheen_roughness");
  if (!sheen.is(0)) {
    f.put("fuzz_weight", sheen, 0);
    f.put("fuzz_color", sheen_color, 1);
    f.put("fuzz_roughness", f.power(sheen_roughness, 0.4), 0.5);
  }
  const Term weight = f.ifGreater(f.multiply(coat, metalness), number(0), number(0), coat);
  const Term coat_roughness = f.get("coat_roughness");
  const Term coat_anisotropy = f.get("coat_anisotropy");
  const Term coat_ior = f.get("coat_IOR");
  const Term darkening = f.get("coat_affect_roughness");
  if (!weight.is(0)) {
    f.put("coat_weight", weight, 0);
    f.put("coat_color", coat_color, 1);
    f.put("coat_roughness", coat_roughness, 0);
    f.put("coat_roughness_anisotropy", coat_anisotropy, 0);
    f.put("coat_ior", coat_ior, 1.6);
    f.put("coat_darkening", darkening, 1);
    f.pass("coat_normal", "geometry_coat_normal");
  }
  const Term thickness = f.multiply(f.get("thin_film_thickness"), number(0.001));
  const Term film_ior = f.get("thin_film_IOR");
  if (!thickness.is(0)) {
    f.put("thin_film_weight", f.ifGreater(thickness, number(0), number(1), number(0)), 0);
    f.put("thin_film_thickness", thickness, 0.5);
    f.put("thin_film_ior", film_ior, 1.4);
  }
  f.put("emission_luminance", f.get("emission"), 0);
  f.put("emission_color", f.get("emission_color"), 1);
  f.put("geometry_opacity", f.channel(f.opacity("red"), 0), 1);
  f.put("geometry_thin_walled", f.get("thin_walled"), 0);
  f.pass("normal", "geometry_normal");
  f.pass("tangent", "geometry_tangent");
}

/// MaterialX's standard_surface_to_gltf_pbr.
void toGltfPbr(Formulas& f) {
  const Term coat = f.get("coat");
  const Term coat_color = f.get("coat_color");
  const Term has_color = f.sum(coat_color, 1);
  const Term scaled = f.multiply(f.get("base_color"), f.get("base"));
  const Term mixed = f.multiply(scaled, f.mix(coat_color, grey(1), coat));
  const Term base = f.ifEqual(has_color, number(0), scaled, mixed);
  const Term depth = f.get("transmission_depth");
  const Term transmission = f.get("transmission");
  const Term transmission_color = f.get("transmission_color");
  const Term tint = f.ifGreater(depth, number(0), grey(1), transmission_color);
  f.put("base_color", f.mix(tint, base, f.multiply(transmission, transmission)), 1);
  f.put("metallic", f.get("metalness"), 1);
  // pbrlib's roughness_anisotropy: alpha across and along.
  const Term roughness = f.get("specular_roughness");
  const Term stretch = f.get("specular_anisotropy");
  const Term rotation = f.get("specular_rotation");
  if (stretch.is(0)) {
    f.put("roughness", roughness, 1);
  } else {
    const Term aspect = f.root(f.minus(number(1), f.least(stretch, number(0.98))));
    const Term alpha = f.multiply(roughness, roughness);
    const Term across = f.least(f.divide(alpha, aspect), number(1));
    const Term along = f.multiply(alpha, aspect);
    const Term rest = f.minus(number(1), along);
    f.put("roughness", f.root(along), 1);
    f.put("anisotropy_strength",
          f.ifGreater(rest, number(0), f.root(f.divide(f.minus(across, along), rest)), number(0)), 0);
    f.put("anisotropy_rotation", f.multiply(rotation, number(-6.283)), 0);
  }
  f.put("specular", f.get("specular"), 1);
  f.put("specular_color", f.get("specular_color"), 1);
  f.put("ior", f.get("specular_IOR"), 1.5);
  f.put("transmission", transmission, 0);
  const Term thin = f.get("thin_walled");
  const Term abbe = f.get("transmission_dispersion");
  if (!transmission.is(0)) {
    f.put("thickness", thin.is(1) ? number(0) : number(1), 0);
    if (!depth.is(0)) f.put("attenuation_distance", depth);
    f.put("attenuation_color", f.ifGreater(depth, number(0), transmission_color, grey(1)), 1);
    f.put("dispersion", f.ifEqual(abbe, number(0), number(0), f.divide(number(20), abbe)), 0);
  }
  const Term sheen = f.get("sheen");
  const Term sheen_color = f.get("sheen_color");
  const Term sheen_roughness = f.get("sheen_roughness");
  if (!sheen.is(0)) {
    f.put("sheen_color", f.multiply(sheen_color, sheen), 0);
    f.put("sheen_roughness", f.root(f.ifGreater(sheen, number(0), sheen_roughness, number(0))), 0);
  }
  const Term coat_roughness = f.get("coat_roughness");
  if (!coat.is(0)) {
    const Term weighted = f.sum(f.multiply(coat_color, coat), 1.0 / 3);
    f.put("clearcoat", f.ifEqual(has_color, number(0), coat, weighted), 0);
    f.put("clearcoat_roughness", coat_roughness, 0);
    f.pass("coat_normal", "clearcoat_normal");
  }
  const Term thickness = f.get("thin_film_thickness");
  const Term film_ior = f.get("thin_film_IOR");
  if (!thickness.is(0)) {
    f.put("iridescence", f.ifGreater(thickness, number(0), number(1), number(0)), 0);
    f.put("iridescence_ior", f.ifGreater(thickness, number(0), film_ior, number(1.3)), 1.3);
    f.put("iridescence_thickness", thickness, 100);
  }
  const Term emission = f.get("emission");
  const Term emission_color = f.get("emission_color");
  if (!emission.is(0)) {
    f.put("emissive", emission_color, 0);
    f.put("emissive_strength", emission, 1);
  }
  const Term alpha = f.luminance(f.opacity("luminance"));
  // White sums to 1 but for the last bits.
  if (!alpha.known() || std::abs(alpha.value[0] - 1) > 1e-9) {
    f.put("alpha", alpha, 1);
    Term mode = number(2);
    mode.type = "integer";
    f.put("alpha_mode", mode);
  }
  f.pass("normal", "normal");
  f.pass("tangent", "tangent");
}

void translateBy(Formulas& formulas, std::string_view as) {
  if (as == "gltf_pbr")
    toGltfPbr(formulas);
  else
    toOpenPbr(formulas);
}

bool isAlike(const Element& a, const Element& b) {
  return a.category == b.category && a.attributes == b.attributes &&
         std::equal(a.children.begin(), a.children.end(), b.children.begin(), b.children.end(), isAlike);
}

const Element* named(const std::vector<Element>& list, std::string_view name) {
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const Element& one) { return one.name() == name; });
  return found == list.end() ? nullptr : &*found;
}

/// Whether two inputs are the same, with what they take of the nodes beside each.
bool isSame(const Element& a, const std::vector<Element>& beside_a, const Element& b,
            const std::vector<Element>& beside_b) {
  const Element* from_a = named(beside_a, a.get("nodename"));
  const Element* from_b = named(beside_b, b.get("nodename"));
  if (a.category != b.category || a.attributes != b.attributes || !from_a != !from_b) return false;
  if (from_a == nullptr) return true;
  return from_a->category == from_b->category &&
         std::equal(from_a->children.begin(), from_a->children.end(), from_b->children.begin(),
                    from_b->children.end(), [&](const Element& one, const Element& other) {
                      return isSame(one, beside_a, other, beside_b);
                    });
}

/// What variants change of the surfaces, as changes of what these become: each is translated with their
/// values.
class VariantTranslation {
public:
  VariantTranslation(const Element& root, std::string_view as, Diagnostics& said) : as_(as), said_(said) {
    Diagnostics elsewhere;  // said where the document is read
    units_.add(root, elsewhere);
    for (const Element& child : root.children)
      if (child.category == "variantset") sets_.push_back(child);
    for (const Element& set : sets_)
      for (const Element& variant : set.children)
        if (variant.category == "variant") {
          changed_.try_emplace(&variant);
          by_name_.try_emplace(nameOf(set, variant), &variant);
        }
    if (any()) findUses(root);
  }
  bool any() const { return !sets_.empty(); }
  const materialx::Units& units() const { return units_; }

  /// `to`, made by `formulas` with the nodes beside it; `names` are those before that. `element`: the
  /// surface, or the nodegraph that it stands in.
  void surface(const Element& from, std::string_view element, Element& to, const Formulas& formulas,
               const std::vector<Element>& beside, const materialx::NameSet& names);
  void finish(Element& root);

private:
  struct Changed {
    std::optional<std::string> surface;  ///< the first that it changes
    std::vector<Element> inputs;
  };
  using Names = std::set<std::string, std::less<>>;

  static bool isInput(const Element& value) {
    const auto is = [&](const Given& one) { return one.name == value.name(); };
    return value.category == "input" && value.find("value") != nullptr &&
           std::any_of(std::begin(kInputs), std::end(kInputs), is);
  }
  static bool namesSurfaces(const Element& set) {
    return !set.get("node").empty() || !set.get("nodedef").empty();
  }
  static std::string nameOf(const Element& set, const Element& variant) {
    return fmt::format("{}/{}", set.name(), variant.name());
  }
  void findUses(const Element& root);
  bool isFor(const Element& set, const Element& variant, const Element& surface,
             std::string_view element) const;
  std::vector<Element> changes(const Element& set, const Element& variant, const Element& from,
                               const Element& to, const Formulas& formulas,
                               const std::vector<Element>& beside, const materialx::NameSet& names,
                               std::vector<Element>& more);
  static void apply(const Element& variant, Element& surface);
  void tellOthers(const Element& set, const Element& variant);
  void tellTogether(const Strings& variants, const Element& from, const Element& to,
                    const std::vector<Element>& beside, const materialx::NameSet& names);
  void warn(const Element& at, std::string message, std::string help) {
    addBounded(said_, {"not-said", Severity::Warning, at.place, std::move(message), std::move(help), {}});
  }
  void lost(const Element& at, std::string_view name) {
    warn(at, fmt::format("the variant {} has no value for {} of {}", quote(at.name()), name, as_),
         "what it changes there is lost");
  }

  std::string_view as_;
  Diagnostics& said_;
  materialx::Units units_;
  std::vector<Element> sets_;
  std::map<std::string, const Element*> by_name_;  ///< variants
  std::map<const Element*, Changed> changed_;      ///< looked up, never walked
  /// By a variant, "wetness/wet", and by its set: surfaces of materials with its values, or the nodegraphs
  /// that these stand in.
  std::map<std::string, Names, std::less<>> uses_;
  std::set<std::pair<std::string, Strings>> together_;  ///< several of one material, by the same names
  Names translated_;
};

/// Finds which surfaces each variant is for, as it is read.
void VariantTranslation::findUses(const Element& root) {
  Element read = root;
  Diagnostics elsewhere;
  const materialx::VariantMaterials made = materialx::addVariants(read, elsewhere);
  std::map<std::string_view, const Element*> materials;
  for (const Element& child : read.children)
    if (child.category == "surfacematerial") materials[child.name()] = &child;  // these are behind others
  for (const materialx::VariantOf& one : made.made) {
    const Element* input = materials.at(one.material)->child("input", "surfaceshader");
    if (input == nullptr) continue;
    // Called as it was, and behind that as what the material's name has got.
    const size_t behind = one.material.size() - one.of.size();
    std::string name(input->get(input->find("nodegraph") != nullptr ? "nodegraph" : "nodename"));
    name.resize(name.size() - std::min(name.size(), behind));
    if (one.variants.size() > 1) together_.emplace(name, one.variants);
    for (const std::string& variant : one.variants) {
      uses_[variant].insert(name);
      uses_[variant.substr(0, variant.find('/'))].insert(name);
    }
  }
}

bool VariantTranslation::isFor(const Element& set, const Element& variant, const Element& surface,
                               std::string_view element) const {
  if (std::none_of(variant.children.begin(), variant.children.end(), isInput)) return false;
  // What no material has changes the same as its set's others.
  for (const std::string& name : {nameOf(set, variant), std::string(set.name())}) {
    if (const auto uses = uses_.find(name); uses != uses_.end()) return uses->second.contains(element);
  }
  if (!namesSurfaces(set)) return true;
  for (const std::string& node : materialx::geometryNames(set.get("node")))
    if (node == surface.name() || node == kFrom) return true;
  for (const std::string& nodedef : materialx::geometryNames(set.get("nodedef")))
    if (nodedef == surface.get("nodedef") || nodedef.starts_with("ND_standard_surface_surfaceshader"))
      return true;
  return false;
}

void VariantTranslation::apply(const Element& variant, Element& surface) {
  for (const Element& value : variant.children) {
    if (!isInput(value)) continue;
    std::erase_if(surface.children, [&](const Element& one) { return one.name() == value.name(); });
    surface.children.push_back(value);
  }
}

/// What a variant of one surface is. `more`: inputs for that surface, which is as before with them.
std::vector<Element> VariantTranslation::changes(const Element& set, const Element& variant,
                                                 const Element& from, const Element& to,
                                                 const Formulas& formulas, const std::vector<Element>& beside,
                                                 const materialx::NameSet& names,
                                                 std::vector<Element>& more) {
  Element varied = from;
  apply(variant, varied);
  materialx::NameSet own_names = names;
  std::vector<Element> own_beside, inputs;
  Diagnostics own_said;
  Formulas own(varied, units_, own_names, own_beside, own_said);
  translateBy(own, as_);
  const std::vector<Element> made = own.finish(as_);
  for (Diagnostic& one : own_said) {
    const bool of_variant = std::any_of(variant.children.begin(), variant.children.end(),
                                        [&](const Element& value) { return value.place == one.place; });
    if (of_variant) addBounded(said_, std::move(one));
  }
  for (const Element& input : made) {
    const Element* before = named(to.children, input.name());
    const bool linked = input.find("value") == nullptr;
    if (before != nullptr && isSame(*before, beside, input, own_beside)) continue;
    if (linked)
      lost(variant, input.name());
    else
      inputs.push_back(input);
  }
  for (const Element& before : to.children) {
    const Element* by_default = formulas.byDefault(before.name());
    if (named(made, before.name()) != nullptr || (by_default != nullptr && isAlike(*by_default, before)))
      continue;
    if (by_default != nullptr)
      inputs.push_back(*by_default);
    else
      lost(variant, before.name());
  }
  // A variant is for what it changes something of: without an input it would be for no surface.
  if (namesSurfaces(set)) return inputs;
  const auto idle = std::find_if(own.defaults().begin(), own.defaults().end(),
                                 [&](const auto& one) { return named(made, one.first) == nullptr; });
  if (inputs.empty() && idle != own.defaults().end()) inputs.push_back(idle->second);
  for (const Element& input : inputs) {
    const Element* by_default = own.byDefault(input.name());
    const bool known = named(to.children, input.name()) != nullptr || named(more, input.name()) != nullptr;
    if (!known && by_default != nullptr) more.push_back(*by_default);
  }
  return inputs;
}

void VariantTranslation::surface(const Element& from, std::string_view element, Element& to,
                                 const Formulas& formulas, const std::vector<Element>& beside,
                                 const materialx::NameSet& names) {
  std::vector<Element> more;
  translated_.emplace(element);
  for (const Element& set : sets_) {
    for (const Element& variant : set.children) {
      if (variant.category != "variant" || !isFor(set, variant, from, element)) continue;
      std::vector<Element> inputs = changes(set, variant, from, to, formulas, beside, names, more);
      Changed& changed = changed_.at(&variant);
      if (!changed.surface) {
        changed = {std::string(from.name()), std::move(inputs)};
      } else if (!std::equal(inputs.begin(), inputs.end(), changed.inputs.begin(), changed.inputs.end(),
                             isAlike)) {
        warn(variant,
             fmt::format("the variant {} makes other changes of {} than of {}", quote(variant.name()),
                         quote(from.name()), quote(*changed.surface)),
             "those of the latter are written");
      }
    }
  }
  for (const auto& one : together_)
    if (one.first == element) tellTogether(one.second, from, to, beside, names);
  std::move(more.begin(), more.end(), std::back_inserter(to.children));
}

/// Variants of one material whose values go into the same input of the new surface: it has the last one's.
void VariantTranslation::tellTogether(const Strings& variants, const Element& from, const Element& to,
                                      const std::vector<Element>& beside, const materialx::NameSet& names) {
  Element varied = from;
  std::map<std::string_view, const Element*> written;
  for (const Element& input : to.children) written[input.name()] = &input;
  const Element* last = nullptr;
  for (const std::string& name : variants) {
    const Element& variant = *by_name_.at(name);
    const Changed& changed = changed_.at(&variant);
    if (!changed.surface) continue;
    apply(variant, varied);
    for (const Element& input : changed.inputs) written[input.name()] = &input;
    last = &variant;
  }
  if (last == nullptr) return;
  materialx::NameSet own_names = names;
  std::vector<Element> own_beside;
  Diagnostics elsewhere;
  Formulas own(varied, units_, own_names, own_beside, elsewhere);
  translateBy(own, as_);
  for (const Element& input : own.finish(as_)) {
    const auto is = written.find(input.name());
    const Element* found = is == written.end() ? own.byDefault(input.name()) : is->second;
    if (is != written.end()) written.erase(is);
    if (found != nullptr && isSame(*found, beside, input, own_beside)) continue;
    return warn(*last,
                fmt::format("the variants {} have no values for {} of {} together", fmt::join(variants, ", "),
                            input.name(), as_),
                "each has its own for the other values of the surface, and the last one holds");
  }
  for (const auto& [name, input] : written) {
    const Element* by_default = own.byDefault(name);
    if (by_default != nullptr && isAlike(*by_default, *input)) continue;
    return warn(*last,
                fmt::format("the variants {} have no values for {} of {} together", fmt::join(variants, ", "),
                            name, as_),
                "each has its own for the other values of the surface, and the last one holds");
  }
}

/// A variant that is for other surfaces, too, is written for those that were translated.
void VariantTranslation::tellOthers(const Element& set, const Element& variant) {
  const auto uses = uses_.find(nameOf(set, variant));
  if (uses == uses_.end()) return;
  for (const std::string& element : uses->second) {
    if (translated_.contains(element)) continue;
    warn(variant,
         fmt::format("the variant {} is for {}, too, which is no {}", quote(variant.name()), quote(element),
                     kFrom),
         fmt::format("it has the inputs that {} has become", quote(*changed_.at(&variant).surface)));
  }
}

void VariantTranslation::finish(Element& root) {
  size_t next = 0;
  for (Element& set : root.children) {
    if (set.category != "variantset") continue;
    const Element& read = sets_[next++];
    bool any = false;
    for (size_t i = 0; i < read.children.size(); ++i) {
      const auto changed = changed_.find(&read.children[i]);
      if (changed == changed_.end() || !changed->second.surface) continue;
      any = true;
      std::vector<Element>& values = set.children[i].children;
      std::erase_if(values, [&](const Element& one) {
        return isInput(one) ||
               (one.category == "input" && named(changed->second.inputs, one.name()) != nullptr);
      });
      values.insert(values.end(), changed->second.inputs.begin(), changed->second.inputs.end());
      tellOthers(read, read.children[i]);
    }
    for (const std::string_view attribute : {"node", "nodedef"}) {
      if (!any || set.find(attribute) == nullptr) continue;
      std::string list;
      for (const std::string& name : materialx::geometryNames(set.get(attribute))) {
        const bool kind = name == kFrom || name.starts_with("ND_standard_surface_surfaceshader");
        list += list.empty() ? "" : ", ";
        list += !kind ? name : name == kFrom ? std::string(as_) : fmt::format("ND_{}_surfaceshader", as_);
      }
      set.set(attribute, list);
    }
  }
}

size_t translateIn(Element& owner, std::string_view as, VariantTranslation& variants, Diagnostics& said) {
  size_t count = 0;
  materialx::NameSet names;
  for (const Element& child : owner.children) names.take(std::string(child.name()));
  std::vector<Element> children;
  for (Element& child : owner.children) {
    if (child.category == "nodegraph") count += translateIn(child, as, variants, said);
    if (child.category != kFrom) {
      children.push_back(std::move(child));
      continue;
    }
    ++count;
    std::vector<Element> beside;
    const materialx::NameSet before = variants.any() ? names : materialx::NameSet();
    Formulas formulas(child, variants.units(), names, beside, said);
    translateBy(formulas, as);
    Element made;
    made.category = as;
    made.place = child.place;
    made.attributes = {{"name", std::string(child.name())}, {"type", "surfaceshader"}};
    made.children = formulas.finish(as);
    const std::string_view element = owner.category == "nodegraph" ? owner.name() : child.name();
    variants.surface(child, element, made, formulas, beside, before);
    std::move(beside.begin(), beside.end(), std::back_inserter(children));
    children.push_back(std::move(made));
  }
  owner.children = std::move(children);
  return count;
}

/// `ours`: that there are formulas for, or that are of the kind already.
void countSurfaces(const Element& owner, std::string_view as, size_t& ours, size_t& others) {
  constexpr std::string_view kOthers[] = {"gltf_pbr",          "open_pbr_surface", "UsdPreviewSurface",
                                          "disney_principled", "surface_unlit",    "surface"};
  for (const Element& child : owner.children) {
    if (child.category == "nodegraph") countSurfaces(child, as, ours, others);
    if (child.category == kFrom || child.category == as) ++ours;
    if (child.category != as &&
        std::find(std::begin(kOthers), std::end(kOthers), child.category) != std::end(kOthers))
      ++others;
  }
}

}  // namespace

bool canTranslate(const Element& root, std::string_view as) {
  size_t ours = 0;
  size_t others = 0;
  countSurfaces(root, as, ours, others);
  return ours > 0 && others == 0;
}

size_t translateSurfaces(Element& root, std::string_view as, Diagnostics& said) {
  VariantTranslation variants(root, as, said);
  const size_t count = translateIn(root, as, variants, said);
  variants.finish(root);
  return count;
}

}  // namespace lacquer::exchange
