// EXT_materials_bump against its text: heights as a normal, and that normal on one of a map by the text's own
// formula. A material with bumps has the colours of one without them whose surface has the bent normal.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "lacquer.h"
#include "physics/model.h"
#include "support/answers.h"

namespace lacquer::physics::bump_test {
namespace {

using Json = nlohmann::json;

constexpr size_t kSize = 4;
constexpr int kHeights[kSize][kSize] = {
    {0, 64, 128, 255}, {30, 200, 90, 10}, {255, 128, 60, 40}, {5, 250, 110, 180}};
/// The same as a PNG.
const char* const kImage =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAQAAAAECAAAAACMmsGiAAAAHElEQVR4nG"
    "NgcGj4zyB3IoqL4X+DjQYD66+8LQBBkwcOlkQFbQAAAABJRU5ErkJggg==";

double texelAt(long x, long y) {
  const auto wrapped = [](long i) { return static_cast<size_t>(((i % 4) + 4) % 4); };
  return kHeights[wrapped(y)][wrapped(x)] / 255.0;
}

/// Bilinear, repeated.
double heightAt(double u, double v) {
  const double x = u * kSize - 0.5, y = v * kSize - 0.5;
  const auto i = static_cast<long>(std::floor(x)), j = static_cast<long>(std::floor(y));
  const double s = x - static_cast<double>(i), t = y - static_cast<double>(j);
  const double upper = texelAt(i, j) * (1 - s) + texelAt(i + 1, j) * s;
  const double lower = texelAt(i, j + 1) * (1 - s) + texelAt(i + 1, j + 1) * s;
  return upper * (1 - t) + lower * t;
}

Vec3 unit(const Vec3& v) {
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  return {v[0] / length, v[1] / length, v[2] / length};
}

/// In the frame of a normal map: x along u, y against v.
Vec3 bumpOf(double u, double v, double factor) {
  constexpr double kHalf = 0.5 / kSize;
  const double across = (heightAt(u + kHalf, v) - heightAt(u - kHalf, v)) * kSize;
  const double along = (heightAt(u, v + kHalf) - heightAt(u, v - kHalf)) * kSize;
  return unit({-factor * across, factor * along, 1});
}

/// "Blending Normal and Bump Perturbations" of the text, its textures decoded.
Vec3 blended(const Vec3& base, const Vec3& bump) {
  const Vec3 t = {base[0], base[1], base[2] + 1};
  const Vec3 u = {-bump[0], -bump[1], bump[2]};
  const double by = (t[0] * u[0] + t[1] * u[1] + t[2] * u[2]) / t[2];
  return unit({t[0] * by - u[0], t[1] * by - u[1], t[2] * by - u[2]});
}

struct Place {
  Vec3 n, t, b;
  double u, v;
};

Vec3 inWorld(const Place& place, const Vec3& way) {
  Vec3 out{};
  for (size_t c = 0; c < 3; ++c) out[c] = place.t[c] * way[0] + place.b[c] * way[1] + place.n[c] * way[2];
  return out;
}

class Bump : public testing::Test {
protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("lacquer_bump_" + std::to_string(testing::UnitTest::GetInstance()->random_seed()) + "_" +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Colours of a material at points.
  Json colors(Json material, const Json& points, const std::vector<std::string>& texels = {}) const {
    material["pbrMetallicRoughness"]["roughnessFactor"] = 0.6;
    const Json gltf = {{"asset", {{"version", "2.0"}}},
                       {"images", {{{"uri", kImage}}}},
                       {"textures", {{{"source", 0}}}},
                       {"materials", {material}}};
    const std::string file = (folder_ / "m.gltf").string();
    std::ofstream(file) << gltf.dump();
    Messages messages;
    const std::string answer =
        test::jsonOf(evaluate(file, "", points.dump(), "points.json", Engine::Double, texels, {}, messages));
    for (const Message& message : messages) EXPECT_EQ(message.level, Message::Level::Note) << message.text;
    return Json::parse(answer)["rgba"];
  }

  static Json pointOf(const Vec3& n, const Vec3& t, double u, double v) {
    return {{"n", n},
            {"t", {t[0], t[1], t[2], 1}},
            {"v", unit({0.1, 0.2, 0.9})},
            {"l", unit({0.5, -0.2, 0.8})},
            {"uv0", {u, v}}};
  }

  static std::vector<Place> places() {
    const Vec3 n = unit({0.1, -0.2, 1});
    const Vec3 t = unit({1, 0, -0.1});
    const Vec3 b = {n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0]};
    std::vector<Place> all;
    for (int i = 0; i < 25; ++i) all.push_back({n, t, b, 0.03 + 0.19 * (i % 5), 0.07 + 0.21 * (i / 5)});
    return all;
  }

  static void expectAlike(const Json& a, const Json& b, double within = 1e-7) {
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i) {
      for (size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(a[i][c].get<double>(), b[i][c].get<double>(), within * (1 + b[i][c].get<double>())) << i;
    }
  }

  std::filesystem::path folder_;
};

Json bumped(double factor) {
  return {
      {"extensions", {{"EXT_materials_bump", {{"bumpFactor", factor}, {"bumpTexture", {{"index", 0}}}}}}}};
}

TEST_F(Bump, HeightsBendTheNormal) {
  Json points = Json::array(), bent = Json::array();
  for (const Place& place : places()) {
    points.push_back(pointOf(place.n, place.t, place.u, place.v));
    bent.push_back(pointOf(inWorld(place, bumpOf(place.u, place.v, 0.1)), place.t, place.u, place.v));
  }
  const Json colors_of_bumps = colors(bumped(0.1), points);
  expectAlike(colors_of_bumps, colors(Json::object(), bent));
  EXPECT_NE(colors_of_bumps, colors(Json::object(), points));
}

TEST_F(Bump, TheyLieOnTheNormalsOfAMap) {
  const Vec3 texel = {0.6, 0.35, 0.9};
  const Vec3 mapped = unit({texel[0] * 2 - 1, texel[1] * 2 - 1, texel[2] * 2 - 1});
  Json points = Json::array(), bent = Json::array();
  for (const Place& place : places()) {
    points.push_back(pointOf(place.n, place.t, place.u, place.v));
    const Vec3 way = blended(mapped, bumpOf(place.u, place.v, 0.1));
    bent.push_back(pointOf(inWorld(place, way), place.t, place.u, place.v));
  }
  Json material = bumped(0.1);
  material["normalTexture"] = {{"index", 0}};
  expectAlike(colors(material, points, {"normalTexture=0.6,0.35,0.9,1"}), colors(Json::object(), bent));
}

/// "The normal used in dielectric_brdf": a coat over nothing that is seen does not change.
TEST_F(Bump, ACoatFollowsTheGeometry) {
  Json points = Json::array();
  for (const Place& place : places()) points.push_back(pointOf(place.n, place.t, place.u, place.v));
  Json coated = {
      {"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}}},
      {"extensions",
       {{"KHR_materials_specular", {{"specularFactor", 0}}},
        {"KHR_materials_clearcoat", {{"clearcoatFactor", 1}, {"clearcoatRoughnessFactor", 0.5}}}}}};
  coated["pbrMetallicRoughness"]["metallicFactor"] = 0;
  Json both = coated;
  both["extensions"].update(bumped(0.3)["extensions"]);
  expectAlike(colors(both, points), colors(coated, points), 1e-12);
}

/// The normal turns over with the side that is seen, map or no map.
TEST_F(Bump, BothSidesHaveThem) {
  Json point = pointOf({0, 0, 1}, {1, 0, 0}, 0.2, 0.3);
  const Vec3 way = bumpOf(0.2, 0.3, 0.1);
  Json behind = pointOf({-way[0], -way[1], -way[2]}, {1, 0, 0}, 0.2, 0.3);
  for (Json* one : {&point, &behind}) {
    (*one)["v"] = unit({0.1, 0.2, -0.9});
    (*one)["l"] = unit({0.5, -0.2, -0.8});
  }
  point["front_facing"] = false;
  Json material = bumped(0.1);
  material["doubleSided"] = true;
  const Json plain = {{"doubleSided", true}};
  expectAlike(colors(material, Json::array({point})), colors(plain, Json::array({behind})));
}

}  // namespace
}  // namespace lacquer::physics::bump_test
