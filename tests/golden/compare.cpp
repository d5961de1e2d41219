#include "compare.h"

#include <fmt/format.h>

#include <cstring>
#include <map>
#include <spirv-tools/libspirv.hpp>

#include "output.h"
#include "support/cases.h"

namespace lacquer::test {

namespace fs = std::filesystem;

namespace {

using Files = std::map<std::string, std::string>;

constexpr size_t kMostLines = 60;  ///< of one file's difference

std::string disassembled(const std::string& bytes) {
  std::vector<uint32_t> words(bytes.size() / 4);
  std::memcpy(words.data(), bytes.data(), words.size() * 4);
  std::string text;
  const spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_1);
  if (!tools.Disassemble(words, &text, SPV_BINARY_TO_TEXT_OPTION_INDENT)) return "(no SPIR-V)\n";
  return text;
}

std::string firstLines(const std::string& text) {
  size_t end = 0;
  for (size_t line = 0; line < kMostLines; ++line) {
    end = text.find('\n', end);
    if (end == std::string::npos || ++end == text.size()) return text;
  }
  return text.substr(0, end) + "  … and more lines\n";
}

std::string difference(const std::string& name, const std::string& expected, const std::string& actual) {
  const std::string lines = diffLines(readable(name, expected), readable(name, actual));
  return firstLines(lines.empty() ? "(only what a disassembly does not show differs)\n" : lines);
}

}  // namespace

std::string readable(const std::string& name, const std::string& bytes) {
  return name.ends_with(".spv") ? disassembled(bytes) : bytes;
}

std::string outputDifferences(const fs::path& expected, const fs::path& actual) {
  const Files before = filesOf(expected);
  const Files after = filesOf(actual);
  if (before == after) return {};
  if (before.empty()) return expected.string() + " holds no files\n";
  std::string text;
  for (const auto& [name, bytes] : before) {
    const auto found = after.find(name);
    if (found == after.end()) {
      text += "missing: " + name + "\n";
    } else if (found->second != bytes) {
      text += "differs: " + name + "\n" + difference(name, bytes, found->second);
    }
  }
  for (const auto& [name, bytes] : after) {
    if (!before.contains(name)) text += "new: " + name + "\n";
  }
  return text;
}

}  // namespace lacquer::test
