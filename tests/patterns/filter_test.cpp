// Filtered variants against the mean of 64 places over a pixel.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>
#include <utility>

#include "patterns/run.h"

namespace lacquer::test::filter_test {
namespace {

constexpr size_t kPixels = 1500;

struct Errors {
  double plain = 0, filtered = 0, mean = 0;  ///< RMS of the node, of its variant, and of the pixels' means
};

/// Over squares of `side` cells, of any turn.
Errors errorsOf(const std::string& form, int dimensions, double side, double (*value)(const Place&)) {
  std::mt19937_64 engine(5);
  const auto unit = [&] { return static_cast<double>(engine() >> 11U) * 0x1p-53; };
  std::vector<double> components;
  std::vector<double> means;
  const auto n = static_cast<size_t>(dimensions);
  for (size_t i = 0; i < kPixels; ++i) {
    std::array<std::array<double, 3>, 2> sides{};
    const double turn = unit() * 6.283185307179586;
    const double tilt = dimensions == 3 ? std::acos(2 * unit() - 1) : 0;
    sides[0] = {std::cos(turn) * side, std::sin(turn) * side, 0};
    sides[1] = {-std::sin(turn) * std::cos(tilt) * side, std::cos(turn) * std::cos(tilt) * side,
                std::sin(tilt) * side};
    const std::array<double, 3> middle{unit() * 200 - 100, unit() * 200 - 100, unit() * 200 - 100};
    const auto at = [&](double x, double y) {
      Place place{};
      for (size_t k = 0; k < n; ++k)
        place[k] = static_cast<float>(middle[k] + x * sides[0][k] + y * sides[1][k]);
      return place;
    };
    double mean = 0;
    for (int y = 0; y < 8; ++y) {
      for (int x = 0; x < 8; ++x) mean += value(at((x + 0.5) / 8 - 0.5, (y + 0.5) / 8 - 0.5)) / 64;
    }
    means.push_back(mean);
    for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
      const Place place = at(x, y);
      components.insert(components.end(), place.begin(), place.begin() + dimensions);
    }
  }
  const Arguments arguments{{dimensions == 2 ? "texcoord" : "position", components}};
  const auto plain = runNode<float>(form, arguments, 4 * kPixels, {}, true)[0];
  const auto filtered = runNode<float>(form, arguments, 4 * kPixels, "filtered", true)[0];
  Errors errors;
  for (size_t i = 0; i < kPixels; ++i) {
    errors.plain += std::pow(plain[4 * i] - means[i], 2);
    errors.filtered += std::pow(filtered[4 * i] - means[i], 2);
    errors.mean += means[i] * means[i];
  }
  for (double* sum : {&errors.plain, &errors.filtered, &errors.mean}) *sum = std::sqrt(*sum / kPixels);
  std::cout << fmt::format("{:18} side {:4}: RMS {:.4f} plain, {:.4f} filtered, {:.4f} of 0\n", form, side,
                           errors.plain, errors.filtered, errors.mean);
  return errors;
}

double noise2(const Place& place) { return noise(2, 1, place)[0]; }
double noise3(const Place& place) { return noise(3, 1, place)[0]; }
double fractal2(const Place& place) { return fractal(2, 1, place, 3, 2, 0.5)[0]; }
double fractal3(const Place& place) { return fractal(3, 1, place, 3, 2, 0.5)[0]; }

struct Kind {
  const char* form;
  int dimensions;
  double (*value)(const Place&);
};
constexpr Kind kKinds[] = {{"noise2d<float>", 2, noise2},
                           {"noise3d<float>", 3, noise3},
                           {"fractal2d<float>", 2, fractal2},
                           {"fractal3d<float>", 3, fractal3}};

TEST(Filtered, NoiseIsNearerToThePixelsMean) {
  for (const double side : {0.25, 0.5, 1.0, 2.0, 4.0}) {
    for (const auto& [form, dimensions, value] : kKinds) {
      const Errors errors = errorsOf(form, dimensions, side, value);
      EXPECT_LT(errors.filtered, 0.66 * errors.plain) << form << ' ' << side;
      // No worse than nothing at all.
      EXPECT_LT(errors.filtered, 1.02 * errors.mean) << form << ' ' << side;
    }
  }
}

TEST(Filtered, WhatIsAsCoarseAsPixelsStays) {
  const auto places = somePlaces(400, 2, 100, 12);
  const Arguments arguments{{"texcoord", componentsOf(places, 2)}};
  // Without neighbours every derivative is 0.
  for (const char* form : {"noise2d<vec4>", "fractal2d<vec2>", "fractal2d<vec4>"})
    EXPECT_EQ(runNode<float>(form, arguments, 400)[0], runNode<float>(form, arguments, 400, "filtered")[0])
        << form;
}

}  // namespace
}  // namespace lacquer::test::filter_test
