#include "passes/pipeline.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "ir/canonical.h"
#include "support/digest.h"

namespace lacquer::passes {

namespace {

/// Decisions of passes that later passes follow.
struct Decided {
  std::optional<HalfForm> half;
};

struct Pass {
  PassInfo info;
  void (*run)(ir::Module&, const PipelineOptions&, Decided&);
};

/// `--optimize`: the search, and who chooses of what it has found.
void optimizeFragment(ir::Module& module, const PipelineOptions& options, Decided& decided);

const optimize::Family& familyOf(const PipelineOptions& options) {
  return options.optimize.family != nullptr ? *options.optimize.family : optimize::families()[0];
}

/// The cheapest of some forms, the first of which has no types of 16 bits.
Choice cheapestOf(std::span<const ir::Module> forms, const PipelineOptions& options) {
  std::optional<Choice> made = options.choose ? options.choose(forms) : std::nullopt;
  if (made) return std::move(*made);
  std::vector<double> cycles;
  for (const ir::Module& form : forms)
    cycles.push_back(std::round(optimize::cyclesOf(form, familyOf(options))));
  const auto least = std::min_element(cycles.begin(), cycles.end());
  return {static_cast<size_t>(least - cycles.begin()), "model", cycles[0], *least};
}

/// `--half`: gives types of 16 bits to what is cheaper with them.
void takeHalves(ir::Module& module, const PipelineOptions& options, Decided& decided) {
  if (!options.half || !module.dag.anyRelaxed()) return;
  std::vector<ir::Module> forms = halves(module, options.relaxed);
  if (!decided.half) {
    Choice choice = cheapestOf(forms, options);
    decided.half = halfOf(choice);
  }
  if (decided.half->index > 0) module = std::move(forms[decided.half->index]);
  module.half = std::move(decided.half->said);
}

constexpr std::array kPasses{
    Pass{{"lights",
          "with known lights (`--lights`): fields of the light become constants, sums over one light lose "
          "their "
          "loop"},
         [](ir::Module& m, const PipelineOptions& o, Decided&) { specializeLights(m, o.lights); }},
    Pass{{"ranges", "removes clamps, choices and guards that intervals prove idle"},
         [](ir::Module& m, const PipelineOptions&, Decided&) { simplifyRanges(m); }},
    Pass{{"loops", "leaves out what loops carry and nobody asks for"},
         [](ir::Module& m, const PipelineOptions&, Decided&) { pruneLoops(m); }},
    Pass{{"reciprocals", "divides by the preshader's values with reciprocals that the preshader makes"},
         [](ir::Module& m, const PipelineOptions&, Decided&) { takeReciprocals(m); }},
    Pass{{"scales", "gathers scalar factors of vectors, takes them out of dot products"},
         [](ir::Module& m, const PipelineOptions&, Decided&) { placeScales(m); }},
    Pass{{"vertex",
          "moves affine functions of interpolated values to the vertex shader, where that costs no "
          "interpolants"},
         [](ir::Module& m, const PipelineOptions&, Decided&) { hoistToVertex(m); }},
    Pass{{"optimize",
          "with `--optimize`: puts the cheapest of equal forms in the place of the fragment stage"},
         [](ir::Module& m, const PipelineOptions& o, Decided& d) { optimizeFragment(m, o, d); }},
    Pass{{"place",
          "splits the DAG at its rates: material values become fields of the `Material` block, interpolated "
          "ones varyings"},
         [](ir::Module& m, const PipelineOptions& o, Decided&) { place(m, o.other); }},
    Pass{{"bind", "numbers the textures that are left"},
         [](ir::Module& m, const PipelineOptions& o, Decided&) { bind(m, o.other); }},
    // Behind all that changes values.
    Pass{{"relax", "with `--relaxed`: marks what may be computed at half precision"},
         [](ir::Module& m, const PipelineOptions& o, Decided&) { relax(m, o.relaxed); }},
    Pass{{"half", "with `--half`: gives types of 16 bits to what is cheaper with them"},
         [](ir::Module& m, const PipelineOptions& o, Decided& d) { takeHalves(m, o, d); }},
    Pass{{"bindless",
          "with `--binding bindless`: makes elements of lists of objects and materials, and of arrays of "
          "textures"},
         [](ir::Module& m, const PipelineOptions& o, Decided&) {
           if (o.bindless) makeBindless(m);
         }},
    Pass{{"arrays", "with `--binding arrays`: makes the material's textures layers of one"},
         [](ir::Module& m, const PipelineOptions& o, Decided&) {
           if (o.arrays) makeArrays(m);
           if (o.static_samplers) return;
           for (ir::TextureSlot& slot : m.textures) slot.sampler.reset();
         }},
};

constexpr auto kInfos = [] {
  std::array<PassInfo, kPasses.size()> infos{};
  for (size_t i = 0; i < kPasses.size(); ++i) infos[i] = kPasses[i].info;
  return infos;
}();

void runFrom(size_t first, ir::Module& module, const PipelineOptions& options) {
  Decided decided;
  for (size_t i = first; i < kPasses.size(); ++i) {
    kPasses[i].run(module, options, decided);
    assert(ir::verify(module).empty());
    if (options.after) options.after(kPasses[i].info.name, module);
  }
}

/// Of the forms that a search has found, and of each with types of 16 bits. `forms` are at 32 bits and went
/// through all passes; `choice` is among them.
std::optional<HalfForm> halfAmong(std::span<const ir::Module> forms, Choice& choice,
                                  const PipelineOptions& options) {
  std::optional<HalfForm> best;
  ir::Module first = forms[choice.index];
  const size_t wide = choice.index;
  for (size_t i = 0; i < forms.size(); ++i) {
    if (!forms[i].dag.anyRelaxed()) continue;
    // The first of halves() is at 32 bits: in its place stands the cheapest of those.
    std::vector<ir::Module> some = halves(forms[i], options.relaxed);
    some[0] = first;
    const HalfForm form = halfOf(cheapestOf(some, options));
    if (i == wide && !best) best = form;
    if (form.index == 0 || (best && best->index > 0 && !(form.said.cycles < best->said.cycles))) continue;
    best = form;
    choice.index = i;
  }
  return best;
}

void optimizeFragment(ir::Module& module, const PipelineOptions& options, Decided& decided) {
  if (options.optimize.level == 0) return;
  if (options.searched != nullptr && options.searched->module) {
    module = *options.searched->module;
    decided.half = options.searched->half;
    return;
  }
  std::vector<optimize::Candidate> found = optimize::search(module, options.optimize);
  // Parts of a cycle tell plans apart that are equally fast.
  Choice choice{found.size() - 1, "model", std::round(found.front().outcome.cycles),
                std::round(found.back().outcome.cycles)};
  const bool by_halves = options.half && options.relaxed > 0;
  if (options.choose || by_halves) {
    const auto here = std::find_if(kPasses.begin(), kPasses.end(),
                                   [](const Pass& pass) { return pass.info.name == "optimize"; });
    PipelineOptions silent = options;
    silent.after = nullptr;
    silent.half = false;
    silent.bindless = silent.arrays = false;  // what is drawn with is compared as it is bound plainly
    std::vector<ir::Module> forms;
    for (const optimize::Candidate& candidate : found) {
      forms.push_back(candidate.module);
      runFrom(static_cast<size_t>(here - kPasses.begin()) + 1, forms.back(), silent);
    }
    // Placed, a module counts a little less or more by the model: with halves all are counted so.
    std::optional<Choice> other = options.choose ? options.choose(forms) : std::nullopt;
    if (!other && by_halves) other = cheapestOf(forms, options);
    if (other) choice = std::move(*other);
    if (by_halves) decided.half = halfAmong(forms, choice, options);
  }
  const optimize::Outcome outcome = found[choice.index].outcome;
  if (choice.index > 0) module = std::move(found[choice.index].module);
  module.optimized = {options.optimize.level,
                      std::string(familyOf(options).name),
                      choice.by,
                      choice.plain,
                      choice.cycles,
                      outcome.growth,
                      outcome.error};
  if (options.searched != nullptr) *options.searched = {module, decided.half};
}

}  // namespace

HalfForm halfOf(const Choice& choice) {
  // As fast with conversions is slower on some other device.
  const bool used = choice.index > 0 && choice.cycles < choice.plain;
  return {used ? choice.index : 0, {used, choice.by, choice.plain, used ? choice.cycles : choice.plain}};
}

std::span<const PassInfo> passes() { return kInfos; }

void runPipeline(ir::Module& module, const PipelineOptions& options) { runFrom(0, module, options); }

Digest contentDigest(const ir::Module& module) { return digestOf(ir::canonical(module)); }

std::string contentAddress(const Digest& digest) {
  constexpr size_t kBytes = 16;
  return hexOf(digest, kBytes);
}

}  // namespace lacquer::passes
