// The direct way to SPIR-V: the words of one stage, section by section.
#include <algorithm>

#include "targets/spirv/body.h"
#include "targets/target.h"

namespace lacquer::targets {

using spirv::Words;

std::vector<uint32_t> writeSpirv(const ir::Module& module, const schedule::Program& program,
                                 const SpirvOptions& options) {
  spirv::Globals globals;
  const spirv::Interface interface = declareInterface(module, program, globals, options.array_length);
  spirv::Body body(module, program, interface, globals, options);
  const uint32_t main = body.write();
  const bool fragment = program.stage == ir::Stage::Fragment;

  Words head;
  head.reserve(64);
  constexpr uint32_t kVersion = 0x00010300;
  constexpr uint32_t kUnregisteredGenerator = 0;
  constexpr uint32_t kSchema = 0;
  for (const uint32_t word :
       {uint32_t{spv::MagicNumber}, kVersion, kUnregisteredGenerator, globals.bound(), kSchema}) {
    head.word(word);
  }
  head.op(spv::OpCapability, spv::CapabilityShader);
  if (globals.halvesUsed()) head.op(spv::OpCapability, spv::CapabilityFloat16);
  if (globals.sizesAsked()) head.op(spv::OpCapability, spv::CapabilityImageQuery);
  if (globals.arraysAsked()) {
    head.op(spv::OpCapability, spv::CapabilityShaderNonUniform);
    if (globals.endlessAsked()) head.op(spv::OpCapability, spv::CapabilityRuntimeDescriptorArray);
    head.op(spv::OpCapability, spv::CapabilitySampledImageArrayNonUniformIndexing);
    head.begin(spv::OpExtension);
    head.text("SPV_EXT_descriptor_indexing");
    head.end();
  }
  if (globals.importsGlsl()) {
    head.begin(spv::OpExtInstImport);
    head.word(globals.glslSet());
    head.text("GLSL.std.450");
    head.end();
  }
  head.op(spv::OpMemoryModel, spv::AddressingModelLogical, spv::MemoryModelGLSL450);
  head.begin(spv::OpEntryPoint);
  head.word(fragment ? spv::ExecutionModelFragment : spv::ExecutionModelVertex);
  head.word(main);
  head.text("main");
  for (const uint32_t variable : interface.entry_point) head.word(variable);
  head.end();
  if (fragment) head.op(spv::OpExecutionMode, main, spv::ExecutionModeOriginUpperLeft);
  const bool depth = std::any_of(program.outputs.begin(), program.outputs.end(),
                                 [&](uint32_t o) { return module.outputs[o].kind == ir::OutputKind::Depth; });
  if (depth) head.op(spv::OpExecutionMode, main, spv::ExecutionModeDepthReplacing);

  std::vector<uint32_t> words;
  const std::array<const Words*, 6> sections = {
      &head, &globals.strings, &globals.names, &globals.decorations, &globals.declarations, &body.code()};
  size_t size = 0;
  for (const Words* section : sections) size += section->words().size();
  words.reserve(size);
  for (const Words* section : sections) {
    words.insert(words.end(), section->words().begin(), section->words().end());
  }
  return words;
}

}  // namespace lacquer::targets
