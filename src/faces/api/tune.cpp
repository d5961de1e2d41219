#include "lacquer/tune.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/internal.h"
#include "prove/nodes.h"
#include "setting/language.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "support/text.h"

namespace lacquer {

namespace {

/// The errors that are tried.
constexpr double kErrors[] = {1e-6, 1e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1};

Tuned tuned(std::string name, const ir::Module& module, const Options& options) {
  optimize::Settings settings = optimization(options);
  settings.level = std::max(settings.level, 1);
  Tuned made;
  made.name = std::move(name);
  made.family = options.optimize_for.empty() ? optimizeFamilies()[0] : options.optimize_for;
  for (const optimize::Outcome& outcome : optimize::front(module, settings, kErrors)) {
    made.plain = std::round(outcome.plain);
    made.forms.push_back({outcome.error, std::round(outcome.cycles), outcome.growth,
                          static_cast<size_t>(outcome.approximations)});
  }
  return made;
}

}  // namespace

std::optional<Tuned> tune(const std::string& name, const Options& options, Messages& messages) {
  const auto wrong = [&](Diagnostics found) {
    report(found, {}, messages);
    return std::nullopt;
  };
  if (Diagnostics found = checkOptions(options); !found.empty()) return wrong(std::move(found));
  const auto library = libraryFor(options);
  if (!library) return wrong(library.error());
  if (Diagnostics found = (*library)->check(); hasError(found)) return wrong(std::move(found));
  const std::string node = name.substr(0, name.find('.'));
  const std::string variant = node.size() < name.size() ? name.substr(node.size() + 1) : "";
  const auto decl = (*library)->node(node);
  if (!decl) {
    return wrong(fail("no-such-node", {}, fmt::format("there is no node '{}'", printable(node)),
                      "`lacquer nodes` lists what there is")
                     .value());
  }
  const auto named = [&](const lang::Variant& one) { return one.name == variant; };
  if (!variant.empty() && std::none_of((*decl)->variants.begin(), (*decl)->variants.end(), named)) {
    return wrong(fail("no-such-variant", {},
                      fmt::format("the node {} has no variant '{}'", node, printable(variant)),
                      fmt::format("`lacquer nodes {}` lists what there is", node))
                     .value());
  }
  return tuned(name, nodeModule(**decl, variant).module, options);
}

std::optional<Tuned> tune(const Graph& graph, const Options& options, Messages& messages) {
  if (!filled(graph.impl_.get(), "graph", messages)) return std::nullopt;
  // Up to where the search would begin.
  Options plain = options;
  plain.optimize = 0;
  plain.optimize_error = 0;
  const Result<Graph::Impl::Prepared> ready = graph.impl_->prepared(plain, checkOptions);
  if (!ready) {
    report(ready.error(), graph.impl_->file, messages);
    return std::nullopt;
  }
  ir::Module before;
  const auto keep = [&](std::string_view pass, const ir::Module& after) {
    if (pass == "vertex") before = after;
  };
  const Result<ir::Module> module = graph.impl_->module(*ready, plain, keep);
  if (!module) {
    report(module.error(), graph.impl_->file, messages);
    return std::nullopt;
  }
  return tuned(graph.name(), before, options);
}

}  // namespace lacquer
