// A library of definitions for documents, such as a studio's own: nodedefs, and the nodegraphs behind them.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "lang/suggest.h"
#include "materialx/element.h"
#include "materialx/materialx.h"
#include "materialx/models.h"
#include "materialx/patterns.h"
#include "materialx/surface.h"
#include "support/text.h"

namespace lacquer::materialx {

namespace {

class DefinitionsReader {
public:
  Result<Definitions> read(const std::vector<lang::SourceFile>& files, const Limits& limits);

private:
  void take(Element& element);
  void checkBodies();
  void checkInheritance();
  void error(const Element& at, const char* code, std::string message, std::string help = {}) {
    addBounded(wrong_, {code, Severity::Error, at.place, std::move(message), std::move(help), {}});
  }
  void missing(const Element& at, std::string_view name) {
    constexpr size_t kMostSuggestions = 20;  // each looks at every name that there is
    std::string close;
    if (++suggestions_ <= kMostSuggestions) {
      std::vector<std::string_view> names;
      for (const auto& [known, element] : nodedefs_) names.push_back(known);
      close = lang::didYouMean(name, names);
    }
    error(at, "no-such-definition",
          fmt::format("{} names the nodedef {}, which is not there", quote(at.name()), quote(name)),
          close.empty() ? "it stands in one of the files, or in one of MaterialX's own beside them" : close);
  }

  Element root_;
  std::map<std::string_view, const Element*> nodedefs_, nodegraphs_;  ///< of root_, once it is whole
  size_t suggestions_ = 0;
  Diagnostics wrong_;
};

/// Keeps what defines, of one file.
void DefinitionsReader::take(Element& element) {
  const bool code = element.category == "implementation" && element.find("nodegraph") == nullptr;
  constexpr std::string_view kKept[] = {"nodedef", "nodegraph", "implementation", "geompropdef"};
  if (code || std::find(std::begin(kKept), std::end(kKept), element.category) == std::end(kKept)) return;
  if (element.name().empty())
    return error(element, "no-name", fmt::format("the {} has no name", quote(element.category)));
  if (element.category == "nodedef" && element.get("node").empty())
    return error(element, "no-name",
                 fmt::format("the definition {} does not say of which node it is", quote(element.name())),
                 "its attribute \"node\" does");
  root_.children.push_back(std::move(element));
}

void DefinitionsReader::checkBodies() {
  std::map<std::pair<std::string_view, std::string_view>, const Element*> bodies;
  for (const Element& child : root_.children) {
    if (child.category == "nodedef" || child.get("nodedef").empty()) continue;
    if (!nodedefs_.contains(child.get("nodedef"))) missing(child, child.get("nodedef"));
    if (child.category == "implementation" && !nodegraphs_.contains(child.get("nodegraph")))
      error(child, "no-such-definition",
            fmt::format("{} names the nodegraph {}, which is not there", quote(child.name()),
                        quote(child.get("nodegraph"))));
    const auto [it, fresh] = bodies.try_emplace({child.get("nodedef"), child.get("target")}, &child);
    if (!fresh)
      error(child, "duplicate-definition",
            fmt::format("{} is implemented a second time", quote(child.get("nodedef"))),
            fmt::format("{} in {}:{} does so", quote(it->second->name()), it->second->place.file,
                        it->second->place.line));
  }
}

void DefinitionsReader::checkInheritance() {
  std::set<const Element*> good;
  for (const Element& child : root_.children) {
    std::set<const Element*> seen;
    for (const Element* at = &child; at->category == "nodedef" && !good.contains(at);) {
      if (!seen.insert(at).second) {
        error(child, "inherit-cycle", fmt::format("{} inherits from itself", quote(child.name())));
        break;
      }
      const std::string_view base = at->get("inherit");
      const auto found = nodedefs_.find(base);
      if (base.empty()) break;
      if (found == nodedefs_.end()) {
        missing(*at, base);
        break;
      }
      at = found->second;
    }
    good.insert(seen.begin(), seen.end());
  }
}

Result<Definitions> DefinitionsReader::read(const std::vector<lang::SourceFile>& files,
                                            const Limits& limits) {
  root_.category = "materialx";
  for (const lang::SourceFile& file : files) {
    Result<Document> document = readXmlAlone(file.text, file.name, limits);
    if (!document) {
      for (const Diagnostic& one : document.error()) addBounded(wrong_, one);
      continue;
    }
    for (Element& child : document->root.children) take(child);
  }
  for (const Element& child : root_.children) {
    if (child.category == "implementation" || child.category == "geompropdef") continue;
    auto& known = child.category == "nodedef" ? nodedefs_ : nodegraphs_;
    const auto [it, fresh] = known.try_emplace(child.name(), &child);
    if (!fresh)
      error(child, "duplicate-definition",
            fmt::format("there is a {} {} already", child.category, quote(child.name())),
            fmt::format("it stands in {}:{}", it->second->place.file, it->second->place.line));
  }
  checkBodies();
  checkInheritance();
  if (hasError(wrong_)) return tl::make_unexpected(std::move(wrong_));
  addTangentSpace(root_);
  return std::make_shared<const Element>(std::move(root_));
}

}  // namespace

Result<Definitions> readDefinitions(const std::vector<lang::SourceFile>& files, const Limits& limits) {
  return DefinitionsReader().read(files, limits);
}

Diagnostics checkDefinitions(const Definitions& definitions, const lang::Library& library,
                             const Limits& limits) {
  Patterns patterns({}, library, {true, limits.nodes, {}, {}, true, &surfaceModels(), definitions.get()});
  patterns.demandAll();
  patterns.finish();
  return patterns.wrong();
}

}  // namespace lacquer::materialx
