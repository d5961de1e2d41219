// What is accepted must be good: it compiles, validates, and comes to finite colours that are not negative.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "feeds.h"
#include "graph/graph.h"
#include "lower/lower.h"
#include "passes/pipeline.h"
#include "setting/language.h"
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
    (*subject)->space.draw(mixed(seed, i), std::span(samples).subspan(i * width, width));
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
  const uint64_t seed = numberOf(bytes);
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
  // Where something may leave the range of what it goes to, a colour may come to anything.
  const bool promised = graph::doubts(*graph, **language, true).empty();
  return judge(*graph, **language, options, numberOf(bytes), promised);
}

}  // namespace lacquer::fuzz
