#include "compare.h"

#include <fmt/format.h>

#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
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

std::string readable(const std::string& name, const std::string& bytes) {
  return name.ends_with(".spv") ? disassembled(bytes) : bytes;
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

/// What each use of a material draws with: "examples/a.gltf, 'Paint', NORMAL TEXCOORD_0" and the shader.
std::map<std::string, std::string> shadersOf(const Files& files) {
  std::map<std::string, std::string> shaders;
  const auto text = files.find("manifest.json");
  if (text == files.end()) return shaders;
  const Json manifest = Json::parse(text->second, nullptr, false);
  if (!manifest.is_object() || !manifest.contains("files")) return shaders;
  for (const Json& file : manifest["files"]) {
    for (const Json& material : file["materials"]) {
      for (const Json& use : material["uses"]) {
        std::string key =
            fmt::format("{}, '{}',", file["source"].get<std::string>(), material["name"].get<std::string>());
        for (const Json& attribute : use["attributes"]) key += " " + attribute.get<std::string>();
        shaders[key] = use["shader"].get<std::string>();
      }
    }
  }
  return shaders;
}

std::string withShader(const std::string& name, const std::string& from, const std::string& to) {
  const size_t at = name.find(from + ".");
  return at == std::string::npos ? std::string() : name.substr(0, at) + to + name.substr(at + from.size());
}

/// The files of a shader that a material had against those that it has, each pair of shaders once.
std::string replacedShaders(const Files& expected, const Files& actual, std::set<std::string>& told) {
  std::string text;
  const std::map<std::string, std::string> now = shadersOf(actual);
  std::set<std::pair<std::string, std::string>> pairs;
  for (const auto& [use, old_id] : shadersOf(expected)) {
    const auto found = now.find(use);
    if (found == now.end() || found->second == old_id) continue;
    const std::string& new_id = found->second;
    text += fmt::format("{}: {} is now {}\n", use, old_id, new_id);
    if (!pairs.insert({old_id, new_id}).second) continue;
    for (const auto& [name, bytes] : expected) {
      const std::string other = withShader(name, old_id, new_id);
      if (other.empty() || !actual.contains(other)) continue;
      told.insert(name);
      told.insert(other);
      // One language is enough to see what has changed; the others say the same.
      if (name.starts_with("glsl/")) text += name + ":\n" + difference(name, bytes, actual.at(other));
    }
  }
  return text;
}

}  // namespace

std::string outputDifferences(const fs::path& expected, const fs::path& actual) {
  const Files before = filesOf(expected);
  const Files after = filesOf(actual);
  if (before == after) return {};
  if (before.empty()) return expected.string() + " holds no files\n";
  std::set<std::string> told;
  std::string text = replacedShaders(before, after, told);
  for (const auto& [name, bytes] : before) {
    const auto found = after.find(name);
    if (found == after.end()) {
      if (!told.contains(name)) text += "missing: " + name + "\n";
    } else if (found->second != bytes) {
      text += "differs: " + name + "\n" + difference(name, bytes, found->second);
    }
  }
  for (const auto& [name, bytes] : after) {
    if (!before.contains(name) && !told.contains(name)) text += "new: " + name + "\n";
  }
  return text;
}

}  // namespace lacquer::test
