#include "eval/subject.h"

#include <fmt/format.h>

#include <string_view>

#include "setting/options.h"
#include "setting/simplify.h"
#include "shader/module.h"
#include "support/file.h"

namespace lacquer {

const std::string& EvalSubject::name() const {
  return std::visit([](const auto* of) -> const std::string& { return of->name; }, of_);
}

const material::Material* EvalSubject::material() const {
  const auto* material = std::get_if<const material::Material*>(&of_);
  return material == nullptr ? nullptr : *material;
}

std::string EvalSubject::title() const {
  if (!name().empty()) return name();
  return isGraph() ? "(graph)" : fmt::format("(material {})", material()->index);
}

std::string EvalSubject::pointer() const {
  return isGraph() ? std::string() : fmt::format("/materials/{}", material()->index);
}

const Diagnostics& EvalSubject::diagnostics() const {
  static const Diagnostics kNone;
  return isGraph() ? kNone : material()->diagnostics;
}

Result<graph::Graph> EvalSubject::built(const gltf::VertexAttributes& attributes, const Language& library,
                                        const Options& options, Diagnostics& warnings,
                                        graph::FlatOutputs* outputs) const {
  if (!isGraph()) {
    Result<graph::Graph> built = buildGraph(*material(), attributes, library, options, warnings);
    if (built && outputs != nullptr) (void)graph::flattened(*built, library, outputs);
    return built;
  }
  const graph::Graph& own = *std::get<const graph::Graph*>(of_);
  if (Diagnostics wrong = asksToBuild(options); !wrong.empty()) return tl::make_unexpected(std::move(wrong));
  if (Diagnostics wrong = graph::check(own, library, limitsOf(options).value_or(Limits{}).nodes);
      lacquer::hasError(wrong))
    return tl::make_unexpected(std::move(wrong));
  graph::Graph graph = graph::flattened(own, library, outputs);
  if (Result<void> simpler = simplifyBuilt(graph, library, options.simplify); !simpler)
    return tl::make_unexpected(std::move(simpler.error()));
  return graph;
}

Result<graph::Graph> EvalSubject::graph(const gltf::VertexAttributes& attributes, const Language& library,
                                        const Options& options, std::vector<graph::Texture>& originals,
                                        Diagnostics& warnings, graph::FlatOutputs* outputs) const {
  Result<graph::Graph> graph = built(attributes, library, options, warnings, outputs);
  if (!graph) return graph;
  for (graph::Texture& slot : graph->textures) {
    originals.push_back(slot);
    slot.file.clear();
    slot.texture = static_cast<int>(originals.size()) - 1;
  }
  return graph;
}

bool isGraphFile(std::string_view path) { return path.ends_with(".json"); }

Result<graph::Graph> readGraphFile(const std::string& path, const Options& options) {
  const Result<Limits> limits = limitsOf(options);
  if (!limits) return tl::make_unexpected(limits.error());
  const Result<std::string> text = readFile(path, limits->file);
  if (!text) return tl::make_unexpected(text.error());
  return graph::fromJson(*text, path, *limits);
}

}  // namespace lacquer
