#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "api/internal.h"
#include "cost/files.h"
#include "graph/matrices.h"
#include "interface/interface.h"
#include "manifest/text.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "shader/module.h"
#include "shader/print.h"
#include "support/text.h"

namespace lacquer {

const Shader::Impl& Shader::impl() const {
  static const Impl kNone;
  return impl_ ? *impl_ : kNone;
}

Shader ShaderMaker::make(ShaderData data, const material::Schema* schema, const Options& options) {
  Shader shader;
  auto impl = std::make_shared<Shader::Impl>();
  static_cast<ShaderData&>(*impl) = std::move(data);
  impl->reflection = reflect(impl->module, impl->has_vertex, schema);
  impl->argument_buffers = options.argument_buffers;
  json::JsonText entry;
  manifest::writeReflection(impl->reflection, options.targets, options.argument_buffers, entry);
  impl->entry = entry.take();
  impl->preshader = Preshader(impl->module);
  shader.impl_ = std::move(impl);
  return shader;
}

const std::string& Shader::id() const { return impl().id; }
bool Shader::hasVertexStage() const { return impl().has_vertex; }
const std::vector<uint32_t>& Shader::vertexSpirv() const { return impl().spirv[0]; }
const std::vector<uint32_t>& Shader::fragmentSpirv() const { return impl().spirv[1]; }
const std::string& Shader::headerText() const { return impl().text[static_cast<size_t>(Target::Cpp)][1]; }
const std::string& Shader::moduleTypes() const { return impl().text[static_cast<size_t>(Target::Js)][0]; }
const std::string& Shader::moduleText() const { return impl().text[static_cast<size_t>(Target::Js)][1]; }
const Reflection& Shader::reflection() const { return impl().reflection; }
const std::string& Shader::interfaceJson() const { return impl().entry; }

const std::string& Shader::fileText(Target target, int file) const {
  static const std::string kNone;
  const bool known = !targetName(target).empty() && (file == 0 || file == 1);
  return known ? impl().text[static_cast<size_t>(target)][file] : kNone;
}

static const std::string& textOf(const Shader& shader, Target target, int stage) {
  static const std::string kNone;
  return targetName(target).empty() || packsBlock(target) ? kNone : shader.fileText(target, stage);
}

const std::string& Shader::vertexText(Target target) const { return textOf(*this, target, 0); }
const std::string& Shader::fragmentText(Target target) const { return textOf(*this, target, 1); }

std::string_view ShaderMaker::code(const Shader& shader, Target target, int stage) {
  const std::vector<uint32_t>& words = shader.impl().spirv[stage];
  if (target == Target::Spirv) return {reinterpret_cast<const char*>(words.data()), words.size() * 4};
  return shader.fileText(target, stage);
}

size_t Shader::uniformSize() const {
  for (const ir::Block& block : impl().module.blocks) {
    if (block.role == ir::BlockRole::Material) return block.size;
  }
  return 0;
}

/// The numbers that a parameter is packed with; of the first that is not the one that is given, a warning.
static ir::Components packedComponents(const ir::Parameter& parameter, const Shader::Values& value,
                                       Messages* messages) {
  ir::Components given = parameter.value;
  const auto count = static_cast<size_t>(ir::componentCount(parameter.type));
  if (!value || !value(parameter.name, {given.data(), count})) return parameter.value;
  ir::Components packed = parameter.value;
  for (size_t c = 0; c < count; ++c) {
    packed[c] = packedNumber(parameter, given[c], parameter.value[c]);
    if (packed[c] == given[c] || messages == nullptr) continue;
    const bool number = !std::isnan(given[c]);
    const std::string what = fmt::format("'{}' is given {}", printable(parameter.name), given[c]);
    const std::string help =
        number ? fmt::format("it takes {}: {} is packed", packedRangeText(parameter), packed[c])
               : fmt::format("{} is packed, as if it were not given", packed[c]);
    messages->push_back(
        toMessage({number ? "out-of-range" : "not-a-number", Severity::Warning, {}, what, help, {}}));
    messages = nullptr;
  }
  return packed;
}

void Shader::Impl::pack(const Values& value, std::span<std::byte> block, Messages* messages) const {
  std::vector<ir::Components> parameters;
  for (const ir::Parameter& parameter : module.parameters)
    parameters.push_back(packedComponents(parameter, value, messages));
  preshader.write(preshader.evaluate([&](uint32_t i) -> const ir::Components& { return parameters[i]; }),
                  block);
}

bool Shader::pack(const Values& value, std::span<std::byte> block) const {
  const size_t size = uniformSize();
  if (block.size() < size) return false;
  impl().pack(value, block.first(size), nullptr);
  return true;
}

bool Shader::pack(const Values& value, std::span<std::byte> block, Messages& messages) const {
  const size_t size = uniformSize();
  if (block.size() < size) {
    report(fail("block-too-small", {}, fmt::format("the block has {} bytes", block.size()),
                fmt::format("it takes {}", size))
               .value(),
           {}, messages);
    return false;
  }
  impl().pack(value, block.first(size), &messages);
  return true;
}

bool Shader::packGraph(const Graph& graph, std::span<std::byte> block, Messages& messages) const {
  if (!filled(graph.impl_.get(), "graph", messages)) return false;
  const graph::Graph& numbers = graph.impl_->graph;
  // A column of a matrix is looked for by what it is called in the shader.
  std::vector<graph::Parameter> columns;
  for (const graph::Parameter& parameter : numbers.parameters) {
    if (!ir::isMatrix(parameter.type)) continue;
    for (graph::Parameter& column : graph::columnsOf(parameter)) columns.push_back(std::move(column));
  }
  const auto named = [&](std::string_view name) -> const graph::Parameter* {
    if (const std::optional<size_t> found = numbers.findParameter(name)) return &numbers.parameters[*found];
    const auto it =
        std::find_if(columns.begin(), columns.end(), [&](const auto& c) { return c.name == name; });
    return it == columns.end() ? nullptr : &*it;
  };
  return pack(
      [&](std::string_view name, std::span<double> components) {
        const graph::Parameter* parameter = named(name);
        if (parameter == nullptr) return false;
        if (static_cast<size_t>(ir::componentCount(parameter->type)) != components.size()) return false;
        std::copy_n(parameter->value.begin(), components.size(), components.begin());
        return true;
      },
      block, messages);
}

std::vector<ShaderCost> measureCost(const std::vector<Shader>& shaders, bool disassembly,
                                    Messages& messages) {
  std::vector<cost::Subject> subjects;
  for (const Shader& shader : shaders)
    subjects.push_back({shader.id(), shader.vertexSpirv(), shader.fragmentSpirv()});
  return measureCostOf(std::move(subjects), disassembly, messages);
}

}  // namespace lacquer
