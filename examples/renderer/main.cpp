// renderer SCENE.glb -o PICTURE.png: draws a glTF file with shaders that the library makes of its materials.
#include <stb/stb_image_write.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "renderer.h"

namespace {

struct Arguments {
  std::string scene, output, environment;
  renderer::Settings settings;
  uint32_t width = 960, height = 540, samples = 2;
  bool last = false;  ///< of the frames that have fallbacks: the one after them
  float seconds = 0, exposure = 1;
};

constexpr const char* kUsage =
    "usage: renderer SCENE.glb|.gltf -o PICTURE.png|.pfm [options]\n"
    "  --size WIDTHxHEIGHT    of the picture, 960x540\n"
    "  --samples N            a row of so many samples each way for a pixel, 1 to 8; 2\n"
    "  --environment SKY.hdr  what `lacquer environment` reads, or a folder that it wrote; the scene's own, "
    "or "
    "a plain studio\n"
    "  --time SECONDS         of the file's animations, and of materials that ask for the time; 24 pictures "
    "a second\n"
    "  --camera N             of the scene's cameras, from 0; one that sees everything where there is none\n"
    "  --variant NAME         of KHR_materials_variants\n"
    "  --exposure X           what radiance is multiplied by before tone mapping\n"
    "  --prepass              depth first, then colours where depth is equal\n"
    "  --programs N           at most so many shaders, which materials share\n"
    "  --fallback first|last  draws at once, with shaders that all materials share, while their own compile; "
    "the picture is that frame, or the first without them\n"
    "  --template NAME        draws what that template puts out first: depth, id, motion, surface\n"
    "  --cache DIR            keeps shaders and filtered environments\n";

uint32_t whole(const char* text, uint32_t least, uint32_t most) {
  char* end = nullptr;
  const unsigned long value = std::strtoul(text, &end, 10);
  if (end == text || *end != '\0' || value < least || value > most)
    throw std::runtime_error(std::string("'") + text + "' is no number from " + std::to_string(least) +
                             " to " + std::to_string(most));
  return static_cast<uint32_t>(value);
}

Arguments argumentsOf(int argc, char** argv) {
  Arguments made;
  made.settings.cache = (std::filesystem::temp_directory_path() / "lacquer_renderer").string();
  for (int i = 1; i < argc; ++i) {
    const std::string flag = argv[i];
    if (flag.empty() || flag[0] != '-') {
      made.scene = flag;
      continue;
    }
    if (flag == "--prepass") {
      made.settings.prepass = true;
      continue;
    }
    if (i + 1 == argc) throw std::runtime_error(flag + " needs a value\n" + kUsage);
    const char* const value = argv[++i];
    int at = 0;
    if (flag == "-o")
      made.output = value;
    else if (flag == "--size") {
      if (std::sscanf(value, "%ux%u%n", &made.width, &made.height, &at) != 2 || value[at] != '\0' ||
          made.width - 1 >= 16384 || made.height - 1 >= 16384)
        throw std::runtime_error(std::string("'") + value + "' is no size such as 960x540");
    } else if (flag == "--samples")
      made.samples = whole(value, 1, 8);
    else if (flag == "--environment")
      made.environment = value;
    else if (flag == "--time")
      made.seconds = std::strtof(value, nullptr);
    else if (flag == "--camera")
      made.settings.camera = whole(value, 0, 1000000);
    else if (flag == "--variant")
      made.settings.variant = value;
    else if (flag == "--exposure")
      made.exposure = std::strtof(value, nullptr);
    else if (flag == "--programs")
      made.settings.programs = whole(value, 0, 1000000);
    else if (flag == "--fallback") {
      made.settings.fallback = true;
      made.last = std::strcmp(value, "last") == 0;
      if (!made.last && std::strcmp(value, "first") != 0)
        throw std::runtime_error(std::string("'") + value + "' is neither first nor last");
    } else if (flag == "--template")
      made.settings.shown = value;
    else if (flag == "--cache")
      made.settings.cache = value;
    else
      throw std::runtime_error("there is no option " + flag + "\n" + kUsage);
  }
  if (made.scene.empty() || made.output.empty()) throw std::runtime_error(kUsage);
  made.settings.width = made.width * made.samples;
  made.settings.height = made.height * made.samples;
  return made;
}

/// From linear radiance to what a screen shows.
/// source: Khronos PBR Neutral Tone Mapper (2024); IEC 61966-2-1 (sRGB)
std::array<float, 3> shown(std::array<float, 3> color) {
  constexpr float kStart = 0.8F - 0.04F, kDesaturation = 0.15F;
  const float least = std::min({color[0], color[1], color[2]});
  const float offset = least < 0.08F ? least - 6.25F * least * least : 0.04F;
  for (float& x : color) x -= offset;
  const float peak = std::max({color[0], color[1], color[2]});
  if (peak >= kStart) {
    const float d = 1 - kStart, lower = 1 - d * d / (peak + d - kStart);
    const float g = 1 - 1 / (kDesaturation * (peak - lower) + 1);
    for (float& x : color) x = x * (lower / peak) * (1 - g) + lower * g;
  }
  for (float& x : color)
    x = x <= 0.0031308F ? 12.92F * std::max(x, 0.0F) : 1.055F * std::pow(x, 1 / 2.4F) - 0.055F;
  return color;
}

/// Averages each pixel's samples: of a picture as they are shown, of radiance as it is.
std::vector<float> resolved(const std::vector<float>& samples, const Arguments& with, bool radiance) {
  std::vector<float> picture(size_t{3} * with.width * with.height);
  const uint32_t n = with.samples;
  for (size_t y = 0; y < size_t{with.height} * n; ++y) {
    for (size_t x = 0; x < size_t{with.width} * n; ++x) {
      const float* from = &samples[4 * (y * with.width * n + x)];
      std::array<float, 3> color{from[0] * with.exposure, from[1] * with.exposure, from[2] * with.exposure};
      if (!radiance) color = shown(color);
      float* to = &picture[3 * (y / n * with.width + x / n)];
      for (size_t c = 0; c < 3; ++c) to[c] += color[c] / static_cast<float>(n * n);
    }
  }
  return picture;
}

void write(const std::vector<float>& picture, const Arguments& with) {
  bool good = false;
  if (with.output.ends_with(".pfm")) {
    std::FILE* file = std::fopen(with.output.c_str(), "wb");
    good = file != nullptr && std::fprintf(file, "PF\n%u %u\n-1.0\n", with.width, with.height) > 0;
    for (uint32_t y = with.height; good && y-- > 0;)  // from the bottom
      good = std::fwrite(&picture[size_t{3} * y * with.width], 12, with.width, file) == with.width;
    if (file != nullptr) good &= std::fclose(file) == 0;
  } else {
    std::vector<unsigned char> bytes(picture.size());
    for (size_t i = 0; i < bytes.size(); ++i)
      bytes[i] = static_cast<unsigned char>(std::clamp(picture[i], 0.0F, 1.0F) * 255 + 0.5F);
    good = stbi_write_png(with.output.c_str(), static_cast<int>(with.width), static_cast<int>(with.height), 3,
                          bytes.data(), static_cast<int>(3 * with.width)) != 0;
  }
  if (!good) throw std::runtime_error(with.output + " cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    Arguments with = argumentsOf(argc, argv);
    const bool folder = std::filesystem::is_directory(with.environment);
    with.settings.environment =
        folder ? with.environment
               : renderer::environmentOf(with.environment, with.scene, with.settings.cache);
    renderer::Device device;
    renderer::Renderer renderer(device, with.scene, with.settings);
    std::vector<float> samples = renderer.draw(with.seconds);
    while (with.last && renderer.hadFallbacks()) samples = renderer.draw(with.seconds);
    write(resolved(samples, with, with.output.ends_with(".pfm")), with);
    std::printf("%s: %s\n", with.output.c_str(), renderer.summary().c_str());
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "renderer: %s\n", error.what());
    return 1;
  }
}
