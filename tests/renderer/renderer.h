// The program of examples/renderer, as the tests run it.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace lacquer::test {

/// Whether there is a Vulkan device to draw on.
bool canDraw();
/// Vulkan's validation layer is installed: every run has it on.
bool haveValidation();

struct Ran {
  int status = -1;
  std::string said;  ///< both streams
};
/// Runs the program in a folder of the test; fails the test where the validation layer says anything.
Ran run(const std::vector<std::string>& words, const std::string& environment = {});

/// Linear radiance, rows from the top.
struct Picture {
  uint32_t width = 0, height = 0;
  std::vector<std::array<float, 3>> pixels;
  const std::array<float, 3>& at(uint32_t x, uint32_t y) const { return pixels[size_t{y} * width + x]; }
};
/// Draws into linear numbers, which are to be radiance: finite and not negative, unless another template's
/// are drawn. Empty, and a failure of the test, where that fails.
Picture draw(const std::filesystem::path& scene, const std::vector<std::string>& options);

/// A folder of the test that runs, empty at first.
const std::filesystem::path& place();
/// Of the environments and shaders of all tests of a run.
std::string cacheFolder();
/// A picture of the surroundings of one radiance, which has eight bits.
std::string uniformSky(float radiance);

}  // namespace lacquer::test
