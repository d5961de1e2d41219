// The functions behind the targets.
#pragma once

#include <string>
#include <string_view>

#include "lacquer.h"

namespace lacquer::fuzz {

// shaders.cpp
std::string feedGltf(std::string_view bytes);
std::string feedGraph(std::string_view bytes);

// oracle.cpp
std::string judgeGltf(std::string_view bytes);
std::string judgeGraph(std::string_view bytes);

// language.cpp
std::string feedNode(std::string_view bytes);
std::string feedDeclaration(std::string_view bytes);

// bytes.cpp
std::string feedImage(std::string_view bytes);
std::string feedPanorama(std::string_view bytes);
std::string feedGeometry(std::string_view bytes);
std::string feedPoints(std::string_view bytes);
std::string feedSpirv(std::string_view bytes);

// files.cpp
std::string feedTexture(std::string_view bytes);
std::string feedCase(std::string_view bytes);
std::string feedManifest(std::string_view bytes);

// entries.cpp
std::string feedEntry(std::string_view bytes);

/// Options that the input's hash chooses; one target, SPIR-V, and no validation.
Options optionsOf(std::string_view bytes);
/// All errors among the messages, one to a line.
std::string errorsOf(const Messages& messages);

/// A folder of this process, in memory where the system has such a place; removed when the program ends.
const std::string& workFolder();
/// Writes a file of the work folder and returns its path.
std::string put(const std::string& name, std::string_view bytes);

}  // namespace lacquer::fuzz
