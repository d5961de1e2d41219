#include "eval/dfg.h"

#include <array>
#include <cmath>
#include <string>

#include "eval/sheen.h"
#include "shader/messages.h"
#include "shader/options.h"
#include "support/file.h"

namespace lacquer {

namespace {

void append(std::string& bytes, uint32_t value, int count = 4) {
  for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFFU);
}

/// The header of a DirectDraw Surface with one level of DXGI_FORMAT_R16G16_UNORM (Microsoft, "Programming
/// Guide for DDS").
std::string ddsHeader(uint32_t size) {
  constexpr uint32_t kCapsHeightWidthPitchFormat = 0x100F;
  constexpr uint32_t kFourCc = 4;
  constexpr uint32_t kDx10 = 0x30315844;
  constexpr uint32_t kTexture = 0x1000;
  constexpr uint32_t kR16G16Unorm = 35;
  constexpr uint32_t kTexture2D = 3;
  std::string bytes = "DDS ";
  for (const uint32_t word :
       {uint32_t{124}, kCapsHeightWidthPitchFormat, size, size, size * 4, uint32_t{0}, uint32_t{1}})
    append(bytes, word);
  for (int i = 0; i < 11; ++i) append(bytes, 0);
  for (const uint32_t word :
       {uint32_t{32}, kFourCc, kDx10, uint32_t{0}, uint32_t{0}, uint32_t{0}, uint32_t{0}, uint32_t{0}})
    append(bytes, word);
  for (const uint32_t word : {kTexture, uint32_t{0}, uint32_t{0}, uint32_t{0}, uint32_t{0}})
    append(bytes, word);
  for (const uint32_t word : {kR16G16Unorm, kTexture2D, uint32_t{0}, uint32_t{1}, uint32_t{0}})
    append(bytes, word);
  return bytes;
}

bool hasSize(uint32_t size, Messages& messages) {
  constexpr uint32_t kLeastSize = 2;
  constexpr uint32_t kMostSize = 1024;
  const Result<void> good = inRange("the table's size", size, kLeastSize, kMostSize, "texels");
  if (!good) report(good.error(), {}, messages);
  return good.has_value();
}

bool write(const std::string& path, uint32_t size, std::vector<float> (*make)(uint32_t), Messages& messages) {
  if (const Result<void> named = hasPath("the table's file", path); !named) {
    report(named.error(), {}, messages);
    return false;
  }
  if (!hasSize(size, messages)) return false;
  std::string bytes = ddsHeader(size);
  for (const float x : make(size)) append(bytes, static_cast<uint32_t>(std::lround(x * 65535.0F)), 2);
  const Result<bool> written = writeFile(path, bytes);
  if (!written) report(written.error(), {}, messages);
  return written.has_value();
}

}  // namespace

std::vector<float> environmentDfg(uint32_t size, Messages& messages) {
  return hasSize(size, messages) ? eval::environmentDfgTable(size) : std::vector<float>();
}

bool writeEnvironmentDfg(const std::string& path, uint32_t size, Messages& messages) {
  return write(path, size, eval::environmentDfgTable, messages);
}

std::vector<float> environmentSheen(uint32_t size, Messages& messages) {
  return hasSize(size, messages) ? eval::environmentSheenTable(size) : std::vector<float>();
}

bool writeEnvironmentSheen(const std::string& path, uint32_t size, Messages& messages) {
  return write(path, size, eval::environmentSheenTable, messages);
}

}  // namespace lacquer
