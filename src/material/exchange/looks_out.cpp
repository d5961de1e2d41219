#include "exchange/looks_out.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "mtlx/looks.h"
#include "mtlx/names.h"
#include "mtlx/said.h"
#include "support/text.h"

namespace lacquer::exchange {

using materialx::Element;

namespace {

constexpr size_t kMostInherited = 1 << 16;  ///< more is an error where looks are read

class LooksOut {
public:
  LooksOut(const Element& read, const material::Document& document, const std::vector<std::string>& names,
           const Moved& moved, Diagnostics& said)
      : source_(read), variants_(addVariantsTo(source_)), chains_(source_), moved_(moved), say_(said) {
    for (const materialx::VariantOf& one : variants_.made)
      made_.insert(one.variants.begin(), one.variants.end());
    size_t next = 0;  // the document's materials are in the order of the elements
    for (const Element& child : source_.children) {
      if (child.category != "surfacematerial") continue;
      const std::string_view shown = child.get("uiname").empty() ? child.name() : child.get("uiname");
      size_t found = next;
      while (found < names.size() && document.materials[found].name != shown) ++found;
      if (found == names.size()) continue;
      names_.try_emplace(child.name(), names[found]);
      next = found + 1;
    }
  }

  std::vector<Element> make() {
    std::vector<Element> made;
    for (const Element& child : source_.children) {
      if (child.category == "variantset") tell(child);
      if (!isOfGeometry(child)) continue;
      made.push_back(child.category == "look" ? look(child) : child);
      settle(made.back());
    }
    return made;
  }

private:
  static materialx::VariantMaterials addVariantsTo(Element& document) {
    Diagnostics elsewhere;  // said where the document is read
    return materialx::addVariants(document, elsewhere);
  }

  /// Prefixes are in the names, and files are named as seen from another folder.
  void settle(Element& element) const {
    std::erase_if(element.attributes, [](const auto& one) {
      return one.first == "fileprefix" || one.first == "geomprefix" ||
             (one.first == "colorspace" && one.second == "lin_rec709");
    });
    if (element.get("type") == "filename" && !element.get("value").empty())
      element.set("value", moved_(std::string(element.get("value"))));
    for (Element& child : element.children) settle(child);
  }

  void tell(const Element& set) {
    bool any = false;
    for (const Element& variant : set.children) {
      if (variant.category != "variant") continue;
      const std::string name = fmt::format("{}/{}", set.name(), variant.name());
      const bool made = made_.contains(name);
      any = any || made;
      if (!made)
        say_(variant, Severity::Warning, "not-said",
             fmt::format("the variant {} is of no material: it is lost", quote(name)),
             "a look assigns it, or a material has what it changes");
    }
    if (any)
      say_(set, Severity::Warning, "not-said",
           fmt::format("the new document has no variantset {}", quote(set.name())),
           "materials with the values of its variants are of their own");
  }

  /// Variants that a look chooses change what it inherits: it has that itself then.
  Element look(const Element& at) {
    const bool whole = !variants_.made.empty() && !at.get("inherit").empty();
    Element made = at;
    made.children.clear();
    if (whole)
      std::erase_if(made.attributes, [](const auto& attribute) { return attribute.first == "inherit"; });
    materialx::NameSet taken;
    size_t place = 0;
    for (const Element* one : whole ? chains_.of(at) : std::vector<const Element*>{&at}) {
      for (const Element& child : one->children) {
        if (child.category == "variantassign") continue;
        if (one != &at && ++inherited_ > kMostInherited) continue;
        Element kept = child;
        if (child.category == "materialassign" && !assign(at, place++, one == &at, kept)) continue;
        if (whole && !child.name().empty()) kept.set("name", taken.free(std::string(child.name())));
        made.children.push_back(std::move(kept));
      }
    }
    return made;
  }

  /// False where the material is not in the new document: it has an error.
  bool assign(const Element& look, size_t place, bool loud, Element& assignment) {
    std::erase_if(assignment.children, [](const Element& one) { return one.category == "variantassign"; });
    const auto variant = variants_.assigned.find({std::string(look.name()), place});
    const std::string_view material =
        variant == variants_.assigned.end() ? assignment.get("material") : std::string_view(variant->second);
    const auto found = names_.find(material);
    if (found != names_.end() && !found->second.empty()) {
      assignment.set("material", found->second);
      return true;
    }
    if (loud && found != names_.end())  // what the document has not is said where it is read
      say_(assignment, Severity::Warning, "not-said",
           fmt::format("the new document has no material {}", quote(material)),
           fmt::format("what the look {} assigns it to is lost", quote(look.name())));
    return false;
  }

  Element source_;
  materialx::VariantMaterials variants_;
  materialx::LookChains chains_;
  const Moved& moved_;
  materialx::Said say_;
  std::set<std::string> made_;  ///< variants that a material has
  size_t inherited_ = 0;
  std::map<std::string_view, std::string> names_;  ///< of the new document's materials, by the elements
};

}  // namespace

bool isOfGeometry(const Element& element) {
  constexpr std::string_view kKinds[] = {"collection", "geominfo", "propertyset", "look", "lookgroup"};
  return std::find(std::begin(kKinds), std::end(kKinds), element.category) != std::end(kKinds);
}

std::vector<Element> looksOf(const Element& read, const material::Document& document,
                             const std::vector<std::string>& names, const Moved& moved, Diagnostics& said) {
  return LooksOut(read, document, names, moved, said).make();
}

}  // namespace lacquer::exchange
