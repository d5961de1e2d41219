// Cube maps in KTX2 files, and the environments of glTF's scenes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "environment/cube.h"
#include "environment/surroundings.h"
#include "lacquer.h"
#include "scene.h"
#include "support/base64.h"

namespace lacquer::test {
namespace light_test {

using environment::Surroundings;
using nlohmann::json;
using texture::CubeLevel;

const Place kPlace{"x", 0, 0, {}};
constexpr uint64_t kMost = 1 << 20;

std::string bytesOf(uint64_t value, size_t count) {
  std::string made;
  for (size_t i = 0; i < count; ++i) made += static_cast<char>((value >> (8 * i)) & 0xFF);
  return made;
}

/// KTX File Format 2.0: a head, one level's index, and its bytes.
std::string ktx2(uint32_t format, uint32_t size, const std::string& data, uint32_t layers = 0,
                 uint32_t faces = 6, uint32_t scheme = 0) {
  std::string file("\xABKTX 20\xBB\r\n\x1A\n", 12);
  for (const uint32_t field : {format, 1U, size, size, 0U, layers, faces, 1U, scheme, 0U, 0U, 0U, 0U})
    file += bytesOf(field, 4);
  file += bytesOf(0, 16);  // of data for supercompression
  file += bytesOf(file.size() + 24, 8) + bytesOf(data.size(), 8) + bytesOf(data.size(), 8);
  return file + data;
}

/// Light that grows along each axis, by another colour.
Rgb along(const Vec3& d) {
  return {static_cast<float>(2 + d[0]), static_cast<float>(3 - d[1]), static_cast<float>(4 + 2 * d[2])};
}

CubeLevel cubeOf(uint32_t size) {
  CubeLevel cube{size, {}};
  for (uint32_t face = 0; face < 6; ++face) {
    for (uint32_t y = 0; y < size; ++y) {
      for (uint32_t x = 0; x < size; ++x)
        cube.texels.push_back(along(environment::texelDirection(face, x, y, size)));
    }
  }
  return cube;
}

std::string floatsOf(const CubeLevel& cube) {
  std::string data;
  for (const Rgb& color : cube.texels) data.append(reinterpret_cast<const char*>(color.data()), sizeof color);
  return data;
}

std::string said(const Diagnostics& all) {
  std::string text;
  for (const Diagnostic& one : all) text.append(text.empty() ? "" : "\n").append(format(one));
  return text;
}

TEST(CubeMaps, EveryFormatIsItsNumbers) {
  // One and a half, a quarter and 1 where floats hold them; a third of the range else.
  struct Row {
    uint32_t format;
    std::string texel;
    std::array<double, 3> values;
  };
  const std::string floats = bytesOf(0x3FC00000, 4) + bytesOf(0x3E800000, 4) + bytesOf(0x3F800000, 4);
  const std::string halves = bytesOf(0x3E00, 2) + bytesOf(0x3400, 2) + bytesOf(0x3C00, 2);
  const std::string shorts = bytesOf(21845, 2) + bytesOf(0, 2) + bytesOf(65535, 2);
  const std::string bytes = bytesOf(85, 1) + bytesOf(0, 1) + bytesOf(255, 1);
  const double third = 1.0 / 3, linear = std::pow((third + 0.055) / 1.055, 2.4);
  const Row rows[] = {
      {23, bytes, {third, 0, 1}},
      {29, bytes, {linear, 0, 1}},
      {37, bytes + "\x07", {third, 0, 1}},
      {43, bytes + "\x07", {linear, 0, 1}},
      {84, shorts, {third, 0, 1}},
      {90, halves, {1.5, 0.25, 1}},
      {91, shorts + "ab", {third, 0, 1}},
      {97, halves + "ab", {1.5, 0.25, 1}},
      {106, floats, {1.5, 0.25, 1}},
      {109, floats + "abcd", {1.5, 0.25, 1}},
      // Six bits of mantissa behind five of exponent, 15 of which stand for 1; five for blue.
      {122, bytesOf((15U << 6 | 32U) | (13U << 6) << 11 | (15U << 5) << 22, 4), {1.5, 0.25, 1}},
      // Nine bits each, of 2^(16 - 15 - 9).
      {123, bytesOf(384U | 64U << 9 | 256U << 18 | 16U << 27, 4), {1.5, 0.25, 1}},
  };
  for (const Row& row : rows) {
    std::string data;
    for (size_t i = 0; i < 6; ++i) data += row.texel;
    const Result<CubeLevel> cube = environment::readCube(ktx2(row.format, 1, data), 0, kMost, kPlace);
    ASSERT_TRUE(cube) << row.format << said(cube.error());
    for (const Rgb& color : cube->texels) {
      for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(color[c], row.values[c], 1e-6) << row.format;
    }
  }
}

TEST(CubeMaps, WhatIsNoCubeIsAnError) {
  const std::string data(6 * 12, '\0');
  const auto outcome = [](const std::string& file, uint32_t layer = 0, uint64_t most = kMost) {
    const Result<CubeLevel> cube = environment::readCube(file, layer, most, kPlace);
    return cube ? "read" : cube.error()[0].code + ": " + cube.error()[0].message;
  };
  const std::string good = ktx2(106, 1, data);
  EXPECT_EQ(outcome(good), "read");
  for (size_t size = 0; size < good.size(); ++size)
    EXPECT_NE(outcome(good.substr(0, size)), "read") << "the first " << size << " bytes";
  EXPECT_EQ(outcome(ktx2(106, 1, data, 0, 1)), "environment-unreadable: the KTX2 file holds no cube map");
  EXPECT_EQ(outcome(ktx2(106, 0, data)), "environment-unreadable: the KTX2 file holds no cube map");
  EXPECT_EQ(outcome(ktx2(106, 1, data, 0, 6, 2)),
            "environment-unreadable: the KTX2 file is supercompressed, by scheme 2");
  EXPECT_EQ(outcome(ktx2(145, 1, data)),
            "environment-unreadable: the KTX2 file's texels have the VkFormat 145");
  EXPECT_EQ(outcome(good, 1), "environment-unreadable: the KTX2 file has no cube map 1");
  EXPECT_EQ(outcome(ktx2(106, 1, data, 2), 1),
            "environment-unreadable: the KTX2 file ends before its largest level does");
  EXPECT_EQ(outcome(ktx2(106, 1, data + data, 2), 1), "read");
  EXPECT_EQ(outcome(ktx2(106, 2, data)),
            "environment-unreadable: the KTX2 file ends before its largest level does");
  EXPECT_EQ(outcome(ktx2(106, 4096, data), 0, 1024).substr(0, 15), "image-too-large");
}

/// Texels of a mirror are the file's where both have the size; light that is linear in the direction keeps
/// two thirds of its slope as irradiance, exactly.
TEST(CubeMaps, AreFilteredAsPicturesAre) {
  for (const uint32_t size : {32U, 48U, 20U}) {
    Surroundings surroundings;
    surroundings.picture = cubeOf(size);
    const environment::Maps maps = environment::mapsOf(surroundings, {32, 256});
    double worst = 0, mirror = 0;
    for (size_t i = 0; i < maps.irradiance.texels.size(); ++i) {
      const auto row = static_cast<uint32_t>(i / 32);
      const Vec3 d = environment::texelDirection(row / 32, static_cast<uint32_t>(i % 32), row % 32, 32);
      const std::array<double, 3> expected = {2 + 2.0 / 3 * d[0], 3 - 2.0 / 3 * d[1], 4 + 4.0 / 3 * d[2]};
      for (size_t c = 0; c < 3; ++c) {
        worst = std::max(worst, std::abs(maps.irradiance.texels[i][c] - expected[c]));
        mirror = std::max(mirror, std::abs(double{maps.specular[0].texels[i][c]} - along(d)[c]));
      }
    }
    EXPECT_LT(worst, 2e-3) << size;
    EXPECT_LT(mirror, size == 32 ? 1e-6 : 0.07) << size;
    // The harmonics of that light are its own.
    EXPECT_NEAR(maps.harmonics[0][0] * 0.28209479, 2, 1e-3);
    EXPECT_NEAR(maps.harmonics[2][2] * 0.48860251, 4.0 / 3, 1e-3);
  }
}

constexpr const char* kNames[] = {"KHR_lights_environment", "KHR_environment_map"};

std::string uriOf(const std::string& bytes) { return "data:image/ktx2;base64," + toBase64(bytes); }

/// Two cubes of one texel to a face, of 1 and of 3, as two layers of one file, and two lights.
json file(const std::string& name = kNames[0], bool other_words = false) {
  std::string data;
  for (const uint32_t one : {0x3F800000U, 0x40400000U}) {
    for (size_t i = 0; i < 18; ++i) data += bytesOf(one, 4);
  }
  json made = {{"asset", {{"version", "2.0"}}}, {"scenes", {json::object(), json::object()}}, {"scene", 1}};
  const json image = {{"uri", uriOf(ktx2(106, 1, data, 2))}, {"mimeType", "image/ktx2"}};
  json& extension = made["extensions"][name];
  extension["cubemaps"] = {{{"source", 0}}, {{"source", 0}, {"layer", 1}, {"intensity", 2}}};
  (other_words ? made : extension)["images"] = {image};
  extension[other_words ? "environment_maps" : "lights"] = {{{"cubemap", 0}}, {{"cubemap", 1}}};
  for (const int i : {0, 1})
    made["scenes"][static_cast<size_t>(i)]["extensions"][name][other_words ? "environment_map" : "light"] = i;
  return made;
}

struct Read {
  std::optional<Surroundings> surroundings;
  std::string said;
};
Read readOf(const json& gltf, int scene = -1) {
  Diagnostics warnings;
  Result<Surroundings> read =
      environment::readSurroundings(gltf.dump(), "x.gltf", true, {{}, {}, scene}, warnings);
  if (!read) return {std::nullopt, said(read.error())};
  return {std::move(*read), said(warnings)};
}

float radianceOf(const Read& read) {
  return read.surroundings ? std::get<CubeLevel>(read.surroundings->picture).texels.at(0)[1] : -1;
}

TEST(EnvironmentLights, OfTheSceneInEitherSpelling) {
  for (const char* name : kNames) {
    for (const bool other_words : {false, true}) {
      const json gltf = file(name, other_words);
      EXPECT_EQ(radianceOf(readOf(gltf)), 6) << "the file's scene: layer 1, twice";
      EXPECT_EQ(radianceOf(readOf(gltf, 0)), 1);
      EXPECT_EQ(readOf(gltf, 2).said,
                "x.gltf: error: the file has no scene 2 [no-environment]\n  help: --scene counts from 0");
    }
  }
  json only = file();
  only.erase("scenes"), only.erase("scene");
  EXPECT_NE(readOf(only).said.find("[no-environment]"), std::string::npos) << "two lights, and no scene";
  only["extensions"][kNames[0]]["lights"].erase(1);
  EXPECT_EQ(radianceOf(readOf(only)), 1);
  EXPECT_EQ(readOf(json::parse(R"({"asset": {"version": "2.0"}})")).said,
            "x.gltf: error: the file's scene has no environment [no-environment]\n"
            "  help: KHR_lights_environment, or KHR_environment_map, gives it one; of several lights the "
            "scene names "
            "one");
}

/// Coefficients are of the irradiance: over pi they are what the map holds. No light is negative.
TEST(EnvironmentLights, CoefficientsStandForTheCubesIrradiance) {
  json gltf = file();
  json& light = gltf["extensions"][kNames[0]]["lights"][1];
  light["irradianceCoefficients"] = json::array();
  for (int k = 0; k < 9; ++k) light["irradianceCoefficients"].push_back({0, 0, 0});
  light["irradianceCoefficients"][0] = {1, 2, 0};
  light["irradianceCoefficients"][1] = {0, 0, 1};
  light["irradianceFactor"] = 3;
  const Read read = readOf(gltf);
  ASSERT_TRUE(read.surroundings) << read.said;
  const environment::Maps maps = environment::mapsOf(*read.surroundings, {32, 64});
  const auto at = [&](uint32_t face) { return maps.irradiance.texels[(size_t{face} * 32 + 16) * 32 + 16]; };
  EXPECT_NEAR(at(0)[0], 3 * 0.28209479 / std::numbers::pi, 1e-6);
  EXPECT_NEAR(at(0)[1], 6 * 0.28209479 / std::numbers::pi, 1e-6);
  EXPECT_NEAR(at(2)[2], 3 * 0.48860251 / std::numbers::pi, 1e-3) << "above";
  EXPECT_EQ(at(3)[2], 0) << "below";
  EXPECT_NEAR(maps.specular[0].texels[0][0], 6, 1e-6) << "the cube is what surfaces mirror";
}

/// A box that shaders cannot hold is cut; one that lies beyond is none.
TEST(EnvironmentLights, ABoxEndsSomewhere) {
  json gltf = file();
  json& light = gltf["extensions"][kNames[0]]["lights"][1];
  light["boundingBoxMin"] = {-1e30, -2, -3};
  light["boundingBoxMax"] = {1e7, 2, 3};
  const Read cut = readOf(gltf);
  ASSERT_TRUE(cut.surroundings && cut.surroundings->box);
  EXPECT_EQ(cut.surroundings->box->min[0], -1e6);
  EXPECT_EQ(cut.surroundings->box->max[0], 1e6);
  light["boundingBoxMin"][0] = 2e6;
  EXPECT_FALSE(readOf(gltf).surroundings->box);
}

TEST(EnvironmentLights, FilesHaveTheBox) {
  json gltf = file();
  Messages messages;
  json& light = gltf["extensions"][kNames[0]]["lights"][1];
  light["boundingBoxMin"] = {-1, -2, -3};
  light["boundingBoxMax"] = {1, 2.5, 3};
  const auto own = filterEnvironment({{}, 32, 64}, gltf.dump(), "x.gltf", {}, messages);
  ASSERT_TRUE(own);
  EXPECT_EQ(json::parse(own->description)["box"],
            json::parse(R"({"min": [-1.0, -2.0, -3.0], "max": [1.0, 2.5, 3.0]})"));
  Environment other{{}, 32, 64};
  other.scene = 0;
  const auto made = filterEnvironment(other, gltf.dump(), "x.gltf", {}, messages);
  ASSERT_TRUE(made);
  EXPECT_FALSE(made->maps.box) << "of the other scene";
  EXPECT_FALSE(json::parse(made->description).contains("box"));
  EXPECT_TRUE(messages.empty());
}

/// A cube map beside its file is read from there, with --allow from elsewhere, and never written over.
TEST(EnvironmentLights, ReadTheirFilesAndKeepThem) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(testing::TempDir()) / "lacquer_scene_light";
  fs::remove_all(folder);
  fs::create_directories(folder / "elsewhere");
  std::string data;
  for (size_t i = 0; i < 18; ++i) data += bytesOf(0x3F800000U, 4);
  json gltf = file();
  gltf["extensions"][kNames[0]]["cubemaps"][1]["layer"] = 0;
  const auto write = [&](const fs::path& cube) {
    std::ofstream(folder / cube, std::ios::binary) << ktx2(106, 1, data);
    gltf["extensions"][kNames[0]]["images"][0]["uri"] = cube.string();
    std::ofstream(folder / "in" / "a.gltf") << gltf.dump();
  };
  fs::create_directories(folder / "in");
  const auto outcome = [&](const fs::path& to, const Strings& allow = {}) {
    Environment how{to.string(), 32, 64};
    Options options;
    options.allow = allow;
    Messages messages;
    const bool good = writeEnvironment(how, (folder / "in/a.gltf").string(), options, messages).has_value();
    return good ? "written" : messages.back().code;
  };
  write("in/environment_specular.ktx2");
  gltf["extensions"][kNames[0]]["images"][0]["uri"] = "environment_specular.ktx2";
  std::ofstream(folder / "in" / "a.gltf") << gltf.dump();
  EXPECT_EQ(outcome(folder / "out"), "written");
  EXPECT_EQ(outcome(folder / "in"), "output-clash");
  EXPECT_EQ(fs::file_size(folder / "in/environment_specular.ktx2"), ktx2(106, 1, data).size());
  write("elsewhere/cube.ktx2");
  gltf["extensions"][kNames[0]]["images"][0]["uri"] = "../elsewhere/cube.ktx2";
  std::ofstream(folder / "in" / "a.gltf") << gltf.dump();
  EXPECT_EQ(outcome(folder / "out"), "image-outside");
  EXPECT_EQ(outcome(folder / "out", {(folder / "elsewhere").string()}), "written");
  fs::remove_all(folder);
}

struct Wrong {
  const char* what;
  void (*change)(json&);
  const char* says;
};
json& lightOf(json& gltf) { return gltf["extensions"][kNames[0]]["lights"][1]; }
json& cubeOf(json& gltf) { return gltf["extensions"][kNames[0]]["cubemaps"][1]; }
const Wrong kWrong[] = {
    {"no cubemap", [](json& j) { lightOf(j).erase("cubemap"); },
     "/extensions/KHR_lights_environment/lights/1: error: the light has no \"cubemap\""},
    {"a cubemap that is not there", [](json& j) { lightOf(j)["cubemap"] = 2; },
     "/lights/1/cubemap: error: cubemap 2 is out of range"},
    {"no source", [](json& j) { cubeOf(j).erase("source"); },
     "/cubemaps/1: error: the cubemap has no \"source\""},
    {"an image that is not there", [](json& j) { cubeOf(j)["source"] = 7; },
     "/cubemaps/1/source: error: source 7 is out of range"},
    {"a layer that is not there", [](json& j) { cubeOf(j)["layer"] = 2; }, "the KTX2 file has no cube map 2"},
    {"a layer below all", [](json& j) { cubeOf(j)["layer"] = -1; }, "/layer: error: layer is -1"},
    {"a layer beyond all", [](json& j) { cubeOf(j)["layer"] = 2048; }, "/layer: error: layer is 2048"},
    {"a negative intensity", [](json& j) { cubeOf(j)["intensity"] = -1; },
     "/intensity: error: intensity is -1"},
    {"eight coefficients",
     [](json& j) {
       lightOf(j)["irradianceCoefficients"] = json(8, json::array({1, 1, 1}));
     },
     "irradianceCoefficients has 8 elements"},
    {"a coefficient of two",
     [](json& j) {
       lightOf(j)["irradianceCoefficients"] = json(9, json::array({1, 1}));
     },
     "/irradianceCoefficients/0: error: a coefficient has 2 elements"},
    {"one corner",
     [](json& j) {
       lightOf(j)["boundingBoxMin"] = {0, 0, 0};
     },
     "the light has one corner of its box"},
    {"a flat box",
     [](json& j) {
       lightOf(j)["boundingBoxMin"] = {0, 0, 0};
       lightOf(j)["boundingBoxMax"] = {1, 0, 1};
     },
     "/boundingBoxMax/1: error: the box ends at 0 and begins at 0"},
    {"a box beyond all",
     [](json& j) {
       lightOf(j)["boundingBoxMin"] = {-1e30, -1, -1};
       lightOf(j)["boundingBoxMax"] = {1, 1, 1};
     },
     "/lights/1: warning: the box ends farther away than shaders take"},
    {"coefficients beyond all",
     [](json& j) {
       lightOf(j)["irradianceCoefficients"] = json(9, json::array({1, 1, 1}));
       lightOf(j)["irradianceFactor"] = 1e30;
     },
     "warning: the irradiance by the coefficients may be larger than 65408"},
    {"another type", [](json& j) { j["extensions"][kNames[0]]["images"][0]["mimeType"] = "image/png"; },
     "/images/0/mimeType: warning: the environment's image is of another type"},
    {"another medium", [](json& j) { lightOf(j)["ior"] = 1.3; },
     "/ior: warning: the medium's index of refraction is not used"},
    {"no KTX2",
     [](json& j) { j["extensions"][kNames[0]]["images"][0]["uri"] = "data:image/ktx2;base64,AAAA"; },
     "/images/0: error: the environment's image is no KTX2 file"},
    {"a file that is not there",
     [](json& j) { j["extensions"][kNames[0]]["images"][0]["uri"] = "none.ktx2"; }, "[image-missing]"},
    {"a scene's light that is not there",
     [](json& j) { j["scenes"][1]["extensions"][kNames[0]]["light"] = 5; },
     "/scenes/1/extensions/KHR_lights_environment/light: error: light 5 is out of range"},
    {"a scene without a light", [](json& j) { j["scenes"][1]["extensions"][kNames[0]].erase("light"); },
     "/scenes/1/extensions/KHR_lights_environment: error: the scene's extension has no \"light\""},
    {"lights that are none", [](json& j) { j["extensions"][kNames[0]]["lights"] = 3; },
     "/scenes/1/extensions/KHR_lights_environment/light: error: light 1 is out of range"},
};

TEST(EnvironmentLights, WhatIsWrongIsToldAtItsPlace) {
  for (const Wrong& one : kWrong) {
    json gltf = file();
    one.change(gltf);
    const Read read = readOf(gltf);
    EXPECT_NE(read.said.find(one.says), std::string::npos) << one.what << ": " << read.said;
  }
}

/// Whoever generates shaders is told the same, but for what is in the image.
TEST(EnvironmentLights, AreCheckedWithTheScene) {
  for (const Wrong& one : kWrong) {
    json gltf = file();
    one.change(gltf);
    // What the bytes are, and what comes of them, whoever makes maps is told.
    if (std::string_view(one.says).starts_with("/")) {
      Messages messages;
      Scene::fromMemory(gltf.dump(), "x.gltf", {}, messages);
      std::string all;
      for (const Message& message : messages) all += message.text + "\n";
      const bool of_bytes = std::string_view(one.says).find("no KTX2") != std::string_view::npos;
      EXPECT_EQ(all.find(one.says) != std::string::npos, !of_bytes) << one.what << ": " << all;
    }
  }
  Messages messages;
  EXPECT_TRUE(Scene::fromMemory(file().dump(), "x.gltf", {}, messages));
  EXPECT_TRUE(messages.empty());
}

}  // namespace light_test
}  // namespace lacquer::test
