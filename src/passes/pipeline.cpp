#include "passes/pipeline.h"

#include <fmt/format.h>

#include <array>
#include <cassert>

#define XXH_INLINE_ALL
#include <xxhash.h>

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

std::string contentAddress(const ir::Module& module) {
  std::string key = module.template_name + "\n" + ir::dump(module);
  for (const ir::TextureSlot& slot : module.textures) {
    const uint32_t place = slot.optional      ? slot.binding.binding
                           : slot.environment ? slot.binding.flat
                                              : slot.binding.flat - module.material_textures;
    key += fmt::format("texture {} {} {} {}\n", slot.name, ir::typeName(slot.type), slot.srgb, place);
  }
  for (const uint32_t index : ir::usedParameters(module)) {
    const ir::Parameter& p = module.parameters[index];
    key += fmt::format("parameter {} {}", p.name, ir::typeName(p.type));
    for (const double x : p.neutral) key += fmt::format(" {}", x);
    key += fmt::format(" {} {} {}", p.range.lo, p.range.hi, p.range.gap);  // the packers hold to it
    key += fmt::format(" {}\n", p.constant_id);
  }
  for (const ir::Varying& varying : module.varyings) key += fmt::format("varying {}\n", varying.name);
  for (const ir::LightGroup& group : module.light_groups)
    key += fmt::format("lights {} {}\n", group.first, group.count);
  return fmt::format("{:016x}", XXH3_64bits(key.data(), key.size()));
}

}  // namespace lacquer::passes
