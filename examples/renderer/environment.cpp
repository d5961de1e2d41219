#include "environment.h"

#include "renderer.h"

#include <lacquer/tools.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace renderer {

namespace fs = std::filesystem;

namespace {

std::string bytesOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path.string() + " cannot be read");
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Levels of a KTX2 file without supercompression (KTX 2.0, "Level Index").
Image readKtx2(Device& device, const fs::path& path) {
  const std::string bytes = bytesOf(path);
  const auto number = [&](size_t at) {
    uint64_t value = 0;
    if (at + 8 > bytes.size()) throw std::runtime_error(path.string() + " is too short");
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  };
  const auto word = [&](size_t at) { return static_cast<uint32_t>(number(at)); };
  if (bytes.compare(1, 6, "KTX 20") != 0 || word(44) != 0)
    throw std::runtime_error(path.string() + " is none of ours");
  const uint32_t faces = word(36), count = word(40);
  const Image image = device.image(
      static_cast<VkFormat>(word(12)), word(20), word(24),
      VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT, count,
      faces, faces == 6 ? VK_IMAGE_VIEW_TYPE_CUBE : VK_IMAGE_VIEW_TYPE_2D);
  std::vector<std::vector<unsigned char>> levels;
  for (uint32_t level = 0; level < count; ++level) {
    const uint64_t from = number(80 + 24 * size_t{level}), size = number(88 + 24 * size_t{level});
    if (from > bytes.size() || size > bytes.size() - from)
      throw std::runtime_error(path.string() + " is too short");
    levels.emplace_back(bytes.begin() + static_cast<ptrdiff_t>(from),
                        bytes.begin() + static_cast<ptrdiff_t>(from + size));
  }
  device.fill(image, levels);
  return image;
}

/// Radiance HDR, without run lengths: a pale sky, a dim floor, and two windows.
void writeStudio(const fs::path& path) {
  constexpr int kWidth = 512, kHeight = 256;
  std::ofstream file(path, std::ios::binary);
  file << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " << kHeight << " +X " << kWidth << "\n";
  for (int y = 0; y < kHeight; ++y) {
    const float up = std::cos((static_cast<float>(y) + 0.5F) / kHeight * 3.14159265F);
    const float sky = 0.5F + 0.5F * std::tanh(6 * up);  // the horizon is no edge
    for (int x = 0; x < kWidth; ++x) {
      const bool window = y / 4 > 12 && y / 4 < 24 && x / 4 % 64 > 40 && x / 4 % 64 < 52;
      float color[3];
      for (int c = 0; c < 3; ++c) {
        const float floor = (c == 0 ? 0.36F : c == 1 ? 0.33F : 0.30F) * (1 + 0.5F * std::min(up, 0.0F));
        const float air = (c == 0   ? 0.86F
                           : c == 1 ? 0.89F
                                    : 0.93F) -
                          (c == 0   ? 0.40F
                           : c == 1 ? 0.28F
                                    : 0.12F) *
                              std::max(up, 0.0F);
        color[c] = window ? (c == 2 ? 4.6F : 5.0F) : floor + (air - floor) * sky;
      }
      int exponent = 0;
      const float most = std::max({color[0], color[1], color[2]});
      const float scale = std::frexp(most, &exponent) * 256 / most;
      for (const float channel : color)
        file.put(static_cast<char>(static_cast<unsigned char>(channel * scale)));
      file.put(static_cast<char>(static_cast<unsigned char>(exponent + 128)));
    }
  }
}

}  // namespace

Environment readEnvironment(Device& device, const std::string& folder) {
  const nlohmann::json json =
      nlohmann::json::parse(bytesOf(fs::path(folder) / "environment.json"), nullptr, false);
  if (!json.is_object() || !json.contains("textures"))
    throw std::runtime_error(folder + " is no environment");
  Environment made;
  made.max_lod = json.value("environment_max_lod", 0.0F);
  if (json.contains("box")) {
    using Corner = std::array<float, 3>;
    made.box = {json["box"].at("min").get<Corner>(), json["box"].at("max").get<Corner>()};
  }
  for (const auto& [name, texture] : json["textures"].items())
    made.maps[name] = readKtx2(device, fs::path(folder) / texture.at("file").get<std::string>());
  return made;
}

std::string environmentOf(const std::string& picture, const std::string& scene, const std::string& cache) {
  fs::create_directories(cache);
  lacquer::Environment how;
  how.size = 128;
  how.samples = 256;
  lacquer::Messages messages;
  if (picture.empty()) {
    // It may name files that change while it does not: it is filtered anew.
    how.output = (fs::path(cache) / "environment-scene").string();
    if (lacquer::writeEnvironment(how, scene, {}, messages)) return how.output;
    if (!messages.empty() && messages.back().code != "no-environment") complain(messages.back().text);
    messages.clear();
  }
  uint64_t hash = 14695981039346656037U;  // FNV-1a: tells pictures apart that nobody made to collide
  if (!picture.empty()) {
    for (const char c : bytesOf(picture)) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211U;
  }
  const fs::path folder = fs::path(cache) / ("environment-" + std::to_string(picture.empty() ? 0 : hash));
  if (fs::exists(folder / "environment.json")) return folder.string();
  const fs::path studio = fs::path(cache) / "studio.hdr";
  if (picture.empty()) writeStudio(studio);
  how.output = folder.string();
  if (lacquer::writeEnvironment(how, picture.empty() ? studio.string() : picture, {}, messages))
    return folder.string();
  throw std::runtime_error(messages.empty() ? "the environment cannot be made" : messages.back().text);
}

}  // namespace renderer
