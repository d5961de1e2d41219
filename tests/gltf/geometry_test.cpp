// Triangles of files: what accessors say, and what they say wrongly.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "gltf/geometry.h"
#include "support/base64.h"

namespace lacquer::gltf {
namespace {

using nlohmann::json;

void append(std::string& bytes, const std::vector<float>& values) {
  const size_t at = bytes.size();
  bytes.resize(at + 4 * values.size());
  std::memcpy(bytes.data() + at, values.data(), 4 * values.size());
}

/// A square of two triangles in the plane z = 0: positions, texture coordinates, then indices of two bytes.
json square() {
  std::string bytes;
  append(bytes, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  append(bytes, {0, 0, 1, 0, 1, 1, 0, 1});
  for (const char i : {0, 1, 2, 0, 2, 3}) bytes += std::string{i, 0};
  return {
      {"asset", {{"version", "2.0"}}},
      {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", {{{"mesh", 0}, {"translation", {10, 0, 0}}, {"scale", {2, 2, 2}}}}},
      {"materials", {json::object(), json::object()}},
      {"meshes",
       {{{"primitives",
          {{{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}, {"indices", 2}, {"material", 1}}}}}}},
      {"buffers",
       {{{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + toBase64(bytes)}}}},
      {"bufferViews",
       {{{"buffer", 0}, {"byteLength", 48}},
        {{"buffer", 0}, {"byteOffset", 48}, {"byteLength", 32}},
        {{"buffer", 0}, {"byteOffset", 80}, {"byteLength", 12}}}},
      {"accessors",
       {{{"bufferView", 0}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
        {{"bufferView", 1}, {"componentType", 5126}, {"count", 4}, {"type", "VEC2"}},
        {{"bufferView", 2}, {"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}}}}};
}

Geometry geometryOf(const json& file, size_t material = 1) {
  const Result<TextureFile> opened = TextureFile::fromMemory(file.dump(), "m.gltf", {});
  EXPECT_TRUE(opened.has_value());
  return opened ? geometryOf(*opened, material) : Geometry();
}

TEST(Geometry, StandsWhereItsNodePutsIt) {
  const Geometry found = geometryOf(square());
  EXPECT_EQ(found.left_out, "");
  // Without normals of their own the triangles are flat, and share no vertex.
  ASSERT_EQ(found.triangles, (std::vector<uint32_t>{0, 1, 2, 3, 4, 5}));
  ASSERT_EQ(found.corners.size(), 6U);
  EXPECT_EQ(found.corners[1].position, (std::array<float, 3>{12, 0, 0}));
  EXPECT_EQ(found.corners[5].position, (std::array<float, 3>{10, 2, 0}));
  EXPECT_EQ(found.corners[1].uv[0], (std::array<float, 2>{1, 0}));
  for (const Corner& corner : found.corners) {
    EXPECT_EQ(corner.normal, (std::array<float, 3>{0, 0, 1}));
    EXPECT_EQ(corner.tangent, (std::array<float, 4>{1, 0, 0, 1}));
  }
  EXPECT_TRUE(geometryOf(square(), 0).triangles.empty());
}

TEST(Geometry, AMirroredNodeKeepsItsOutside) {
  json file = square();
  file["nodes"][0]["scale"] = {-1, 1, 1};
  const Geometry found = geometryOf(file);
  ASSERT_EQ(found.triangles, (std::vector<uint32_t>{0, 2, 1, 3, 5, 4}));
  EXPECT_EQ(found.corners[0].normal, (std::array<float, 3>{0, 0, 1}));
  EXPECT_EQ(found.corners[0].tangent, (std::array<float, 4>{-1, 0, 0, -1}));
}

TEST(Geometry, NodesMultiplyAndModesMakeTriangles) {
  json file = square();
  file["nodes"][0]["children"] = {1};
  file["nodes"].push_back({{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1}}});
  const Geometry both = geometryOf(file);
  ASSERT_EQ(both.corners.size(), 12U);
  EXPECT_EQ(both.corners[7].position, (std::array<float, 3>{12, 0, 2}));
  json strip = square();
  strip["meshes"][0]["primitives"][0]["mode"] = 5;
  // 0 1 2 0 2 3: the third triangle has a vertex twice.
  EXPECT_EQ(geometryOf(strip).triangles.size(), 9U);
  strip["meshes"][0]["primitives"][0].erase("indices");
  EXPECT_EQ(geometryOf(strip).triangles.size(), 6U);
  strip["meshes"][0]["primitives"][0]["mode"] = 6;
  EXPECT_EQ(geometryOf(strip).triangles.size(), 6U);
}

TEST(Geometry, WhatIsWrongIsLeftOut) {
  const std::vector<std::pair<const char*, std::function<void(json&)>>> kWrong = {
      {"an accessor lies outside of its buffer", [](json& f) { f["accessors"][0]["count"] = 5; }},
      {"an accessor lies outside of its buffer", [](json& f) { f["accessors"][0]["byteOffset"] = 1; }},
      {"an accessor lies outside of its buffer",
       [](json& f) { f["accessors"][0]["byteOffset"] = 9007199254740991.0; }},
      {"an accessor lies outside of its buffer",
       [](json& f) { f["bufferViews"][0]["byteOffset"] = 9007199254740991.0; }},
      {"an accessor lies outside of its buffer",
       [](json& f) {
         f["bufferViews"][0]["byteLength"] = 9007199254740991.0, f["accessors"][0]["count"] = 9;
       }},
      {"a byteStride is wrong", [](json& f) { f["bufferViews"][0]["byteStride"] = 1e15; }},
      {"a byteStride is wrong", [](json& f) { f["bufferViews"][0]["byteStride"] = 4; }},
      {"an accessor is empty, or longer than what is read",
       [](json& f) { f["accessors"][2]["count"] = 4e9; }},
      {"an accessor is empty, or longer than what is read", [](json& f) { f["accessors"][0]["count"] = -1; }},
      {"an accessor has an unknown type", [](json& f) { f["accessors"][0]["type"] = "MAT4"; }},
      {"an accessor has an unknown type", [](json& f) { f["accessors"][0]["componentType"] = 5124; }},
      {"an accessor is sparse", [](json& f) { f["accessors"][0]["sparse"] = json::object(); }},
      {"an accessor has no bufferView", [](json& f) { f["accessors"][0].erase("bufferView"); }},
      {"an accessor is not there", [](json& f) { f["meshes"][0]["primitives"][0]["indices"] = 77; }},
      {"a bufferView has no buffer", [](json& f) { f["bufferViews"][2]["buffer"] = 1; }},
      {"indices are no whole numbers", [](json& f) { f["meshes"][0]["primitives"][0]["indices"] = 1; }},
      {"a primitive has no triangles", [](json& f) { f["meshes"][0]["primitives"][0]["mode"] = 1; }},
      {"an attribute has too few numbers", [](json& f) { f["accessors"][1]["count"] = 3; }},
      {"an attribute has too few numbers", [](json& f) { f["accessors"][1]["type"] = "SCALAR"; }},
      {"a position is no number, or too far away",
       [](json& f) {
         f["nodes"][0]["scale"] = {1e300, 1e300, 1e300};
       }},
      {"a position is no number, or too far away",
       [](json& f) {
         std::string bytes;
         append(bytes, {0, 0, 0, std::numeric_limits<float>::quiet_NaN(), 0, 0, 1, 1, 0, 0, 1, 0});
         f["buffers"].push_back({{"uri", "data:x;base64," + toBase64(bytes)}});
         f["bufferViews"][0]["buffer"] = 1;
       }},
  };
  for (const auto& [why, make] : kWrong) {
    json file = square();
    make(file);
    const Geometry found = geometryOf(file);
    EXPECT_EQ(found.left_out, why);
    EXPECT_TRUE(found.triangles.empty()) << why;
  }
  json indices = square();  // the last vertex is not there: its triangle is none
  indices["accessors"][0]["count"] = indices["accessors"][1]["count"] = 3;
  EXPECT_EQ(geometryOf(indices).triangles.size(), 3U);
}

TEST(Geometry, CirclesEnd) {
  json file = square();
  file["nodes"][0]["children"] = {0, 0, 1};
  file["nodes"].push_back({{"children", {0, 1}}});
  EXPECT_EQ(geometryOf(file).triangles.size(), 6U);
  file.erase("scenes");
  EXPECT_EQ(geometryOf(file).triangles.size(), 6U);
}

TEST(Geometry, HasALimit) {
  json file = square();
  json& primitives = file["meshes"][0]["primitives"];
  for (int i = 0; i < 50; ++i) primitives.push_back(primitives[0]);
  json nodes = json::array();
  for (int i = 0; i < 2000; ++i) nodes.push_back(i), file["nodes"].push_back({{"mesh", 0}});
  file["scenes"][0]["nodes"] = nodes;
  const Geometry found = geometryOf(file);
  EXPECT_LE(found.corners.size(), kMostCorners);
  EXPECT_GT(found.corners.size(), kMostCorners - 10);
  EXPECT_NE(found.left_out.find("more than"), std::string::npos);
}

/// The square's first primitive of positions that end far away, at many nodes that move them further: each
/// comes to nothing.
TEST(Geometry, WhatComesToNothingIsNotTriedForEver) {
  json file = square();
  constexpr size_t kCount = 200'000;
  std::string bytes;
  append(bytes, std::vector<float>(3 * kCount));
  for (const float x : {3e14F, 0.0F, 0.0F}) append(bytes, {x});
  for (const unsigned i : {0U, 1U, unsigned{kCount}}) {
    for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(i >> shift & 0xFFU);
  }
  const size_t positions = 12 * (kCount + 1);
  file["buffers"].push_back({{"uri", "data:x;base64," + toBase64(bytes)}});
  file["bufferViews"] = {{{"buffer", 1}, {"byteLength", positions}},
                         {{"buffer", 1}, {"byteOffset", positions}, {"byteLength", 12}}};
  file["accessors"] = {{{"bufferView", 0}, {"componentType", 5126}, {"count", kCount + 1}, {"type", "VEC3"}},
                       {{"bufferView", 1}, {"componentType", 5125}, {"count", 3}, {"type", "SCALAR"}}};
  json& far = file["meshes"][0]["primitives"][0];
  far["attributes"] = {{"POSITION", 0}, {"NORMAL", 0}};
  far["indices"] = 1;
  file["nodes"] = json::array({{{"mesh", 0}, {"scale", {2, 2, 2}}}});
  file["scenes"][0]["nodes"] = json::array({0});
  EXPECT_FALSE(geometryOf(file).triangles.empty());  // 6e14 is not too far
  for (int i = 1; i <= 60; ++i) {
    file["nodes"].push_back({{"mesh", 0}, {"scale", {9, 9, 9}}});
    file["scenes"][0]["nodes"].insert(file["scenes"][0]["nodes"].begin(), i);
  }
  // The last node would be a good one, but nobody comes to it any more.
  const Geometry found = geometryOf(file);
  EXPECT_EQ(found.left_out, "a position is no number, or too far away");
  EXPECT_TRUE(found.triangles.empty());
}

/// Hours, if each node looked at each primitive.
TEST(Geometry, AMeshIsReadOnceForAllOfItsNodes) {
  json file = square();
  const json primitive = file["meshes"][0]["primitives"][0];
  json primitives = json::array();
  for (int i = 0; i < 200'000; ++i) primitives.push_back({{"material", 0}});
  primitives.push_back(primitive);
  file["meshes"][0]["primitives"] = std::move(primitives);
  json nodes = json::array();
  file["nodes"] = json::array();
  for (int i = 0; i < 20'000; ++i) nodes.push_back(i), file["nodes"].push_back({{"mesh", 0}});
  file["scenes"][0]["nodes"] = std::move(nodes);
  EXPECT_EQ(geometryOf(file).triangles.size(), 6U * 20'000);
}

TEST(Geometry, ATangentsSignIsOne) {
  json file = square();
  std::string bytes;
  for (int i = 0; i < 4; ++i) append(bytes, {0, 0, 1, 2, 0, 0, i % 2 == 0 ? 0.25F : -1e30F});
  file["buffers"].push_back({{"uri", "data:x;base64," + toBase64(bytes)}});
  file["bufferViews"].push_back({{"buffer", 1}, {"byteLength", bytes.size()}, {"byteStride", 28}});
  file["accessors"].push_back({{"bufferView", 3}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}});
  file["accessors"].push_back(
      {{"bufferView", 3}, {"byteOffset", 12}, {"componentType", 5126}, {"count", 4}, {"type", "VEC4"}});
  json& attributes = file["meshes"][0]["primitives"][0]["attributes"];
  attributes["NORMAL"] = 3;
  attributes["TANGENT"] = 4;
  const Geometry found = geometryOf(file);
  ASSERT_EQ(found.corners.size(), 4U) << found.left_out;
  EXPECT_EQ(found.corners[0].tangent, (std::array<float, 4>{1, 0, 0, 1}));
  EXPECT_EQ(found.corners[1].tangent, (std::array<float, 4>{1, 0, 0, -1}));
}

}  // namespace
}  // namespace lacquer::gltf
