// A file's contract without a folder: what it is drawn with, and the code of that.
#pragma once

#include <functional>

#include "shader/print.h"
#include "structures/code.h"
#include "structures/describe.h"

namespace lacquer {

/// A distinct shader with all of its code.
struct CodedShader {
  ShaderData data;
  std::vector<std::pair<Target, bool>> validated;  ///< of each target of a shader
};

struct MadeContract {
  Contract values;                   ///< its `shaders` are without a Shader
  std::vector<CodedShader> shaders;  ///< in the same order
  Diagnostics diagnostics;           ///< of materials and shaders, in their order
};
/// The document's materials, or those of the names in `only` where there are some. Uses threads. `progress`
/// is called with the number of shaders done and of all, from one thread at a time.
MadeContract contractOf(const material::Document& document, const std::vector<std::string>& only,
                        const Setting& setting, Structures& structures,
                        const std::function<void(size_t done, size_t known)>& progress);

/// What keys of results begin with: this build with its compilers and validators, and the node files.
/// `node_files`: is given their names, where it is not null. `all_known`: false where some cannot be read.
Key baseOf(const Options& options, std::vector<std::string>* node_files = nullptr, bool* all_known = nullptr);

}  // namespace lacquer
