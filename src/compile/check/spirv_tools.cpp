// SPIRV-Tools: the validator and the optimizer.
#include <fmt/format.h>
#include <glslang/Public/ShaderLang.h>

#include <spirv-tools/libspirv.hpp>
#include <spirv-tools/optimizer.hpp>

#include "check/check.h"

namespace lacquer::check {
namespace {

/// Collects messages. The first line says what is wrong; the lines below it show the instruction.
spvtools::MessageConsumer collectInto(Diagnostics& list, std::string code, const std::string& name) {
  return [&list, code = std::move(code), name](spv_message_level_t level, const char*,
                                               const spv_position_t& position, const char* message) {
    Diagnostic diagnostic;
    diagnostic.code = code;
    diagnostic.place.file = name;
    switch (level) {
      case SPV_MSG_FATAL:
      case SPV_MSG_INTERNAL_ERROR:
      case SPV_MSG_ERROR: diagnostic.severity = Severity::Error; break;
      case SPV_MSG_WARNING: diagnostic.severity = Severity::Warning; break;
      case SPV_MSG_INFO:
      case SPV_MSG_DEBUG: return;
    }
    std::string_view text = message;
    while (text.ends_with('\n')) text.remove_suffix(1);
    const size_t end = text.find('\n');
    diagnostic.message = fmt::format("{} (instruction {})", text.substr(0, end), position.index);
    if (end != std::string_view::npos) diagnostic.excerpt = text.substr(end + 1);
    list.push_back(std::move(diagnostic));
  };
}

Diagnostic withoutReason(const char* code, const std::string& name) {
  return {code, Severity::Error, {name, 0, 0, {}}, "failed without an error", {}, {}};
}

}  // namespace

std::string toolVersions() {
  const glslang::Version glslang = glslang::GetVersion();
  return fmt::format("glslang {}.{}.{}{}, {}", glslang.major, glslang.minor, glslang.patch, glslang.flavor,
                     spvSoftwareVersionDetailsString());
}

static Diagnostics validateFor(spv_target_env environment, const Spirv& words, const std::string& name) {
  Diagnostics list;
  spvtools::SpirvTools tools(environment);
  tools.SetMessageConsumer(collectInto(list, "spirv-val", name));
  const bool valid = tools.Validate(words);
  if (valid) return {};
  if (!hasError(list)) list.push_back(withoutReason("spirv-val", name));
  return list;
}

Diagnostics validate(const Spirv& words, bool open_gl, const std::string& name) {
  return validateFor(open_gl ? SPV_ENV_OPENGL_4_5 : SPV_ENV_VULKAN_1_1, words, name);
}

Diagnostics validateForeign(const Spirv& words, const std::string& name) {
  return validateFor(SPV_ENV_VULKAN_1_3, words, name);
}

Result<Spirv> optimize(const Spirv& words, const std::string& name) {
  Diagnostics list;
  spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_1);
  optimizer.SetMessageConsumer(collectInto(list, "spirv-opt", name));
  optimizer.RegisterPerformancePasses();
  Spirv optimized;
  if (optimizer.Run(words.data(), words.size(), &optimized)) return optimized;
  if (!hasError(list)) list.push_back(withoutReason("spirv-opt", name));
  return tl::make_unexpected(std::move(list));
}

}  // namespace lacquer::check
