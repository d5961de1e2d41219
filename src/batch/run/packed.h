// manifest.json as one file of records (lacquer/packed.h), made of its values.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lacquer/contract.h"
#include "support/diagnostic.h"

namespace lacquer {

struct PackedCode {
  std::string target, stage;
  std::string_view bytes;
  bool validated = false;
};
struct PackedShader {
  std::string_view id;
  const Reflection* reflection = nullptr;
  bool argument_buffers = false;  ///< of its MSL
  std::vector<PackedCode> codes;
};

/// The bytes of a packed manifest. A use's `shader` is an index into `shaders`; its block is made of its
/// `uniforms`. "too-large" for what takes 4 GiB.
Result<std::string> packedBytes(std::span<const FileContract* const> files,
                                std::span<const PackedShader> shaders);

}  // namespace lacquer
