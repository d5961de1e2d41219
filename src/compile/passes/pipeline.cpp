#include "passes/pipeline.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "analysis/relax.h"
#include "ir/canonical.h"
#include "support/digest.h"

namespace lacquer::passes {

namespace {

struct Pass {
  PassInfo info;
  void (*run)(ir::Module&, const PipelineOptions&);
};

/// `--optimize`: the search, and who chooses of what it has found.
void optimizeFragment(ir::Module& module, const PipelineOptions& options);

/// `--half`: gives types of 16 bits to what is cheaper with them.
void takeHalves(ir::Module& module, const PipelineOptions& options) {
  if (!options.half || !module.dag.anyRelaxed()) return;
  std::vector<double> gains;
  std::vector<ir::Module> forms = halves(module, options.relaxed, gains);
  const auto best = static_cast<size_t>(std::max_element(gains.begin(), gains.end()) - gains.begin());
  const double plain = analysis::relaxedCost(module).all_cycles;
  Choice choice{best, "model", plain, plain - gains[best]};
  if (options.choose && forms.size() > 1) {
    if (std::optional<Choice> other = options.choose(forms)) choice = std::move(*other);
  }
  // As fast with conversions is slower on some other device.
  const bool used = choice.index > 0 && choice.cycles < choice.plain;
  if (used) module = std::move(forms[choice.index]);
  module.half = ir::Half{used, choice.by, choice.plain, used ? choice.cycles : choice.plain};
}

constexpr std::array kPasses{
    Pass{{"lights",
          "with known lights (`--lights`): fields of the light become constants, sums over one light lose "
          "their "
          "loop"},
         [](ir::Module& m, const PipelineOptions& o) { specializeLights(m, o.lights); }},
    Pass{{"ranges", "removes clamps, choices and guards that intervals prove idle"},
         [](ir::Module& m, const PipelineOptions&) { simplifyRanges(m); }},
    Pass{{"loops", "leaves out what loops carry and nobody asks for"},
         [](ir::Module& m, const PipelineOptions&) { pruneLoops(m); }},
    Pass{{"reciprocals", "divides by the preshader's values with reciprocals that the preshader makes"},
         [](ir::Module& m, const PipelineOptions&) { takeReciprocals(m); }},
    Pass{{"scales", "gathers scalar factors of vectors, takes them out of dot products"},
         [](ir::Module& m, const PipelineOptions&) { placeScales(m); }},
    Pass{{"vertex",
          "moves affine functions of interpolated values to the vertex shader, where that costs no "
          "interpolants"},
         [](ir::Module& m, const PipelineOptions&) { hoistToVertex(m); }},
    Pass{{"optimize",
          "with `--optimize`: puts the cheapest of equal forms in the place of the fragment stage"},
         [](ir::Module& m, const PipelineOptions& o) { optimizeFragment(m, o); }},
    Pass{{"place",
          "splits the DAG at its rates: material values become fields of the `Material` block, interpolated "
          "ones varyings"},
         [](ir::Module& m, const PipelineOptions& o) { place(m, o.other); }},
    Pass{{"bind", "numbers the textures that are left"},
         [](ir::Module& m, const PipelineOptions& o) { bind(m, o.other); }},
    // Behind all that changes values.
    Pass{{"relax", "with `--relaxed`: marks what may be computed at half precision"},
         [](ir::Module& m, const PipelineOptions& o) { relax(m, o.relaxed); }},
    Pass{{"half", "with `--half`: gives types of 16 bits to what is cheaper with them"},
         [](ir::Module& m, const PipelineOptions& o) { takeHalves(m, o); }},
    Pass{{"bindless",
          "with `--binding bindless`: makes elements of lists of objects and materials, and of arrays of "
          "textures"},
         [](ir::Module& m, const PipelineOptions& o) {
           if (o.bindless) makeBindless(m);
         }},
    Pass{{"arrays", "with `--binding arrays`: makes the material's textures layers of one"},
         [](ir::Module& m, const PipelineOptions& o) {
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
  for (size_t i = first; i < kPasses.size(); ++i) {
    kPasses[i].run(module, options);
    assert(ir::verify(module).empty());
    if (options.after) options.after(kPasses[i].info.name, module);
  }
}

void optimizeFragment(ir::Module& module, const PipelineOptions& options) {
  if (options.optimize.level == 0) return;
  std::vector<optimize::Candidate> found = optimize::search(module, options.optimize);
  const optimize::Family& family =
      options.optimize.family != nullptr ? *options.optimize.family : optimize::families()[0];
  // Parts of a cycle tell plans apart that are equally fast.
  Choice choice{found.size() - 1, "model", std::round(found.front().outcome.cycles),
                std::round(found.back().outcome.cycles)};
  if (options.choose) {
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
    if (std::optional<Choice> other = options.choose(forms)) choice = std::move(*other);
  }
  const optimize::Outcome outcome = found[choice.index].outcome;
  if (choice.index > 0) module = std::move(found[choice.index].module);
  module.optimized = {options.optimize.level, std::string(family.name), choice.by,    choice.plain,
                      choice.cycles,          outcome.growth,           outcome.error};
}

}  // namespace

std::span<const PassInfo> passes() { return kInfos; }

void runPipeline(ir::Module& module, const PipelineOptions& options) { runFrom(0, module, options); }

Digest contentDigest(const ir::Module& module) { return digestOf(ir::canonical(module)); }

std::string contentAddress(const Digest& digest) {
  constexpr size_t kBytes = 16;
  return hexOf(digest, kBytes);
}

}  // namespace lacquer::passes
