// A module's code for every target, and where that lies.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "ir/module.h"
#include "shader/options.h"
#include "shader/times.h"

namespace lacquer {

/// One distinct shader.
struct ShaderData {
  ir::Module module;  ///< placed and bound
  std::string id;
  bool has_vertex = false;
  /// By target, by stage. Target::Cpp's one file stands with the fragments, as Target::Js's code does; its
  /// types stand before it.
  std::string text[kTargetCount][2];
  std::vector<uint32_t> spirv[2];
  std::string interface;
};

/// What is wrong with the code of each target.
using Wrong = std::array<Diagnostics, kTargetCount>;

/// Prints every target that the options name, and compiles and validates them when asked. Validation failures
/// go to `wrong`; the code is there all the same.
void print(ShaderData& shader, const Options& options, Wrong& wrong, StageTimes* times = nullptr);

/// The path below the output folder: "glsl/ID.frag.glsl", "cpp/ID.h", "js/ID.d.ts".
std::string shaderPath(Target target, const std::string& id, int stage);

/// What the file is called in the manifest: "vert", "frag", "header", "types", "module".
std::string_view fileKind(Target target, int stage);

/// The target has no stages: it packs the material's block.
inline bool packsBlock(Target target) { return target == Target::Cpp || target == Target::Js; }

/// The first of the stages, 0 or 1, that have a file; the last is 1. Target::Cpp has one file, Target::Js
/// two.
inline int firstStage(Target target, bool has_vertex) {
  return target == Target::Js || (has_vertex && target != Target::Cpp) ? 0 : 1;
}

/// What is made is a shader: the manifest says whether it was validated.
inline bool isShader(Target target) { return !packsBlock(target); }
/// Some compiler or validator on this machine checks the target's code. WGSL's need not be installed, and
/// Metal's is nowhere.
bool hasValidator(Target target);

}  // namespace lacquer
