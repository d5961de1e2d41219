#include "inputs.h"

#include <sstream>

#include <fstream>

#include <gtest/gtest.h>

#include "support/cases.h"

namespace lacquer::test {

std::string errorsOf(const Messages& messages) {
  std::string codes;
  for (const Message& message : messages) {
    if (message.level != Message::Level::Error) continue;
    EXPECT_NE(message.text, "");
    EXPECT_NE(message.message, "");
    codes += (codes.empty() ? "" : " ") + message.code;
  }
  return codes;
}

std::string paintGltf(int lights) {
  std::string text = R"({"asset": {"version": "2.0"}, "materials": [{"name": "Paint"}])";
  std::string list;
  std::string nodes;
  std::string indices;
  for (int i = 0; i < lights; ++i) {
    const std::string comma = i == 0 ? "" : ", ";
    list += comma + R"({"type": "point"})";
    nodes += comma + R"({"extensions": {"KHR_lights_punctual": {"light": )" + std::to_string(i) + "}}}";
    indices += comma + std::to_string(i);
  }
  if (lights > 0) {
    text +=
        R"(, "extensionsUsed": ["KHR_lights_punctual"], "extensions": {"KHR_lights_punctual": {"lights": [)" +
        list + R"(]}}, "nodes": [)" + nodes + R"(], "scene": 0, "scenes": [{"nodes": [)" + indices + "]}]";
  }
  return text + "}";
}

Scene paintScene() {
  Messages messages;
  Scene scene = Scene::fromMemory(paintGltf(), "paint.gltf", {}, messages);
  EXPECT_EQ(errorsOf(messages), "");
  return scene;
}

Graph paintGraph() {
  Messages messages;
  Graph graph = paintScene().graph(0, {}, {}, messages);
  EXPECT_EQ(errorsOf(messages), "");
  return graph;
}

Options quick() {
  Options options;
  options.validate = false;
  options.targets = {Target::Glsl};
  return options;
}

Strings examples() {
  Strings files;
  for (const auto& file : findFiles(sourceFolder() / "examples", ".gltf")) files.push_back(file.string());
  return files;
}

std::filesystem::path emptyFolder() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "lacquer_api" / test->test_suite_name() / test->name();
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

std::string readBytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string sourceIn(const std::string& manifest) {
  constexpr std::string_view kKey = "\"source\": \"";
  const size_t at = manifest.find(kKey) + kKey.size();
  return manifest.substr(at, manifest.find('"', at) - at);
}

}  // namespace lacquer::test
