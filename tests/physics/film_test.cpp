// The nodes of the thin film against the text of KHR_materials_iridescence, and its readings.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "physics/film_reference.h"
#include "physics/node_values.h"

namespace lacquer::physics::film_test {
namespace {

struct Film {
  double cosine = 1;
  Vec3 dielectric{0.04, 0.04, 0.04}, metal{0.5, 0.5, 0.5};
  double ior = 1.3, thickness = 400;
};

/// Cosines, reflectances, indices and thicknesses all over their ranges, ends included now and then.
std::vector<Film> randomFilms(size_t count, uint64_t seed) {
  Random random(seed);
  const auto edged = [&](double lo, double hi) {
    const double kind = uniform(random);
    return kind < 0.03 ? lo : kind < 0.06 ? hi : uniform(random, lo, hi);
  };
  std::vector<Film> films(count);
  for (Film& f : films) {
    f.cosine = edged(0, 1);
    for (double& x : f.metal) x = edged(0, 1);
    const double grey = std::pow(edged(0, 1), 3);
    f.dielectric = {grey, grey, grey};
    const double kind = uniform(random);
    f.ior = kind < 0.8 ? edged(1, 3) : kind < 0.9 ? std::exp(uniform(random, 0, 20)) : 1.33;
    f.thickness = kind < 0.8 ? edged(0, 1200) : std::exp(uniform(random, 0, std::log(1e6)));
  }
  return films;
}

eval::Columns columnsOf(const std::vector<Film>& films) {
  std::vector<double> cosine, dielectric, grey, metal, ior, thickness;
  for (const Film& f : films) {
    cosine.push_back(f.cosine);
    grey.push_back(f.dielectric[0]);
    dielectric.insert(dielectric.end(), f.dielectric.begin(), f.dielectric.end());
    metal.insert(metal.end(), f.metal.begin(), f.metal.end());
    ior.push_back(f.ior);
    thickness.push_back(f.thickness);
  }
  return {{"cosine", eval::Column::perPoint(1, cosine)},
          {"F0", eval::Column::perPoint(3, metal)},
          {"metal_F0", eval::Column::perPoint(3, metal)},
          {"dielectric_F0", eval::Column::perPoint(3, dielectric)},
          {"ior", eval::Column::perPoint(1, ior)},
          {"thickness", eval::Column::perPoint(1, thickness)}};
}

template <class T>
std::vector<std::vector<T>> valuesOf(const std::string& node, const std::vector<Film>& films,
                                     const std::string& variant = {}) {
  eval::Columns columns = columnsOf(films);
  if (node == "film_fresnel_pair_grey") {
    std::vector<double> grey;
    for (const Film& f : films) grey.push_back(f.dielectric[0]);
    columns["dielectric_F0"] = eval::Column::perPoint(1, grey);
  }
  return nodeValues<T>(node, variant, columns, films.size());
}

/// The metal under the film.
Vec3 filmOf(const Film& film) {
  const std::vector<double> value = valuesOf<double>("film_fresnel", {film})[0];
  return {value[0], value[1], value[2]};
}

double scalarOf(const std::string& node, const eval::Columns& columns) {
  return nodeValues<double>(node, {}, columns, 1)[0][0];
}

double weightOf(double factor, double thickness, double texel = 1) {
  return scalarOf("film_weight", {{"factor", eval::Column::constant({factor})},
                                  {"thickness", eval::Column::constant({thickness})},
                                  {"texel", eval::Column::constant({texel})}});
}

double thicknessOf(double minimum, double maximum, double texel = 1) {
  return scalarOf("film_thickness", {{"minimum", eval::Column::constant({minimum})},
                                     {"maximum", eval::Column::constant({maximum})},
                                     {"texel", eval::Column::constant({texel})}});
}

double farthest(const Vec3& a, const Vec3& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

double schlickOf(double F0, double cosine) { return F0 + (1 - F0) * std::pow(1 - cosine, 5); }

template <class T>
double worstOf(const std::string& variant, const std::vector<Film>& films) {
  const std::vector<T> actual = valuesOf<T>("film_fresnel", films, variant)[0];
  double worst = 0;
  for (size_t i = 0; i < films.size(); ++i) {
    const Film& f = films[i];
    const Vec3 expected = filmFresnel(f.cosine, f.metal, f.ior, f.thickness);
    for (size_t c = 0; c < 3; ++c)
      worst = std::max(worst, std::abs(expected[c] - static_cast<double>(actual[3 * i + c])));
  }
  return worst;
}

TEST(Film, DoubleAgreesWithTheText) {
  const double worst = worstOf<double>("", randomFilms(100000, 1));
  // Squares and fourth powers of what the text takes the exponential and the cosine of again.
  EXPECT_LT(worst, 1e-12);
  fmt::print("worst error in double {:.2e}\n", worst);
}

/// The cosine of up to 225 radians, each rounded, is off by 1e-5, but its Gaussian is 1e-19 there.
TEST(Film, FloatAgreesWithTheText) {
  std::vector<Film> films = randomFilms(100000, 2);
  for (Film& f : films) {
    for (double* x : {&f.cosine, &f.metal[0], &f.metal[1], &f.metal[2], &f.ior, &f.thickness})
      *x = static_cast<double>(static_cast<float>(*x));
  }
  const double worst = worstOf<float>("", films);
  EXPECT_LT(worst, 2e-5);
  fmt::print("worst error in float {:.2e}\n", worst);
}

TEST(Film, APairIsTwoFilms) {
  const std::vector<Film> films = randomFilms(2000, 3);
  const std::vector<std::vector<double>> pair = valuesOf<double>("film_fresnel_pair", films);
  const std::vector<std::vector<double>> grey = valuesOf<double>("film_fresnel_pair_grey", films);
  for (size_t i = 0; i < films.size(); ++i) {
    const Film& f = films[i];
    const Vec3 dielectric = filmFresnel(f.cosine, f.dielectric, f.ior, f.thickness);
    const Vec3 metal = filmFresnel(f.cosine, f.metal, f.ior, f.thickness);
    for (size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(pair[0][3 * i + c], dielectric[c], 1e-11);
      EXPECT_NEAR(pair[1][3 * i + c], metal[c], 1e-11);
      EXPECT_NEAR(grey[0][3 * i + c], dielectric[c], 1e-11);
      EXPECT_NEAR(grey[1][3 * i + c], metal[c], 1e-11);
    }
  }
}

/// What the comments of the variants say, for films of 1000 nm and indices up to 3.
TEST(Film, VariantsAreOffByWhatTheySay) {
  std::vector<Film> films = randomFilms(100000, 4);
  std::erase_if(films, [](const Film& f) { return f.ior > 3 || f.thickness > 1000; });
  const double three_waves = worstOf<double>("three_waves", films);
  const double one_order = worstOf<double>("one_order", films);
  fmt::print("three_waves {:.3f}, one_order {:.3f}\n", three_waves, one_order);
  EXPECT_LT(three_waves, 0.05);
  EXPECT_GT(three_waves, 0.03);
  EXPECT_LT(one_order, 0.35);
  EXPECT_GT(one_order, 0.2);
}

TEST(Film, ThicknessIsBetweenItsEnds) {
  EXPECT_DOUBLE_EQ(thicknessOf(100, 400), 400);  // without a texture the maximum
  EXPECT_DOUBLE_EQ(thicknessOf(100, 400, 0), 100);
  EXPECT_DOUBLE_EQ(thicknessOf(100, 400, 0.25), 175);
  EXPECT_DOUBLE_EQ(thicknessOf(400, 100, 0.25), 325);  // the minimum may exceed the maximum
  EXPECT_DOUBLE_EQ(thicknessOf(0, 1e9, 1), 1e6);       // more than a millimetre is a millimetre
}

// Beyond the first millimetre nothing changes: the waves are gone.
TEST(Film, ThickFilmsHaveNoWaves) {
  const Film thick{0.6, {}, {0.9, 0.5, 0.1}, 1.3, 1e6};
  EXPECT_LT(farthest(filmOf(thick), filmFresnel(0.6, thick.metal, 1.3, 1e9)), 1e-12);
  EXPECT_LT(farthest(filmOf(thick), filmFresnel(0.6, thick.metal, 1.3, 3e4)), 1e-12);
}

// White metal is no special case: the text's guard alone has no finite index there.
TEST(Film, WhiteMetal) {
  for (double thickness = 50; thickness < 1000; thickness += 50) {
    Film film{0.7, {}, {1, 1, 1}, 1.3, thickness};
    const Vec3 white = filmOf(film);
    film.metal = {0.999, 0.999, 0.999};
    EXPECT_LT(farthest(white, filmOf(film)), 0.01) << thickness;
    film.metal = {0.9998, 0.9998, 0.9998};
    EXPECT_LT(farthest(white, filmOf(film)), 1e-12) << thickness;
  }
  FilmReadings text;
  text.bounded_guard = false;
  const double just_below = 1 - 0.0001;
  EXPECT_FALSE(std::abs(filmFresnel(0.7, {1, 1, 1}, 1.3, 400, text)[0] -
                        filmFresnel(0.7, {just_below, just_below, just_below}, 1.3, 400, text)[0]) < 1e-12);
}

// The text bounds the sum from below alone: it passes 1, and the least of it is below 0.
TEST(Film, StaysWithinOne) {
  const std::vector<Film> films = randomFilms(100000, 5);
  const std::vector<double> values = valuesOf<double>("film_fresnel", films)[0];
  FilmReadings text;
  text.bounded_sum = false;
  double most = 0;
  for (size_t i = 0; i < films.size(); ++i) {
    const Film& f = films[i];
    const Vec3 free = filmFresnel(f.cosine, f.metal, f.ior, f.thickness, text);
    for (size_t c = 0; c < 3; ++c) {
      ASSERT_GE(values[3 * i + c], 0);
      ASSERT_LE(values[3 * i + c], 1);
      most = std::max(most, free[c]);
    }
  }
  EXPECT_GT(most, 1.1);
}

// The text's sum of a film of no thickness is not the base's reflectance; its weight is 0.
TEST(Film, WithoutAThicknessThereIsNone) {
  const Vec3 none = filmOf({1, {}, {0.04, 0.04, 0.04}, 1.3, 0});
  EXPECT_NEAR(none[0], 0.0438, 5e-5);
  EXPECT_NEAR(none[1], 0.0392, 5e-5);
  EXPECT_NEAR(none[2], 0.0385, 5e-5);
  EXPECT_EQ(weightOf(1, 0), 0);
  EXPECT_EQ(weightOf(0.8, 0.1), 0.8);
  EXPECT_EQ(weightOf(0.8, 400), 0.8);
  EXPECT_EQ(weightOf(0.8, 400, 0.5), 0.4);
  EXPECT_NEAR(weightOf(1, 0.05), 0.5, 1e-12);  // without a step
}

// An index of 1 is what the text makes of it.
TEST(Film, AnIndexOfOneIsNotNeutral) {
  const Vec3 film = filmOf({0.1, {}, {0.04, 0.04, 0.04}, 1, 400});
  EXPECT_NEAR(film[0], 1.0, 0.01);
  EXPECT_NEAR(schlickOf(0.04, 0.1), 0.607, 1e-3);
}

// Where the film's index lies between those of the base's colours, some waves are turned over and some not.
TEST(Film, TurnsGoToTheWaves) {
  FilmReadings other;
  other.turns_of_waves = false;
  const Film film{0.8, {}, {0.3, 0.02, 0.02}, 1.6, 500};
  const Vec3 by_waves = filmFresnel(film.cosine, film.metal, film.ior, film.thickness);
  const Vec3 by_colors = filmFresnel(film.cosine, film.metal, film.ior, film.thickness, other);
  EXPECT_LT(farthest(filmOf(film), by_waves), 1e-12);
  EXPECT_GT(farthest(by_colors, by_waves), 0.02);
}

}  // namespace
}  // namespace lacquer::physics::film_test
