#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

namespace {

std::string inQuotes(std::string_view name) { return "'" + printable(name) + "'"; }

}  // namespace

Strings passNames() {
  std::vector<std::string> names = {"lower"};
  for (const passes::PassInfo& pass : passes::passes()) names.emplace_back(pass.name);
  return names;
}

/// Reports what an edit was told wrongly; always false.
bool Graph::Impl::refuse(std::string code, std::string message, std::string help, Messages& messages) const {
  report(fail(std::move(code), {}, std::move(message), std::move(help)).value(), file, messages);
  return false;
}

/// The source in its JSON form; nothing, and messages, when it is none.
std::optional<graph::Source> Graph::Impl::source(std::string_view text, Messages& messages) const {
  Result<graph::Source> parsed = graph::sourceFromJson(text);
  if (parsed) return std::move(*parsed);
  report(parsed.error(), file, messages);
  return std::nullopt;
}

Graph Graph::fromJson(std::string_view text, const std::string& name, Messages& messages) {
  Graph result;
  Result<graph::Graph> graph = graph::fromJson(text, name);
  if (!graph) {
    report(graph.error(), name, messages);
    return result;
  }
  result.impl_ = std::make_shared<Impl>(Impl{std::move(*graph), name, {}, ImagesOf::Nothing, {}});
  return result;
}

Graph Graph::load(const std::string& path, const Options& options, Messages& messages) {
  Graph result;
  Result<graph::Graph> graph = readGraphFile(path, options);
  if (!graph) return report(graph.error(), path, messages), result;
  result.impl_ = std::make_shared<Impl>(Impl{std::move(*graph), path, {}, ImagesOf::Graph, {}});
  return result;
}

const std::string& Graph::name() const {
  static const std::string kNone;
  return impl_ ? impl_->graph.name : kNone;
}

std::string Graph::toJson() const { return impl_ ? graph::toJson(impl_->graph) : std::string(); }
std::string Graph::toDot() const { return impl_ ? graph::toDot(impl_->graph) : std::string(); }

std::vector<TextureUse> Graph::textures() const {
  std::vector<TextureUse> textures;
  if (!impl_) return textures;
  for (const ir::TextureSlot& slot : impl_->graph.textures)
    textures.push_back(
        {slot.name, std::string(ir::typeName(slot.type)), slot.srgb, slot.texture, slot.pointer});
  return textures;
}

std::vector<Parameter> Graph::parameters() const {
  std::vector<Parameter> parameters;
  if (!impl_) return parameters;
  for (const ir::Parameter& p : impl_->graph.parameters) {
    const bool gap = p.range.gap > 0;
    const Range range{gap ? p.range.gap : p.range.lo, p.range.hi, gap};
    parameters.push_back({p.name,
                          std::string(ir::typeName(p.type)),
                          {p.value.begin(), p.value.begin() + ir::componentCount(p.type)},
                          range,
                          p.pointer});
  }
  return parameters;
}

bool Graph::addNode(const std::string& id, const std::string& type, Messages& messages) {
  if (!filled(impl_.get(), "graph", messages)) return false;
  if (impl_->graph.find(id)) {
    return impl_->refuse("duplicate-name", fmt::format("there is a node {} already", inQuotes(id)),
                         "give the new one another id", messages);
  }
  impl_->graph.add(id, type);
  return true;
}

bool Graph::removeNode(const std::string& id, Messages& messages) {
  if (!filled(impl_.get(), "graph", messages)) return false;
  return impl_->graph.remove(id) ||
         impl_->refuse("no-such-node", fmt::format("there is no node {}", inQuotes(id)), {}, messages);
}

bool Graph::connect(const std::string& node, const std::string& input, std::string_view source,
                    Messages& messages) {
  if (!filled(impl_.get(), "graph", messages)) return false;
  const std::optional<size_t> found = impl_->graph.find(node);
  if (!found)
    return impl_->refuse("no-such-node", fmt::format("there is no node {}", inQuotes(node)), {}, messages);
  std::optional<graph::Source> from = impl_->source(source, messages);
  if (!from) return false;
  impl_->graph.connect(*found, input, std::move(*from));
  return true;
}

bool Graph::setOutput(const std::string& port, std::string_view source, Messages& messages) {
  if (!filled(impl_.get(), "graph", messages)) return false;
  std::optional<graph::Source> from = impl_->source(source, messages);
  if (!from) return false;
  auto& outputs = impl_->graph.outputs;
  const auto it =
      std::find_if(outputs.begin(), outputs.end(), [&](const auto& output) { return output.first == port; });
  if (it != outputs.end()) {
    it->second = std::move(*from);
  } else {
    outputs.emplace_back(port, std::move(*from));
  }
  return true;
}

bool Graph::setParameter(const std::string& name, const std::vector<double>& value, Messages& messages) {
  if (!filled(impl_.get(), "graph", messages)) return false;
  std::vector<graph::Parameter>& parameters = impl_->graph.parameters;
  const std::optional<size_t> found = impl_->graph.findParameter(name);
  const auto count = found ? static_cast<size_t>(ir::componentCount(parameters[*found].type)) : value.size();
  if (value.size() != count || value.empty() || value.size() > 4) {
    return impl_->refuse(
        "wrong-count", fmt::format("{} is given {} numbers", inQuotes(name), value.size()),
        found ? fmt::format("it is a {}", ir::typeName(parameters[*found].type)) : "a parameter has 1 to 4",
        messages);
  }
  if (found && parameters[*found].type == ir::Type::Bool && value[0] != 0 && value[0] != 1) {
    return impl_->refuse("wrong-type", fmt::format("{} is given {}", inQuotes(name), value[0]),
                         "it is a bool, 0 or 1", messages);
  }
  const auto wrong = std::find_if(value.begin(), value.end(), [](double x) { return !graph::fitsFloat(x); });
  if (wrong != value.end()) {
    return impl_->refuse(std::isfinite(*wrong) ? "out-of-range" : "not-finite",
                         fmt::format("{} is given {}", inQuotes(name), *wrong),
                         std::string(graph::kFloatHelp), messages);
  }
  if (!found) {
    graph::Parameter& fresh = parameters.emplace_back();
    fresh.name = name;
    fresh.type = ir::floatType(static_cast<int>(count));
  }
  std::copy(value.begin(), value.end(), parameters[found.value_or(parameters.size() - 1)].value.begin());
  return true;
}

bool Graph::setRange(const std::string& parameter, const Range& range, Messages& messages) {
  if (!filled(impl_.get(), "graph", messages)) return false;
  const std::optional<size_t> found = impl_->graph.findParameter(parameter);
  if (!found) {
    return impl_->refuse("no-such-parameter", fmt::format("there is no parameter {}", inQuotes(parameter)),
                         {}, messages);
  }
  const std::string said = fmt::format("[{}, {}]{} is no range of {}", range.low, range.high,
                                       range.or_zero ? " or 0" : "", inQuotes(parameter));
  if (!(range.low <= range.high) || (range.or_zero && !(range.low > 0))) {
    return impl_->refuse("wrong-range", said,
                         "the lowest number comes first; 0 stands beside a range that begins above it",
                         messages);
  }
  // -inf below and inf above stand for no end; between them there are numbers.
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  if (range.low == kInfinite || range.high == -kInfinite)
    return impl_->refuse("wrong-range", said, "no number is in it", messages);
  for (const double end : {range.low, range.high}) {
    if (std::isfinite(end) && !graph::fitsFloat(end))
      return impl_->refuse("out-of-range", said, std::string(graph::kFloatHelp), messages);
  }
  ir::Range& to = impl_->graph.parameters[*found].range;
  if (range.or_zero)
    to = {{0, range.high}, range.low};
  else
    to = {{range.low, range.high}, 0};
  return true;
}

bool Graph::check(Messages& messages, const Options& options) {
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
  const Result<Limits> limits = limitsOf(options);
  if (!limits) return tl::make_unexpected(limits.error());
  if (Diagnostics found = graph::check(graph, library, limits->nodes); lacquer::hasError(found))
    return tl::make_unexpected(std::move(found));
  graph::Graph flat = graph::flattened(graph, library);
  if (Result<void> simpler = simplifyBuilt(flat, library, options.simplify); !simpler)
    return tl::make_unexpected(std::move(simpler.error()));
  return flat;
}

Result<ir::Module> Graph::Impl::module(const Options& options, Diagnostics (*check)(const Options&),
                                       const AfterPass& after) const {
  if (Diagnostics wrong = check(options); !wrong.empty()) return tl::make_unexpected(std::move(wrong));
  const auto library = libraryFor(options);
  if (!library) return tl::make_unexpected(library.error());
  const Result<graph::Graph> flat = this->flat(options, **library);
  if (!flat) return tl::make_unexpected(flat.error());
  return toModule(*flat, **library, options, scene_lights, after, cost::chooserOf(options));
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
  return structureKey(impl_->graph, lightFacts(options, impl_->scene_lights), setting).text();
}

Shader Graph::generate(const Options& options, Messages& messages) {
  Shader shader;
  if (!filled(impl_.get(), "graph", messages)) return shader;
  Result<ir::Module> module = impl_->module(options, checkOptions);
  if (!module) {
    report(module.error(), impl_->file, messages);
    return shader;
  }
  const Diagnostics over = overLimits(*module, options.targets);
  report(over, impl_->file, messages);
  if (lacquer::hasError(over)) return shader;
  const std::shared_ptr<const Language> language = *libraryFor(options);
  const Result<const material::Schema*> schema = language->models.schema();
  ShaderData data;
  data.id = shaderId(*module, *language);
  data.has_vertex = lacquer::hasVertexStage(*module);
  data.module = std::move(*module);
  Wrong wrong;
  print(data, options, wrong);
  for (const Diagnostics& of_target : wrong) report(of_target, impl_->file, messages);
  return ShaderMaker::make(std::move(data), schema ? *schema : nullptr, options);
}

std::string Graph::dump(const Options& options, std::string_view pass, Messages& messages) {
  if (!filled(impl_.get(), "graph", messages)) return {};
  const Strings known = passNames();
  if (!pass.empty() && std::find(known.begin(), known.end(), pass) == known.end()) {
    std::string help = "there are";
    for (const std::string& name : known) help += (&name == known.data() ? " " : ", ") + name;
    impl_->refuse("unknown-pass", fmt::format("there is no pass {}", inQuotes(pass)), help, messages);
    return {};
  }
  std::string text;
  const auto keep = [&](std::string_view name, const ir::Module& module) {
    if (name == pass) text = ir::dump(module);
  };
  const Result<ir::Module> module = impl_->module(options, checkReading, keep);
  if (module) return pass.empty() ? ir::dump(*module) : text;
  report(module.error(), impl_->file, messages);
  return {};
}

std::optional<Proofs> Graph::prove(const Options& options, Messages& messages, Precision precision) {
  if (!filled(impl_.get(), "graph", messages)) return std::nullopt;
  const Result<ir::Module> module = impl_->module(options, checkReading);
  if (!module) return report(module.error(), impl_->file, messages), std::nullopt;
  const std::shared_ptr<const Language> library = *libraryFor(options);
  return valueOf(proveGraph(*impl_->flat(options, *library), *module, *library, options, precision),
                 impl_->file, messages);
}

}  // namespace lacquer
