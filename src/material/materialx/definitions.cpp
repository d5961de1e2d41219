// A library of definitions for documents, such as a studio's own: nodedefs, and the nodegraphs behind them.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "materialx/flaws.h"
#include "materialx/materialx.h"
#include "materialx/patterns.h"
#include "materialx/surface.h"
#include "mtlx/element.h"
#include "mtlx/models.h"
#include "mtlx/namespaces.h"
#include "support/text.h"

namespace lacquer::materialx {

namespace {

class DefinitionsReader {
public:
  Result<Definitions> read(const std::vector<lang::SourceFile>& files, const Limits& limits);

private:
  void take(Element& element);
  void error(const Element& at, const char* code, std::string message, std::string help = {}) {
    addBounded(wrong_, {code, Severity::Error, at.place, std::move(message), std::move(help), {}});
  }

  Element root_;
  Siblings nodedefs_, nodegraphs_;  ///< of root_, once whole
  Diagnostics wrong_;
};

/// Keeps what defines, of one file.
void DefinitionsReader::take(Element& element) {
  const bool code = element.category == "implementation" && element.find("nodegraph") == nullptr;
  constexpr std::string_view kKept[] = {"nodedef", "nodegraph", "implementation", "geompropdef", "unitdef"};
  if (code || std::find(std::begin(kKept), std::end(kKept), element.category) == std::end(kKept)) return;
  if (element.name().empty())
    return error(element, "no-name", fmt::format("the {} has no name", quote(element.category)));
  if (element.category == "nodedef" && element.get("node").empty())
    return error(element, "no-name",
                 fmt::format("the definition {} does not say of which node it is", quote(element.name())),
                 "its attribute \"node\" does");
  root_.children.push_back(std::move(element));
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
    for (const Diagnostic& one : document->said) {
      Element& warning = root_.children.emplace_back();
      warning.category = kWarning;
      warning.place = one.place;
      warning.attributes = {{"code", one.code}, {"message", one.message}, {"help", one.help}};
    }
  }
  qualifyNames(root_);
  for (const Element& child : root_.children) {
    if (child.category != "nodedef" && child.category != "nodegraph") continue;
    auto& known = child.category == "nodedef" ? nodedefs_ : nodegraphs_;
    const auto [it, fresh] = known.try_emplace(child.name(), &child);
    if (!fresh)
      error(child, "duplicate-definition",
            fmt::format("there is a {} {} already", child.category, quote(child.name())),
            fmt::format("it stands in {}:{}", it->second->place.file, it->second->place.line));
  }
  addBareNames(root_, nodedefs_, nodegraphs_);
  for (Flaw& flaw : flawsOf(root_, nodedefs_, nodegraphs_)) addBounded(wrong_, std::move(flaw.said));
  if (hasError(wrong_)) return tl::make_unexpected(std::move(wrong_));
  takeDisabled(root_);
  makeConversionsUnlit(root_);
  addTangentSpace(root_);
  root_.index();
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
