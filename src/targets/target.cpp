#include "targets/target.h"

#include <array>
#include <cassert>

#include "targets/clike.h"

namespace lacquer::targets {

namespace {

constexpr Bound kColors = {ir::kMostColors, ir::kMostColors};

/// Vulkan 1.1, "Required Limits": maxPerStageDescriptorUniformBuffers, maxUniformBufferRange,
/// maxPerStageDescriptorSamplers, maxVertexOutputComponents (64). Of colours it promises 4 (so does OpenGL
/// ES), but a device with fewer than 8 is not found any more, and every G-buffer has more than 4.
constexpr DeviceLimits kVulkan = {kColors, {12}, {16384}, {16}, {16}};
/// OpenGL 4.5, "Implementation Dependent Values": MAX_DRAW_BUFFERS, MAX_FRAGMENT_UNIFORM_BLOCKS,
/// MAX_UNIFORM_BLOCK_SIZE, MAX_TEXTURE_IMAGE_UNITS, MAX_VARYING_VECTORS.
constexpr DeviceLimits kOpenGl = {kColors, {14}, {16384}, {16}, {15}};
/// OpenGL ES 3.0, the same; so WebGL 2.
constexpr DeviceLimits kEs = {kColors, {12}, {16384}, {16}, {15}};
/// Direct3D 11 and 12: D3D11_COMMONSHADER_CONSTANT_BUFFER_API_SLOT_COUNT,
/// D3D11_REQ_CONSTANT_BUFFER_ELEMENT_COUNT, D3D11_COMMONSHADER_SAMPLER_SLOT_COUNT (of Direct3D 12 on hardware
/// of tier 1), and D3D11_VS_OUTPUT_REGISTER_COUNT, of which SV_Position takes one.
constexpr DeviceLimits kDirect3d = {kColors, {14}, {65536, 65536}, {16}, {31, 31}};
/// WebGPU, "Limits", what a device has without asking: maxUniformBuffersPerShaderStage,
/// maxUniformBufferBindingSize, maxSamplersPerShaderStage, maxInterStageShaderVariables.
constexpr DeviceLimits kWebGpu = {kColors, {12}, {65536}, {16}, {16}};
/// Metal's feature set tables: the entries of the tables of buffers and of sampler states, and the inputs of
/// a fragment function of the family Mac 2. Of the constant address space 64 KiB are sure.
constexpr DeviceLimits kMetal = {kColors, {31}, {65536}, {16}, {31}};

constexpr std::array<Row, 9> kRows = {{
    {Target::Glsl, "glsl", "glsl", true, &kVulkan, "GLSL 4.50 for Vulkan"},
    {Target::GlslGl, "glsl-gl", "glsl", false, &kOpenGl, "GLSL 4.50 for OpenGL 4.5"},
    {Target::Essl, "essl", "glsl", false, &kEs, "ESSL 3.00 for WebGL 2 and OpenGL ES 3.0"},
    {Target::Hlsl, "hlsl", "hlsl", false, &kDirect3d, "HLSL for Shader Model 5 and 6"},
    {Target::Spirv, "spirv", "spv", true, &kVulkan, "SPIR-V 1.3 for Vulkan 1.1"},
    {Target::Cpp, "cpp", "h", false, nullptr, "a C++11 header that packs the material's uniform block"},
    {Target::Js, "js", "js", false, nullptr,
     "an ES module that packs the material's uniform block, with its types"},
    {Target::Wgsl, "wgsl", "wgsl", true, &kWebGpu, "WGSL for WebGPU"},
    {Target::Msl, "msl", "metal", true, &kMetal, "MSL 2.1 for Metal, made of the SPIR-V"},
}};

}  // namespace

std::span<const Row> rows() { return kRows; }

std::string printText(const ir::Module& module, const schedule::Program& program, Target target,
                      std::string_view head) {
  assert(ir::verify(module).empty());
  switch (target) {
    case Target::Glsl: return printProgram(glslVulkan(), module, program, head);
    case Target::GlslGl: return printProgram(glslOpenGl(), module, program, head);
    case Target::Essl: return printProgram(essl300(), module, program, head);
    case Target::Hlsl: return printProgram(hlsl(), module, program, head);
    case Target::Wgsl: return printProgram(wgsl(), module, program, head);
    case Target::Spirv: break;  // words, not text: writeSpirv
    case Target::Msl: break;    // not printed: made of the words
    case Target::Cpp: break;    // no stage: headerText
    case Target::Js: break;     // no stage: moduleText
  }
  assert(false && "not a target with a text");
  return {};
}

std::string headerText(const ir::Module& module, std::string_view name, std::string_view head) {
  assert(ir::verify(module).empty());
  return printHeader(module, name, head);
}

std::string commentText(std::string_view lines) {
  Text text;
  text.comments(lines);
  return text.take();
}

std::string blockName(const ir::Block& block) { return block.plural() ? block.name + "s" : block.name; }

std::string samplerName(const ir::TextureSlot& slot) { return slot.name + "_sampler"; }

PreshaderText preshaderText(const ir::Module& module) {
  std::vector<std::string> taken;
  for (const uint32_t index : ir::usedParameters(module)) taken.push_back(module.parameters[index].name);
  const schedule::Program program = schedule::schedulePreshader(module, taken);
  PreshaderText text;
  for (const schedule::Statement& s : program.statements) {
    if (s.kind != schedule::StatementKind::Let) continue;
    text.values.push_back({program.names[s.value], module.dag[s.value].type,
                           printDefinition(glslVulkan(), module, program, s.value)});
  }
  for (const ir::PreshaderField& field : module.preshader)
    text.fields.push_back(printValue(glslVulkan(), module, program, field.value));
  return text;
}

std::vector<std::string> expressionTexts(const ir::Module& module, std::span<const ir::ValueId> values) {
  constexpr size_t kLongest = 160;
  return printExpressions(glslVulkan(), module, values, kLongest);
}

}  // namespace lacquer::targets
