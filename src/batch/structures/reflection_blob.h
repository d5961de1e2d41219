// A shader's interface in the cache.
#pragma once

#include "lacquer/reflection.h"
#include "support/blob.h"

namespace lacquer {

template <>
struct LastEnumerator<BlockRole> {
  static constexpr BlockRole value = BlockRole::List;
};
template <>
struct LastEnumerator<TextureRole> {
  static constexpr TextureRole value = TextureRole::Object;
};
template <>
struct LastEnumerator<RootKind> {
  static constexpr RootKind value = RootKind::Samplers;
};

template <>
struct LastEnumerator<Wrap> {
  static constexpr Wrap value = Wrap::Mirror;
};
template <>
struct LastEnumerator<Filter> {
  static constexpr Filter value = Filter::LinearMipmapLinear;
};

template <class Archive>
void fields(Archive& archive, RootParameter& of) {
  archive(of.kind, of.space, of.binding, of.count);
}
template <class Archive>
void fields(Archive& archive, BoundResource& of) {
  archive(of.name, of.at.set, of.at.binding, of.at.flat, of.vertex, of.fragment);
  archive(of.wgsl.group, of.wgsl.binding, of.wgsl.sampler);
  for (MslPlace* at : {&of.msl, &of.msl_argument}) archive(at->argument_buffer, at->index, at->sampler);
}
template <class Archive>
void fields(Archive& archive, BlockField& of) {
  archive(of.name, of.type, of.offset, of.array, of.stride, of.meaning, of.expression);
}
template <class Archive>
void fields(Archive& archive, PreshaderValue& of) {
  archive(of.name, of.type, of.expression);
}
template <class Archive>
void fields(Archive& archive, UniformBlock& of) {
  archive(static_cast<BoundResource&>(of), of.role, of.structure, of.list, of.size, of.array, of.values,
          of.fields);
}
template <class Archive>
void fields(Archive& archive, ReflectedTexture& of) {
  archive(static_cast<BoundResource&>(of), of.slot, of.type, of.sampler, of.role, of.srgb, of.array,
          of.number, of.layered);
  TextureSampler sampler = of.static_sampler.value_or(TextureSampler());
  bool fixed = of.static_sampler.has_value();
  archive(fixed, sampler.wrap_s, sampler.wrap_t, sampler.mag_filter, sampler.min_filter, of.static_register);
  if (fixed) of.static_sampler = sampler;
}
template <class Archive>
void fields(Archive& archive, ShaderInput& of) {
  archive(of.name, of.type, of.location);
}
template <class Archive>
void fields(Archive& archive, ShaderOutput& of) {
  archive(of.name, of.location, of.holds, of.type);
}
template <class Archive>
void fields(Archive& archive, Range& of) {
  archive(of.low, of.high, of.or_zero);
}
template <class Archive>
void fields(Archive& archive, ReflectedParameter& of) {
  archive(of.name, of.type, of.range, of.neutral, of.meaning, of.fields);
}
template <class Archive>
void fields(Archive& archive, SpecConstant& of) {
  archive(of.id, of.name, of.component, of.type, of.neutral);
}
template <class Archive>
void fields(Archive& archive, OperationProof& of) {
  archive(of.term, of.name, of.operation, of.rate, of.operand, of.need);
  archive(of.reached.low, of.reached.high, of.reached.nan, of.safe);
}
template <class Archive>
void fields(Archive& archive, Reflection& of) {
  archive(of.bindless, of.template_name, of.blocks, of.parameters, of.has_spec_constants, of.spec_constants,
          of.textures, of.inputs, of.outputs, of.depth, of.displaces, of.proved, of.unproved,
          of.webgpu_limits, of.root_signature, of.root_parameters);
  RelaxedFigures figures = of.relaxed.value_or(RelaxedFigures());
  bool relaxed = of.relaxed.has_value();
  archive(relaxed, figures.bound, figures.operations, figures.of_operations, figures.cycles,
          figures.of_cycles, figures.conversions);
  if (relaxed) of.relaxed = figures;
  HalfFigures types = of.half.value_or(HalfFigures());
  bool half = of.half.has_value();
  archive(half, types.used, types.by, types.cycles, types.of_cycles);
  if (half) of.half = types;
  OptimizedFigures search = of.optimized.value_or(OptimizedFigures());
  bool optimized = of.optimized.has_value();
  archive(optimized, search.level, search.family, search.by, search.cycles, search.of_cycles,
          search.error_growth, search.error);
  if (optimized) of.optimized = search;
}

}  // namespace lacquer
