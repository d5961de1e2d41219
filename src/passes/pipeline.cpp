#include "passes/pipeline.h"

#include <fmt/format.h>

#include <array>
#include <cassert>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace lacquer::passes {

namespace {

struct Pass {
  std::string_view name;
  void (*run)(ir::Module&, const PipelineOptions&);
};

constexpr std::array kPasses{
    // What is known of the lights turns fields into constants: whole branches of the light model fold away.
    Pass{"lights", [](ir::Module& m, const PipelineOptions& o) { specializeLights(m, o.lights); }},
    // Clamps and choices that the ranges of the inputs prove idle.
    Pass{"ranges", [](ir::Module& m, const PipelineOptions&) { simplifyRanges(m); }},
    // The preshader divides, and once.
    Pass{"reciprocals", [](ir::Module& m, const PipelineOptions&) { takeReciprocals(m); }},
    // One product of two Floats instead of three with a vector's components.
    Pass{"scales", [](ir::Module& m, const PipelineOptions&) { placeScales(m); }},
    // Affine functions of interpolated values may be computed at the vertices.
    Pass{"vertex", [](ir::Module& m, const PipelineOptions&) { hoistToVertex(m); }},
    // Material rate goes to the preshader, vertex rate to the vertex stage.
    Pass{"place", [](ir::Module& m, const PipelineOptions&) { place(m); }},
    // The textures that are left get their slots.
    Pass{"bind", [](ir::Module& m, const PipelineOptions&) { bind(m); }},
    // What may be done at half precision, where that is asked for. Behind all that changes values.
    Pass{"relax", [](ir::Module& m, const PipelineOptions& o) { relax(m, o.relaxed); }},
};

constexpr auto kPassNames = [] {
  std::array<std::string_view, kPasses.size()> names{};
  for (size_t i = 0; i < kPasses.size(); ++i) names[i] = kPasses[i].name;
  return names;
}();

}  // namespace

std::span<const std::string_view> passNames() { return kPassNames; }

void runPipeline(ir::Module& module, const PipelineOptions& options) {
  for (const Pass& pass : kPasses) {
    pass.run(module, options);
    assert(ir::verify(module).empty());
    if (options.after) options.after(pass.name, module);
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
    key += fmt::format(" {}\n", p.constant_id);
  }
  for (const ir::Varying& varying : module.varyings) key += fmt::format("varying {}\n", varying.name);
  for (const ir::LightGroup& group : module.light_groups)
    key += fmt::format("lights {} {}\n", group.first, group.count);
  return fmt::format("{:016x}", XXH3_64bits(key.data(), key.size()));
}

}  // namespace lacquer::passes
