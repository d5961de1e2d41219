#include "mtlx/looks.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "lang/suggest.h"
#include "mtlx/said.h"
#include "support/text.h"

namespace lacquer::materialx {

namespace {

constexpr size_t kMostAssignments = 1 << 16;  ///< of a document's looks, with what they inherit

/// Whether an expression ends within brackets or braces, or closes what is not open.
bool isUnbalanced(std::string_view list) {
  char open = 0;
  for (const char c : list) {
    if (c == '[' || c == '{') {
      if (open != 0 && (open == '[' || c == '{')) return true;
      if (open == 0 || c == '{') open = c;
    } else if (c == ']' || c == '}') {
      if (open == '{' && c == ']') continue;  // of brackets within braces
      if (open != (c == ']' ? '[' : '{')) return true;
      open = 0;
    }
  }
  return open != 0;
}

/// Reads one document's looks.
class LooksReader {
public:
  LooksReader(const Element& document, const std::vector<std::string>& materials,
              const VariantMaterials& variants, Diagnostics& said)
      : document_(document), variants_(variants), say_(said), chains_(document) {
    for (size_t i = 0; i < materials.size(); ++i) numbers_.try_emplace(materials[i], static_cast<int>(i));
    for (const Element& one : document.children) {
      if (!one.name().empty()) by_name_.try_emplace({one.category, one.name()}, &one);
      if (one.category != "look" && one.category != "collection") others_.insert(one.name());
    }
  }

  Looks read();

private:
  const Element* find(std::string_view category, std::string_view name) const {
    const auto it = by_name_.find({category, name});
    return it == by_name_.end() ? nullptr : it->second;
  }
  Strings listed(const Element& at, std::string_view attribute);
  GeometryNames geometry(const Element& at, std::string_view paths, std::string_view collection, bool needed);
  void circles();
  void collection(const Element& at);
  void info(const Element& at);
  void group(const Element& at);
  void look(const Element& at);
  bool isTooMuch(const Element& at);
  void assignments(const Element& at, Look& to, size_t& materials);
  void material(const Element& at, const std::string* variant, Look& to);
  void property(const Element& at, Look& to);
  bool truth(const Element& at, std::string_view attribute, bool by_default);

  const Element& document_;
  const VariantMaterials& variants_;
  Said say_;
  LookChains chains_;
  std::map<std::string_view, int> numbers_;  ///< of materials
  std::set<std::string_view> others_;        ///< names of what may be a material elsewhere
  std::map<std::pair<std::string_view, std::string_view>, const Element*> by_name_;
  /// Collections that include one which they are in.
  std::set<const Element*> circular_;
  size_t assigned_ = 0;
  const Element* first_too_many_ = nullptr;
  Looks result_;
};

Looks LooksReader::read() {
  circles();
  chains_.tell(say_);
  for (const Element& one : document_.children) {
    if (one.category == "collection") collection(one);
    if (one.category == "geominfo") info(one);
    if (one.category == "look") look(one);
    if (one.category == "lookgroup") group(one);
  }
  if (first_too_many_ != nullptr)
    say_(*first_too_many_, Severity::Error, "too-many",
         fmt::format("the document's looks have more than {} assignments, or their groups so many looks",
                     kMostAssignments));
  for (const VariantOf& one : variants_.made) {
    const auto made = numbers_.find(one.material), of = numbers_.find(one.of);
    if (made != numbers_.end() && of != numbers_.end())
      result_.variants.push_back({made->second, of->second, one.variants});
  }
  return std::move(result_);
}

/// Names and expressions of an attribute.
Strings LooksReader::listed(const Element& at, std::string_view attribute) {
  const std::string* value = at.find(attribute);
  if (value == nullptr) return {};
  if (isUnbalanced(*value)) {
    say_(at, Severity::Error, "wrong-geometry", fmt::format("{} is {}", attribute, quote(*value)),
         "each [ has its ], and each { its }");
    return {};
  }
  return geometryNames(*value);
}

GeometryNames LooksReader::geometry(const Element& at, std::string_view paths, std::string_view collection,
                                    bool needed) {
  GeometryNames names;
  names.paths = listed(at, paths);
  names.collection = trimmed(at.get(collection));
  const bool both = at.find(paths) != nullptr && !names.collection.empty();
  if (both) {
    say_(at, Severity::Error, "two-geometries",
         fmt::format("{} has {} and {}", at.category, quote(paths), quote(collection)),
         "one of the two says it");
    names.collection.clear();
  }
  if (!names.collection.empty() && find("collection", names.collection) == nullptr)
    say_(at, Severity::Warning, "no-such-collection",
         fmt::format("the document has no collection {}", quote(names.collection)),
         say_.meant(document_, "collection", names.collection));
  if (needed && at.find(paths) == nullptr && at.get(collection).empty())
    say_(at, Severity::Warning, "no-geometry",
         fmt::format("{} {} is for no geometry", at.category, quote(at.name())),
         fmt::format("{} or {} names it", quote(paths), quote(collection)));
  return names;
}

/// Finds collections that include themselves: each is looked at once.
void LooksReader::circles() {
  struct Step {
    const Element* at;
    Strings includes;
    size_t next = 0;
  };
  std::set<const Element*> open, done;
  for (const Element& first : document_.children) {
    if (first.category != "collection" || done.contains(&first)) continue;
    std::vector<Step> stack;
    const auto enter = [&](const Element& one) {
      open.insert(&one);
      stack.push_back({&one, geometryNames(one.get("includecollection"))});
    };
    enter(first);
    while (!stack.empty()) {
      Step& step = stack.back();
      if (step.next == step.includes.size()) {
        open.erase(step.at);
        done.insert(step.at);
        stack.pop_back();
        continue;
      }
      const Element* next = find("collection", step.includes[step.next++]);
      if (next == nullptr || done.contains(next)) continue;
      if (open.contains(next))
        circular_.insert(step.at);
      else
        enter(*next);
    }
  }
}

void LooksReader::collection(const Element& at) {
  GeometryCollection made;
  made.name = at.name();
  made.include = listed(at, "includegeom");
  made.exclude = listed(at, "excludegeom");
  made.collections = geometryNames(at.get("includecollection"));
  const bool empty = made.include.empty() && made.collections.empty();
  std::erase_if(made.collections, [&](const std::string& name) {
    if (find("collection", name) != nullptr) return false;
    say_(at, Severity::Error, "no-such-collection",
         fmt::format("{} includes {}, which is not there", quote(at.name()), quote(name)),
         say_.meant(document_, "collection", name));
    return true;
  });
  if (circular_.contains(&at)) {
    say_(at, Severity::Error, "collection-cycle",
         fmt::format("the collection {} includes itself", quote(at.name())));
    made.collections.clear();
  }
  if (empty && at.find("includegeom") == nullptr)
    say_(at, Severity::Warning, "no-geometry", fmt::format("the collection {} is empty", quote(at.name())),
         "\"includegeom\" or \"includecollection\" says what is in it");
  result_.collections.push_back(std::move(made));
}

void LooksReader::info(const Element& at) {
  GeometryInfo made;
  made.name = at.name();
  made.geometry = geometry(at, "geom", "collection", true);
  for (const Element& one : at.children) {
    const bool token = one.category == "token";
    if (!token && one.category != "geomprop") {
      say_(one, Severity::Warning, "unknown-element",
           fmt::format("a geominfo has no {}", quote(one.category)), "it has \"geomprop\" and \"token\"");
      continue;
    }
    (token ? made.tokens : made.properties)
        .push_back({std::string(one.name()), std::string(one.get("type")), std::string(one.get("value"))});
  }
  result_.geometry.push_back(std::move(made));
}

/// The looks of a group, with those of the groups in it.
void LooksReader::group(const Element& at) {
  LookGroup made;
  made.name = at.name();
  std::set<std::string_view> met;
  std::vector<const Element*> left{&at};
  while (!left.empty()) {
    const Element& one = *left.back();
    left.pop_back();
    for (const std::string& name : geometryNames(one.get("looks"))) {
      if (isTooMuch(at)) return;
      const Element* within = find("lookgroup", name);
      if (const auto known = chains_.looks().find(name); known != chains_.looks().end()) {
        if (met.insert(known->first).second) made.looks.push_back(name);
      } else if (within == &at) {
        say_(at, Severity::Error, "look-cycle", fmt::format("the group {} is in itself", quote(name)));
      } else if (within != nullptr) {
        if (met.insert(within->name()).second) left.push_back(within);
      } else if (&one == &at) {
        say_(at, Severity::Error, "no-such-look",
             fmt::format("{} has {}, which is not there", quote(at.name()), quote(name)),
             say_.meant(document_, "look", name));
      }
    }
  }
  made.by_default = at.get("default").empty() ? at.get("active") : at.get("default");
  if (!made.by_default.empty() && !met.contains(made.by_default)) {
    say_(at, Severity::Error, "no-such-look",
         fmt::format("the default of {} is {}, which is none of its looks", quote(at.name()),
                     quote(made.by_default)));
    made.by_default.clear();
  }
  result_.groups.push_back(std::move(made));
}

void LooksReader::look(const Element& at) {
  Look made;
  made.name = at.name();
  size_t materials = 0;
  const std::vector<const Element*> chain =
      first_too_many_ == nullptr ? chains_.of(at) : std::vector<const Element*>();
  for (const Element* one : chain) {
    // What is wrong in another look is said there.
    Diagnostics elsewhere;
    Diagnostics* own = one == &at ? nullptr : say_.to(&elsewhere);
    assignments(*one, made, materials);
    if (own != nullptr) say_.to(own);
  }
  result_.looks.push_back(std::move(made));
}

bool LooksReader::truth(const Element& at, std::string_view attribute, bool by_default) {
  const std::string* value = at.find(attribute);
  if (value == nullptr || *value == "true" || *value == "false")
    return value == nullptr ? by_default : *value == "true";
  say_(at, Severity::Error, "wrong-value", fmt::format("{} is {}", quote(attribute), quote(*value)),
       "it is true or false");
  return by_default;
}

/// `variant`: the material with variants that stands there for the one that is named; null for none.
void LooksReader::material(const Element& at, const std::string* variant, Look& to) {
  MaterialAssignment made;
  made.name = at.name();
  const std::string_view name = variant != nullptr ? std::string_view(*variant) : at.get("material");
  made.geometry = geometry(at, "geom", "collection", true);
  made.exclusive = truth(at, "exclusive", true);
  for (const Element& one : at.children) {
    if (one.category != "variantassign")
      say_(one, Severity::Warning, "unknown-element",
           fmt::format("a materialassign has no {}", quote(one.category)), "it has \"variantassign\"");
  }
  const auto number = numbers_.find(name);
  if (number != numbers_.end()) {
    made.material = number->second;
    to.materials.push_back(std::move(made));
    return;
  }
  if (!name.empty() && others_.contains(name))
    say_(at, Severity::Warning, "no-such-material",
         fmt::format("{} is no material that is read", quote(name)),
         "a surfacematerial beside the nodegraphs is");
  else
    say_(at, Severity::Error, "no-such-material",
         name.empty() ? fmt::format("{} has no material", quote(at.name()))
                      : fmt::format("the document has no material {}", quote(name)),
         say_.meant(document_, "surfacematerial", name));
}

/// A propertyassign, or each property of the set of a propertysetassign.
void LooksReader::property(const Element& at, Look& to) {
  const GeometryNames names = geometry(at, "geom", "collection", true);
  if (at.category == "propertyassign") {
    to.properties.push_back({std::string(at.get("property")), std::string(at.get("type")),
                             std::string(at.get("value")), std::string(at.get("target")), names});
    if (!at.get("property").empty()) return;
    to.properties.pop_back();
    return say_(at, Severity::Error, "no-property", fmt::format("{} names no property", quote(at.name())));
  }
  // The specification's own example calls it "propertysetname".
  const std::string_view name =
      at.find("propertyset") != nullptr ? at.get("propertyset") : at.get("propertysetname");
  const Element* set = find("propertyset", name);
  if (set == nullptr)
    return say_(at, Severity::Error, "no-such-propertyset",
                fmt::format("the document has no propertyset {}", quote(name)),
                say_.meant(document_, "propertyset", name));
  for (const Element& one : set->children) {
    if (one.category != "property") {
      say_(one, Severity::Warning, "unknown-element",
           fmt::format("a propertyset has no {}", quote(one.category)), "it has \"property\"");
      continue;
    }
    to.properties.push_back({std::string(one.name()), std::string(one.get("type")),
                             std::string(one.get("value")), std::string(one.get("target")), names});
  }
}

/// Counts an assignment, or a look of a group; true where there are too many.
bool LooksReader::isTooMuch(const Element& at) {
  if (++assigned_ <= kMostAssignments) return false;
  if (first_too_many_ == nullptr) first_too_many_ = &at;
  return true;
}

/// `materials`: how many materialassigns of this look have been met.
void LooksReader::assignments(const Element& at, Look& to, size_t& materials) {
  for (const Element& one : at.children) {
    if (isTooMuch(one)) return;
    if (one.category == "materialassign") {
      const auto variant = variants_.assigned.find({to.name, materials++});
      material(one, variant == variants_.assigned.end() ? nullptr : &variant->second, to);
    } else if (one.category == "propertyassign" || one.category == "propertysetassign") {
      property(one, to);
    } else if (one.category == "visibility" || one.category == "visibilityassign") {
      to.visibility.push_back({std::string(one.get("vistype")), truth(one, "visible", true),
                               geometry(one, "geom", "collection", true),
                               geometry(one, "viewergeom", "viewercollection", false)});
    } else if (one.category != "variantassign") {
      constexpr std::string_view kKnown[] = {"materialassign", "variantassign", "visibility",
                                             "propertyassign", "propertysetassign"};
      say_(one, Severity::Warning, "unknown-element", fmt::format("a look has no {}", quote(one.category)),
           "it has " + listOf(kKnown));
    }
  }
}

}  // namespace

void Said::operator()(const Element& at, Severity severity, std::string code, std::string message,
                      std::string help) const {
  addBounded(*to_, {std::move(code), severity, at.place, std::move(message), std::move(help), {}});
}

std::string Said::meant(const Element& of, std::string_view category, std::string_view name) {
  constexpr size_t kMostSuggestions = 20;  // each looks at every name that there is
  if (++suggestions_ > kMostSuggestions) return {};
  std::vector<std::string_view> names;
  for (const Element& one : of.children) {
    if (one.category == category) names.push_back(one.name());
  }
  return lang::didYouMean(name, names);
}

LookChains::LookChains(const Element& document) : document_(document), looks_(namesOf(document, "look")) {
  std::set<const Element*> done;
  for (const Element& first : document.children) {
    if (first.category != "look") continue;
    std::vector<const Element*> path;
    std::set<const Element*> open;
    const Element* end = nullptr;  // what the last of the path inherits from
    for (const Element* at = &first; at != nullptr && !done.contains(at);) {
      path.push_back(at);
      open.insert(at);
      const std::string_view name = at->get("inherit");
      const auto base = looks_.find(name);
      if (base == looks_.end() && !name.empty()) missing_.push_back(at);
      end = base == looks_.end() ? nullptr : base->second;
      if (open.contains(end)) circles_.push_back(std::exchange(end, nullptr));
      at = end;
    }
    for (; !path.empty(); path.pop_back()) {
      const Element* look = path.back();
      done.insert(look);
      bases_[look] = end == nullptr || !end->children.empty() ? end : bases_[end];
      end = look;
    }
  }
}

void LookChains::tell(Said& said) const {
  for (const Element* look : circles_)
    said(*look, Severity::Error, "look-cycle",
         fmt::format("the look {} inherits from itself", quote(look->name())));
  for (const Element* look : missing_)
    said(*look, Severity::Error, "no-such-look",
         fmt::format("{} inherits from {}, which is not there", quote(look->name()),
                     quote(look->get("inherit"))),
         said.meant(document_, "look", look->get("inherit")));
}

std::vector<const Element*> LookChains::of(const Element& look) const {
  std::vector<const Element*> chain{&look};
  for (const Element* at = bases_.at(&look); at != nullptr; at = bases_.at(at)) chain.push_back(at);
  std::reverse(chain.begin(), chain.end());
  return chain;
}

ByName namesOf(const Element& document, std::string_view category) {
  ByName names;
  for (const Element& one : document.children) {
    if (one.category == category) names.try_emplace(one.name(), &one);
  }
  return names;
}

std::vector<std::string> geometryNames(std::string_view list) {
  std::vector<std::string> names;
  size_t begin = 0, depth = 0;
  for (size_t i = 0; i <= list.size(); ++i) {
    if (i < list.size() && list[i] == '{') ++depth;
    if (i < list.size() && list[i] == '}' && depth > 0) --depth;
    if (i < list.size() && (list[i] != ',' || depth > 0)) continue;
    const std::string_view one = trimmed(list.substr(begin, i - begin));
    if (!one.empty()) names.emplace_back(one);
    begin = i + 1;
  }
  return names;
}

Looks readLooks(const Element& document, const std::vector<std::string>& materials,
                const VariantMaterials& variants, Diagnostics& said) {
  return LooksReader(document, materials, variants, said).read();
}

}  // namespace lacquer::materialx
