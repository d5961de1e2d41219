#include "materialx/flaws.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "lang/suggest.h"
#include "support/text.h"

namespace lacquer::materialx {

const Element* findNamed(const Siblings& all, std::string_view name) {
  if (const auto exact = all.find(name); exact != all.end()) return exact->second;
  const size_t colon = name.rfind(':');
  const auto found = colon == std::string_view::npos ? all.end() : all.find(name.substr(colon + 1));
  const bool there = found != all.end() && found->second->get("namespace") == name.substr(0, colon);
  return there ? found->second : nullptr;
}

void addBareNames(const Element& root, Siblings& nodedefs, Siblings& nodegraphs) {
  for (const Element& child : root.children) {
    if (child.get("namespace").empty()) continue;
    if (child.category == "nodedef") nodedefs.try_emplace(withoutNamespace(child.name()), &child);
    if (child.category == "nodegraph") nodegraphs.try_emplace(withoutNamespace(child.name()), &child);
  }
}

bool isOneVersion(std::string_view a, std::string_view b) {
  const auto short_of = [](std::string_view version) {
    version = trimmed(version);
    return version.ends_with(".0") ? version.substr(0, version.size() - 2) : version;
  };
  return short_of(a) == short_of(b);
}

namespace {

class Flaws {
public:
  Flaws(const Element& root, const Siblings& nodedefs, const Siblings& nodegraphs)
      : root_(root), nodedefs_(nodedefs), nodegraphs_(nodegraphs) {}

  std::vector<Flaw> all() {
    bodies();
    inheritance();
    return std::move(found_);
  }

private:
  void add(const Element& at, const char* code, std::string message, std::string help,
           std::vector<std::string_view> nodedefs) {
    found_.push_back(
        {{code, Severity::Error, at.place, std::move(message), std::move(help), {}}, std::move(nodedefs)});
  }
  void missing(const Element& at, std::string_view name, std::vector<std::string_view> of);
  void bodies();
  void inheritance();

  const Element& root_;
  const Siblings& nodedefs_;
  const Siblings& nodegraphs_;
  size_t suggestions_ = 0;
  std::vector<Flaw> found_;
};

void Flaws::missing(const Element& at, std::string_view name, std::vector<std::string_view> of) {
  constexpr size_t kMostSuggestions = 20;  // each looks at every name that there is
  std::string close;
  if (++suggestions_ <= kMostSuggestions) {
    std::vector<std::string_view> names;
    for (const auto& [known, element] : nodedefs_) names.push_back(known);
    std::sort(names.begin(), names.end());
    close = lang::didYouMean(name, names);
  }
  add(at, "no-such-definition",
      fmt::format("{} names the nodedef {}, which is not there", quote(at.name()), quote(name)),
      close.empty() ? "it stands in one of the files, or in one of MaterialX's own beside them" : close,
      std::move(of));
}

void Flaws::bodies() {
  std::map<std::pair<std::string_view, std::string_view>, const Element*> bodies;
  for (const Element& child : root_.children) {
    const bool implementation = child.category == "implementation" && child.find("nodegraph") != nullptr;
    if ((!implementation && child.category != "nodegraph") || child.get("nodedef").empty()) continue;
    const Element* nodedef = findNamed(nodedefs_, child.get("nodedef"));
    const std::string_view of = nodedef == nullptr ? child.get("nodedef") : nodedef->name();
    if (nodedef == nullptr) missing(child, of, {});
    if (implementation && findNamed(nodegraphs_, child.get("nodegraph")) == nullptr)
      add(child, "no-such-definition",
          fmt::format("{} names the nodegraph {}, which is not there", quote(child.name()),
                      quote(child.get("nodegraph"))),
          {}, {of});
    const auto [it, fresh] = bodies.try_emplace({of, child.get("target")}, &child);
    if (!fresh)
      add(child, "duplicate-definition", fmt::format("{} is implemented a second time", quote(of)),
          fmt::format("{} in {}:{} does so", quote(it->second->name()), it->second->place.file,
                      it->second->place.line),
          {of});
  }
}

void Flaws::inheritance() {
  std::map<const Element*, size_t> bases;  // how many a definition has behind it; looked up, never walked
  for (const Element& child : root_.children) {
    if (!child.get("target").empty()) continue;  // of other renderers
    std::set<const Element*> seen;
    std::vector<const Element*> path;
    std::vector<std::string_view> names;
    const Element* at = &child;
    while (at != nullptr && at->category == "nodedef" && !bases.contains(at)) {
      if (!seen.insert(at).second) {
        add(child, "inherit-cycle", fmt::format("{} inherits from itself", quote(child.name())), {}, names);
        for (const Element* one : path) bases.emplace(one, 0);
        path.clear();
        break;
      }
      path.push_back(at);
      names.push_back(at->name());
      const std::string_view base = at->get("inherit");
      const Element* found = base.empty() ? nullptr : findNamed(nodedefs_, base);
      if (found == nullptr && !base.empty()) missing(*at, base, names);
      at = found;
    }
    const auto known = bases.find(at);
    size_t behind = known == bases.end() ? 0 : known->second + 1;
    for (; !path.empty(); path.pop_back()) {
      const Element& one = *path.back();
      bases.emplace(&one, behind);
      if (behind++ <= kDeepestInheritance) continue;
      add(one, "inherit-too-deep",
          fmt::format("{} inherits through more than {} definitions", quote(one.name()), kDeepestInheritance),
          "inputs of those behind them would be missing", {one.name()});
    }
  }
}

}  // namespace

std::vector<Flaw> flawsOf(const Element& root, const Siblings& nodedefs, const Siblings& nodegraphs) {
  return Flaws(root, nodedefs, nodegraphs).all();
}

}  // namespace lacquer::materialx
