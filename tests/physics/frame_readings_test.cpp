// Readings that the frame behind shows, or the medium, or surroundings that are not the same to all sides:
// what direct light and a white room cannot tell apart.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/stack_subject.h"
#include "support/materials.h"

namespace lacquer::physics::frame_readings_test {
namespace {

using Json = nlohmann::json;

/// A white dielectric of that roughness with these extensions.
StackMaterial white(double roughness, const char* extensions) {
  StackMaterial material;
  material.json = {{"name", "M"},
                   {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", roughness}}},
                   {"extensions", Json::parse(extensions)}};
  return material;
}

Sample slanted() { return sampleOf(tilted(0.6, 0.5), {0, 0, 1}); }

/// Where the frame is seen by red, green and blue, in x and in y: each relative to what a white frame gives.
struct Places {
  Vec3 x{}, y{};
};
Places placesOf(const StackMaterial& material, const Sample& sample, double scale = 1) {
  const auto whole = [](double, double, double) { return Vec3{1, 1, 1}; };
  // Frames hold no negative light.
  const auto at_x = [](double x, double, double) { return Vec3{x + 50, x + 50, x + 50}; };
  const auto at_y = [](double, double y, double) { return Vec3{y + 50, y + 50, y + 50}; };
  const Vec3 all = lacquerThrough(material, sample, whole, scale);
  const Vec3 x = lacquerThrough(material, sample, at_x, scale);
  const Vec3 y = lacquerThrough(material, sample, at_y, scale);
  Places places;
  for (size_t c = 0; c < 3; ++c) {
    places.x[c] = x[c] / all[c] - 50;
    places.y[c] = y[c] / all[c] - 50;
  }
  return places;
}

/// Snell's law at a normal along z, and a walk of that length from the origin.
Vec2 exitOf(const Vec3& v, double ior, double length) {
  const double k = 1 / ior;
  return {-v[0] * k * length, -v[1] * k * length};
}

double lodOf(const StackMaterial& material) {
  const auto level = [](double, double, double lod) { return Vec3{lod, 1, 1}; };
  const Vec3 seen = lacquerThrough(material, slanted(), level);
  return seen[0] / seen[1];
}

TEST(FrameReadings, E06InfiniteIndexLooksAlongTheNormal) {
  for (const char* const more : {"", R"(, "KHR_materials_dispersion": {"dispersion": 1})"}) {
    const std::string extensions = std::string(R"({"KHR_materials_transmission": {"transmissionFactor": 1},
        "KHR_materials_volume": {"thicknessFactor": 2}, "KHR_materials_ior": {"ior": 0},
        "KHR_materials_specular": {"specularColorFactor": [0.1, 0.1, 0.1]})") +
                                   more + "}";
    const Places seen = placesOf(white(0.3, extensions.c_str()), slanted());
    for (size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(seen.x[c], 0, 1e-9);
      EXPECT_NEAR(seen.y[c], 0, 1e-9);
    }
  }
}

TEST(FrameReadings, E30TheIndexScalesTheRoughness) {
  constexpr const char* kPane = R"({"KHR_materials_transmission": {"transmissionFactor": 1},
                                    "KHR_materials_ior": {"ior": %s}})";
  const auto lod = [&](const char* ior) {
    std::string text = kPane;
    text.replace(text.find("%s"), 2, ior);
    return lodOf(white(0.5, text.c_str()));
  };
  EXPECT_NEAR(lod("1.2"), 16 * 0.5 * 0.4, 1e-9);
  EXPECT_EQ(lod("1"), 0);
  EXPECT_NEAR(lod("2"), 16 * 0.5, 1e-9);
}

// The refracted ray is walked for the thickness times the mean length of the object's axes.
TEST(FrameReadings, E35TheWalkIsScaledByTheMeanOfTheAxes) {
  const StackMaterial glass = white(0.1, R"({"KHR_materials_transmission": {"transmissionFactor": 1},
      "KHR_materials_volume": {"thicknessFactor": 2}, "KHR_materials_ior": {"ior": 1.4}})");
  const Sample s = slanted();
  for (const double scale : {1.0, 0.5}) {
    const Vec2 expected = exitOf(s.v, 1.4, 2 * scale * 5 / 3);
    const Places seen = placesOf(glass, s, scale);
    EXPECT_NEAR(seen.x[1], expected[0], 1e-9);
    EXPECT_NEAR(seen.y[1], expected[1], 1e-9);
  }
}

TEST(FrameReadings, E38NoIndexIsBelowOne) {
  // Half the spread is 1: red would be refracted by 0.5.
  const char* const prism = R"({"KHR_materials_transmission": {"transmissionFactor": 1},
      "KHR_materials_volume": {"thicknessFactor": 0.6}, "KHR_materials_dispersion": {"dispersion": 80}})";
  const Sample s = slanted();
  const Places seen = placesOf(white(0.1, prism), s);
  const Vec3 iors{1, 1.5, 2.5};
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(seen.x[c], exitOf(s.v, iors[c], 1)[0], 1e-9) << c;
}

TEST(FrameReadings, E47ARetroreflectorSeesTheEye) {
  Configuration setup;
  setup.ibl = true;
  setup.textures["environment_specular"] = [](size_t, const Vec3& direction, double) {
    return Vec4{2 + direction[0], 2 + direction[1], 2 + direction[2], 1};
  };
  StackMaterial mirror = white(0.3, R"({"KHR_materials_retroreflection": {"retroreflectionFactor": 1}})");
  mirror.json["pbrMetallicRoughness"]["metallicFactor"] = 1;
  Sample s = slanted();
  s.light = {0, 0, 0};
  const Vec4 seen = Subject(gltfOf(mirror), 0, {}, setup).color<double>(s);
  for (size_t c = 1; c < 3; ++c) EXPECT_NEAR(seen[c] / seen[0], (2 + s.v[c]) / (2 + s.v[0]), 1e-9);
}

// What comes through loses what the fibres of a sheen keep, as all that lies below them does.
TEST(FrameReadings, E12SheenScalesWhatComesThrough) {
  const char* const pane = R"({"KHR_materials_transmission": {"transmissionFactor": 1}})";
  const char* const cloth = R"({"KHR_materials_transmission": {"transmissionFactor": 1},
      "KHR_materials_sheen": {"sheenColorFactor": [0.2, 0.8, 0.4], "sheenRoughnessFactor": 0.5}})";
  const auto whole = [](double, double, double) { return Vec3{1, 1, 1}; };
  const Sample s = sampleOf(tilted(0.2), {0, 0, 1});
  const Vec3 bare = lacquerThrough(white(0.3, pane), s, whole);
  const Vec3 covered = lacquerThrough(white(0.3, cloth), s, whole);
  // A black base under the environment shows the fibres alone, which reflect E of it.
  Configuration setup;
  setup.ibl = true;
  Sample dark = s;
  dark.light = {0, 0, 0};
  const auto room = [&](const char* extensions) {
    StackMaterial black = white(0.3, extensions);
    black.json["pbrMetallicRoughness"]["baseColorFactor"] = {0, 0, 0, 1};
    black.json["pbrMetallicRoughness"]["metallicFactor"] = 1;
    black.json["extensions"]["KHR_materials_specular"] = {{"specularFactor", 0}};
    return Subject(gltfOf(black), 0, {}, setup).color<double>(dark, {1, 1, 1});
  };
  const Vec4 without = room("{}");
  const Vec4 fibres =
      room(R"({"KHR_materials_sheen": {"sheenColorFactor": [0.2, 0.8, 0.4], "sheenRoughnessFactor": 0.5}})");
  // shown = without * (1 - 0.8 E) + color * E, in two channels.
  const double albedo = (fibres[1] - without[1]) / (0.8 - 0.8 * without[1]);
  EXPECT_GT(albedo, 0.05);
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(covered[c] / bare[c], 1 - 0.8 * albedo, 1e-9);
}

StackMaterial medium(const char* scatter) {
  StackMaterial m = white(0.5, R"({"KHR_materials_transmission": {"transmissionFactor": 1},
      "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 2, "attenuationColor": [0.2, 0.5, 0.8]}})");
  m.json["extensions"].update(Json::parse(scatter));
  return m;
}

void expectMedium(const StackMaterial& material) {
  const StackMedium expected = mediumOf(readStack(material.json));
  const StackMedium actual = lacquerMedium(material);
  EXPECT_EQ(actual.anisotropy, expected.anisotropy);
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(actual.extinction[c], expected.extinction[c], 1e-9);
    EXPECT_NEAR(actual.scattering[c], expected.scattering[c], 1e-9);
  }
}

TEST(FrameReadings, E42EachMediumIsByItsText) {
  expectMedium(medium(R"({"KHR_materials_scatter": {"scatterStrengthFactor": 1,
      "multiscatterColorFactor": [0.9, 0.5, 0.1], "scatterAnisotropy": 0.7}})"));
  expectMedium(medium(R"({"KHR_materials_volume_scatter": {"multiscatterColorFactor": [0.9, 0.5, 0.1],
      "scatterAnisotropy": 0.7}})"));
}

bool warns(const StackMaterial& material, const std::string& code, const std::string& pointer) {
  const Result<material::Document> document = test::materialsOf(gltfOf(material), "test.gltf");
  if (!document) return false;
  for (const Diagnostic& d : document->materials.at(0).diagnostics) {
    if (d.code == code && d.severity == Severity::Warning && d.place.pointer == pointer) return true;
  }
  return false;
}

TEST(FrameReadings, E43ScatterWinsOverVolumeScatterWithAWarning) {
  const char* const newer = R"({"KHR_materials_scatter": {"scatterStrengthFactor": 0.8,
      "multiscatterColorFactor": [0.9, 0.5, 0.1], "scatterAnisotropy": 0.3}})";
  StackMaterial both = medium(newer);
  EXPECT_FALSE(warns(both, "overruled-extension", "/materials/0/extensions/KHR_materials_volume_scatter"));
  const StackMedium alone = lacquerMedium(both);
  both.json["extensions"]["KHR_materials_volume_scatter"] = {{"multiscatterColorFactor", {0.1, 0.9, 0.9}},
                                                             {"scatterAnisotropy", -0.6}};
  EXPECT_TRUE(warns(both, "overruled-extension", "/materials/0/extensions/KHR_materials_volume_scatter"));
  const StackMedium seen = lacquerMedium(both);
  EXPECT_EQ(seen.scattering, alone.scattering);
  EXPECT_EQ(seen.anisotropy, alone.anisotropy);
}

TEST(FrameReadings, E44VolumeScatterHasTwoNames) {
  const StackMaterial text =
      medium(R"({"KHR_materials_volume_scatter": {"multiscatterColorFactor": [0.9, 0.5, 0.1]}})");
  const StackMaterial schema =
      medium(R"({"KHR_materials_volume_scatter": {"multiscatterColor": [0.9, 0.5, 0.1]}})");
  EXPECT_EQ(lacquerMedium(text).scattering, lacquerMedium(schema).scattering);
  EXPECT_GT(lacquerMedium(schema).scattering[0], 0.1);
  EXPECT_FALSE(warns(schema, "unknown-property",
                     "/materials/0/extensions/KHR_materials_volume_scatter/multiscatterColor"));
  // The text's name wins.
  const StackMaterial both =
      medium(R"({"KHR_materials_volume_scatter": {"multiscatterColorFactor": [0.9, 0.5, 0.1],
      "multiscatterColor": [0.1, 0.1, 0.1]}})");
  EXPECT_EQ(lacquerMedium(both).scattering, lacquerMedium(text).scattering);
}

TEST(FrameReadings, E51NamesAndRangesThatTheSchemasLack) {
  const std::string outer = "/materials/0/extensions/KHR_materials_anisotropy";
  const StackMaterial example =
      white(0.5, R"({"KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "extensions":
      {"EXT_materials_anisotropy_openpbr": {"anisotropyUseOpenPbr": true}}}})");
  EXPECT_TRUE(warns(example, "unknown-property",
                    outer + "/extensions/EXT_materials_anisotropy_openpbr/anisotropyUseOpenPbr"));
  const StackMaterial table =
      white(0.5, R"({"KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "extensions":
      {"EXT_materials_anisotropy_openpbr": {"openPbrAnisotropyEnabled": true}}},
      "KHR_materials_specular": {"specularFactor": 0.5, "extensions":
      {"EXT_materials_specular_edge_color": {"specularEdgeColorEnabled": true}}},
      "KHR_materials_clearcoat": {"clearcoatFactor": 1},
      "ADOBE_materials_clearcoat_specular": {"clearcoatIor": 3}})");
  const Result<material::Document> document = test::materialsOf(gltfOf(table), "test.gltf");
  ASSERT_TRUE(document);
  for (const Diagnostic& d : document->materials.at(0).diagnostics) ADD_FAILURE() << format(d);
}

// Tangent, bitangent and normal are orthonormal where a map leans the normal over the tangent.
TEST(FrameReadings, E28TheFrameIsOrthonormalUnderANormalMap) {
  StackMaterial m = white(0.4, R"({"KHR_materials_anisotropy": {"anisotropyStrength": 0.8}})");
  m.json["pbrMetallicRoughness"]["metallicFactor"] = 1;
  Sample flat = sampleOf(tilted(0.7, 0.3), tilted(0.6, 1.9));
  flat.n = {0.48, 0.36, 0.8};
  const Vec3 expected = stackDirect(readStack(m.json), flat);
  m.json["normalTexture"] = {{"index", 0}};
  m.texels["normalTexture"] = {0.5 + 0.24, 0.5 + 0.18, 0.5 + 0.4, 1};
  const Vec3 shown = lacquerDirect(m, sampleOf(flat.v, flat.l));
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(shown[c], expected[c], 1e-6 * expected[c]);  // texels are floats
}

}  // namespace
}  // namespace lacquer::physics::frame_readings_test
