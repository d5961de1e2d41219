// What a shader is bound to, as values.
#include <algorithm>
#include <cstring>

#include "c/handles.h"

using lacquer::BoundResource;
using lacquer::Reflection;
using namespace lacquer::c;

namespace {

const Reflection& reflectionOf(const lacquer_shader* shader) { return shaderOf(shader).reflection(); }

lacquer_binding bindingOf(const BoundResource& of) {
  return {of.at.set,
          of.at.binding,
          of.at.flat,
          of.wgsl.group,
          of.wgsl.binding,
          of.wgsl.sampler,
          of.msl.index,
          of.msl.sampler,
          of.msl_argument.argument_buffer,
          of.msl_argument.index,
          of.msl_argument.sampler,
          of.vertex ? 1 : 0,
          of.fragment ? 1 : 0};
}

}  // namespace

size_t lacquer_shader_block_count(const lacquer_shader* shader) { return reflectionOf(shader).blocks.size(); }
size_t lacquer_shader_texture_count(const lacquer_shader* shader) {
  return reflectionOf(shader).textures.size();
}
size_t lacquer_shader_input_count(const lacquer_shader* shader) { return reflectionOf(shader).inputs.size(); }
size_t lacquer_shader_output_count(const lacquer_shader* shader) {
  return reflectionOf(shader).outputs.size();
}

int lacquer_shader_block(const lacquer_shader* shader, size_t index, lacquer_block* to, size_t size) {
  const Reflection& all = reflectionOf(shader);
  if (index >= all.blocks.size()) return 0;
  const lacquer::UniformBlock& of = all.blocks[index];
  const lacquer_block made = {of.name.c_str(), of.structure.c_str(),
                              of.list.c_str(), static_cast<int>(of.role),
                              bindingOf(of),   of.size,
                              of.array,        of.fields.size()};
  return fillRow(made, to, size);
}

int lacquer_shader_field(const lacquer_shader* shader, size_t block, size_t index, lacquer_field* to,
                         size_t size) {
  const Reflection& all = reflectionOf(shader);
  if (block >= all.blocks.size() || index >= all.blocks[block].fields.size()) return 0;
  const lacquer::BlockField& of = all.blocks[block].fields[index];
  return fillRow(lacquer_field{of.name.c_str(), of.type.c_str(), of.offset, of.array, of.stride}, to, size);
}

int lacquer_shader_texture(const lacquer_shader* shader, size_t index, lacquer_texture* to, size_t size) {
  const Reflection& all = reflectionOf(shader);
  if (index >= all.textures.size()) return 0;
  const lacquer::ReflectedTexture& of = all.textures[index];
  const lacquer::TextureSampler sampler = of.static_sampler.value_or(lacquer::TextureSampler());
  const lacquer_texture made = {of.name.c_str(),
                                of.type.c_str(),
                                of.sampler.c_str(),
                                of.slot.c_str(),
                                static_cast<int>(of.role),
                                of.srgb ? 1 : 0,
                                bindingOf(of),
                                of.array.c_str(),
                                of.number,
                                of.layered ? 1 : 0,
                                of.static_sampler ? 1 : 0,
                                static_cast<int>(sampler.wrap_s),
                                static_cast<int>(sampler.wrap_t),
                                static_cast<int>(sampler.mag_filter),
                                static_cast<int>(sampler.min_filter),
                                of.static_register};
  return fillRow(made, to, size);
}

int lacquer_shader_input(const lacquer_shader* shader, size_t index, lacquer_place* to, size_t size) {
  const Reflection& all = reflectionOf(shader);
  if (index >= all.inputs.size()) return 0;
  const lacquer::ShaderInput& of = all.inputs[index];
  return fillRow(lacquer_place{of.name.c_str(), of.type.c_str(), of.location}, to, size);
}

int lacquer_shader_output(const lacquer_shader* shader, size_t index, lacquer_place* to, size_t size) {
  const Reflection& all = reflectionOf(shader);
  if (index >= all.outputs.size()) return 0;
  const lacquer::ShaderOutput& of = all.outputs[index];
  return fillRow(lacquer_place{of.name.c_str(), of.type.c_str(), of.location}, to, size);
}

const char* lacquer_shader_depth(const lacquer_shader* shader) { return reflectionOf(shader).depth.c_str(); }

const char* lacquer_shader_displaced(const lacquer_shader* shader, size_t index) {
  const lacquer::Strings& all = reflectionOf(shader).displaces;
  return index < all.size() ? all[index].c_str() : nullptr;
}

size_t lacquer_graph_texture_count(const lacquer_graph* graph) {
  return guarded(nullptr, size_t{0}, [&](lacquer::Messages&) { return graphOf(graph).textures().size(); });
}

int lacquer_graph_texture(const lacquer_graph* graph, size_t index, char* slot, size_t capacity,
                          int* texture) {
  return guarded(nullptr, 0, [&](lacquer::Messages&) {
    const std::vector<lacquer::TextureUse> textures = graphOf(graph).textures();
    if (index >= textures.size()) return 0;
    const std::string& name = textures[index].name;
    if (slot != nullptr && capacity <= name.size()) return 0;
    if (slot != nullptr) std::memcpy(slot, name.c_str(), name.size() + 1);
    if (texture != nullptr) *texture = textures[index].texture;
    return 1;
  });
}
