// From a file's bytes to its JSON text.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "support/diagnostic.h"
#include "support/file.h"

namespace lacquer::gltf {

/// As readFile().
inline Result<std::string> readBytes(const std::string& path) { return readFile(path); }

/// Four bytes of a GLB as a number; they must be there.
/// source: glTF 2.0, "Binary glTF Layout" (little-endian)
uint32_t word(std::string_view bytes, size_t offset);

/// The JSON in `bytes`, which are a .gltf or a .glb (told apart by the GLB's magic, not by a file name). The
/// view is into `bytes`. Fails when a GLB is truncated or its chunks do not fit.
Result<std::string_view> jsonText(std::string_view bytes, const std::string& file);

}  // namespace lacquer::gltf
