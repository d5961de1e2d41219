// The tables' files, read back: DDS and KTX2 by their specifications' offsets, PNG by stb's decoder.
#include "texture/table.h"

#include <gtest/gtest.h>
#include <stb/stb_image.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "lacquer.h"
#include "support/cases.h"
#include "texture/container.h"

namespace lacquer::test {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t kSize = 24;

uint64_t numberAt(const std::string& bytes, size_t at, int count = 4) {
  uint64_t number = 0;
  for (int i = 0; i < count; ++i) number |= uint64_t{static_cast<unsigned char>(bytes.at(at + i))} << (8 * i);
  return number;
}

double halfValue(uint64_t bits) {
  const auto exponent = static_cast<int>(bits >> 10 & 31);
  const auto fraction = static_cast<double>(bits & 1023);
  return exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
}

/// What the library writes, and the numbers that it should hold.
struct Written {
  std::string bytes;
  std::vector<float> values;
};

Written written(const char* name, bool sheen) {
  const fs::path folder = fs::path(testing::TempDir()) / "lacquer_table";
  const std::string path = (folder / name).string();
  Messages messages;
  Written result;
  EXPECT_TRUE(sheen ? writeEnvironmentSheen(path, kSize, messages)
                    : writeEnvironmentDfg(path, kSize, messages));
  EXPECT_TRUE(messages.empty());
  result.values = sheen ? environmentSheen(kSize, messages) : environmentDfg(kSize, messages);
  result.bytes = readFile(path);
  fs::remove_all(folder);
  return result;
}

}  // namespace

TEST(Table, DdsIsOf16BitUnorm) {
  const Written file = written("dfg.dds", false);
  EXPECT_EQ(file.bytes.substr(0, 4), "DDS ");
  EXPECT_EQ(numberAt(file.bytes, 12), kSize);
  EXPECT_EQ(numberAt(file.bytes, 16), kSize);
  EXPECT_EQ(numberAt(file.bytes, 128), 35U);
  ASSERT_EQ(file.bytes.size(), 148 + file.values.size() * 2);
  for (size_t i = 0; i < file.values.size(); ++i)
    EXPECT_NEAR(static_cast<double>(numberAt(file.bytes, 148 + 2 * i, 2)) / 65535, file.values[i],
                0.51 / 65535);
}

/// Offsets are those of the KTX 2.0 specification, sections 3 and 5.
TEST(Table, Ktx2IsOfHalves) {
  for (const bool sheen : {false, true}) {
    const Written file = written("table.KTX2", sheen);
    const std::string& b = file.bytes;
    EXPECT_EQ(b.substr(0, 12), "\xABKTX 20\xBB\r\n\x1A\n");
    constexpr uint64_t kR16G16Sfloat = 83;
    const std::vector<uint64_t> head = {kR16G16Sfloat, 2, kSize, kSize, 0, 0, 1, 1, 0};
    for (size_t i = 0; i < head.size(); ++i) EXPECT_EQ(numberAt(b, 12 + 4 * i), head[i]) << i;
    const uint64_t descriptor = numberAt(b, 48);
    EXPECT_EQ(numberAt(b, 52), 60U);
    EXPECT_EQ(numberAt(b, descriptor), 60U);            // total
    EXPECT_EQ(numberAt(b, descriptor + 10, 2), 56U);    // block
    EXPECT_EQ(numberAt(b, descriptor + 12, 1), 1U);     // RGB
    EXPECT_EQ(numberAt(b, descriptor + 14, 1), 1U);     // linear
    EXPECT_EQ(numberAt(b, descriptor + 20, 1), 4U);     // bytes of a texel
    EXPECT_EQ(numberAt(b, descriptor + 28, 2), 0U);     // red from bit 0
    EXPECT_EQ(numberAt(b, descriptor + 44, 2), 16U);    // green from bit 16
    EXPECT_EQ(numberAt(b, descriptor + 47, 1), 0xC1U);  // green, signed float
    const uint64_t keys = numberAt(b, 56);
    EXPECT_EQ(keys, descriptor + 60);
    EXPECT_EQ(b.substr(keys + 4, 18), std::string("KTXorientation\0rd\0", 18));
    const uint64_t level = numberAt(b, 80, 8);
    EXPECT_EQ(level % 4, 0U);
    EXPECT_EQ(level, keys + numberAt(b, 60));
    EXPECT_EQ(numberAt(b, 88, 8), file.values.size() * 2);
    EXPECT_EQ(numberAt(b, 96, 8), file.values.size() * 2);
    ASSERT_EQ(b.size(), level + file.values.size() * 2);
    for (size_t i = 0; i < file.values.size(); ++i) {
      const double x = file.values[i];
      EXPECT_NEAR(halfValue(numberAt(b, level + 2 * i, 2)), x, std::max(x / 2048, std::ldexp(1, -25))) << i;
    }
  }
}

TEST(Table, PngHasSixteenBits) {
  const Written file = written("dfg.png", false);
  const auto* bytes = reinterpret_cast<const unsigned char*>(file.bytes.data());
  const auto length = static_cast<int>(file.bytes.size());
  EXPECT_TRUE(stbi_is_16_bit_from_memory(bytes, length));
  int width = 0;
  int height = 0;
  int channels = 0;
  uint16_t* texels = stbi_load_16_from_memory(bytes, length, &width, &height, &channels, 0);
  ASSERT_NE(texels, nullptr) << stbi_failure_reason();
  EXPECT_EQ(width, static_cast<int>(kSize));
  EXPECT_EQ(height, static_cast<int>(kSize));
  ASSERT_EQ(channels, 3);
  for (size_t i = 0; i < file.values.size(); ++i)
    EXPECT_NEAR(texels[i / 2 * 3 + i % 2] / 65535.0, file.values[i], 0.51 / 65535) << i;
  stbi_image_free(texels);
}

TEST(Table, EveryHalfIsItself) {
  for (uint32_t bits = 0; bits <= 0x7BFF; ++bits)
    ASSERT_EQ(texture::halfBits(static_cast<float>(halfValue(bits))), bits);
  // Between two of them: the even one; a little more: the upper one.
  EXPECT_EQ(texture::halfBits(1 + -std::ldexp(1.0F, -12)), 0x3C00);
  EXPECT_EQ(texture::halfBits(0.5F + std::ldexp(1.0F, -12)), 0x3800);
  EXPECT_EQ(texture::halfBits(0.5F + std::ldexp(1.25F, -12)), 0x3801);
  EXPECT_EQ(texture::halfBits(std::ldexp(1.5F, -24)), 2);
}

TEST(Table, TheEndingSaysWhichItIs) {
  Messages messages;
  EXPECT_FALSE(writeEnvironmentDfg("dfg.tga", kSize, messages));
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0].code, "table-format");
  EXPECT_EQ(messages[0].help, "it ends in .dds, .ktx2 or .png");
  EXPECT_FALSE(fs::exists("dfg.tga"));
}

}  // namespace lacquer::test
