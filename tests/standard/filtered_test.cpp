// The variants that fade what is finer than a pixel, against the mean of 64 by 64 samples of the reference
// over the pixel.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "eval/evaluate.h"
#include "lang/library.h"
#include "prove/nodes.h"

namespace lacquer::test {
namespace {

using Inputs = std::vector<std::pair<std::string, std::vector<double>>>;

/// The first component of the node's result at each place.
std::vector<double> valuesOf(const std::string& name, const std::string& variant, const Inputs& inputs,
                             const std::vector<std::pair<double, double>>& places) {
  static const lang::Library kLibrary = lang::Library::embedded();
  const auto node = kLibrary.node(name);
  EXPECT_TRUE(node) << name;
  if (!node) return {};
  const NodeModule made = nodeModule(**node, variant);
  eval::Bindings bindings;
  bindings.quads = true;
  for (const auto& [input, values] : inputs) {
    eval::Column& column = bindings.columns[input];
    column.components = static_cast<int>(values.size());
    column.per_point = true;
    for (size_t i = 0; i < places.size(); ++i)
      column.values.insert(column.values.end(), values.begin(), values.end());
  }
  eval::Column& column = bindings.columns["texcoord"];
  column.components = 2;
  column.per_point = true;
  for (const auto& [u, v] : places) column.values.insert(column.values.end(), {u, v});
  const std::vector<ir::ValueId> roots = {made.module.outputs[0].value};
  const auto found = eval::evaluate<double>(made.module, roots, bindings, places.size());
  EXPECT_TRUE(found) << name;
  if (!found) return {};
  const size_t width = (*found)[0].size() / places.size();
  std::vector<double> first;
  for (size_t i = 0; i < places.size(); ++i) first.push_back((*found)[0][i * width]);
  return first;
}

struct Error {
  double worst = 0, mean = 0;  ///< of the variant
  double plain = 0,
         rms = 0;  ///< root mean squares of the reference in the middle of a pixel, and of the variant
};

/// How far the variant is from the mean over pixels of that size.
Error errorOf(const std::string& node, const Inputs& inputs, double pixel) {
  constexpr int kSide = 64;
  Error error;
  constexpr int kPlaces = 40;
  for (int k = 0; k < kPlaces; ++k) {
    const double u = 3.7 * std::sin(1.3 * k), v = 2.9 * std::cos(2.1 * k);
    const std::vector<std::pair<double, double>> quad = {
        {u, v}, {u + pixel, v}, {u, v + pixel}, {u + pixel, v + pixel}};
    const double filtered = valuesOf(node, "filtered", inputs, quad)[0];
    std::vector<std::pair<double, double>> samples;
    for (int i = 0; i < kSide * kSide; ++i)
      samples.emplace_back(u + ((i % kSide + 0.5) / kSide - 0.5) * pixel,
                           v + ((i / kSide + 0.5) / kSide - 0.5) * pixel);
    double mean = 0;
    for (const double value : valuesOf(node, {}, inputs, samples)) mean += value / (kSide * kSide);
    const double plain = valuesOf(node, {}, inputs, {{u, v}})[0];
    error.worst = std::max(error.worst, std::abs(filtered - mean));
    error.mean += std::abs(filtered - mean) / kPlaces;
    error.plain += (plain - mean) * (plain - mean) / kPlaces;
    error.rms += (filtered - mean) * (filtered - mean) / kPlaces;
  }
  error.plain = std::sqrt(error.plain);
  error.rms = std::sqrt(error.rms);
  return error;
}

TEST(StandardFiltered, CheckerboardIsTheMeanOfItsPixel) {
  const Inputs inputs = {
      {"color1", {1, 1, 1}}, {"color2", {0, 0, 0}}, {"uvtiling", {1, 1}}, {"uvoffset", {0.2, 0.1}}};
  for (const double pixel : {0.001, 0.1, 0.7, 1.5, 4.3, 60.0}) {
    const Error error = errorOf("checkerboard", inputs, pixel);
    EXPECT_LT(error.worst, 0.03) << pixel;
    EXPECT_LT(error.mean, 0.01) << pixel;
  }
}

TEST(StandardFiltered, GridIsTheMeanOfItsPixel) {
  const Inputs inputs = {
      {"uvtiling", {1, 1}}, {"uvoffset", {0.2, 0.1}}, {"thickness", {0.3}}, {"staggered", {0}}};
  for (const double pixel : {0.001, 0.1, 0.7, 1.5, 2.3}) {
    const Error error = errorOf("grid", inputs, pixel);
    EXPECT_LT(error.worst, 0.03) << pixel;
    EXPECT_LT(error.mean, 0.012) << pixel;
  }
  // Far away 0.3 and 0.7 of each axis make 1 - 0.7 * 0.7.
  EXPECT_NEAR(valuesOf("grid", "filtered", inputs, {{0, 0}, {400, 0}, {0, 400}, {400, 400}})[0], 0.51, 0.005);
}

/// The table of docs/patterns.md.
TEST(StandardFiltered, IsNearerThanThePlain) {
  const Inputs checker = {
      {"color1", {1, 1, 1}}, {"color2", {0, 0, 0}}, {"uvtiling", {1, 1}}, {"uvoffset", {0.2, 0.1}}};
  const Inputs grid = {
      {"uvtiling", {1, 1}}, {"uvoffset", {0.2, 0.1}}, {"thickness", {0.3}}, {"staggered", {0}}};
  for (const double pixel : {0.25, 0.5, 1.0, 2.0, 4.0}) {
    const Error of_checker = errorOf("checkerboard", checker, pixel);
    const Error of_grid = errorOf("grid", grid, pixel);
    std::cout << fmt::format("| {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} |\n", pixel, of_checker.plain,
                             of_checker.rms, of_grid.plain, of_grid.rms);
    EXPECT_LT(of_checker.rms, of_checker.plain / 10) << pixel;
    EXPECT_LT(of_grid.rms, of_grid.plain / 10) << pixel;
  }
}

}  // namespace
}  // namespace lacquer::test
