#include "renderer.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>

namespace lacquer::test {

namespace fs = std::filesystem;

namespace {

std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

Ran start(const std::string& command) {
  Ran made;
  std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return made;
  char block[4096];
  while (const size_t got = std::fread(block, 1, sizeof block, pipe)) made.said.append(block, got);
  const int status = ::pclose(pipe);
  made.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return made;
}

}  // namespace

bool haveValidation() {
  return fs::exists("/usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json");
}

bool canDraw() {
  static const bool can = [] {
    const Ran run =
        start(quoted(LACQUER_RENDERER) + " " + quoted(LACQUER_SOURCE "/examples/renderer/still_life.glb") +
              " -o " + quoted((place() / "first.png").string()) + " --size 16x16 --samples 1 --cache " +
              quoted(cacheFolder()));
    if (run.status != 0) std::printf("nothing can be drawn here: %s\n", run.said.c_str());
    return run.status == 0;
  }();
  return can;
}

Ran run(const std::vector<std::string>& words, const std::string& environment) {
  std::string command = environment;
  if (haveValidation()) command += " VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation";
  command += " " + quoted(LACQUER_RENDERER);
  for (const std::string& word : words) command += " " + quoted(word);
  Ran made = start(command);
  EXPECT_EQ(made.said.find("VUID"), std::string::npos) << made.said;
  EXPECT_EQ(made.said.find("Validation"), std::string::npos) << made.said;
  return made;
}

const fs::path& place() {
  static const fs::path folder = [] {
    fs::path made = fs::path(testing::TempDir()) / "lacquer_renderer_test";
    fs::remove_all(made);
    fs::create_directories(made);
    return made;
  }();
  return folder;
}

std::string cacheFolder() { return (place() / "cache").string(); }

Picture draw(const fs::path& scene, const std::vector<std::string>& options) {
  const fs::path output = place() / "picture.pfm";
  fs::remove(output);
  std::vector<std::string> words{scene.string(), "-o", output.string(), "--cache", cacheFolder()};
  words.insert(words.end(), options.begin(), options.end());
  const Ran made = run(words);
  EXPECT_EQ(made.status, 0) << made.said;
  Picture picture;
  std::ifstream file(output, std::ios::binary);
  std::string magic;
  float scale = 0;
  file >> magic >> picture.width >> picture.height >> scale;
  file.get();
  EXPECT_EQ(magic, "PF");
  picture.pixels.resize(size_t{picture.width} * picture.height);
  for (uint32_t y = picture.height; y-- > 0;)
    file.read(reinterpret_cast<char*>(&picture.pixels[size_t{y} * picture.width]), 12 * picture.width);
  EXPECT_TRUE(file) << "the picture is too short";
  if (std::find(options.begin(), options.end(), "--template") != options.end()) return picture;
  for (const auto& pixel : picture.pixels) {
    for (const float x : pixel) EXPECT_TRUE(std::isfinite(x) && x >= 0);
  }
  return picture;
}

std::string uniformSky(float radiance) {
  const fs::path path = place() / ("sky" + std::to_string(radiance) + ".hdr");
  std::ofstream file(path, std::ios::binary);
  file << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16 +X 32\n";
  int exponent = 0;
  const auto mantissa = static_cast<unsigned char>(std::frexp(radiance, &exponent) * 256);
  for (int i = 0; i < 16 * 32; ++i) {
    for (int c = 0; c < 3; ++c) file.put(static_cast<char>(mantissa));
    file.put(static_cast<char>(exponent + 128));
  }
  return path.string();
}

}  // namespace lacquer::test
