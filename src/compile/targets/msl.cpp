// Metal's language, made of the SPIR-V by SPIRV-Cross, where Lacquer was built with it. What is decided here
// is where resources are bound; nothing here compiles the text.
#include <fmt/format.h>

#include "targets/clike.h"
#include "targets/target.h"

#ifdef LACQUER_SPIRV_CROSS
#include <spirv_cross_c.h>

#include <memory>
#endif

namespace lacquer::targets {

MslBinding mslBinding(const ir::Binding& binding, bool argument_buffers, bool list) {
  if (argument_buffers) return {binding.set, 2 * binding.binding, 2 * binding.binding + 1};
  // A list's flat number is one of the textures', which are another kind in Metal.
  constexpr uint32_t kListBuffers = 16;
  return {0, list ? kListBuffers + binding.flat : binding.flat, binding.flat};
}

MslBinding mslArray(const ir::Binding& binding) {
  const uint32_t number = binding.binding - ir::kMaterialBinding.binding - 1;
  const uint32_t first = 2 * (ir::kMaterialBinding.binding + 1) + 2 * kMslTextures * number;
  return {binding.set, first, first + kMslTextures};
}

#ifdef LACQUER_SPIRV_CROSS

namespace {

/// MSL 2.1: macOS 10.14 and iOS 12, the first that Metal's tools still take for what argument buffers want.
constexpr unsigned kMslVersion = SPVC_MAKE_MSL_VERSION(2, 1, 0);

using Context = std::unique_ptr<spvc_context_s, decltype(&spvc_context_destroy)>;

class Crossing {
public:
  Crossing(Context context, bool argument_buffers)
      : context_(std::move(context)), argument_buffers_(argument_buffers) {}

  Result<std::string> run(const ir::Module& module, const schedule::Program& program,
                          const std::vector<uint32_t>& words) {
    const bool good = parse(words) && setOptions() && bind(module, program);
    const char* text = nullptr;
    if (good && spvc_compiler_compile(compiler_, &text) == SPVC_SUCCESS) return std::string(text);
    return fail("spirv-cross", {}, spvc_context_get_last_error_string(context_.get()));
  }

private:
  bool parse(const std::vector<uint32_t>& words) {
    spvc_parsed_ir parsed = nullptr;
    return spvc_context_parse_spirv(context_.get(), words.data(), words.size(), &parsed) == SPVC_SUCCESS &&
           spvc_context_create_compiler(context_.get(), SPVC_BACKEND_MSL, parsed,
                                        SPVC_CAPTURE_MODE_TAKE_OWNERSHIP, &compiler_) == SPVC_SUCCESS;
  }

  bool setOptions() {
    spvc_compiler_options options = nullptr;
    const auto set = [&](spvc_compiler_option option, unsigned value) {
      return spvc_compiler_options_set_uint(options, option, value) == SPVC_SUCCESS;
    };
    return spvc_compiler_create_compiler_options(compiler_, &options) == SPVC_SUCCESS &&
           set(SPVC_COMPILER_OPTION_MSL_VERSION, kMslVersion) &&
           set(SPVC_COMPILER_OPTION_MSL_ARGUMENT_BUFFERS, argument_buffers_ ? 1 : 0) &&
           // Without it, a stage's buffer would lack what the stage does not read.
           set(SPVC_COMPILER_OPTION_MSL_FORCE_ACTIVE_ARGUMENT_BUFFER_RESOURCES, argument_buffers_ ? 1 : 0) &&
           spvc_compiler_install_compiler_options(compiler_, options) == SPVC_SUCCESS;
  }

  bool bind(const ir::Module& module, const schedule::Program& program) {
    const SpvExecutionModel stage =
        program.stage == ir::Stage::Vertex ? SpvExecutionModelVertex : SpvExecutionModelFragment;
    const auto add = [&](uint32_t set, uint32_t binding, uint32_t resource, uint32_t sampler) {
      spvc_msl_resource_binding at;
      spvc_msl_resource_binding_init(&at);
      at.stage = stage;
      at.desc_set = set;
      at.binding = binding;
      at.msl_buffer = at.msl_texture = resource;
      at.msl_sampler = sampler;
      return spvc_compiler_msl_add_resource_binding(compiler_, &at) == SPVC_SUCCESS;
    };
    const auto put = [&](const ir::Binding& binding, const MslBinding& to) {
      const bool buffer =
          !argument_buffers_ || add(binding.set, SPVC_MSL_ARGUMENT_BUFFER_BINDING, to.buffer, 0);
      return buffer && add(binding.set, binding.binding, to.index, to.sampler);
    };
    const auto place = [&](const ir::Binding& binding, bool list) {
      return put(binding, mslBinding(binding, argument_buffers_, list));
    };
    bool good = true;
    for (const uint32_t index : program.blocks) {
      const ir::Block& block = module.blocks[index];
      good = good && place(block.binding, block.list);
    }
    for (const uint32_t index : declaredTextures(module, program)) {
      const ir::TextureSlot& slot = module.textures[index];
      good = good &&
             (slot.array.empty() ? place(slot.binding, false) : put(slot.binding, mslArray(slot.binding)));
    }
    return good;
  }

  Context context_;
  bool argument_buffers_;
  spvc_compiler compiler_ = nullptr;  ///< the context's
};

}  // namespace

Result<std::string> mslText(const ir::Module& module, const schedule::Program& program,
                            const TextOptions& options) {
  spvc_context context = nullptr;
  if (spvc_context_create(&context) != SPVC_SUCCESS)
    return fail("spirv-cross", {}, "SPIRV-Cross cannot be used");
  Crossing crossing(Context(context, spvc_context_destroy), options.argument_buffers);
  Result<std::string> text = crossing.run(
      module, program, writeSpirv(module, program, {.relaxed = false, .array_length = kMslTextures}));
  if (!text) return text;
  return commentText(options.head) + "\n" + *text;
}

#else

Result<std::string> mslText(const ir::Module&, const schedule::Program&, const TextOptions&) {
  return fail("msl-unavailable", {},
              "this program was built without SPIRV-Cross, which makes Metal's language",
              "build it where the library is installed (docs/dependencies.md)");
}

#endif

}  // namespace lacquer::targets
