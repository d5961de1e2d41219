#include "bench/optimize.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>

#include "bench/works.h"
#include "optimize/optimize.h"
#include "setting/options.h"
#include "shader/module.h"

namespace lacquer::bench {

namespace {

/// A work's module as the passes before the search leave it.
Result<ir::Module> moduleOf(const Work& work, Options options) {
  options.lights = {Lights::Mode::Fixed, {{"directional", 1}}};
  options.ibl = work.ibl;
  const auto language = libraryFor(options);
  if (!language) return tl::make_unexpected(language.error());
  if (auto names = resolveNames(**language, options); !names) return tl::make_unexpected(names.error());
  const Result<material::Document> document =
      readMaterials(std::string(LACQUER_SOURCE_FOLDER "/bench/works/") + work.file, **language, options);
  if (!document) return tl::make_unexpected(document.error());
  Diagnostics warnings;
  const gltf::VertexAttributes attributes{true, true, false, {true, true}};
  Result<graph::Graph> graph =
      buildGraph(document->materials.at(0), attributes, **language, options, warnings);
  if (!graph) return tl::make_unexpected(graph.error());
  if (Diagnostics found = graph::check(*graph, **language); hasError(found))
    return tl::make_unexpected(std::move(found));
  ir::Module before;
  const AfterPass keep = [&](std::string_view pass, const ir::Module& module) {
    if (pass == "vertex") before = module;
  };
  const Result<ir::Module> module = toModule(*graph, **language, options, {}, keep);
  if (!module) return tl::make_unexpected(module.error());
  return before;
}

}  // namespace

int runOptimize() {
  Options options;
  const int level = std::getenv("LEVEL") != nullptr ? std::atoi(std::getenv("LEVEL")) : 1;
  double plain = 0;
  double best = 0;
  double seconds = 0;
  for (const Work& work : kWorks) {
    if (std::getenv("WORK") != nullptr && work.name != std::getenv("WORK")) continue;
    const Result<ir::Module> module = moduleOf(work, options);
    if (!module) {
      fmt::print(stderr, "{}\n", format(module.error().at(0)));
      return 1;
    }
    const auto begin = std::chrono::steady_clock::now();
    const std::vector<optimize::Candidate> found = optimize::search(*module, {level, 0, nullptr});
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    fmt::print("{:6} {:7.0f} -> {:7.0f}  growth {:.2f}  {:.2f} s\n", work.name, found.front().outcome.cycles,
               found.back().outcome.cycles, found.back().outcome.growth, took.count());
    std::fflush(stdout);
    plain += found.front().outcome.cycles;
    best += found.back().outcome.cycles;
    seconds += took.count();
  }
  fmt::print("{:6} {:7.0f} -> {:7.0f}  {:.2f} s\n", "all", plain, best, seconds);
  return 0;
}

}  // namespace lacquer::bench
