// What the C++ interface makes of examples/ comes through the C interface, to the byte.
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "handle.h"
#include "lacquer.h"
#include "support/cases.h"

namespace lacquer::test::golden_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::map<std::string, std::string> filesBelow(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file())
      files[fs::relative(entry.path(), folder).generic_string()] = readFile(entry.path());
  }
  return files;
}

uint32_t bitsOf(const Json& attributes) {
  const std::vector<std::string> names = {"NORMAL",     "TANGENT",    "COLOR_0",   "TEXCOORD_0",
                                          "TEXCOORD_1", "TEXCOORD_2", "TEXCOORD_3"};
  uint32_t bits = 0;
  for (const Json& name : attributes) {
    for (size_t i = 0; i < names.size(); ++i) {
      if (name == names[i]) bits |= 1U << i;
    }
  }
  return bits;
}

class Through {
public:
  explicit Through(const fs::path& folder) : files_(filesBelow(folder)) {}

  void use(lacquer_scene* scene, size_t material, const Json& use) {
    CMessages messages;
    const uint32_t bits = bitsOf(use["attributes"]);
    bool listed = false;
    for (size_t i = 0; i < lacquer_scene_use_count(scene, material); ++i)
      listed = listed || lacquer_scene_use(scene, material, i) == bits;
    EXPECT_TRUE(listed) << use["attributes"];
    const CGraph graph(lacquer_scene_graph(scene, material, bits, nullptr, messages));
    const COptions options =
        optionsFrom(R"({"targets": ["glsl", "glsl-gl", "essl", "hlsl", "spirv", "wgsl"]})", messages);
    const CShader shader(lacquer_graph_generate(graph.get(), options.get(), messages));
    EXPECT_EQ(messages.takeCodes(), "");
    ASSERT_NE(shader, nullptr);
    const std::string id = lacquer_shader_id(shader.get());
    EXPECT_EQ(id, use["shader"]);
    for (const auto& [name, bytes] : files_) {
      if (name.find("/" + id + ".") == std::string::npos) continue;
      ++compared_;
      const int stage = name.find(".vert.") != std::string::npos ? LACQUER_VERTEX : LACQUER_FRAGMENT;
      EXPECT_EQ(codeOf(shader.get(), name.substr(0, name.find('/')), stage), bytes) << name;
    }
  }
  size_t compared() const { return compared_; }

private:
  static std::string codeOf(const lacquer_shader* shader, const std::string& target, int stage) {
    size_t size = 0;
    if (target != "spirv") {
      const char* text = lacquer_shader_text(shader, target.c_str(), stage, &size);
      return {text, size};
    }
    const uint32_t* words = lacquer_shader_spirv(shader, stage, &size);
    std::string bytes(4 * size, '\0');
    if (size > 0) std::memcpy(bytes.data(), words, bytes.size());
    return bytes;
  }

  std::map<std::string, std::string> files_;
  size_t compared_ = 0;
};

/// The examples' shaders for every target, made by a run over the files.
void generateInto(const fs::path& folder) {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(sourceFolder() / "examples"))
    if (entry.path().extension() == ".gltf") files.push_back(entry.path().string());
  Options options;
  options.targets = {Target::Glsl, Target::GlslGl, Target::Essl, Target::Hlsl, Target::Spirv, Target::Wgsl};
  options.validate = false;
  Messages messages;
  EXPECT_TRUE(generate(files, {}, folder.string(), options, messages).ok);
}

TEST(CGolden, everyFileOfARunComesThroughTheInterface) {
  const fs::path folder = fs::path(testing::TempDir()) / "lacquer-c-golden";
  fs::remove_all(folder);
  generateInto(folder);
  Through through(folder);
  const Json manifest = Json::parse(readFile(folder / "manifest.json"));
  for (const Json& file : manifest["files"]) {
    CMessages messages;
    const std::string source = file["source"];
    const std::string bytes = readFile(folder / source);
    const CScene scene(lacquer_scene_read(bytes.data(), bytes.size(), source.c_str(), nullptr, messages));
    ASSERT_NE(scene, nullptr) << messages.takeCodes();
    for (const Json& material : file["materials"]) {
      size_t size = 0;
      const size_t index = material["index"];
      const char* name = lacquer_scene_material_name(scene.get(), index, &size);
      EXPECT_EQ(std::string(name, size), material["name"]);
      for (const Json& use : material["uses"]) through.use(scene.get(), index, use);
    }
  }
  EXPECT_GT(through.compared(), 200u);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace lacquer::test::golden_test
