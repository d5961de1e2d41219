// Where rays leave the box of a local environment, at the places where a plain formula would divide by 0.
#include <gtest/gtest.h>

#include <cmath>

#include "node_values.h"

namespace lacquer::physics {
namespace local_environment_test {

using Vec3 = std::array<double, 3>;

template <class T>
Vec3 seen(const Vec3& direction, const Vec3& place, const Vec3& least, const Vec3& most) {
  const auto column = [](const Vec3& v) { return eval::Column::perPoint(3, {v[0], v[1], v[2]}); };
  const auto values = nodeValues<T>("localized", {},
                                    {{"direction", column(direction)},
                                     {"position", column(place)},
                                     {"box_min", column(least)},
                                     {"box_max", column(most)}},
                                    1);
  return {static_cast<double>(values[0][0]), static_cast<double>(values[0][1]),
          static_cast<double>(values[0][2])};
}

void expectSeen(const Vec3& expected, const Vec3& direction, const Vec3& place,
                const Vec3& least = {-2, -2, -2}, const Vec3& most = {2, 2, 2}) {
  const Vec3 exact = seen<double>(direction, place, least, most);
  const Vec3 rounded = seen<float>(direction, place, least, most);
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(exact[c], expected[c], 1e-9 * (1 + std::abs(expected[c]))) << c;
    EXPECT_NEAR(rounded[c], expected[c], 1e-5 * (1 + std::abs(expected[c]))) << c;
  }
}

TEST(LocalEnvironment, RaysEndAtTheWalls) {
  expectSeen({2, 0, 0}, {1, 0, 0}, {0, 0, 0});
  expectSeen({2, 1, -1}, {1, 0, 0}, {-1, 1, -1});
  expectSeen({0.5, -2, 0}, {0, -1, 0}, {0.5, 1, 0});
  const double s = std::sqrt(0.5);
  expectSeen({2, 2, 0}, {s, s, 0}, {1, 1, 0});  // into an edge
  // The middle is the box's own, wherever that is.
  expectSeen({2, 0, 0}, {1, 0, 0}, {11, 20, 30}, {8, 18, 28}, {12, 22, 32});
}

TEST(LocalEnvironment, AlongAWallAndOnIt) {
  // A component of 0, one that is smaller than what it is divided by, and one that is as large.
  for (const double small : {0.0, 1e-9, -1e-9, 1e-6, -1e-6, 2e-6})
    expectSeen({2, 2 * small, 0}, {1, small, 0}, {0, 0, 0});
  // On the wall, along it and out of it.
  expectSeen({2, 0, 2}, {1, 0, 0}, {0, 0, 2});
  expectSeen({0, 0, 2}, {0, 0, 1}, {0, 0, 2});
}

TEST(LocalEnvironment, FromWithoutThePlaceItself) {
  expectSeen({5, 0, 0}, {1, 0, 0}, {5, 0, 0});
  const Vec3 v = seen<float>({0, 0.6, 0.8}, {0, 3, 0}, {-2, -2, -2}, {2, 2, 2});
  for (const double x : v) EXPECT_TRUE(std::isfinite(x));
}

}  // namespace local_environment_test
}  // namespace lacquer::physics
