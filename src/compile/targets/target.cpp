#include "targets/target.h"

#include <array>
#include <cassert>
#include <utility>

#include "targets/clike.h"

namespace lacquer::targets {

namespace {

constexpr Bound kColors = {ir::kMostColors, ir::kMostColors};

/// Vulkan 1.1, "Required Limits": maxPerStageDescriptorUniformBuffers, maxUniformBufferRange,
/// maxPerStageDescriptorSamplers, maxVertexOutputComponents (64), maxVertexInputAttributes. Of colours it
/// promises 4 (so does OpenGL ES), but a device with fewer than 8 is not found any more, and every G-buffer
/// has more than 4.
constexpr DeviceLimits kVulkan = {kColors, {12}, {16384}, {16}, {16}, {16}};
/// OpenGL 4.5, "Implementation Dependent Values": MAX_DRAW_BUFFERS, MAX_FRAGMENT_UNIFORM_BLOCKS,
/// MAX_UNIFORM_BLOCK_SIZE, MAX_TEXTURE_IMAGE_UNITS, MAX_VARYING_VECTORS, MAX_VERTEX_ATTRIBS.
constexpr DeviceLimits kOpenGl = {kColors, {14}, {16384}, {16}, {15}, {16}};
/// OpenGL ES 3.0, the same; so WebGL 2.
constexpr DeviceLimits kEs = {kColors, {12}, {16384}, {16}, {15}, {16}};
/// Direct3D 11 and 12: D3D11_COMMONSHADER_CONSTANT_BUFFER_API_SLOT_COUNT,
/// D3D11_REQ_CONSTANT_BUFFER_ELEMENT_COUNT, D3D11_COMMONSHADER_SAMPLER_SLOT_COUNT (of Direct3D 12 on hardware
/// of tier 1), D3D11_VS_OUTPUT_REGISTER_COUNT, of which SV_Position takes one, and
/// D3D11_IA_VERTEX_INPUT_STRUCTURE_ELEMENT_COUNT.
constexpr DeviceLimits kDirect3d = {kColors, {14}, {65536, 65536}, {16}, {31, 31}, {32, 32}};
/// WebGPU, "Limits", what a device has without asking: maxUniformBuffersPerShaderStage,
/// maxUniformBufferBindingSize, maxSamplersPerShaderStage, maxInterStageShaderVariables,
/// maxVertexAttributes.
constexpr DeviceLimits kWebGpu = {kColors, {12}, {65536}, {16}, {16}, {16}};
/// Metal's feature set tables: the entries of the tables of buffers and of sampler states, and the inputs of
/// a fragment function of the family Mac 2; and vertex attributes. Of the constant address space 64 KiB are
/// sure.
constexpr DeviceLimits kMetal = {kColors, {31}, {65536}, {16}, {31}, {31}};

constexpr std::array<File, 2> filesOf(std::string_view vertex, std::string_view fragment) {
  return {{{"vert", vertex}, {"frag", fragment}}};
}
constexpr auto kGlslFiles = filesOf("vert.glsl", "frag.glsl");

const Row kBuiltIn[] = {
    {.id = Target::Glsl,
     .name = "glsl",
     .files = kGlslFiles,
     .dialect = glslVulkan,
     .checker = Checker::Vulkan,
     .version = "#version 450",
     .specialization = true,
     .limits = &kVulkan,
     .prose = "GLSL 4.50 for Vulkan"},
    {.id = Target::GlslGl,
     .name = "glsl-gl",
     .files = kGlslFiles,
     .dialect = glslOpenGl,
     .checker = Checker::OpenGl,
     .version = "#version 450",
     .bindless = false,
     .limits = &kOpenGl,
     .prose = "GLSL 4.50 for OpenGL 4.5"},
    {.id = Target::Essl,
     .name = "essl",
     .files = kGlslFiles,
     .dialect = essl300,
     .checker = Checker::Es,
     .version = "#version 300 es",
     .bindless = false,
     .limits = &kEs,
     .prose = "ESSL 3.00 for WebGL 2 and OpenGL ES 3.0"},
    {.id = Target::Hlsl,
     .name = "hlsl",
     .files = filesOf("vert.hlsl", "frag.hlsl"),
     .dialect = hlsl,
     .checker = Checker::Direct3d,
     .binds = "d3d12",
     .limits = &kDirect3d,
     .prose = "HLSL for Shader Model 5 and 6"},
    {.id = Target::Spirv,
     .name = "spirv",
     .files = filesOf("vert.spv", "frag.spv"),
     .words = true,
     .checker = Checker::Words,
     .specialization = true,
     .limits = &kVulkan,
     .prose = "SPIR-V 1.3 for Vulkan 1.1"},
    {.id = Target::Cpp,
     .name = "cpp",
     .files = {{{}, {"header", "h"}}},
     .packer = headerText,
     .prose = "a C++11 header that packs the material's uniform block"},
    {.id = Target::Js,
     .name = "js",
     .files = {{{"types", "d.ts"}, {"module", "js"}}},
     .packer = moduleText,
     .prose = "an ES module that packs the material's uniform block, with its types"},
    {.id = Target::Wgsl,
     .name = "wgsl",
     .files = filesOf("vert.wgsl", "frag.wgsl"),
     .dialect = wgsl,
     .checker = Checker::Tint,
     .specialization = true,
     .binds = "webgpu",
     .limits = &kWebGpu,
     .prose = "WGSL for WebGPU"},
    {.id = Target::Msl,
     .name = "msl",
     .files = filesOf("vert.metal", "frag.metal"),
     .stage = mslText,
     .specialization = true,
     .argument_buffers = true,
     .binds = "metal",
     .limits = &kMetal,
     .prose = "MSL 2.1 for Metal, made of the SPIR-V"},
};

std::deque<Row>& table() {
  static std::deque<Row> rows(std::begin(kBuiltIn), std::end(kBuiltIn));
  return rows;
}

}  // namespace

const std::deque<Row>& rows() { return table(); }

Target addRow(Row row) {
  row.id = static_cast<Target>(table().size());
  table().push_back(std::move(row));
  return table().back().id;
}

std::string printText(const ir::Module& module, const schedule::Program& program, Target target,
                      std::string_view head) {
  assert(ir::verify(module).empty());
  return printProgram(row(target).dialect(), module, program, head);
}

Result<std::string> stageText(const ir::Module& module, const schedule::Program& program, Target target,
                              const TextOptions& options) {
  const Row& of = row(target);
  Result<std::string> text = of.stage != nullptr
                                 ? of.stage(module, program, options)
                                 : Result<std::string>(printText(module, program, target, options.head));
  return text && of.change ? of.change(*text) : text;
}

PackerText headerText(const ir::Module& module, std::string_view name, std::string_view head) {
  assert(ir::verify(module).empty());
  return {{}, printHeader(module, name, head)};
}

std::string commentText(std::string_view lines) {
  Text text;
  text.comments(lines);
  return text.take();
}

std::string blockName(const ir::Block& block) { return block.plural() ? block.name + "s" : block.name; }

std::string samplerName(const ir::TextureSlot& slot) { return slot.boundName() + "_sampler"; }

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
