#include <algorithm>
#include <cstring>

#include "api/internal.h"
#include "shader/interface.h"
#include "shader/module.h"
#include "shader/options.h"
#include "shader/print.h"

namespace lacquer {

const Shader::Impl& Shader::impl() const {
  static const Impl kNone;
  return impl_ ? *impl_ : kNone;
}

const std::string& Shader::id() const { return impl().id; }
bool Shader::hasVertexStage() const { return impl().has_vertex; }
const std::vector<uint32_t>& Shader::vertexSpirv() const { return impl().spirv[0]; }
const std::vector<uint32_t>& Shader::fragmentSpirv() const { return impl().spirv[1]; }
const std::string& Shader::headerText() const { return impl().text[static_cast<size_t>(Target::Cpp)][1]; }
const std::string& Shader::moduleTypes() const { return impl().text[static_cast<size_t>(Target::Js)][0]; }
const std::string& Shader::moduleText() const { return impl().text[static_cast<size_t>(Target::Js)][1]; }
const std::string& Shader::interfaceJson() const { return impl().interface; }

static const std::string& textOf(const std::string (&text)[kTargetCount][2], Target target, int stage) {
  static const std::string kNone;
  const auto row = static_cast<size_t>(target);
  return row >= kTargetCount || packsBlock(target) ? kNone : text[row][stage];
}

const std::string& Shader::vertexText(Target target) const { return textOf(impl().text, target, 0); }
const std::string& Shader::fragmentText(Target target) const { return textOf(impl().text, target, 1); }

size_t Shader::uniformSize() const {
  for (const ir::Block& block : impl().module.blocks) {
    if (block.role == ir::BlockRole::Material) return block.size;
  }
  return 0;
}

bool Shader::pack(const Values& value, std::span<std::byte> block) const {
  const size_t size = uniformSize();
  if (block.size() < size) return false;
  std::vector<ir::Components> parameters;
  for (const ir::Parameter& parameter : impl().module.parameters) {
    ir::Components components = parameter.value;
    const std::span<double> numbers(components.data(),
                                    static_cast<size_t>(ir::componentCount(parameter.type)));
    parameters.push_back(value && value(parameter.name, numbers) ? components : parameter.value);
  }
  std::fill_n(block.begin(), size, std::byte{0});
  const Preshader& preshader = impl().preshader;
  const std::vector<ir::Components> values =
      preshader.evaluate([&](uint32_t i) -> const ir::Components& { return parameters[i]; });
  for (size_t i = 0; i < values.size(); ++i) {
    const Preshader::Field& field = preshader.fields()[i];
    for (int c = 0; c < ir::componentCount(field.type); ++c) {
      const auto x = static_cast<float>(values[i][static_cast<size_t>(c)]);
      std::memcpy(block.data() + field.offset + size_t{4} * static_cast<size_t>(c), &x, 4);
    }
  }
  return true;
}

}  // namespace lacquer
