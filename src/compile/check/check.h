// Real compilers and validators over what the printers wrote. A failure here is a bug of Lacquer, never of
// the user's input.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lacquer/options.h"
#include "support/diagnostic.h"

namespace lacquer::check {

enum class Stage : uint8_t { Vertex, Fragment };

using Spirv = std::vector<uint32_t>;

/// HLSL numbers cbuffers, textures and samplers apart (b0, t0, s0); Vulkan has one row of bindings per set.
/// In SPIR-V made from HLSL, `register(bN, spaceM)` becomes binding N + kHlslBufferShift of set M, and so on.
/// The gaps are the limits: 16 cbuffers and 32 textures of a set.
inline constexpr uint32_t kHlslBufferShift = 0;
inline constexpr uint32_t kHlslTextureShift = 16;
inline constexpr uint32_t kHlslSamplerShift = 48;

/// Some compiler or validator on this machine checks the target's code (targets::Row::checker).
bool canCheck(Target target);
/// What helps where nothing does; may be empty.
std::string_view howToCheck(Target target);
/// The programs beside what is linked that check the target's code, as they are told from others.
std::string programsOf(Target target);

/// What is wrong with the text of a stage, by all that checks the target's code. `name` is the file name in
/// diagnostics.
Diagnostics checkText(const std::string& text, Target target, Stage stage, const std::string& name);
/// The same of a stage's SPIR-V for Vulkan: validate() and checkSlots().
Diagnostics checkWords(const Spirv& words, const std::string& name);

/// Compiles the text of a target that glslang knows. `name` is the file name in diagnostics. For
/// Checker::Vulkan and Direct3d the result is SPIR-V 1.3 for Vulkan 1.1; OpenGl gives OpenGL SPIR-V, after
/// the text has passed as a driver's input, too; Es is only checked (the result is empty). The text must
/// begin with the row's version. HLSL is compiled as for Shader Model 6; its entry point is
/// `main`, and its cbuffers keep the offsets of HLSL's
/// packing rules, except behind an array: Direct3D goes on in the last element's register, glslang in the
/// next one. The errors are glslang's messages, one diagnostic each, code "glslang". Safe to call from
/// several threads.
Result<Spirv> compile(std::string_view text, Target target, Stage stage, const std::string& name);

/// spirv-val for Vulkan 1.1 (or OpenGL 4.5). An empty list when valid. Code "spirv-val".
Diagnostics validate(const Spirv& words, bool open_gl, const std::string& name);
/// The same for Vulkan 1.3, of modules that others made (SPIR-V up to 1.6).
Diagnostics validateForeign(const Spirv& words, const std::string& name);

/// Two resources in one place, by the decorations in the words; OpenGL numbers blocks and textures apart.
/// Code "slot-clash"; spirv-val allows it. An empty list for words that are no module: validate() says so.
Diagnostics checkSlots(const Spirv& words, bool open_gl, const std::string& name);

/// spirv-opt -O (performance passes). Used for comparisons only; nothing the product writes goes through it.
Result<Spirv> optimize(const Spirv& words, const std::string& name);

/// What is linked, as it names itself: "glslang 12.0.0, SPIRV-Tools v2023.1 …".
std::string toolVersions();

/// True when `dxc` is on the PATH and can be run from here (on POSIX systems only).
bool haveDxc();

/// What tells the dxc on the PATH from another one without running it: the file that it leads to, its size
/// and when it was modified. Empty where there is none.
std::string dxcIdentity();

/// Compiles HLSL with dxc (profile vs_6_0 / ps_6_0), with the root signature LACQUER_ROOT_SIGNATURE where the
/// text defines it. An empty list when it compiles; without dxc one error,
/// "dxc-missing". Code "dxc". Safe to call from several threads, as long as none changes the environment.
Diagnostics compileWithDxc(const std::string& text, Stage stage, const std::string& name);

/// True when `lacquer-wgsl-check` (checks/wgsl) is on the PATH and can be run from here (on POSIX systems
/// only).
bool haveTint();

/// What tells it from another one without running it: the file that it leads to, its size, when it was
/// modified, and the description of the package with the compiler. Empty where there is none.
std::string tintIdentity();

/// Compiles WGSL with Tint, Dawn's compiler, of either stage. An empty list when it has nothing to say;
/// warnings and notes are said as such. Code "tint"; where there is no program or no compiler in it one
/// error, "tint-missing". The program is started once and lives as long as the process. Safe to call from
/// several threads, which take turns, as long as none changes the environment.
Diagnostics compileWithTint(const std::string& text, const std::string& name);

}  // namespace lacquer::check
