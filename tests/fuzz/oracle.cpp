// What is accepted must be good: it compiles, validates, and comes to finite colours that are not negative.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cache/key.h"
#include "feeds.h"
#include "graph/graph.h"
#include "lower/lower.h"
#include "passes/pipeline.h"
#include "shader/language.h"
#include "shader/module.h"
#include "shader/print.h"
#include "stress/subject.h"

namespace lacquer::fuzz {

namespace {

constexpr size_t kMostMaterials = 2;
constexpr size_t kSamples = 8;
/// Of the inputs, one in so many goes through the texts of all targets and their compilers, too: these take
/// ten times as long as all the rest.
constexpr uint64_t kTextsEvery = 16;

std::string textOf(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& d : diagnostics) text += format(d) + "\n";
  return text;
}

/// Whether all that is connected lies in the range of what it goes to, as both are declared: what a parameter
/// may be and a node may give, where check() looks at today's values alone and trusts the graph for the rest.
/// Behind a broken promise a colour may come to anything.
class Promises {
public:
  Promises(const graph::Graph& graph, const lang::Library& library)
      : graph_(graph), library_(library), template_(**library.template_(graph.template_name)) {}

  bool kept() const {
    for (const graph::Node& node : graph_.nodes) {
      for (const auto& [name, source] : node.inputs) {
        if (!fits(source, named((*library_.node(node.type))->params, name))) return false;
      }
    }
    return std::all_of(graph_.outputs.begin(), graph_.outputs.end(), [&](const auto& output) {
      const auto port = std::find_if(template_.ports.begin(), template_.ports.end(),
                                     [&](const lang::PortDecl& p) { return p.param.name == output.first; });
      return fits(output.second, port->param);
    });
  }

private:
  static const lang::Param& named(const std::vector<lang::Param>& params, std::string_view name) {
    return *std::find_if(params.begin(), params.end(), [&](const lang::Param& p) { return p.name == name; });
  }

  bool fits(const graph::Source& source, const lang::Param& into) const {
    if (!into.has_range || !ir::isFloating(into.type)) return true;
    const ir::Range* range = rangeOf(source);
    if (range == nullptr) return std::holds_alternative<graph::Literal>(source.from);
    const bool gap = into.range.gap > range->gap && range->lo < into.range.gap;
    return range->lo >= into.range.lo && range->hi <= into.range.hi && !gap;
  }

  /// Null for a literal, which check() has looked at, and where nothing is declared.
  const ir::Range* rangeOf(const graph::Source& source) const {
    if (const auto* parameter = std::get_if<graph::ParameterRef>(&source.from))
      return &graph_.parameters[*graph_.findParameter(parameter->name)].range;
    const lang::Param* declared = nullptr;
    if (const auto* given = std::get_if<graph::GivenRef>(&source.from)) {
      const auto found = template_.find(given->name);
      declared = &found->given->results[found->index];
    } else if (const auto* node = std::get_if<graph::NodeRef>(&source.from)) {
      const std::string& type = graph_.nodes[*graph_.find(node->node)].type;
      declared = &named((*library_.node(type))->results, node->output);
    }
    return declared != nullptr && declared->has_range ? &declared->range : nullptr;
  }

  const graph::Graph& graph_;
  const lang::Library& library_;
  const lang::TemplateDecl& template_;
};

std::string codeOf(const ir::Module& module, const Language& language, const Options& options) {
  ShaderData data;
  data.module = module;
  data.id = shaderId(module, language);
  data.has_vertex = hasVertexStage(module);
  Wrong wrong;
  print(data, options, wrong);
  for (const Diagnostics& of_target : wrong) {
    if (!of_target.empty()) return "the code is not valid:\n" + textOf(of_target);
  }
  return {};
}

/// Colours of samples over all inputs in their ranges, the material's parameters among them. `promised`: they
/// must be good ones.
std::string coloursOf(const graph::Graph& graph, const Language& language, uint64_t seed, bool promised) {
  Result<ir::Module> module = lower::lower(graph, language, {lower::ParameterMode::Uniform, true});
  if (!module) return "an accepted graph is not lowered:\n" + textOf(module.error());
  passes::PipelineOptions pipeline;
  pipeline.lights = {false, {{"directional", 1}}};
  passes::runPipeline(*module, pipeline);
  const auto subject = stress::materialSubject("fuzz", std::move(*module), {});
  if (!subject) return "an accepted graph is not evaluated:\n" + textOf(subject.error());
  const size_t width = (*subject)->space.width();
  std::vector<double> samples(kSamples * width);
  for (size_t i = 0; i < kSamples; ++i)
    (*subject)->space.draw(stress::mixed(seed, i), std::span(samples).subspan(i * width, width));
  const stress::Values values = (*subject)->evaluate(stress::Arithmetic::Double, samples, kSamples);
  for (size_t r = 0; r < values.size(); ++r) {
    const stress::Root& root = (*subject)->roots[r];
    if (root.kind != stress::Root::Kind::Result) continue;
    for (const double x : values[r]) {
      if (!(std::isfinite(x) && x >= 0) && promised) return fmt::format("{} comes to {}", root.name, x);
    }
  }
  return {};
}

/// `graph` is checked. `promised`: its colours must be good.
std::string judge(const graph::Graph& graph, const Language& language, Options options, uint64_t seed,
                  bool promised) {
  if (seed % kTextsEvery == 0) {
    options.targets = {Target::Glsl, Target::GlslGl, Target::Essl, Target::Hlsl, Target::Spirv};
    if (options.parameters == Parameters::Spec) options.targets = {Target::Glsl, Target::Spirv};
  }
  options.validate = true;
  const Result<ir::Module> module = toModule(graph, language, options, {});
  if (!module) return "an accepted graph makes no module:\n" + textOf(module.error());
  if (std::string wrong = codeOf(*module, language, options); !wrong.empty()) return wrong;
  return graph.template_name == "forward" ? coloursOf(graph, language, seed, promised) : std::string();
}

}  // namespace

std::string judgeGltf(std::string_view bytes) {
  Options options = optionsOf(bytes);
  const auto language = libraryFor(options);
  if (const Result<void> named = resolveNames(**language, options); !named) return textOf(named.error());
  const Result<const material::Schema*> schema = (*language)->models.schema();
  const auto document =
      material::readText(std::string(bytes), "fuzz.gltf", **schema, {options.permissive, {}});
  if (!document) return {};
  const uint64_t seed = keyOf(bytes).high;
  size_t left = kMostMaterials;
  for (const material::Material& material : document->materials) {
    if (lacquer::hasError(material.diagnostics)) continue;
    if (left-- == 0) break;
    Diagnostics said;
    Result<graph::Graph> graph =
        buildGraph(material, {true, true, true, {true, true, true, true}}, **language, options, said);
    if (!graph) return "an accepted material has no graph:\n" + textOf(graph.error());
    const Diagnostics found = graph::check(*graph, **language);
    if (lacquer::hasError(found)) return "an accepted material has a wrong graph:\n" + textOf(found);
    if (std::string wrong = judge(*graph, **language, options, seed, true); !wrong.empty()) return wrong;
  }
  return {};
}

std::string judgeGraph(std::string_view bytes) {
  Options options = optionsOf(bytes);
  const auto language = libraryFor(options);
  Result<graph::Graph> graph = graph::fromJson(bytes, "fuzz.json");
  if (!graph || lacquer::hasError(graph::check(*graph, **language))) return {};
  return judge(*graph, **language, options, keyOf(bytes).high, Promises(*graph, **language).kept());
}

}  // namespace lacquer::fuzz
