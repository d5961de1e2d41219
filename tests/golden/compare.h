// What differs between two outputs of generate(), for a person to read.
#pragma once

#include <filesystem>
#include <string>

namespace lacquer::test {

/// A file's text: of SPIR-V, by its name, the disassembly.
std::string readable(const std::string& name, const std::string& bytes);

/// Empty when both folders hold the same files with the same bytes. Otherwise the missing, the new and the
/// differing files, with their lines; SPIR-V is shown disassembled.
std::string outputDifferences(const std::filesystem::path& expected, const std::filesystem::path& actual);

}  // namespace lacquer::test
