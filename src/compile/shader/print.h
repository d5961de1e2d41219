// A module's code for every target, and where that lies.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "ir/module.h"
#include "setting/options.h"
#include "shader/times.h"

namespace lacquer {

/// One distinct shader.
struct ShaderData {
  ir::Module module;  ///< placed and bound
  std::string id;
  bool has_vertex = false;
  /// By target, by targets::Row::files.
  std::string text[kMostTargets][2];
  std::vector<uint32_t> spirv[2];  ///< of targets::Row::words
};

/// Takes the bytes of a file of the target; SPIR-V's words with their lowest byte first.
std::string takeBytes(ShaderData& shader, Target target, int file);
/// Puts them back.
void putBytes(std::string bytes, ShaderData& shader, Target target, int file);

/// What is wrong with the code of each target.
using Wrong = std::array<Diagnostics, kMostTargets>;

/// Prints every target that the options name, and compiles and validates them when asked. Validation failures
/// go to `wrong`; the code is there all the same.
void print(ShaderData& shader, const Options& options, Wrong& wrong, StageTimes* times = nullptr);

/// The path below the output folder: "glsl/ID.frag.glsl", "cpp/ID.h", "js/ID.d.ts".
std::string shaderPath(Target target, const std::string& id, int stage);

/// What the file is called in the manifest: "vert", "frag", "header", "types", "module".
std::string_view fileKind(Target target, int stage);

/// The target has no stages: it packs the material's block.
bool packsBlock(Target target);

/// The first of the target's files, 0 or 1; the last is 1.
int firstStage(Target target, bool has_vertex);

/// What is made is a shader: the manifest says whether it was validated.
inline bool isShader(Target target) { return !packsBlock(target); }
/// Some compiler or validator on this machine checks the target's code.
/// `arrays`: it has arrays of textures, of which compilers of WGSL know none.
bool hasValidator(Target target, bool arrays = false);
/// "not-validated", of each target of which shaders are wanted validated and nothing here can.
Diagnostics withoutValidator(const Options& options);

}  // namespace lacquer
