// The back-ends: a row per target.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ir/module.h"
#include "lacquer/options.h"
#include "schedule/schedule.h"
#include "support/diagnostic.h"

namespace lacquer::targets {

/// How much of something a platform takes.
struct Bound {
  uint32_t sure;             ///< every device of it takes that many
  uint32_t most = kNoBound;  ///< and none more
  static constexpr uint32_t kNoBound = ~0U;
};

/// What a shader may have on the target's platform.
struct DeviceLimits {
  Bound outputs;      ///< colours of a fragment
  Bound blocks;       ///< uniform blocks of a stage
  Bound block_bytes;  ///< of one
  Bound textures;     ///< of a stage, each with its sampler
  Bound varyings;     ///< between the stages, each of up to four components
  Bound attributes;   ///< locations of the vertex stage's inputs
};

/// How the text of a stage is to be printed.
struct TextOptions {
  std::string_view head;          ///< comment lines at the top, one per line
  bool argument_buffers = false;  ///< Options::argument_buffers
};

/// The files of what packs a block.
struct PackerText {
  std::string types;  ///< empty where it has none of its own
  std::string code;
};

class Dialect;

/// What is written of a stage, or, of what packs a block, its types and its code.
struct File {
  std::string_view kind;    ///< in the manifest: "vert"; empty: there is no such file
  std::string_view suffix;  ///< behind the shader's id: "vert.glsl"
};

/// How a text comes to be validated.
enum class Checker : uint8_t {
  None,
  Vulkan,     ///< glslang, to SPIR-V for Vulkan
  OpenGl,     ///< glslang, as a driver's input and to SPIR-V for OpenGL
  Es,         ///< glslang, as a driver's input
  Direct3d,   ///< glslang, and DXC where there is one
  Words,      ///< SPIR-V as it is
  Tint,       ///< where there is one
  Registered  ///< Row::check
};

/// Everything that is known of a target. Whoever asks what a target is like reads it here.
struct Row {
  Target id = {};
  std::string_view name = {};  ///< on the command line and in DIR/<target>/: "glsl"
  std::array<File, 2> files = {};
  /// What makes its code; one of these. `dialect`: the stages of the legalized module are printed by it.
  const Dialect& (*dialect)() = nullptr;
  Result<std::string> (*stage)(const ir::Module& module, const schedule::Program& program,
                               const TextOptions& options) = nullptr;
  PackerText (*packer)(const ir::Module& module, std::string_view name, std::string_view head) = nullptr;
  bool words = false;  ///< the stages are writeSpirv()'s

  Checker checker = Checker::None;
  std::string_view version = {};         ///< the line that a text must begin with: "#version 450"
  bool bindless = true;                  ///< BindingModel::Bindless is for it
  bool specialization = false;           ///< it has specialization constants
  bool argument_buffers = false;         ///< Options::argument_buffers is about it
  std::string_view binds = {};           ///< the manifest's member that says where its API binds; empty: none
  const DeviceLimits* limits = nullptr;  ///< null: it is no shader
  std::string_view prose = {};
  /// Of a registered target: what is done to the text of a stage, and what is wrong with it.
  std::function<Result<std::string>(const std::string& text)> change = {};
  std::function<Diagnostics(const std::string& text, ir::Stage stage)> check = {};
  std::string identity = {};  ///< what tells it from another of its name: code is kept by it
};

/// All targets, in the order of the enumeration; those that are registered stand behind.
const std::deque<Row>& rows();
/// `id` must be one of them.
inline const Row& row(Target id) { return rows()[static_cast<size_t>(id)]; }
/// Adds a row, whose id is set. Not beside anything else that reads the rows.
Target addRow(Row row);

/// The text of one stage of a target with a dialect or a stage(). The module must be placed and bound, and
/// for a dialect legalized. Errors: Row::stage's and Row::change's.
Result<std::string> stageText(const ir::Module& module, const schedule::Program& program, Target target,
                              const TextOptions& options);
/// The same of a target with a dialect of its own.
std::string printText(const ir::Module& module, const schedule::Program& program, Target target,
                      std::string_view head);

/// Target::Cpp: a C++11 header in the namespace lacquer_shaders::NAME with the parameters, the material's
/// block, the preshader as a function, and the bindings. The module must be placed and bound. `name`: the
/// shader's id. `head` as above.
PackerText headerText(const ir::Module& module, std::string_view name, std::string_view head);

/// Target::Js: the same as an ES module, and its types.
PackerText moduleText(const ir::Module& module, std::string_view name, std::string_view head);

/// Where WGSL binds what the contract has at a set and a binding: blocks and textures at twice the binding, a
/// texture's sampler behind it. So no two resources share a place where the contract's do not.
struct WgslBinding {
  uint32_t group = 0, binding = 0;
  uint32_t sampler = 0;  ///< of a texture
};
WgslBinding wgslBinding(const ir::Binding& binding);

/// Where Metal has it. Plain: a block, a texture or a sampler at `index` of its kind, the flat number of the
/// contract; a list is a buffer behind all blocks', at 16 more. In argument buffers: at `index`, a texture's
/// sampler behind it, of the buffer of the set.
struct MslBinding {
  uint32_t buffer = 0;  ///< the argument buffer
  uint32_t index = 0, sampler = 0;
};
MslBinding mslBinding(const ir::Binding& binding, bool argument_buffers, bool list = false);
/// The same of an array of textures, which is in an argument buffer and has that many, for Metal's have an
/// end; the samplers lie behind them.
inline constexpr uint32_t kMslTextures = 1024;
MslBinding mslArray(const ir::Binding& binding);

/// Target::Msl: the text of one stage, whose function is called `main0`. The module must be placed and bound.
/// `head` as above. Errors: "msl-unavailable" where Lacquer was built without SPIRV-Cross; "spirv-cross",
/// which is a bug.
Result<std::string> mslText(const ir::Module& module, const schedule::Program& program,
                            const TextOptions& options);

/// Lines as comments of the C-like languages.
std::string commentText(std::string_view lines);

/// What every text calls a block: an array of `Light` lies in `Lights`.
std::string blockName(const ir::Block& block);
/// What HLSL and WGSL call a texture's sampler; in the other texts it has none of its own.
std::string samplerName(const ir::TextureSlot& slot);

/// The preshader in GLSL, for people and for other tools. Its length is linear in the number of operations.
struct PreshaderText {
  struct Value {
    std::string name;
    ir::Type type;
    std::string expression;  ///< over the parameters and the values before it
  };
  std::vector<Value> values;        ///< with names that no parameter has
  std::vector<std::string> fields;  ///< the expressions of Module::preshader, over parameters and values
};
PreshaderText preshaderText(const ir::Module& module);

/// Each value as one GLSL expression, for people: the first 160 bytes and '…' for what is left.
std::vector<std::string> expressionTexts(const ir::Module& module, std::span<const ir::ValueId> values);

/// The SPIR-V words of one stage, written directly: SPIR-V 1.3, Vulkan 1.1.
struct SpirvOptions {
  bool debug = false;         ///< OpLine toward the node source where known
  bool relaxed = true;        ///< RelaxedPrecision for what the Dag says is relaxed
  uint32_t array_length = 0;  ///< of arrays of textures; 0: they have no end
};
std::vector<uint32_t> writeSpirv(const ir::Module& module, const schedule::Program& program,
                                 const SpirvOptions& options);

}  // namespace lacquer::targets
