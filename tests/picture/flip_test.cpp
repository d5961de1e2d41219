// FLIP and CIEDE2000 against published values, and against numbers that a program written from the paper with
// plain two-dimensional kernels has given.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "picture/flip.h"

namespace lacquer::picture {
namespace {

constexpr uint32_t kWidth = 20;
constexpr uint32_t kHeight = 16;

template <class Fill>
Pixels pixels(const Fill& fill) {
  Pixels made{kWidth, kHeight, {}};
  for (uint32_t y = 0; y < kHeight; ++y) {
    for (uint32_t x = 0; x < kWidth; ++x) made.colors.push_back(fill(x, y));
  }
  return made;
}

Pixels uniform(const Color& color) {
  return pixels([&](uint32_t, uint32_t) { return color; });
}

Pixels first() {
  return pixels([](uint32_t x, uint32_t y) {
    return Color{x / 19.0, y / 15.0, (x * 7 + y * 13) % 17 / 16.0};
  });
}
Pixels second() {
  return pixels([](uint32_t x, uint32_t y) {
    return Color{std::min(1.0, x / 19.0 * 0.8 + 0.1), y / 15.0 * y / 15.0, (x * 5 + y * 11) % 13 / 12.0};
  });
}

double at(const std::vector<double>& map, uint32_t x, uint32_t y) { return map[y * kWidth + x]; }

double mean(const std::vector<double>& map) {
  double sum = 0;
  for (const double x : map) sum += x;
  return sum / static_cast<double>(map.size());
}

TEST(Flip, UniformColors) {
  // Green and blue are the furthest apart; the limits of the two differences are the paper's.
  EXPECT_NEAR(flip(uniform({0, 1, 0}), uniform({0, 0, 1}))[0], 1, 1e-12);
  EXPECT_NEAR(flip(uniform({0, 0, 0}), uniform({1, 1, 1}))[0], 0.9673797618501422, 1e-9);
  EXPECT_NEAR(flip(uniform({1, 0, 0}), uniform({0, 1, 0}))[0], 0.986662275325087, 1e-9);
  EXPECT_NEAR(flip(uniform({.5, .5, .5}), uniform({.6, .6, .6}))[0], 0.19621471464878956, 1e-9);
  EXPECT_EQ(flip(uniform({.5, .2, .1}), uniform({.5, .2, .1}))[0], 0);
}

TEST(Flip, ColorsAndFeaturesOfAPattern) {
  const std::vector<double> map = flip(first(), second());
  EXPECT_NEAR(mean(map), 0.5785525447692715, 1e-9);
  EXPECT_NEAR(at(map, 0, 0), 0.3696671002181664, 1e-9);
  EXPECT_NEAR(at(map, 7, 0), 0.2738261555965663, 1e-9);
  EXPECT_NEAR(at(map, 19, 0), 0.42905428615494395, 1e-9);
  EXPECT_NEAR(at(map, 3, 5), 0.7806312228926687, 1e-9);
  EXPECT_NEAR(at(map, 10, 8), 0.7224117037405919, 1e-9);
  EXPECT_NEAR(at(map, 19, 15), 0.43759648182067723, 1e-9);
}

TEST(Flip, FromNearer) {
  const std::vector<double> map = flip(first(), second(), 30);
  EXPECT_NEAR(mean(map), 0.5795121593479954, 1e-9);
  EXPECT_NEAR(at(map, 0, 0), 0.14606960493684967, 1e-9);
  EXPECT_NEAR(at(map, 3, 5), 0.8173467171307102, 1e-9);
}

TEST(Flip, AnEdgeThatMoves) {
  const auto edge = [](uint32_t place) {
    return pixels([place](uint32_t x, uint32_t) {
      const double c = x < place ? 0.2 : 0.8;
      return Color{c, c, c};
    });
  };
  const std::vector<double> map = flip(edge(10), edge(12));
  EXPECT_NEAR(at(map, 5, 8), 0.0025755897038886137, 1e-9);
  EXPECT_NEAR(at(map, 9, 8), 0.5716310049955402, 1e-9);
  EXPECT_NEAR(at(map, 10, 8), 0.6851756754371733, 1e-9);
  EXPECT_NEAR(at(map, 16, 8), 0.001657258279649307, 1e-9);
}

TEST(Flip, OneBrightPixel) {
  const Pixels plain = uniform({0.5, 0.2, 0.1});
  Pixels firefly = plain;
  firefly.colors[8 * kWidth + 10] = {1, 1, 1};
  const std::vector<double> map = flip(plain, firefly);
  EXPECT_NEAR(at(map, 7, 8), 0.05241814003843672, 1e-9);
  EXPECT_NEAR(at(map, 10, 8), 0.42168490511834267, 1e-9);
  EXPECT_EQ(flip(firefly, plain), map);
}

TEST(Color, SpacesGoThereAndBack) {
  for (const Color& color : {Color{0.2, 0.5, 0.9}, Color{0, 0, 0}, Color{1, 0, 0.01}}) {
    const Color back = linearOfYcxcz(ycxczOf(color));
    for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(back[i], color[i], 1e-12);
  }
  const Color white = labOf({1, 1, 1});
  EXPECT_NEAR(white[0], 100, 1e-12);
  EXPECT_NEAR(white[1], 0, 1e-12);
  EXPECT_NEAR(white[2], 0, 1e-12);
}

struct Pair {
  Color a, b;
  double difference;
};
/// Sharma, Wu and Dalal 2005, table 1.
constexpr Pair kPairs[] = {
    {{50.0000, 2.6772, -79.7751}, {50.0000, 0.0000, -82.7485}, 2.0425},
    {{50.0000, 3.1571, -77.2803}, {50.0000, 0.0000, -82.7485}, 2.8615},
    {{50.0000, 2.8361, -74.0200}, {50.0000, 0.0000, -82.7485}, 3.4412},
    {{50.0000, -1.3802, -84.2814}, {50.0000, 0.0000, -82.7485}, 1.0000},
    {{50.0000, -1.1848, -84.8006}, {50.0000, 0.0000, -82.7485}, 1.0000},
    {{50.0000, -0.9009, -85.5211}, {50.0000, 0.0000, -82.7485}, 1.0000},
    {{50.0000, 0.0000, 0.0000}, {50.0000, -1.0000, 2.0000}, 2.3669},
    {{50.0000, -1.0000, 2.0000}, {50.0000, 0.0000, 0.0000}, 2.3669},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0009}, 7.1792},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0010}, 7.1792},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0011}, 7.2195},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0012}, 7.2195},
    {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0009, -2.4900}, 4.8045},
    {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0011, -2.4900}, 4.7461},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 0.0000, -2.5000}, 4.3065},
    {{50.0000, 2.5000, 0.0000}, {73.0000, 25.0000, -18.0000}, 27.1492},
    {{50.0000, 2.5000, 0.0000}, {61.0000, -5.0000, 29.0000}, 22.8977},
    {{50.0000, 2.5000, 0.0000}, {56.0000, -27.0000, -3.0000}, 31.9030},
    {{50.0000, 2.5000, 0.0000}, {58.0000, 24.0000, 15.0000}, 19.4535},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 3.1736, 0.5854}, 1.0000},
    {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
    {{63.0109, -31.0961, -5.8663}, {62.8187, -29.7946, -4.0864}, 1.2630},
    {{61.2901, 3.7196, -5.3901}, {61.4292, 2.2480, -4.9620}, 1.8731},
    {{35.0831, -44.1164, 3.7933}, {35.0232, -40.0716, 1.5901}, 1.8645},
    {{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
    {{36.4612, 47.8580, 18.3852}, {36.2715, 50.5065, 21.2231}, 1.4146},
    {{90.8027, -2.0831, 1.4410}, {91.1528, -1.6435, 0.0447}, 1.4441},
    {{90.9257, -0.5406, -0.9208}, {88.6381, -0.8985, -0.7239}, 1.5381},
    {{6.7747, -0.2908, -2.4247}, {5.8714, -0.0985, -2.2286}, 0.6377},
    {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082},
};

TEST(Color, DeltaE2000IsThatOfItsTable) {
  for (const Pair& pair : kPairs) {
    EXPECT_NEAR(deltaE2000(pair.a, pair.b), pair.difference, 1e-4);
    EXPECT_NEAR(deltaE2000(pair.b, pair.a), pair.difference, 1e-4);
  }
}

}  // namespace
}  // namespace lacquer::picture
