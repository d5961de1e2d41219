#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>

#include "mtlx/looks.h"
#include "mtlx/models.h"
#include "mtlx/said.h"
#include "support/text.h"

namespace lacquer::materialx {

namespace {

constexpr size_t kMostVariants = 4096;           ///< materials of a document that variants make
constexpr size_t kMostCopied = size_t{1} << 18;  ///< elements of these
constexpr size_t kMostPairs = size_t{1} << 20;   ///< variants and materials that are looked at

/// Makes the materials that variants ask for.
class Variants {
public:
  Variants(Element& document, Diagnostics& said);
  VariantMaterials make();

private:
  /// A material, and where its values stand.
  struct Subject {
    const Element* material = nullptr;
    const Element* shader = nullptr;  ///< null where it has none, which is said where it is read
    const Element* graph = nullptr;   ///< that the shader stands in; null for none
    /// Categories and names of inputs and tokens: of the shader, of its graph and of graphs that it takes.
    std::set<std::pair<std::string_view, std::string_view>> names;
  };
  /// A variantset, and which surfaces it is for.
  struct Set {
    const Element* element = nullptr;
    Strings nodes, definitions;
    bool used = false;
  };
  struct Chosen {
    Set* set = nullptr;
    const Element* variant = nullptr;
    std::string name() const { return fmt::format("{}/{}", set->element->name(), variant->name()); }
  };
  struct Wanted {
    const Subject* subject = nullptr;
    std::vector<Chosen> chosen;
    std::string name;
  };

  void subject(const Element& material);
  void check(const Element& set);
  void assigned(const Element& at, bool loud, std::vector<Chosen>& to);
  void ofLooks();
  void ofSets();
  std::string want(const Element& at, const Subject& subject, const std::vector<Chosen>& chosen);
  bool isFor(const Set& set, const Element& shader) const;
  bool hasSomething(const Subject& subject, const Chosen& chosen, bool defaults) const;
  void portsOf(const Element& definitions);
  const Element* named(std::string_view name) const;
  void add(const Wanted& wanted);
  static bool apply(const std::vector<Chosen>& chosen, Element& to, bool surface);

  Element& document_;
  Said say_;
  ByName nodes_, nodedefs_;
  std::multimap<std::string_view, std::string_view> tokens_;  ///< of definitions, by their nodes
  /// Inputs of definitions, by their nodes.
  std::map<std::string_view, std::set<std::string_view>> ports_;
  std::vector<Subject> subjects_;
  std::map<std::string_view, const Subject*> by_name_;
  std::vector<Set> sets_;
  std::map<std::string_view, Set*> sets_by_name_;
  std::vector<Wanted> wanted_;
  std::set<std::string> known_;
  std::vector<Element> more_;
  size_t copied_ = 0;
  bool too_many_ = false;
  VariantMaterials result_;
};

Variants::Variants(Element& document, Diagnostics& said)
    : document_(document), say_(said), nodedefs_(namesOf(document, "nodedef")) {
  constexpr std::string_view kOthers[] = {"input",          "output",     "token",    "nodedef",
                                          "look",           "collection", "geominfo", "variantset",
                                          "implementation", "lookgroup"};
  for (const Element& one : document.children) {
    if (std::find(std::begin(kOthers), std::end(kOthers), one.category) == std::end(kOthers))
      nodes_.try_emplace(one.name(), &one);
    for (const Element& port : one.children)
      if (one.category == "nodedef" && port.category == "token")
        tokens_.emplace(withoutNamespace(one.get("node")), port.name());
    if (one.category == "variantset")
      sets_.push_back({&one, geometryNames(one.get("node")), geometryNames(one.get("nodedef")), false});
  }
  if (sets_.empty()) return;
  portsOf(document);
  portsOf(surfaceModels());
  ports_["surface_unlit"] = {"emission", "emission_color", "transmission", "transmission_color", "opacity"};
  for (Set& set : sets_) sets_by_name_.try_emplace(set.element->name(), &set);
  for (const Element& one : document.children) {
    if (one.category == "surfacematerial") subject(one);
  }
  for (const Subject& one : subjects_) by_name_.try_emplace(one.material->name(), &one);
}

/// A node or nodegraph beside the materials.
const Element* Variants::named(std::string_view name) const {
  const auto it = nodes_.find(name);
  return it == nodes_.end() ? nullptr : it->second;
}

void Variants::subject(const Element& material) {
  Subject& made = subjects_.emplace_back();
  made.material = &material;
  const Element* in = material.child("input", "surfaceshader");
  if (in == nullptr) return;
  const Element* found = named(in->get(in->find("nodegraph") != nullptr ? "nodegraph" : "nodename"));
  if (found == nullptr) return;
  if (found->category == "nodegraph") {
    made.graph = found;
    std::string_view name;
    for (const Element& output : found->children) {
      const bool wanted = in->get("output").empty() || output.name() == in->get("output");
      if (output.category == "output" && wanted && name.empty()) name = output.get("nodename");
    }
    for (const Element& node : found->children) {
      if (!name.empty() && node.name() == name && node.category != "input" && node.category != "output")
        made.shader = &node;
    }
  } else {
    made.shader = found;
  }
  if (made.shader == nullptr) return;
  std::vector<const Element*> owners{made.shader};
  if (made.graph != nullptr) owners.push_back(made.graph);
  for (const Element& input : made.shader->children) {
    if (made.graph != nullptr || input.category != "input") continue;
    const Element* graph = named(input.get(input.find("nodegraph") != nullptr ? "nodegraph" : "nodename"));
    if (graph != nullptr && graph->category == "nodegraph") owners.push_back(graph);
  }
  for (const Element* owner : owners) {
    for (const Element& one : owner->children) {
      if (one.category == "input" || one.category == "token") made.names.emplace(one.category, one.name());
    }
  }
  // Tokens of its definition, which it need not say.
  const auto [first, last] = tokens_.equal_range(withoutNamespace(made.shader->category));
  for (auto it = first; it != last; ++it) made.names.emplace("token", it->second);
}

/// Takes the inputs of definitions, which their nodes need not say.
void Variants::portsOf(const Element& definitions) {
  for (const Element& one : definitions.children) {
    if (one.category != "nodedef") continue;
    std::set<std::string_view>& ports = ports_[withoutNamespace(one.get("node"))];
    for (const Element& port : one.children)
      if (port.category == "input") ports.insert(port.name());
  }
}

/// Whether a variantset is for a surface: it may name nodes, or definitions of such.
bool Variants::isFor(const Set& set, const Element& shader) const {
  if (set.nodes.empty() && set.definitions.empty()) return true;
  const std::string_view kind = withoutNamespace(shader.category);
  const auto is = [&](std::string_view node) {
    return node == shader.name() || node == shader.category || node == kind;
  };
  if (std::any_of(set.nodes.begin(), set.nodes.end(), is)) return true;
  return std::any_of(set.definitions.begin(), set.definitions.end(), [&](const std::string& name) {
    if (name == shader.get("nodedef") || name.starts_with("ND_" + shader.category + "_surfaceshader"))
      return true;
    const auto nodedef = nodedefs_.find(name);
    return nodedef != nodedefs_.end() && withoutNamespace(nodedef->second->get("node")) == kind;
  });
}

/// Gives inputs and tokens the values of the variants; true where there was one. A surface has inputs and
/// tokens that it does not list.
bool Variants::apply(const std::vector<Chosen>& all, Element& to, bool surface) {
  bool any = false;
  for (const Chosen& chosen : all) {
    for (const Element& value : chosen.variant->children) {
      if ((value.category != "input" && value.category != "token") || value.find("value") == nullptr)
        continue;
      const auto own = std::find_if(to.children.begin(), to.children.end(), [&](const Element& one) {
        return one.category == value.category && one.name() == value.name();
      });
      any = any || own != to.children.end();
      if (own != to.children.end()) {
        *own = value;
      } else if (surface) {
        to.children.push_back(value);
        to.children.back().set(kOfVariant, chosen.name());
      }
    }
  }
  return any;
}

/// Whether a material has an input or a token of a variant's names. `defaults`: or leaves one at its default.
bool Variants::hasSomething(const Subject& subject, const Chosen& chosen, bool defaults) const {
  if (subject.shader == nullptr || !isFor(*chosen.set, *subject.shader)) return false;
  if (!chosen.set->nodes.empty() || !chosen.set->definitions.empty()) return true;
  const auto ports = ports_.find(withoutNamespace(subject.shader->category));
  const std::vector<Element>& values = chosen.variant->children;
  return std::any_of(values.begin(), values.end(), [&](const Element& value) {
    if (value.find("value") == nullptr) return false;
    return subject.names.contains({value.category, value.name()}) ||
           (defaults && value.category == "input" && ports != ports_.end() &&
            ports->second.contains(value.name()));
  });
}

void Variants::check(const Element& set) {
  std::set<std::string_view> names;
  for (const Element& variant : set.children) {
    if (variant.category != "variant") {
      say_(variant, Severity::Warning, "unknown-element",
           fmt::format("a variantset has no {}", quote(variant.category)), "it has \"variant\"");
      continue;
    }
    if (!names.insert(variant.name()).second)
      say_(variant, Severity::Error, "duplicate-name",
           fmt::format("{} has two variants {}", quote(set.name()), quote(variant.name())),
           "the first one counts");
    for (const Element& value : variant.children) {
      if (value.category != "input" && value.category != "token")
        say_(value, Severity::Warning, "unknown-element",
             fmt::format("a variant has no {}", quote(value.category)), "it has \"input\" and \"token\"");
      else if (value.find("value") == nullptr)
        say_(value, Severity::Error, "variant-connected",
             fmt::format("{} of the variant {} has no value", quote(value.name()), quote(variant.name())),
             "a variant has values, and connects nothing");
    }
  }
}

/// The variants that the children of a look or of an assignment choose.
void Variants::assigned(const Element& at, bool loud, std::vector<Chosen>& to) {
  for (const Element& one : at.children) {
    if (one.category != "variantassign") continue;
    const auto found = sets_by_name_.find(one.get("variantset"));
    Set* set = found == sets_by_name_.end() ? nullptr : found->second;
    const Element* variant = set == nullptr ? nullptr : set->element->child("variant", one.get("variant"));
    if (set != nullptr) set->used = true;
    if (variant != nullptr) {
      to.push_back({set, variant});
    } else if (loud && set == nullptr) {
      const std::string_view name = one.get("variantset");
      say_(one, Severity::Error, "no-such-variant",
           fmt::format("the document has no variantset {}", quote(name)),
           say_.meant(document_, "variantset", name));
    } else if (loud) {
      const std::string_view name = one.get("variant");
      say_(one, Severity::Error, "no-such-variant",
           fmt::format("{} has no variant {}", quote(set->element->name()), quote(name)),
           say_.meant(*set->element, "variant", name));
    }
  }
}

/// The name of the material with these values; empty where none is for it.
std::string Variants::want(const Element& at, const Subject& subject, const std::vector<Chosen>& chosen) {
  Wanted wanted{&subject, {}, std::string(subject.material->name())};
  if (subject.shader == nullptr) return {};
  for (const Chosen& one : chosen) {
    if (!isFor(*one.set, *subject.shader)) continue;
    // Of a set that is chosen from twice the later choice holds, in its place.
    std::erase_if(wanted.chosen, [&](const Chosen& before) { return before.set == one.set; });
    wanted.chosen.push_back(one);
  }
  if (wanted.chosen.empty()) return {};
  for (const Chosen& one : wanted.chosen) wanted.name += "/" + one.name();
  std::string name = wanted.name;
  if (!known_.insert(name).second) return name;
  copied_ +=
      countOfElements(*subject.shader) + (subject.graph == nullptr ? 0 : countOfElements(*subject.graph));
  for (const Element& input : subject.shader->children) {
    const std::string* graph = input.find("nodegraph");
    const Element* from = graph == nullptr ? nullptr : named(*graph);
    if (from != nullptr) copied_ += countOfElements(*from);
  }
  if (too_many_) return {};
  if (wanted_.size() == kMostVariants || copied_ > kMostCopied) {
    say_(at, Severity::Error, "too-many",
         fmt::format("variants make more than {} materials, or {} elements", kMostVariants, kMostCopied));
    too_many_ = true;
    return {};
  }
  wanted_.push_back(std::move(wanted));
  return name;
}

/// What looks assign.
void Variants::ofLooks() {
  size_t pairs = 0;
  const LookChains chains(document_);
  for (const Element& look : document_.children) {
    if (look.category != "look") continue;
    const std::vector<const Element*> chain = chains.of(look);
    std::vector<Chosen> of_all;
    for (const Element* one : chain) assigned(*one, one == &look, of_all);
    size_t place = 0;
    for (const Element* one : chain) {
      for (const Element& assignment : one->children) {
        if (too_many_ || ++pairs > kMostPairs) return;
        if (assignment.category != "materialassign") continue;
        std::vector<Chosen> chosen = of_all;
        assigned(assignment, one == &look, chosen);
        const auto subject = by_name_.find(assignment.get("material"));
        const size_t at = place++;
        if (subject == by_name_.end() || chosen.empty()) continue;
        std::string name = want(assignment, *subject->second, chosen);
        if (!name.empty()) result_.assigned[{std::string(look.name()), at}] = std::move(name);
      }
    }
  }
}

/// What no look assigns: each variant alone.
void Variants::ofSets() {
  size_t pairs = 0;
  for (size_t i = 0; i < sets_.size(); ++i) {
    if (sets_[i].used) continue;
    for (const Element& variant : sets_[i].element->children) {
      if (variant.category != "variant") continue;
      bool any = false;
      // Materials that say what it changes are meant, and without one those that leave it at its default.
      for (const bool defaults : {false, true}) {
        for (const Subject& subject :
             any ? std::span<const Subject>() : std::span<const Subject>(subjects_)) {
          if (++pairs > kMostPairs)
            return say_(variant, Severity::Error, "too-many",
                        fmt::format("there are more than {} pairs of a variant and a material", kMostPairs));
          const Chosen chosen{&sets_[i], &variant};
          if (!hasSomething(subject, chosen, defaults)) continue;
          any = true;
          (void)want(variant, subject, {chosen});
          if (too_many_) return;
        }
      }
      if (!any)
        say_(variant, Severity::Warning, "unused-variant",
             fmt::format("no material has what the variant {} changes", quote(variant.name())),
             "its names are those of inputs and tokens of a surface, or of a nodegraph that it takes");
    }
  }
}

/// The elements of one material with its values.
void Variants::add(const Wanted& wanted) {
  const Subject& of = *wanted.subject;
  const std::string behind = wanted.name.substr(of.material->name().size());
  const auto renamed = [&](const Element& from) {
    Element made = from;
    made.set("name", std::string(from.name()) + behind);
    return made;
  };
  const auto retarget = [&](Element& input) {
    const std::string_view attribute = input.find("nodegraph") != nullptr ? "nodegraph" : "nodename";
    input.set(attribute, std::string(input.get(attribute)) + behind);
  };
  Element material = renamed(*of.material);
  if (!material.get("uiname").empty()) material.set("uiname", std::string(material.get("uiname")) + behind);
  for (Element& input : material.children) {
    if (input.category == "input" && input.name() == "surfaceshader") retarget(input);
  }
  if (of.graph != nullptr) {
    Element whole = renamed(*of.graph);
    apply(wanted.chosen, whole, false);
    for (Element& node : whole.children) {
      if (node.name() == of.shader->name() && node.category == of.shader->category)
        apply(wanted.chosen, node, true);
    }
    more_.push_back(std::move(whole));
  } else {
    Element surface = renamed(*of.shader);
    apply(wanted.chosen, surface, true);
    std::map<std::string_view, bool> graphs;  // whether a nodegraph has some of the values
    for (Element& input : surface.children) {
      const Element* from = named(input.get(input.find("nodegraph") != nullptr ? "nodegraph" : "nodename"));
      if (input.category != "input" || from == nullptr || from->category != "nodegraph") continue;
      const auto [known, fresh] = graphs.try_emplace(from->name(), false);
      if (fresh) {
        Element whole = renamed(*from);
        known->second = apply(wanted.chosen, whole, false);
        if (known->second) more_.push_back(std::move(whole));
      }
      if (known->second) retarget(input);
    }
    more_.push_back(std::move(surface));
  }
  more_.push_back(std::move(material));
}

VariantMaterials Variants::make() {
  for (const Set& set : sets_) check(*set.element);
  if (sets_.empty()) {
    // Choices of what is not there are wrong all the same.
    for (const Element& look : document_.children) {
      std::vector<Chosen> none;
      if (look.category != "look") continue;
      assigned(look, true, none);
      for (const Element& one : look.children) {
        if (one.category == "materialassign") assigned(one, true, none);
      }
    }
    return {};
  }
  ofLooks();
  ofSets();
  if (too_many_) return {};
  for (const Wanted& wanted : wanted_) {
    add(wanted);
    VariantOf& one =
        result_.made.emplace_back(VariantOf{wanted.name, std::string(wanted.subject->material->name()), {}});
    for (const Chosen& chosen : wanted.chosen) one.variants.push_back(chosen.name());
  }
  for (Element& one : more_) document_.children.push_back(std::move(one));
  return std::move(result_);
}

}  // namespace

VariantMaterials addVariants(Element& document, Diagnostics& said) { return Variants(document, said).make(); }

}  // namespace lacquer::materialx
