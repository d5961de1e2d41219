// What is seen of meshes.
#include "preview/mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace lacquer::preview {
namespace {

/// The unit sphere, off its place and of another size.
Mesh sphere(double radius, const Vec3& middle, bool inside_out = false) {
  constexpr uint32_t kAround = 64;
  constexpr uint32_t kDown = 32;
  Mesh mesh;
  for (uint32_t row = 0; row <= kDown; ++row) {
    for (uint32_t column = 0; column <= kAround; ++column) {
      const double up = row * std::numbers::pi / kDown;
      const double around = column * 2 * std::numbers::pi / kAround;
      eval::Point& point = mesh.vertices.emplace_back();
      point.n = {std::sin(up) * std::sin(around), std::cos(up), std::sin(up) * std::cos(around)};
      for (size_t i = 0; i < 3; ++i) point.position[i] = middle[i] + radius * point.n[i];
    }
  }
  for (uint32_t row = 0; row < kDown; ++row) {
    for (uint32_t column = 0; column < kAround; ++column) {
      const uint32_t a = row * (kAround + 1) + column;
      const uint32_t b = a + kAround + 1;
      const std::array<uint32_t, 6> two = {a, b, b + 1, a, b + 1, a + 1};
      for (const size_t k :
           inside_out ? std::array<size_t, 6>{0, 2, 1, 3, 5, 4} : std::array<size_t, 6>{0, 1, 2, 3, 4, 5})
        mesh.triangles.push_back(two[k]);
    }
  }
  return mesh;
}

TEST(Mesh, ASphereFillsTheBallsPlace) {
  constexpr uint32_t kSize = 64;
  const auto seen = coverageOf(sphere(250, {1000, -20, 3}), 0.7, kSize, 2);
  ASSERT_TRUE(seen);
  // A disk of the picture's width less its margin; a polyhedron has a little less.
  const double disk = std::numbers::pi / 4 * std::pow(kSize * 2 / 1.045 * 0.5, 2) * 4;
  EXPECT_NEAR(static_cast<double>(seen->samples.size()), disk * 1.028, 0.02 * disk);
  // As large as it is: nothing is scaled but the way from the eye.
  const double radius = seen->standing.radius;
  EXPECT_NEAR(radius, 250, 1);
  EXPECT_NEAR(seen->standing.eye[2], 6 * radius, 1e-9);
  const std::array<double, 16>& m = seen->standing.model;
  for (const Coverage::Sample& sample : seen->samples) {
    EXPECT_TRUE(sample.front);
    Vec3 p{};
    float sum = 0;
    for (size_t k = 0; k < 3; ++k) {
      const Vec3& v = seen->vertices[sample.corners[k]].position;
      for (size_t i = 0; i < 3; ++i)
        p[i] += static_cast<double>(sample.weights[k]) *
                (m[i] * v[0] + m[4 + i] * v[1] + m[8 + i] * v[2] + m[12 + i]) / radius;
      sum += sample.weights[k];
    }
    EXPECT_NEAR(sum, 1, 1e-5);
    // On the sphere, on this side of it, and on the way from the eye through the sample's pixel.
    EXPECT_NEAR(std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]), 1, 0.01);
    EXPECT_GT(p[2], -0.05);
    const double x = p[0] * 6 / (6 - p[2]) / 1.045;
    const double y = p[1] * 6 / (6 - p[2]) / 1.045;
    EXPECT_NEAR((x + 1) * kSize / 2, sample.pixel % kSize + 0.5, 0.51);
    EXPECT_NEAR((1 - y) * kSize / 2, sample.pixel / kSize + 0.5, 0.51);
  }
}

TEST(Mesh, BackFacesAreSeenWhereTheMaterialHasTwoSides) {
  Mesh mesh = sphere(1, {0, 0, 0}, true);
  const auto inside = coverageOf(mesh, 0, 32, 2);  // through the front that is not there, to the far side
  ASSERT_TRUE(inside);
  for (const Coverage::Sample& sample : inside->samples) EXPECT_TRUE(sample.front);
  mesh.double_sided = true;
  const auto outside = coverageOf(mesh, 0, 32, 2);
  ASSERT_TRUE(outside);
  for (const Coverage::Sample& sample : outside->samples) EXPECT_FALSE(sample.front);
}

TEST(Mesh, WhatCannotBeDrawnIsNot) {
  Mesh point = sphere(0, {1, 2, 3});
  EXPECT_FALSE(coverageOf(point, 0, 32, 2));
  Mesh none;
  EXPECT_FALSE(coverageOf(none, 0, 32, 2));
  // Many triangles as large as the picture.
  Mesh many;
  many.double_sided = true;
  for (const Vec3& at : {Vec3{-1, -1, 0}, Vec3{1, -1, 0}, Vec3{0, 1, 0}})
    many.vertices.emplace_back().position = at;
  for (int i = 0; i < 2000; ++i) many.triangles.insert(many.triangles.end(), {0, 1, 2});
  EXPECT_TRUE(coverageOf(many, 0, 64, 2));
  EXPECT_FALSE(coverageOf(many, 0, 512, 2));
}

}  // namespace
}  // namespace lacquer::preview
