#include "vulkan/passthrough.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "check/check.h"

namespace lacquer::vulkan {
namespace {

std::string typeName(const check::Slot& slot) {
  static constexpr std::string_view kScalars[] = {"float", "int", "uint"};
  static constexpr std::string_view kVectors[] = {"vec", "ivec", "uvec"};
  const auto scalar = static_cast<size_t>(slot.scalar);
  return slot.count == 1 ? std::string(kScalars[scalar]) : fmt::format("{}{}", kVectors[scalar], slot.count);
}

}  // namespace

Result<std::vector<uint32_t>> passthroughVertex(const check::Interface& fragment) {
  if (!fragment.odd_input.empty()) {
    return fail("spirv-reflection", {}, fragment.odd_input + " is of a type that no vertex attribute has",
                "name the vertex module, too");
  }
  std::string text = "#version 450\n", body;
  uint32_t position = 0;
  for (size_t i = 0; i < fragment.inputs.size(); ++i) {
    const check::Slot& slot = fragment.inputs[i];
    const std::string type = typeName(slot);
    const std::string layout =
        fmt::format("layout(location = {}, component = {})", slot.location, slot.component);
    const std::string_view flat = slot.scalar == check::Scalar::Float ? "" : "flat ";
    text += fmt::format("{0} in {1} a{2};\n{0} {3}out {1} v{2};\n", layout, type, i, flat);
    body += fmt::format("  v{0} = a{0};\n", i);
    position = std::max(position, slot.location + 1);
  }
  text += fmt::format(
      "layout(location = {}) in vec4 position;\nvoid main() {{\n{}  gl_Position = position;\n}}\n", position,
      body);
  return check::compile(text, Target::Glsl, check::Stage::Vertex, "passthrough.vert");
}

}  // namespace lacquer::vulkan
