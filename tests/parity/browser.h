// Fragment shaders at points in a browser: what the tests of its languages share.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "parity/subject.h"

namespace lacquer::parity {

std::string base64(const std::vector<unsigned char>& bytes);

/// Whether what is bound there is a list of the module's.
bool isList(const ir::Module& module, const vulkan::UniformBlock& block);

/// What both pages call the same of a texture: its shape, size, texels, and how they are looked up.
nlohmann::json textureWords(const vulkan::Texture& texture);

/// The same of a fragment stage: how many points, and its colours; the other lists are empty.
nlohmann::json workWords(const vulkan::Work& work, const ir::Module& module);

/// Runs all works in one browser, by a program of checks/; nothing where there is none.
std::optional<nlohmann::json> colorsOf(const char* program, const nlohmann::json& works);

/// The outputs of a work; of discarded points, and of those alone, what the CPU says. `text` is shown on a
/// failure.
std::vector<std::vector<float>> outputsOf(const Subject& subject, const nlohmann::json& colors,
                                          const std::string& text);

/// Runs the subjects, more than `least` numbers in all, and holds them to the bounds of all engines.
void expectColors(const char* program, const std::vector<Subject>& subjects,
                  const std::function<nlohmann::json(const Subject&)>& work_of, size_t least);

/// Every so many materials of examples/.
std::vector<Subject> materials(const MaterialSetting& setting, size_t points, size_t stride);

}  // namespace lacquer::parity
