// What the renderer draws is what `lacquer eval` computes at the same points, in double.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <lacquer.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "renderer.h"

namespace lacquer::test::parity_test {
namespace {

using Json = nlohmann::json;

/// Two by two texels, of which one has no alpha.
const char* const kTexels =
    "data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAYAAABytg0kAAAAGklEQVR42mP476DwX+"
    "GEw38GAYMPDA0NDf8BSXgINeeL7IEAAAAASUVORK5CYII=";

struct Subject {
  const char* name;
  const char* material;  ///< its members, in JSON
};

constexpr Subject kSubjects[] = {
    {"default", R"("pbrMetallicRoughness": {})"},
    {"dielectric",
     R"("pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.3, 0.1, 1], "metallicFactor": 0, "roughnessFactor": 0.4})"},
    {"metal",
     R"("pbrMetallicRoughness": {"baseColorFactor": [1, 0.8, 0.4, 1], "metallicFactor": 1, "roughnessFactor": 0.25})"},
    {"emissive",
     R"("emissiveFactor": [1, 0.5, 0.25], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 3}})"},
    {"coat",
     R"("pbrMetallicRoughness": {"baseColorFactor": [0.6, 0.1, 0.1, 1], "metallicFactor": 0}, "extensions":
      {"KHR_materials_coat": {"coatFactor": 0.8, "coatRoughnessFactor": 0.2, "coatColorFactor": [0.9, 0.6, 0.4], "coatDarkeningFactor": 1}})"},
    {"clearcoat",
     R"("extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.1}})"},
    {"sheen",
     R"("pbrMetallicRoughness": {"metallicFactor": 0}, "extensions": {"KHR_materials_sheen": {"sheenColorFactor": [0.5, 0.4, 1], "sheenRoughnessFactor": 0.5}})"},
    {"anisotropy",
     R"("pbrMetallicRoughness": {"roughnessFactor": 0.4}, "extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 0.7, "anisotropyRotation": 0.5}})"},
    {"iridescence",
     R"("pbrMetallicRoughness": {"roughnessFactor": 0.3}, "extensions": {"KHR_materials_iridescence": {"iridescenceFactor": 1}})"},
    {"transmission",
     R"("pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0, "baseColorFactor": [0.9, 0.7, 0.5, 1]},
      "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.75}})"},
    {"unlit",
     R"("pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.4, 0.6, 1]}, "extensions": {"KHR_materials_unlit": {}})"},
    {"textured",
     R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0.5, "roughnessFactor": 0.6})"},
    {"transformed",
     R"("pbrMetallicRoughness": {"metallicFactor": 0, "baseColorTexture": {"index": 0, "extensions":
      {"KHR_texture_transform": {"offset": [0.5, 0], "scale": [1, -1]}}}})"},
    {"masked",
     R"("alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0})"},
    {"normal map", R"("normalTexture": {"index": 1}, "pbrMetallicRoughness": {"roughnessFactor": 0.5})"},
    {"blended",
     R"("alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.5, 0.1, 0.4], "metallicFactor": 0})"},
    {"animated",
     R"("emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0, "extensions": {"KHR_texture_procedurals": {"index": 0}}})"},
};
/// An eighth of the seconds, a 240th of the pictures.
constexpr const char* kProcedural = R"({"name": "g", "nodetype": "nodegraph", "type": "color3", "nodes": [
  {"name": "t", "nodetype": "time", "type": "float"}, {"name": "f", "nodetype": "frame", "type": "float"},
  {"name": "c", "nodetype": "combine3", "type": "color3", "inputs": {
    "in1": {"type": "float", "node": 0}, "in2": {"type": "float", "node": 1}, "in3": {"type": "float", "value": 4}}},
  {"name": "s", "nodetype": "multiply", "type": "color3", "inputs": {
    "in1": {"type": "color3", "node": 2}, "in2": {"type": "color3", "value": [0.125, 0.00416667, 0.125]}}}],
  "outputs": {"out": {"type": "color3", "node": 3}}})";
constexpr size_t kSubjectCount = std::size(kSubjects);
constexpr size_t kColumns = 4, kRows = (kSubjectCount + kColumns - 1) / kColumns;
constexpr double kSide = 0.9, kDistance = 6, kYfov = 0.9;
constexpr double kLight[3] = {0.48, 0.6, 0.64};  ///< unit, towards it
constexpr double kRadiance[3] = {2, 1.5, 1};
constexpr float kSky = 0.5F;

using Vec = std::array<double, 3>;
Vec unit(const Vec& v) {
  const double size = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  return {v[0] / size, v[1] / size, v[2] / size};
}

double cornerX(size_t i) { return (static_cast<double>(i % kColumns) - kColumns / 2.0); }
double cornerY(size_t i) { return (kRows / 2.0 - 1 - static_cast<double>(i / kColumns)); }
/// Of the square's vertices, not of its plane.
Vec normalOf(size_t i) {
  return unit(
      {0.35 * std::sin(1.7 * static_cast<double>(i)), 0.3 * std::cos(2.3 * static_cast<double>(i)), 1});
}
Vec tangentOf(size_t i) {
  const Vec n = normalOf(i);
  return unit({n[2], 0, -n[0]});
}

/// Squares in a plane before the camera, one for each subject, with vertices that say which way they face.
Json fileOf() {
  std::string bytes;
  const auto put = [&](std::initializer_list<double> numbers) {
    for (const double number : numbers) {
      const auto x = static_cast<float>(number);
      bytes.append(reinterpret_cast<const char*>(&x), 4);
    }
  };
  Json file = {{"asset", {{"version", "2.0"}}}, {"scene", 0}};
  Json nodes = Json::array();
  const auto accessor = [&](const char* type, size_t from, size_t count) {
    file["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", from}, {"byteLength", bytes.size() - from}});
    file["accessors"].push_back({{"bufferView", file["bufferViews"].size() - 1},
                                 {"componentType", 5126},
                                 {"count", count},
                                 {"type", type}});
    return file["accessors"].size() - 1;
  };
  for (size_t i = 0; i < kSubjectCount; ++i) {
    const double x = cornerX(i), y = cornerY(i);
    const Vec n = normalOf(i), t = tangentOf(i);
    Json attributes;
    size_t at = bytes.size();
    for (const auto& [u, v] :
         {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}})
      put({x + kSide * u, y + kSide * v, 0});
    attributes["POSITION"] = accessor("VEC3", at, 6);
    at = bytes.size();
    for (int k = 0; k < 6; ++k) put({n[0], n[1], n[2]});
    attributes["NORMAL"] = accessor("VEC3", at, 6);
    at = bytes.size();
    for (int k = 0; k < 6; ++k) put({t[0], t[1], t[2], 1});
    attributes["TANGENT"] = accessor("VEC4", at, 6);
    at = bytes.size();
    for (const auto& [u, v] :
         {std::pair{0.0, 1.0}, {1.0, 1.0}, {1.0, 0.0}, {0.0, 1.0}, {1.0, 0.0}, {0.0, 0.0}})
      put({u, v});
    attributes["TEXCOORD_0"] = accessor("VEC2", at, 6);
    file["meshes"].push_back({{"primitives", {{{"attributes", attributes}, {"material", i}}}}});
    nodes.push_back({{"mesh", i}});
    file["materials"].push_back(
        Json::parse(fmt::format("{{\"name\": \"{}\", {}}}", kSubjects[i].name, kSubjects[i].material)));
  }
  file["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 0}, {"sampler", 0}}};
  file["images"] = {{{"uri", kTexels}}};
  file["samplers"] = {{{"magFilter", 9728}, {"minFilter", 9728}}};
  file["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", kYfov}, {"znear", 0.1}, {"zfar", 100}}}}};
  nodes.push_back({{"camera", 0}, {"translation", {0, 0, kDistance}}});
  // A rotation that turns -z away from the light: half of the way from -z to there, about their normal.
  const Vec half = unit({-kLight[0], -kLight[1], -kLight[2] - 1});
  nodes.push_back({{"rotation", {-half[1] * -1 * -1, half[0] * -1, 0, 0}},
                   {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  const Vec z{0, 0, -1};
  const double w = z[2] * half[2];
  nodes.back()["rotation"] = {z[1] * half[2] - z[2] * half[1], z[2] * half[0] - z[0] * half[2], 0, w};
  file["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "directional"},
       {"color", {kRadiance[0] / 2, kRadiance[1] / 2, kRadiance[2] / 2}},
       {"intensity", 2}}};
  file["extensionsUsed"] = {"KHR_lights_punctual",       "KHR_materials_emissive_strength",
                            "KHR_materials_coat",        "KHR_materials_clearcoat",
                            "KHR_materials_sheen",       "KHR_materials_anisotropy",
                            "KHR_materials_iridescence", "KHR_materials_transmission",
                            "KHR_materials_unlit",       "KHR_texture_transform"};
  for (const char* name : {"KHR_texture_procedurals", "EXT_texture_procedurals_mx_1_39"})
    file["extensionsUsed"].push_back(name);
  file["extensions"]["KHR_texture_procedurals"]["procedurals"] = {Json::parse(kProcedural)};
  Json all = Json::array();
  for (size_t i = 0; i < nodes.size(); ++i) all.push_back(i);
  file["nodes"] = nodes;
  file["scenes"] = {{{"nodes", all}}};
  static const char* const kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  while (bytes.size() % 3 != 0) bytes += '\0';
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const uint32_t three = static_cast<unsigned char>(bytes[i]) << 16 |
                           static_cast<unsigned char>(bytes[i + 1]) << 8 |
                           static_cast<unsigned char>(bytes[i + 2]);
    for (int shift = 18; shift >= 0; shift -= 6) text += kDigits[three >> shift & 63];
  }
  file["buffers"] = {{{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + text}}};
  return file;
}

constexpr uint32_t kWidth = 320, kHeight = 320;

/// The pixels of a subject that are looked at, and their points.
struct Samples {
  std::vector<std::pair<uint32_t, uint32_t>> pixels;
  Json points = Json::array();
};

Samples samplesOf(size_t i) {
  Samples made;
  const double tangent = std::tan(kYfov / 2);
  const Vec n = normalOf(i), t = tangentOf(i);
  for (const auto& [u, v] : {std::pair{0.22, 0.27}, {0.74, 0.23}, {0.77, 0.71}, {0.28, 0.76}, {0.4, 0.4}}) {
    const double x = cornerX(i) + kSide * u, y = cornerY(i) + kSide * v;
    const auto px = static_cast<uint32_t>((x / (kDistance * tangent) + 1) / 2 * kWidth);
    const auto py = static_cast<uint32_t>((1 - y / (kDistance * tangent)) / 2 * kHeight);
    // The pixel's middle.
    const double at_x = ((px + 0.5) / kWidth * 2 - 1) * kDistance * tangent;
    const double at_y = (1 - (py + 0.5) / kHeight * 2) * kDistance * tangent;
    const Vec view = unit({-at_x, -at_y, kDistance});
    made.pixels.emplace_back(px, py);
    made.points.push_back({{"n", n},
                           {"t", {t[0], t[1], t[2], 1}},
                           {"v", view},
                           {"l", kLight},
                           {"light", kRadiance},
                           {"env", {kSky, kSky, kSky}},
                           {"uv0", {(at_x - cornerX(i)) / kSide, 1 - (at_y - cornerY(i)) / kSide}},
                           {"position", {at_x, at_y, 0}}});
  }
  return made;
}

class RendererParity : public testing::TestWithParam<double> {};

TEST_P(RendererParity, PicturesAreWhatEvalSays) {
  if (!canDraw()) GTEST_SKIP() << "no Vulkan device";
  Trial trial;
  trial.time = GetParam();
  trial.frame = std::floor(24 * trial.time);
  const std::filesystem::path path = place() / "subjects.gltf";
  std::ofstream(path) << fileOf().dump();
  const Picture picture =
      draw(path, {"--size", fmt::format("{}x{}", kWidth, kHeight), "--samples", "1", "--environment",
                  uniformSky(kSky), "--time", fmt::format("{}", trial.time)});
  ASSERT_EQ(picture.pixels.size(), size_t{kWidth} * kHeight);
  for (const float x : picture.at(2, 2))
    EXPECT_NEAR(x, kSky, 1e-3) << "the sky is what the points have for it";
  Options options;
  Messages messages;
  const Scene scene = Scene::load(path.string(), options, messages);
  double most = 0;
  for (size_t i = 0; i < kSubjectCount; ++i) {
    const Samples samples = samplesOf(i);
    // lavapipe is up to 0.9 % off where it decodes sRGB.
    const bool textured = std::string_view(kSubjects[i].material).find("Texture\"") != std::string_view::npos;
    const std::optional<Evaluation> answer =
        evaluate(scene, i, samples.points.dump(), Engine::Double, {}, options, messages, trial);
    ASSERT_TRUE(answer) << (messages.empty() ? "" : messages.back().text);
    for (size_t p = 0; p < samples.pixels.size(); ++p) {
      const auto [x, y] = samples.pixels[p];
      const bool discarded = !answer->discarded.empty() && answer->discarded[p];
      const double alpha = discarded ? 0 : answer->rgba[p][3];
      for (size_t c = 0; c < 3; ++c) {
        const double color = discarded ? 0 : answer->rgba[p][c];
        const double expected = color * alpha + kSky * (1 - alpha);
        const double error = std::abs(picture.at(x, y)[c] - expected) / std::max(expected, 0.02);
        most = std::max(most, error);
        EXPECT_LT(error, textured ? 1e-2 : 2e-3)
            << kSubjects[i].name << ", pixel " << x << " " << y << ", channel " << c << ": "
            << picture.at(x, y)[c] << ", not " << expected;
      }
    }
  }
  std::printf("the largest difference is %.2g\n", most);
}
INSTANTIATE_TEST_SUITE_P(AtTimes, RendererParity, testing::Values(0.0, 2.5));

}  // namespace
}  // namespace lacquer::test::parity_test
