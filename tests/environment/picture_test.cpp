// Pictures of the surroundings as they are read: good ones, and those that want to do harm.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <random>

#include "scene.h"
#include "support/cases.h"

#ifdef LACQUER_OPENEXR
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#endif

namespace lacquer::test {
namespace {

constexpr uint64_t kMost = uint64_t{1} << 26;
const Place kPlace{"sky.hdr", 0, 0, {}};

Result<Panorama> read(const std::string& bytes, Diagnostics& warnings, uint64_t most = kMost) {
  return environment::readPanorama(bytes, most, kPlace, warnings);
}

std::string codeOf(const std::string& bytes, uint64_t most = kMost) {
  Diagnostics warnings;
  const Result<Panorama> panorama = read(bytes, warnings, most);
  return panorama ? "" : panorama.error()[0].code;
}

TEST(Radiance, IsReadFlatAndEncoded) {
  const Panorama panorama = outdoors(64, 3000);
  for (const bool encoded : {false, true}) {
    Diagnostics warnings;
    const Result<Panorama> back = read(radianceFile(panorama, encoded), warnings);
    ASSERT_TRUE(back) << format(back.error()[0]);
    EXPECT_TRUE(warnings.empty());
    ASSERT_EQ(back->width, 64U);
    ASSERT_EQ(back->height, 32U);
    for (size_t i = 0; i < panorama.texels.size(); ++i) {
      const Rgb& c = panorama.texels[i];
      for (size_t k = 0; k < 3; ++k)
        ASSERT_NEAR(back->texels[i][k], c[k], std::max({c[0], c[1], c[2]}) / 127) << i;
    }
  }
}

TEST(Radiance, WrongOnesAreRefused) {
  const std::string good = radianceFile(outdoors(64, 30), true);
  for (const size_t length : {size_t{0}, size_t{5}, size_t{11}, size_t{40}, size_t{80}})
    EXPECT_EQ(codeOf(good.substr(0, length)), "environment-unreadable") << length;
  EXPECT_EQ(codeOf("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n+Y 32 +X 64\n"), "environment-unreadable");
  EXPECT_EQ(codeOf("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 100000 +X 100000\n"), "environment-unreadable");
  EXPECT_EQ(codeOf("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y -5 +X 64\n"), "environment-unreadable");
  EXPECT_EQ(codeOf("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 20000 +X 32000\n"), "image-too-large");
  EXPECT_EQ(codeOf(good, 1000), "image-too-large");
  EXPECT_EQ(codeOf("\x89PNG\r\n\x1a\n"), "environment-unreadable");
}

/// Whatever a byte is changed to: a picture or a message, and never more than the head claims.
TEST(Radiance, DamagedOnesDoNoHarm) {
  const std::string good = radianceFile(outdoors(32, 30), true);
  std::mt19937 random(5);
  size_t accepted = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string bytes = good;
    for (int k = 0; k < 3; ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
    if (i % 4 == 0) bytes.resize(random() % bytes.size());
    Diagnostics warnings;
    const Result<Panorama> panorama = read(bytes, warnings, 4096);
    if (!panorama) continue;
    ++accepted;
    for (const Rgb& c : panorama->texels) {
      for (const float x : c) ASSERT_TRUE(x >= 0 && x <= 65408);
    }
  }
  EXPECT_GT(accepted, 300U);
}

TEST(Picture, OfAnotherShapeIsStretchedWithAWord) {
  Panorama square = constant(32, {1, 1, 1});
  square.width = 16;
  square.height = 32;
  Diagnostics warnings;
  ASSERT_TRUE(read(radianceFile(square, true), warnings));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].code, "environment-shape");
}

#ifdef LACQUER_OPENEXR

std::string exrFile(const Panorama& panorama, bool grey, Imf::Compression compression, int left = 0) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "lacquer_sky.exr";
  const auto width = static_cast<int>(panorama.width), height = static_cast<int>(panorama.height);
  const Imath::Box2i window({left, left}, {left + width - 1, left + height - 1});
  Imf::Header header(window, window, 1, {0, 0}, 1, Imf::INCREASING_Y, compression);
  Imf::FrameBuffer frame;
  const char* names[] = {"R", "G", "B"};
  auto* base = reinterpret_cast<char*>(const_cast<Rgb*>(panorama.texels.data()));
  for (size_t i = 0; i < (grey ? 1U : 3U); ++i) {
    const char* name = grey ? "Y" : names[i];
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    frame.insert(
        name, Imf::Slice::Make(Imf::FLOAT, base + 4 * i, window, sizeof(Rgb), sizeof(Rgb) * panorama.width));
  }
  {
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(height);
  }
  std::string bytes = readFile(path);
  std::filesystem::remove(path);
  return bytes;
}

TEST(OpenExr, IsReadAsItIs) {
  const Panorama panorama = outdoors(64, 3000);
  for (const Imf::Compression compression :
       {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
    for (const int left : {0, -17}) {
      Diagnostics warnings;
      const Result<Panorama> back = read(exrFile(panorama, false, compression, left), warnings);
      ASSERT_TRUE(back) << format(back.error()[0]);
      EXPECT_TRUE(warnings.empty());
      EXPECT_EQ(back->width, 64U);
      EXPECT_EQ(back->texels, panorama.texels);
    }
  }
  Diagnostics warnings;
  const Result<Panorama> grey = read(exrFile(panorama, true, Imf::ZIP_COMPRESSION), warnings);
  ASSERT_TRUE(grey);
  for (size_t i = 0; i < panorama.texels.size(); ++i) {
    const float x = panorama.texels[i][0];
    ASSERT_EQ(grey->texels[i], (Rgb{x, x, x}));
  }
}

TEST(OpenExr, WhatIsNoRadianceIsReplaced) {
  Panorama panorama = constant(16, {1, 2, 3});
  panorama.texels[5] = {std::nanf(""), -1, std::numeric_limits<float>::infinity()};
  panorama.texels[6] = {1e30F, 65408, 0};
  Diagnostics warnings;
  const Result<Panorama> back = read(exrFile(panorama, false, Imf::NO_COMPRESSION), warnings);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->texels[5], (Rgb{0, 0, 65408}));
  EXPECT_EQ(back->texels[6], (Rgb{65408, 65408, 0}));
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_EQ(warnings[0].message, "2 numbers are negative or none");
  EXPECT_EQ(warnings[1].message, "2 numbers are larger than 65408");
}

TEST(OpenExr, WrongOnesAreRefused) {
  const std::string good = exrFile(outdoors(64, 30), false, Imf::ZIP_COMPRESSION);
  EXPECT_EQ(codeOf(good, 1000), "image-too-large");
  for (const size_t length : {size_t{4}, size_t{9}, size_t{100}, good.size() / 2, good.size() - 1})
    EXPECT_EQ(codeOf(good.substr(0, length)), "environment-unreadable") << length;
  // The data window's far corner, so far that no memory holds it.
  std::string huge = good;
  const size_t window =
      huge.find("dataWindow") + std::strlen("dataWindow") + 1 + std::strlen("box2i") + 1 + 4;
  for (size_t i = 8; i < 16; ++i) huge[window + i] = static_cast<char>(i % 4 == 3 ? 0x3f : 0xff);
  EXPECT_EQ(codeOf(huge), "environment-unreadable");
  std::mt19937 random(5);
  for (int i = 0; i < 2000; ++i) {
    std::string bytes = good;
    const size_t reach = i % 2 == 0 ? 400 : bytes.size();  // half of them in the head
    for (int k = 0; k < 3; ++k) bytes[random() % reach] = static_cast<char>(random());
    Diagnostics warnings;
    const Result<Panorama> panorama = read(bytes, warnings, 4096);
    if (!panorama) continue;
    for (const Rgb& c : panorama->texels) {
      for (const float x : c) ASSERT_TRUE(x >= 0 && x <= 65408);
    }
  }
}

#endif

}  // namespace
}  // namespace lacquer::test
