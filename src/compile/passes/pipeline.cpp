#include "passes/pipeline.h"

#include <array>
#include <cassert>

#include "ir/canonical.h"
#include "support/digest.h"

namespace lacquer::passes {

namespace {

struct Pass {
  PassInfo info;
  void (*run)(ir::Module&, const PipelineOptions&);
};

constexpr std::array kPasses{
    Pass{{"lights",
          "with known lights (`--lights`): fields of the light become constants, sums over one light lose "
          "their "
          "loop"},
         [](ir::Module& m, const PipelineOptions& o) { specializeLights(m, o.lights); }},
    Pass{{"ranges", "removes clamps, choices and guards that intervals prove idle"},
         [](ir::Module& m, const PipelineOptions&) { simplifyRanges(m); }},
    Pass{{"reciprocals", "divides by the preshader's values with reciprocals that the preshader makes"},
         [](ir::Module& m, const PipelineOptions&) { takeReciprocals(m); }},
    Pass{{"scales", "gathers scalar factors of vectors, takes them out of dot products"},
         [](ir::Module& m, const PipelineOptions&) { placeScales(m); }},
    Pass{{"vertex",
          "moves affine functions of interpolated values to the vertex shader, where that costs no "
          "interpolants"},
         [](ir::Module& m, const PipelineOptions&) { hoistToVertex(m); }},
    Pass{{"place",
          "splits the DAG at its rates: material values become fields of the `Material` block, interpolated "
          "ones varyings"},
         [](ir::Module& m, const PipelineOptions&) { place(m); }},
    Pass{{"bind", "numbers the textures that are left"},
         [](ir::Module& m, const PipelineOptions&) { bind(m); }},
    // Behind all that changes values.
    Pass{{"relax", "with `--relaxed`: marks what may be computed at half precision"},
         [](ir::Module& m, const PipelineOptions& o) { relax(m, o.relaxed); }},
};

constexpr auto kInfos = [] {
  std::array<PassInfo, kPasses.size()> infos{};
  for (size_t i = 0; i < kPasses.size(); ++i) infos[i] = kPasses[i].info;
  return infos;
}();

}  // namespace

std::span<const PassInfo> passes() { return kInfos; }

void runPipeline(ir::Module& module, const PipelineOptions& options) {
  for (const Pass& pass : kPasses) {
    pass.run(module, options);
    assert(ir::verify(module).empty());
    if (options.after) options.after(pass.info.name, module);
  }
}

Digest contentDigest(const ir::Module& module) { return digestOf(ir::canonical(module)); }

std::string contentAddress(const Digest& digest) {
  constexpr size_t kBytes = 16;
  return hexOf(digest, kBytes);
}

}  // namespace lacquer::passes
