#include <fmt/format.h>

#include <algorithm>

#include "api/internal.h"
#include "cost/choose.h"
#include "eval/subject.h"
#include "graph/text.h"
#include "interface/interface.h"
#include "prove/prove.h"
#include "setting/language.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "setting/simplify.h"
#include "shader/limits.h"
#include "shader/module.h"
#include "shader/print.h"
#include "structures/contract.h"
#include "support/text.h"

namespace lacquer {

Strings passNames() {
  std::vector<std::string> names = {"lower"};
  for (const passes::PassInfo& pass : passes::passes()) names.emplace_back(pass.name);
  return names;
}

Graph Graph::fromJson(std::string_view text, const std::string& name, Messages& messages,
                      const Options& options) {
  Graph result;
  const Result<Limits> limits = limitsOf(options);
  if (!limits) return report(limits.error(), {}, messages), result;
  auto language = libraryFor(options);
  if (!language) return report(language.error(), {}, messages), result;
  Result<graph::Graph> graph = graph::fromJson(text, name, *limits);
  if (!graph) return report(graph.error(), name, messages), result;
  result.impl_ = std::make_shared<Impl>(Impl{std::move(*graph), name, std::move(*language), *limits});
  return result;
}

Graph Graph::load(const std::string& path, const Options& options, Messages& messages) {
  Graph result;
  Result<graph::Graph> graph = readGraphFile(path, options);
  if (!graph) return report(graph.error(), path, messages), result;
  auto language = libraryFor(options);
  if (!language) return report(language.error(), {}, messages), result;
  result.impl_ = std::make_shared<Impl>(
      Impl{std::move(*graph), path, std::move(*language), *limitsOf(options), {}, ImagesOf::Graph});
  return result;
}

const std::string& Graph::name() const {
  static const std::string kNone;
  return impl_ ? impl_->graph.name : kNone;
}

std::string Graph::toJson() const { return impl_ ? graph::toJson(impl_->graph) : std::string(); }
std::string Graph::toDot() const { return impl_ ? graph::toDot(impl_->graph) : std::string(); }

bool Graph::check(Messages& messages, const Options& options) const {
  if (!filled(impl_.get(), "graph", messages)) return false;
  const auto library = libraryFor(options);
  if (!library) {
    report(library.error(), {}, messages);
    return false;
  }
  const Result<Limits> limits = limitsOf(options);
  const Diagnostics found = limits ? graph::check(impl_->graph, **library, limits->nodes) : limits.error();
  report(found, impl_->file, messages);
  if (lacquer::hasError(found)) return false;
  report(graph::doubts(impl_->graph, **library), impl_->file, messages);
  return true;
}

Result<graph::Graph> Graph::Impl::flat(const Options& options, const lang::Library& library) const {
  const Result<Limits> allowed = limitsOf(options);
  if (!allowed) return tl::make_unexpected(allowed.error());
  if (Diagnostics found = graph::check(graph, library, allowed->nodes); lacquer::hasError(found))
    return tl::make_unexpected(std::move(found));
  graph::Graph flat = graph::flattened(graph, library);
  Strings words;
  for (const std::string& word : options.simplify) {
    if (std::find(built_with.begin(), built_with.end(), word) == built_with.end()) words.push_back(word);
  }
  if (Result<void> simpler = simplifyBuilt(flat, library, words); !simpler)
    return tl::make_unexpected(std::move(simpler.error()));
  if (knowsSamplers(options)) addSamplers(flat, nullptr);
  return flat;
}

Result<Graph::Impl::Prepared> Graph::Impl::prepared(const Options& options,
                                                    Diagnostics (*check)(const Options&)) const {
  if (Diagnostics wrong = check(options); !wrong.empty()) return tl::make_unexpected(std::move(wrong));
  auto library = libraryFor(options);
  if (!library) return tl::make_unexpected(library.error());
  Result<graph::Graph> flat = this->flat(options, **library);
  if (!flat) return tl::make_unexpected(std::move(flat.error()));
  return Prepared{std::move(*library), std::move(*flat)};
}

Result<ir::Module> Graph::Impl::module(const Prepared& of, const Options& options,
                                       const AfterPass& after) const {
  return toModule(of.flat, *of.language, options, scene_lights, after, cost::chooserOf(options));
}

std::string Graph::structure(const Options& options, Messages& messages) const {
  if (!filled(impl_.get(), "graph", messages)) return {};
  if (const Diagnostics wrong = checkOptions(options); !wrong.empty()) {
    report(wrong, {}, messages);
    return {};
  }
  const auto library = libraryFor(options);
  if (!library) return report(library.error(), {}, messages), std::string();
  const Setting setting{options, **library, baseOf(options)};
  const passes::LightFacts lights = lightFacts(options, impl_->scene_lights);
  const Result<graph::Graph> flat = impl_->flat(options, **library);
  if (!flat) return report(flat.error(), impl_->file, messages), std::string();
  return programKey(*flat, lights, setting).text();
}

Shader Graph::generate(const Options& options, Messages& messages) {
  Shader shader;
  if (!filled(impl_.get(), "graph", messages)) return shader;
  impl_->made.reset();
  const Result<Impl::Prepared> ready = impl_->prepared(options, checkOptions);
  if (!ready) return report(ready.error(), impl_->file, messages), shader;
  const Language& language = *ready->language;
  Result<ir::Module> module = impl_->module(*ready, options);
  if (!module) return report(module.error(), impl_->file, messages), shader;
  const Diagnostics over = overLimits(*module, options.targets);
  report(over, impl_->file, messages);
  if (lacquer::hasError(over)) return shader;
  report(aboutHalf(*module, options), impl_->file, messages);
  const Result<const material::Schema*> schema = language.models.schema();
  ShaderData data;
  data.id = shaderId(*module, language);
  data.has_vertex = lacquer::hasVertexStage(*module);
  data.module = std::move(*module);
  Wrong wrong;
  print(data, options, wrong);
  for (const Diagnostics& of_target : wrong) report(of_target, impl_->file, messages);
  impl_->made = Impl::Made{options, ready->language, graph::programKey(ready->flat, language), impl_->graph};
  return ShaderMaker::make(std::move(data), schema ? *schema : nullptr, options);
}

std::string Graph::dump(const Options& options, std::string_view pass, Messages& messages) const {
  if (!filled(impl_.get(), "graph", messages)) return {};
  const Strings known = passNames();
  if (!pass.empty() && std::find(known.begin(), known.end(), pass) == known.end()) {
    std::string help = "there are";
    for (const std::string& name : known) help += (&name == known.data() ? " " : ", ") + name;
    report(fail("unknown-pass", {}, fmt::format("there is no pass '{}'", printable(pass)), help).value(),
           impl_->file, messages);
    return {};
  }
  std::string text;
  const auto keep = [&](std::string_view name, const ir::Module& module) {
    if (name == pass) text = ir::dump(module);
  };
  const Result<Impl::Prepared> ready = impl_->prepared(options, checkReading);
  if (!ready) return report(ready.error(), impl_->file, messages), std::string();
  const Result<ir::Module> module = impl_->module(*ready, options, keep);
  if (module) return pass.empty() ? ir::dump(*module) : text;
  report(module.error(), impl_->file, messages);
  return {};
}

std::optional<Proofs> Graph::prove(const Options& options, Messages& messages, Precision precision) const {
  if (!filled(impl_.get(), "graph", messages)) return std::nullopt;
  const Result<Impl::Prepared> ready = impl_->prepared(options, checkReading);
  if (!ready) return report(ready.error(), impl_->file, messages), std::nullopt;
  const Result<ir::Module> module = impl_->module(*ready, options);
  if (!module) return report(module.error(), impl_->file, messages), std::nullopt;
  return valueOf(proveGraph(ready->flat, *module, *ready->language, options, precision), impl_->file,
                 messages);
}

}  // namespace lacquer
