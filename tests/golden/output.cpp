#include "output.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <fstream>

#include "support/cases.h"

namespace lacquer::test {

namespace fs = std::filesystem;

Folder::Folder() {
  static std::atomic<uint64_t> count{
      static_cast<uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count())};
  do {
    path_ = fs::path(testing::TempDir()) / ("lacquer-golden-" + std::to_string(count++));
  } while (!fs::create_directories(path_));
}

Folder::~Folder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

WorkingFolder::WorkingFolder(const fs::path& folder) : before_(fs::current_path()) {
  fs::current_path(folder);
}
WorkingFolder::~WorkingFolder() { fs::current_path(before_); }

void writeText(const fs::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) ADD_FAILURE() << file.string() << " cannot be written";
}

std::map<std::string, std::string> filesOf(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const fs::path& file : findFiles(folder, "")) {
    files[file.lexically_relative(folder).generic_string()] = readFile(file);
  }
  return files;
}

Json manifestOf(const fs::path& folder) {
  const Json json = Json::parse(readFile(folder / "manifest.json"), nullptr, false);
  if (!json.is_discarded()) return json;
  ADD_FAILURE() << (folder / "manifest.json").string() << " is no JSON";
  return nullptr;
}

std::string textOf(const Messages& messages) {
  std::string text;
  for (const Message& message : messages) text += message.text + "\n";
  return text;
}

std::vector<std::string> exampleFiles() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(sourceFolder() / "examples")) {
    if (entry.path().extension() == ".gltf") names.push_back("examples/" + entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::map<std::string, Json> exampleJson() {
  std::map<std::string, Json> all;
  for (const std::string& name : exampleFiles()) all[name] = Json::parse(readFile(sourceFolder() / name));
  return all;
}

Json generateWell(const std::vector<std::string>& files, const fs::path& folder, const Options& options) {
  Messages messages;
  const Report report = generate(files, {}, folder.string(), options, messages);
  EXPECT_TRUE(report.ok) << textOf(messages);
  EXPECT_FALSE(hasError(messages)) << textOf(messages);
  for (const ShaderReport& shader : report.shaders)
    EXPECT_EQ(shader.validated, options.validate) << shader.id;
  return manifestOf(folder);
}

std::map<std::string, std::string> codeOf(const Shader& shader) {
  std::map<std::string, std::string> code;
  for (const Target target : {Target::Glsl, Target::GlslGl, Target::Essl, Target::Hlsl, Target::Wgsl}) {
    code[std::string(targetName(target)) + " vert"] = shader.vertexText(target);
    code[std::string(targetName(target)) + " frag"] = shader.fragmentText(target);
  }
  const auto bytes = [](const std::vector<uint32_t>& words) {
    std::string text(words.size() * 4, '\0');
    if (!words.empty()) std::memcpy(text.data(), words.data(), text.size());
    return text;
  };
  code["spirv vert"] = bytes(shader.vertexSpirv());
  code["spirv frag"] = bytes(shader.fragmentSpirv());
  code["interface"] = shader.interfaceJson();
  return code;
}

}  // namespace lacquer::test
