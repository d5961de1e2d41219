// What `lacquer environment` writes, read back by the formats' specifications; and the preview that uses it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "lacquer.h"
#include "preview/studio.h"
#include "scene.h"
#include "support/answers.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

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

class Files : public testing::Test {
protected:
  Files() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    std::ofstream(picture(), std::ios::binary) << radianceFile(panorama_, true);
  }
  ~Files() override { fs::remove_all(folder_); }

  std::string picture() const { return (folder_ / "sky.hdr").string(); }
  std::string out() const { return (folder_ / "out").string(); }

  json write(bool dds, bool shared) {
    Messages messages;
    const std::string answer =
        jsonOf(writeEnvironment({out(), 64, 256, dds, shared}, picture(), {}, messages));
    EXPECT_TRUE(messages.empty()) << messages[0].text;
    EXPECT_EQ(answer, readFile(out() + "/environment.json"));
    return json::parse(answer);
  }

  fs::path folder_ = fs::path(testing::TempDir()) / "lacquer_environment";
  Panorama panorama_ = outdoors(128, 400);
};

TEST_F(Files, InMemoryAreTheSame) {
  const json written = write(true, true);
  Messages messages;
  const auto made =
      filterEnvironment({"", 64, 256, true, true}, readFile(picture()), "sky.hdr", {}, messages);
  ASSERT_TRUE(made);
  EXPECT_EQ(json::parse(made->description), written);
  ASSERT_EQ(made->files.size(), 5U);
  for (size_t i = 0; i < 5; ++i)
    EXPECT_EQ(made->files[i], readFile(out() + "/" + made->maps.textures[i].file)) << i;
  EXPECT_TRUE(messages.empty());
  EXPECT_FALSE(filterEnvironment({"", 48, 256}, readFile(picture()), "sky.hdr", {}, messages));
  EXPECT_FALSE(filterEnvironment({"", 64, 256}, "no picture", "sky.hdr", {}, messages));
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_EQ(messages[0].code, "out-of-range");
  EXPECT_EQ(messages[1].code, "environment-unreadable");
  EXPECT_EQ(messages[1].file, "sky.hdr");
}

/// The numbers of a texel in a cube's file, from its bytes.
Rgb texelAt(const std::string& bytes, size_t at, bool shared) {
  if (!shared) {
    return {static_cast<float>(halfValue(numberAt(bytes, at, 2))),
            static_cast<float>(halfValue(numberAt(bytes, at + 2, 2))),
            static_cast<float>(halfValue(numberAt(bytes, at + 4, 2)))};
  }
  const uint64_t bits = numberAt(bytes, at);
  const int exponent = static_cast<int>(bits >> 27) - 15 - 9;
  const auto channel = [&](int i) { return static_cast<float>(std::ldexp(bits >> (9 * i) & 511, exponent)); };
  return {channel(0), channel(1), channel(2)};
}

TEST_F(Files, OfBothContainersAndTexelsHoldTheMaps) {
  Diagnostics warnings;
  const Result<Panorama> read =
      environment::readPanorama(radianceFile(panorama_, true), 1 << 20, {}, warnings);
  ASSERT_TRUE(read);
  const environment::MapOptions how{64, 256};
  const environment::Maps maps =
      environment::makeMaps(environment::LightTree(*read, environment::treeSizeOf(*read, how)), how);
  for (const bool dds : {false, true}) {
    for (const bool shared : {false, true}) {
      const json answer = write(dds, shared);
      EXPECT_EQ(answer["environment_max_lod"], 3);
      const json& row = answer["textures"]["environment_specular"];
      EXPECT_EQ(row["file"], dds ? "environment_specular.dds" : "environment_specular.ktx2");
      EXPECT_EQ(row["format"], shared ? "E5B9G9R9_UFLOAT_PACK32" : "R16G16B16A16_SFLOAT");
      const std::string bytes = readFile(out() + "/" + row["file"].get<std::string>());
      const size_t texel = shared ? 4 : 8;
      std::vector<size_t> places;  // of each level's first face
      if (dds) {
        EXPECT_EQ(numberAt(bytes, 112) & 0xFE00U, 0xFE00U);
        EXPECT_EQ(numberAt(bytes, 128), shared ? 67U : 10U);
        EXPECT_EQ(numberAt(bytes, 136), 4U);
        EXPECT_EQ(numberAt(bytes, 28), 4U);  // levels
        size_t at = 148;
        for (size_t i = 0; i < 4; ++i) {
          places.push_back(at);
          at += texel * (64 >> i) * (64 >> i);
        }
        EXPECT_EQ(bytes.size(), 148 + 6 * (at - 148));
      } else {
        EXPECT_EQ(numberAt(bytes, 12), shared ? 123U : 97U);
        EXPECT_EQ(numberAt(bytes, 36), 6U);
        EXPECT_EQ(numberAt(bytes, 40), 4U);
        for (size_t i = 0; i < 4; ++i) {
          places.push_back(numberAt(bytes, 80 + 24 * i, 8));
          EXPECT_EQ(places.back() % texel, 0U);
          EXPECT_EQ(numberAt(bytes, 88 + 24 * i, 8), texel * 6 * (64 >> i) * (64 >> i));
        }
        EXPECT_EQ(bytes.size(), places[0] + texel * 6 * 64 * 64);
        const uint64_t descriptor = numberAt(bytes, 48);
        EXPECT_EQ(numberAt(bytes, descriptor), numberAt(bytes, 52));
        EXPECT_EQ(numberAt(bytes, descriptor + 20, 1), texel);
        if (shared) {
          // Khronos Data Format 1.3: each of three channels has nine bits, and the exponent in common.
          EXPECT_EQ(numberAt(bytes, descriptor + 28 + 16), 27U | 4U << 16 | 0x20U << 24);
          EXPECT_EQ(numberAt(bytes, descriptor + 28 + 32), 9U | 8U << 16 | 1U << 24);
        }
      }
      for (size_t i = 0; i < 4; ++i) {
        const texture::CubeLevel& level = maps.specular[i];
        const size_t face = size_t{level.size} * level.size;
        const size_t faces = dds ? texel * (64 * 64 + 32 * 32 + 16 * 16 + 8 * 8) : texel * face;
        for (size_t k = 0; k < level.texels.size(); ++k) {
          const Rgb got = texelAt(bytes, places[i] + k / face * faces + k % face * texel, shared);
          const Rgb& c = level.texels[k];
          const float largest = std::max({c[0], c[1], c[2]});
          for (size_t n = 0; n < 3; ++n)
            ASSERT_NEAR(got[n], c[n], shared ? largest / 500 : c[n] / 2000 + 1e-7) << i << " " << k;
        }
      }
      for (const char* slot :
           {"environment_charlie", "environment_irradiance", "environment_dfg", "environment_sheen"})
        EXPECT_TRUE(fs::exists(out() + "/" + answer["textures"][slot]["file"].get<std::string>())) << slot;
      EXPECT_EQ(answer["irradiance_harmonics"].size(), 9U);
    }
  }
}

TEST_F(Files, OfADraftAreSmall) {
  Environment draft;
  draft.output = out();
  draft.draft = true;
  Messages messages;
  const auto sizesOf = [&] {
    std::vector<uint32_t> sizes;
    const auto made = writeEnvironment(draft, picture(), {}, messages);
    EXPECT_TRUE(made);
    if (!made) return sizes;
    for (const EnvironmentTexture& texture : made->textures) sizes.push_back(texture.size);
    return sizes;
  };
  EXPECT_EQ(sizesOf(), (std::vector<uint32_t>{64, 16, 32, 32, 32}));
  const std::string capped = readFile(out() + "/environment_specular.ktx2");
  draft.samples = 64;
  draft.size = 64;
  sizesOf();
  EXPECT_EQ(readFile(out() + "/environment_specular.ktx2"), capped);
  draft.size = 32;
  EXPECT_EQ(sizesOf(), (std::vector<uint32_t>{32, 8, 32, 32, 32}));
  EXPECT_TRUE(messages.empty());
}

TEST_F(Files, AreTheSameWithAnyNumberOfThreads) {
  Messages messages;
  Options one;
  one.jobs = 1;
  writeEnvironment({out(), 32, 64}, picture(), one, messages);
  const std::string bytes = readFile(out() + "/environment_specular.ktx2");
  one.jobs = 3;
  writeEnvironment({out(), 32, 64}, picture(), one, messages);
  EXPECT_EQ(readFile(out() + "/environment_specular.ktx2"), bytes);
  EXPECT_TRUE(messages.empty());
}

TEST_F(Files, WrongArgumentsAreToldBeforeAnythingIsWritten) {
  const auto codeOf = [&](const Environment& environment, const std::string& path,
                          const Options& options = {}) {
    Messages messages;
    EXPECT_FALSE(writeEnvironment(environment, path, options, messages));
    return messages.empty() ? "" : messages[0].code;
  };
  EXPECT_EQ(codeOf({out(), 100, 256}, picture()), "out-of-range");
  EXPECT_EQ(codeOf({out(), 2048, 256}, picture()), "out-of-range");
  EXPECT_EQ(codeOf({out(), 64, 1}, picture()), "out-of-range");
  EXPECT_EQ(codeOf({"", 64, 256}, picture()), "no-path");
  EXPECT_EQ(codeOf({out(), 64, 256}, picture() + ".not"), "file-unreadable");
  Options little;
  little.limits = {"image=100"};
  EXPECT_EQ(codeOf({out(), 64, 256}, picture(), little), "image-too-large");
  EXPECT_FALSE(fs::exists(out()));
}

/// The picture is the only light: what it lights is as bright as the picture, and not as the studio.
TEST_F(Files, ThePreviewIsLitByThem) {
  const std::string white = (folder_ / "white.hdr").string();
  std::ofstream(white, std::ios::binary) << radianceFile(constant(64, {0.5F, 0.25F, 0.125F}), true);
  Diagnostics warnings;
  const Result<Panorama> panorama = environment::readPanorama(
      radianceFile(constant(64, {0.5F, 0.25F, 0.125F}), true), 1 << 20, {}, warnings);
  const environment::MapOptions how{32, 64};
  const preview::Studio studio(environment::makeMaps(environment::LightTree(*panorama, 32), how));
  EXPECT_FALSE(studio.hasLamps());
  for (const double roughness : {0.0, 0.3, 1.0}) {
    for (const preview::Vec3& color :
         {studio.radiance({0.6, 0, 0.8}, roughness), studio.fibreRadiance({0, 1, 0}, roughness),
          studio.irradiance({0, 0, 1})}) {
      EXPECT_NEAR(color[0], 0.5, 1e-3);
      EXPECT_NEAR(color[1], 0.25, 1e-3);
      EXPECT_NEAR(color[2], 0.125, 1e-3);
    }
  }
  Messages messages;
  Preview preview;
  preview.output = (folder_ / "ball.png").string();
  preview.size = 16;
  const std::string file = (sourceFolder() / "examples/coat.gltf").string();
  ASSERT_TRUE(drawPreview(preview, {file}, {}, {}, messages));
  const std::string studio_bytes = readFile(preview.output);
  preview.environment = white;
  ASSERT_TRUE(drawPreview(preview, {file}, {}, {}, messages)) << messages[0].text;
  EXPECT_NE(readFile(preview.output), studio_bytes);
  preview.environment = file;
  EXPECT_FALSE(drawPreview(preview, {file}, {}, {}, messages));
  EXPECT_EQ(messages.back().code, "no-environment");
  preview.environment = preview.output;
  preview.output += ".other.png";
  EXPECT_FALSE(drawPreview(preview, {file}, {}, {}, messages));
  EXPECT_EQ(messages.back().code, "environment-unreadable");
}

}  // namespace
}  // namespace lacquer::test
