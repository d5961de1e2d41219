// Pictures of the surroundings as they are read: good ones, and those that want to do harm.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "scene.h"
#include "support/cases.h"

#ifdef LACQUER_OPENEXR
#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <ImfTiledOutputFile.h>
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

std::string messageOf(const std::string& bytes) {
  Diagnostics warnings;
  const Result<Panorama> panorama = read(bytes, warnings);
  return panorama ? "" : panorama.error()[0].message;
}

constexpr const char* kRadianceHead = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n";
/// One row of 127 pixels, a run for each plane.
constexpr std::string_view kRun("\2\2\0\x7f\xff\x80\xff\x80\xff\x80\xff\x80", 12);

/// A line of a NUL is empty to readers with C's strings, and none of the file's empty lines: behind it they
/// would find other pixels, with runs of none up to the end, and for ever.
TEST(Radiance, ItsHeadHasOneEnd) {
  const std::string size = "-Y 1 +X 127\n", good = "\n" + size + std::string(kRun);
  EXPECT_EQ(codeOf(kRadianceHead + good), "");
  const std::string nul("\0\n", 2),
      damaged = "the picture's head is damaged, or its rows do not run from the upper left";
  EXPECT_EQ(messageOf(kRadianceHead + nul + good), damaged);
  EXPECT_EQ(messageOf(kRadianceHead + nul + size + "zz\n" + good), damaged);
  EXPECT_EQ(messageOf(kRadianceHead + nul + size + std::string("\2\2\0\x7f\x7f\n", 6) + good), damaged);
  // As 32 bits it would be 127.
  EXPECT_EQ(messageOf(kRadianceHead + std::string("\n-Y 1 +X 4294967423\n") + std::string(kRun)),
            "the picture claims 4294967423 x 1 pixels");
  // A line may be as long as it likes.
  EXPECT_EQ(codeOf(kRadianceHead + std::string(3000, 'a') + "\n" + good), "");
}

/// Of every length but the whole one, and whether the rows have the width that they claim.
TEST(Radiance, ItsRowsAreWhole) {
  const std::string damaged = "the picture is damaged", head = kRadianceHead + std::string("\n-Y 2 +X ");
  const std::string run(kRun), encoded = head + "127\n" + run;
  for (size_t i = 0; i < run.size(); ++i) EXPECT_EQ(messageOf(encoded + run.substr(0, i)), damaged) << i;
  EXPECT_EQ(messageOf(encoded + run), "");
  for (size_t i = 0; i < 32; ++i) EXPECT_EQ(messageOf(head + "4\n" + std::string(i, 'a')), damaged) << i;
  EXPECT_EQ(messageOf(head + "4\n" + std::string(32, 'a')), "");
  EXPECT_EQ(messageOf(head + "128\n" + run + run + run), damaged);
  // So wide a row is never encoded, whatever it begins with.
  EXPECT_EQ(messageOf(head + "32768\n" + run + std::string(1000, '\1')), damaged);
  const std::string none = std::string(kRun.substr(0, 4)) + std::string(1000, '\0');
  EXPECT_EQ(messageOf(encoded + none), damaged);
  EXPECT_EQ(messageOf(kRadianceHead + std::string("\n-Y 8192 +X 8192\n") + "\2\2 "), damaged);
}

/// By the format's definition: (m / 256) * 2^(e - 128), without the half that some readers add.
TEST(Radiance, ItsNumbersAreExact) {
  const std::string file = kRadianceHead + std::string("\n-Y 1 +X 3\n") +
                           std::string("\x80\x40\x01\x81\xff\xff\xff\0\x01\x80\0\x01", 12);
  const Result<Panorama> panorama = environment::readRadiance(file, kMost, kPlace);
  ASSERT_TRUE(panorama);
  EXPECT_EQ(panorama->texels[0], (Rgb{1, 0.5F, 0x1p-7F}));
  EXPECT_EQ(panorama->texels[1], (Rgb{0, 0, 0}));
  EXPECT_EQ(panorama->texels[2], (Rgb{0x1p-135F, 0x1p-128F, 0}));
}

/// Whatever a byte is changed to: a picture or a message, and never more than the head claims.
TEST(Radiance, DamagedOnesDoNoHarm) {
  const std::string good = radianceFile(outdoors(32, 30), true);
  std::mt19937 random(5);
  size_t accepted = 0;
  for (int i = 0; i < 4000; ++i) {
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

const std::filesystem::path kExrPath = std::filesystem::path(testing::TempDir()) / "lacquer_sky.exr";

/// The file's bytes, which goes.
std::string takeExr() {
  std::string bytes = readFile(kExrPath);
  std::filesystem::remove(kExrPath);
  return bytes;
}

/// With channels beside the colours, `more` of them, and a note.
std::string exrFile(const Panorama& panorama, bool grey, Imf::Compression compression, int left = 0,
                    int more = 0, const std::string& note = {}) {
  const auto width = static_cast<int>(panorama.width), height = static_cast<int>(panorama.height);
  const Imath::Box2i window({left, left}, {left + width - 1, left + height - 1});
  Imf::Header header(window, window, 1, {0, 0}, 1, Imf::INCREASING_Y, compression);
  if (!note.empty()) header.insert("note", Imf::StringAttribute(note));
  Imf::FrameBuffer frame;
  auto* base = reinterpret_cast<char*>(const_cast<Rgb*>(panorama.texels.data()));
  const auto insert = [&](const std::string& name, size_t i) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    frame.insert(
        name, Imf::Slice::Make(Imf::FLOAT, base + 4 * i, window, sizeof(Rgb), sizeof(Rgb) * panorama.width));
  };
  const char* names[] = {"R", "G", "B"};
  for (size_t i = 0; i < (grey ? 1U : 3U); ++i) insert(grey ? "Y" : names[i], i);
  for (int i = 0; i < more; ++i) insert("more" + std::to_string(i), 0);
  {
    Imf::OutputFile file(kExrPath.c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(height);
  }
  return takeExr();
}

std::string numberBytes(uint32_t number) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(number >> (8 * i) & 255);
  return bytes;
}

/// An attribute that claims `size` bytes.
std::string attribute(const std::string& name, const std::string& type, uint32_t size,
                      const std::string& value = {}) {
  return name + '\0' + type + '\0' + numberBytes(size) + value;
}

constexpr const char* kHeadDamaged = "the picture's head is damaged";

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

TEST(OpenExr, OfAnAttributeNoMoreIsTakenThanThereIs) {
  const std::string good = exrFile(constant(16, {1, 2, 3}), false, Imf::ZIP_COMPRESSION);
  const auto with = [&](const std::string& attribute) {
    return messageOf(good.substr(0, 8) + attribute + good.substr(8));
  };
  for (const char* type : {"string", "floatvector", "stringvector", "preview", "unheard"}) {
    for (const uint32_t size : {0x7ffffff0U, 0x80000000U, 0xffffffffU})
      EXPECT_EQ(with(attribute("note", type, size)), kHeadDamaged) << type << " " << size;
  }
  EXPECT_EQ(with(attribute(std::string(256, 'n'), "string", 1, "a")), kHeadDamaged);
  EXPECT_EQ(with(attribute("note", std::string(256, 't'), 1, "a")), kHeadDamaged);
  // Of a type's own size, and none other.
  EXPECT_EQ(with(attribute("lineOrder", "lineOrder", 2, std::string(2, '\0'))), kHeadDamaged);
  EXPECT_EQ(with(attribute("channels", "chlist", 2, std::string(2, '\0'))), kHeadDamaged);
  EXPECT_EQ(with(attribute("channels", "chlist", 1, "a")), kHeadDamaged);
}

/// The library takes eight bytes of a double that claims more, and what follows for the next attribute.
TEST(OpenExr, InAnAttributeNoOtherHides) {
  const Panorama panorama = constant(16, {1, 2, 3});
  const std::string hidden = std::string(8, '\0') + attribute("hidden", "string", 0x7ffffff0U) + "rest";
  std::string bytes = exrFile(panorama, false, Imf::ZIP_COMPRESSION, 0, 0, hidden);
  const size_t type = bytes.find(std::string("note\0string", 11)) + 5;
  bytes.replace(type, 6, "double");
  Diagnostics warnings;
  const Result<Panorama> back = read(bytes, warnings);
  ASSERT_TRUE(back) << format(back.error()[0]);
  EXPECT_EQ(back->texels, panorama.texels);
}

TEST(OpenExr, HasAFewChannels) {
  const Panorama panorama = constant(16, {1, 2, 3});
  EXPECT_EQ(messageOf(exrFile(panorama, false, Imf::ZIP_COMPRESSION, 0, 13)), "");
  const std::string many = "the picture has more than 16 channels";
  EXPECT_EQ(messageOf(exrFile(panorama, false, Imf::ZIP_COMPRESSION, 0, 14)), many);
  // A second list is joined to the first.
  std::string list;
  for (char i = 'a'; i < 'a' + 14; ++i)
    list += std::string{i, 0} + numberBytes(2) + std::string(4, '\0') + numberBytes(1) + numberBytes(1);
  list += '\0';
  const std::string good = exrFile(panorama, false, Imf::ZIP_COMPRESSION);
  const std::string more = attribute("channels", "chlist", static_cast<uint32_t>(list.size()), list);
  EXPECT_EQ(messageOf(good.substr(0, 8) + more + good.substr(8)), many);
}

/// Nothing of what is not there is unpacked: a tile's place in the file is all that is said.
TEST(OpenExr, HasNoTilesThatAreLargerThanMostPictures) {
  for (const int more : {1, 2}) {
    Imf::Header header(4096, 4096);
    header.setTileDescription(Imf::TileDescription(4096, 4096));
    for (const char* name : {"R", "G", "B"}) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    for (int i = 0; i < more; ++i)
      header.channels().insert("more" + std::to_string(i), Imf::Channel(Imf::FLOAT));
    { const Imf::TiledOutputFile file(kExrPath.c_str(), header); }
    const std::string message = messageOf(takeExr());
    EXPECT_EQ(message == "the picture's tiles are too large", more > 1) << message;
    EXPECT_NE(message, "");
  }
}

TEST(OpenExr, OfSeveralPartsTheFirstIsRead) {
  const Panorama panorama = constant(16, {1, 2, 3});
  std::vector<Imf::Header> headers;
  for (const char* name : {"sky", "other"}) {
    Imf::Header& header = headers.emplace_back(16, 8);
    header.setName(name);
    header.setType(Imf::SCANLINEIMAGE);
    for (const char* channel : {"R", "G", "B"}) header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
  }
  {
    Imf::MultiPartOutputFile file(kExrPath.c_str(), headers.data(), 2);
    auto* base = reinterpret_cast<char*>(const_cast<Rgb*>(panorama.texels.data()));
    for (int part = 0; part < 2; ++part) {
      Imf::OutputPart output(file, part);
      Imf::FrameBuffer frame;
      for (size_t i = 0; i < 3; ++i)
        frame.insert(std::string(1, "RGB"[i]),
                     Imf::Slice(Imf::FLOAT, base + 4 * i, sizeof(Rgb), sizeof(Rgb) * 16));
      output.setFrameBuffer(frame);
      output.writePixels(8);
    }
  }
  const std::string good = takeExr();
  Diagnostics warnings;
  const Result<Panorama> back = read(good, warnings);
  ASSERT_TRUE(back) << format(back.error()[0]);
  EXPECT_EQ(back->texels, panorama.texels);
  // In the head of another part, too, nothing claims what is not there.
  std::string damaged = good;
  const size_t name = damaged.rfind(std::string("name\0string", 11));
  damaged.replace(name + 12, 4, numberBytes(0x7ffffff0U));
  EXPECT_EQ(messageOf(damaged), kHeadDamaged);
}

/// Pixels of a deep picture, with `samples` each, of which the nearest hides the others.
std::string deepFile(unsigned samples) {
  constexpr int kSide = 64;
  Imf::Header header(kSide, kSide);
  header.setType(Imf::DEEPSCANLINE);
  header.compression() = Imf::RLE_COMPRESSION;
  std::vector<unsigned> counts(size_t{kSide} * kSide, samples);
  std::vector<half> ones(samples, half(1));
  std::vector<half*> pixels(counts.size(), ones.data());
  Imf::DeepFrameBuffer frame;
  frame.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()), sizeof(unsigned),
                                          sizeof(unsigned) * kSide));
  for (const char* name : {"R", "G", "B", "A", "Z"}) {
    header.channels().insert(name, Imf::Channel(Imf::HALF));
    frame.insert(name, Imf::DeepSlice(Imf::HALF, reinterpret_cast<char*>(pixels.data()), sizeof(half*),
                                      sizeof(half*) * kSide, sizeof(half)));
  }
  {
    Imf::DeepScanLineOutputFile file(kExrPath.c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(kSide);
  }
  return takeExr();
}

TEST(OpenExr, IsNotDeeperThanMemory) {
  EXPECT_EQ(messageOf(deepFile(2)), "");
  EXPECT_EQ(codeOf(deepFile((1U << 25) / 4096 + 1)), "environment-unreadable");
}

#endif

}  // namespace
}  // namespace lacquer::test
