#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "c/handles.h"

namespace lacquer::c {

const Shader& shaderOf(const lacquer_shader* shader) {
  static const Shader kNone;
  return shader == nullptr ? kNone : shader->shader;
}

}  // namespace lacquer::c

using namespace lacquer::c;
using lacquer::Messages;
using lacquer::Shader;

void lacquer_shader_free(lacquer_shader* shader) { delete shader; }
const char* lacquer_shader_id(const lacquer_shader* shader) { return shaderOf(shader).id().c_str(); }
int lacquer_shader_has_vertex_stage(const lacquer_shader* shader) {
  return shaderOf(shader).hasVertexStage() ? 1 : 0;
}

const char* lacquer_shader_text(const lacquer_shader* shader, const char* target, int stage, size_t* size) {
  static const std::string kNone;
  lacquer::Target found{};
  const bool known = target != nullptr && lacquer::findTarget(target, found);
  const Shader& of = shaderOf(shader);
  if (!known || (stage != LACQUER_VERTEX && stage != LACQUER_FRAGMENT)) return give(kNone, size);
  const bool vertex = stage == LACQUER_VERTEX;
  return give(of.fileText(found, vertex ? 0 : 1), size);
}

const uint32_t* lacquer_shader_spirv(const lacquer_shader* shader, int stage, size_t* count) {
  static const std::vector<uint32_t> kNone;
  const Shader& of = shaderOf(shader);
  const std::vector<uint32_t>& words = stage == LACQUER_VERTEX     ? of.vertexSpirv()
                                       : stage == LACQUER_FRAGMENT ? of.fragmentSpirv()
                                                                   : kNone;
  if (count != nullptr) *count = words.size();
  return words.empty() ? nullptr : words.data();
}

const char* lacquer_shader_interface(const lacquer_shader* shader, size_t* size) {
  return give(shaderOf(shader).interfaceJson(), size);
}

size_t lacquer_shader_uniform_size(const lacquer_shader* shader) { return shaderOf(shader).uniformSize(); }

int lacquer_shader_pack(const lacquer_shader* shader, const lacquer_value* values, size_t count, void* block,
                        size_t capacity, lacquer_messages* messages) {
  return guarded(messages, 0, [&](Messages& to) {
    if (shader == nullptr) return sayError(messages, "empty-handle", "the shader is empty", ""), 0;
    const std::span<const lacquer_value> given(values, values == nullptr ? 0 : count);
    bool good = true;
    const auto find = [&](std::string_view name, std::span<double> components) {
      // Of two values of one name the last counts.
      const auto it = std::find_if(given.rbegin(), given.rend(), [&](const lacquer_value& value) {
        return value.name != nullptr && value.name == name;
      });
      if (it == given.rend()) return false;
      if (it->count != components.size() || it->numbers == nullptr) {
        sayError(messages, "wrong-count", fmt::format("'{}' is given {} numbers", name, it->count),
                 fmt::format("it has {}", components.size()));
        good = false;
        return false;
      }
      std::copy_n(it->numbers, it->count, components.begin());
      return true;
    };
    // Beside the caller's block, which stays as it is where something is wrong.
    std::vector<std::byte> packed(block == nullptr ? 0 : std::min(capacity, shader->shader.uniformSize()));
    good = shader->shader.pack(find, packed, to) && good;
    if (good) std::copy(packed.begin(), packed.end(), static_cast<std::byte*>(block));
    return good ? 1 : 0;
  });
}
