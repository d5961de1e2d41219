#include "lod/moves.h"

#include <algorithm>
#include <cmath>

#include "optimize/cost.h"
#include "setting/options.h"
#include "setting/simplify.h"
#include "shader/module.h"
#include "support/jobs.h"

namespace lacquer::lod {

namespace {

/// What looks worse is not looked at: as of the last level that is made when nothing is said.
constexpr double kMostSeen = 2;

double fragmentCycles(const ir::Module& module, const optimize::Family& family) {
  optimize::Constants constants;
  const optimize::Plan plan = optimize::planOf(module, constants);
  return optimize::cyclesOf(optimize::Counter(module).count(plan, constants), family);
}

/// The vertex stage counted as a fragment stage of the same outputs.
double vertexCycles(ir::Module module, const optimize::Family& family) {
  std::erase_if(module.outputs, [](const ir::Output& out) { return out.stage != ir::Stage::Vertex; });
  for (ir::Output& out : module.outputs) out.stage = ir::Stage::Fragment;
  for (const ir::Varying& varying : module.varyings) {
    if (varying.source != ir::kNoValue)
      module.outputs.push_back({ir::OutputKind::Color, ir::Stage::Fragment, varying.name, 0, varying.source});
  }
  return fragmentCycles(module, family);
}

Words nodesOf(const LodMaterial::Given& given, const Options& options) {
  Diagnostics warnings;
  const Result<graph::Graph> graph = given.subject.built(given.attributes, given.language, options, warnings);
  if (!graph) return {};
  Words words = possibleWords(*graph, given.subject.material(), given.language, options);
  std::erase_if(words, [](const std::string& word) { return !word.starts_with("vertex:"); });
  return words;
}

}  // namespace

Result<std::optional<std::vector<Moved>>> moves(const LodMaterial::Given& given, uint32_t size,
                                                Messages& messages, const Progress& progress) {
  Options plain = given.options;
  plain.programs_model = true;
  plain.optimize = 0;
  plain.optimize_error = 0;
  const optimize::Family* const named = optimization(plain).family;
  const optimize::Family& family = named != nullptr ? *named : optimize::families()[0];
  const LodMaterial::Given searched{given.subject, given.attributes, given.lights,
                                    given.images,  given.language,   plain,
                                    given.texels,  given.mesh,       given.radius};
  LodMaterial subject(searched, size);
  const Result<Tried> opened = subject.open(messages);
  if (!opened && opened.error().front().code == "lod-template") return std::nullopt;
  if (!opened) return tl::make_unexpected(opened.error());
  const Result<ir::Module> exact = subject.module({});
  if (!exact) return tl::make_unexpected(exact.error());
  const double at_vertices = vertexCycles(*exact, family);
  const auto moreOf = [&](const ir::Module& module) {
    return std::max(vertexCycles(module, family) - at_vertices, 0.0);
  };
  size_t done = 0, known = 0;
  const Measure measure = [&](const std::vector<Words>& sets, double) {
    const size_t together = std::max<size_t>(16, 4 * threads());
    known += sets.size();
    std::vector<std::optional<Tried>> tried;
    for (size_t i = 0; i < sets.size(); i += together) {
      const auto begin = sets.begin() + static_cast<ptrdiff_t>(i);
      const size_t count = std::min(together, sets.size() - i);
      for (std::optional<Tried>& one : subject.measure({begin, begin + static_cast<ptrdiff_t>(count)})) {
        const Result<ir::Module> module = one ? subject.module(one->words) : exact;
        if (one && module) one->cost = fragmentCycles(*module, family) + kVertexShare * moreOf(*module);
        tried.push_back(std::move(one));
      }
      done += count;
      if (progress) progress(done, known);
    }
    return tried;
  };
  Bounds bounds;
  bounds.most_error = kMostSeen;
  const Tried first{{}, fragmentCycles(*exact, family), 0};
  const Subject of_word = [](const std::string& word) { return word; };
  const std::vector<Tried> best =
      front(search(first, nodesOf(searched, plain), of_word, bounds, measure).tried);

  // The forms of each of them that are equal to it may be cheaper still.
  Options optimized = plain;
  optimized.optimize = std::max(given.options.optimize, 1U);
  const LodMaterial::Given with{given.subject, given.attributes, given.lights, given.images, given.language,
                                optimized,     given.texels,     given.mesh,   given.radius};
  const LodMaterial cheapest(with, size);
  std::vector<Moved> moved;
  double least = 0;
  for (const Tried& one : best) {
    const Result<ir::Module> module = cheapest.module(one.words);
    if (!module) return tl::make_unexpected(module.error());
    const double cycles = module->optimized ? module->optimized->cycles : 0;
    const double more = one.words.empty() ? 0 : std::round(moreOf(*module));
    const double cost = cycles + kVertexShare * more;
    const bool cheaper = one.words.empty() || cost < least;
    if (cheaper) least = cost;
    if (!cheaper || one.words.empty()) continue;
    const Result<LevelFigures> seen = subject.seen(one.words, true);
    if (!seen) return tl::make_unexpected(seen.error());
    // Smaller pictures may have told two apart the other way: what costs more and looks worse is none.
    while (!moved.empty() && moved.back().error.delta_e >= seen->error.delta_e) moved.pop_back();
    moved.push_back({one.words, seen->error, cycles, more, cost, shaderId(*module, given.language)});
  }
  return moved;
}

}  // namespace lacquer::lod
