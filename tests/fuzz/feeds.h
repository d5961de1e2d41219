// The functions behind the targets.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "lacquer.h"
#include "support/digest.h"

namespace lacquer::fuzz {

// shaders.cpp
std::string feedGltf(std::string_view bytes);
std::string feedGraph(std::string_view bytes);

// oracle.cpp
std::string judgeGltf(std::string_view bytes);
std::string judgeGraph(std::string_view bytes);

// edits.cpp
std::string feedEdits(std::string_view bytes);

// addresses.cpp
std::string feedAddresses(std::string_view bytes);

// language.cpp
std::string feedNode(std::string_view bytes);
std::string feedDeclaration(std::string_view bytes);

// parts.cpp
std::string feedPart(std::string_view bytes);

// bytes.cpp
std::string feedImage(std::string_view bytes);
std::string feedPanorama(std::string_view bytes);
std::string feedIes(std::string_view bytes);
std::string feedGeometry(std::string_view bytes);
std::string feedPoints(std::string_view bytes);
std::string feedSpirv(std::string_view bytes);
std::string feedPacked(std::string_view bytes);

// files.cpp
std::string feedTexture(std::string_view bytes);
std::string feedCase(std::string_view bytes);
std::string feedManifest(std::string_view bytes);

// written.cpp
std::string feedDocumentOut(std::string_view bytes);
std::string feedProceduralsOut(std::string_view bytes);

// definitions.cpp
std::string feedDefinitions(std::string_view bytes);

// entries.cpp
std::string feedEntry(std::string_view bytes);

/// A number that the input chooses, and another one for each `which` of the first four.
inline uint64_t numberOf(std::string_view bytes, size_t which = 0) {
  const Digest digest = digestOf(bytes);
  uint64_t number = 0;
  std::memcpy(&number, digest.data() + sizeof number * which, sizeof number);
  return number;
}

/// Options that the input's hash chooses; one target, SPIR-V, and no validation.
Options optionsOf(std::string_view bytes);
/// All errors among the messages, one to a line.
std::string errorsOf(const Messages& messages);

/// A folder of this process, in memory where the system has such a place; removed when the program ends.
const std::string& workFolder();
/// Writes a file of the work folder and returns its path.
std::string put(const std::string& name, std::string_view bytes);

}  // namespace lacquer::fuzz
