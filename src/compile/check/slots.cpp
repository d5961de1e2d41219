// Whether two resources of a SPIR-V module share a place (SPIR-V specification, 3.20; Vulkan, "Shader
// Interfaces").
#include <fmt/format.h>

#include <map>
#include <tuple>

#include "check/check.h"
#include "check/reflect.h"

namespace lacquer::check {

Diagnostics checkSlots(const Spirv& words, bool open_gl, const std::string& name) {
  Diagnostics wrong;
  // The variable by its place; OpenGL counts blocks, storage buffers and textures each for themselves.
  std::map<std::tuple<bool, bool, uint32_t, uint32_t>, std::string> taken;
  for (const Taken& one : reflectPlaces(words)) {
    const auto [it, fresh] =
        taken.try_emplace({open_gl && one.block, open_gl && one.storage, one.set, one.binding}, one.name);
    if (fresh) continue;
    wrong.push_back({"slot-clash",
                     Severity::Error,
                     {name, 0, 0, {}},
                     fmt::format("'{}' and '{}' are both at set {}, binding {}", it->second, one.name,
                                 one.set, one.binding),
                     {},
                     {}});
  }
  return wrong;
}

}  // namespace lacquer::check
