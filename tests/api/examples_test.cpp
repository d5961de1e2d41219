// The programs of examples/ run, and say what the library says.
#include <gtest/gtest.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "inputs.h"

#ifdef LACQUER_BIND
namespace lacquer::test {
namespace {

std::string outputOf(const std::string& program, const std::string& file) {
  std::string text;
  std::FILE* pipe = ::popen(("'" + program + "' '" + file + "'").c_str(), "r");
  if (pipe == nullptr) return text;
  char block[4096];
  while (const size_t got = std::fread(block, 1, sizeof block, pipe)) text.append(block, got);
  EXPECT_EQ(::pclose(pipe), 0);
  return text;
}

TEST(Examples, BindSaysWhatTheManifestSays) {
  const std::string file = std::string(LACQUER_EXAMPLES) + "/car_paint.gltf";
  const std::string text = outputOf(LACQUER_BIND, file);
  Options options = quick();
  Messages messages;
  const Scene scene = Scene::load(file, options, messages);
  for (size_t i = 0; i < scene.materialCount(); ++i) {
    for (const Attributes& attributes : scene.uses(i)) {
      const Shader shader = scene.graph(i, attributes, options, messages).generate(options, messages);
      ASSERT_TRUE(shader);
      const auto entry = nlohmann::json::parse(shader.interfaceJson());
      EXPECT_NE(text.find(shader.id()), std::string::npos);
      for (const auto& block : entry["uniforms"]) {
        const std::string line = "buffer " + block["flat"].dump() + ": " + block["block"].get<std::string>() +
                                 ", " + block["size"].dump() + " bytes";
        EXPECT_NE(text.find(line), std::string::npos) << line << "\n" << text;
      }
      for (const auto& texture : entry["textures"]) {
        const std::string line = "unit " + texture["flat"].dump() + ": " + texture["name"].get<std::string>();
        EXPECT_NE(text.find(line), std::string::npos) << line << "\n" << text;
      }
    }
  }
}
}  // namespace
}  // namespace lacquer::test
#endif
