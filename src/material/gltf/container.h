// From a file's bytes to its JSON text.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "support/diagnostic.h"
#include "support/file.h"

namespace lacquer::gltf {

/// As readFile().
inline Result<std::string> readBytes(const std::string& path) { return readFile(path); }

/// A part of a GLB.
struct Chunk {
  enum class Kind : uint8_t { Json, Binary, Other };
  Kind kind = Kind::Other;
  uint32_t encoding = 0;  ///< of version 3; 0 are bytes as they are, others are defined nowhere
  std::string_view data;
};

/// A GLB, as views into its bytes.
struct Container {
  uint32_t version = 2;
  std::string_view json;  ///< the text of the first chunk of that type
  std::vector<Chunk> chunks;
};

/// By its magic, not by a file's name.
bool isGlb(std::string_view bytes);

/// A GLB of version 2 or 3. Errors: "truncated-glb" when it is cut off or its chunks do not fit,
/// "unsupported-version", "no-json-chunk".
/// source: glTF 2.0, "Binary glTF Layout"; version 3: the draft of glTF 2.1, in the same section
Result<Container> containerOf(std::string_view bytes, const std::string& file);

/// The JSON in `bytes`, which are a .gltf or a .glb. The view is into `bytes`. Errors: those of
/// containerOf(), "empty-file".
Result<std::string_view> jsonText(std::string_view bytes, const std::string& file);

}  // namespace lacquer::gltf
