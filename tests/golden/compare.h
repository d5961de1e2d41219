// What differs between two outputs of generate(), for a person to read.
#pragma once

#include <filesystem>
#include <string>

namespace lacquer::test {

/// Empty when both folders hold the same files with the same bytes. Otherwise the missing, the new and the
/// differing files, with their lines; SPIR-V is shown disassembled. A shader's name is the address of its
/// content, so a change takes away files and adds others: the shaders that one material had and has are
/// compared with each other.
std::string outputDifferences(const std::filesystem::path& expected, const std::filesystem::path& actual);

}  // namespace lacquer::test
