// The noises of nodes/standard/ against their published definitions, in float and in double.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "patterns/run.h"

namespace lacquer::test::patterns_test {
namespace {

constexpr size_t kPoints = 100000;
constexpr double kAllowed = 1e-5;
const char* const kTypes[] = {"float", "vec2", "vec3", "vec4"};

std::string place(int dimensions) { return dimensions == 2 ? "texcoord" : "position"; }

/// How far results are from what they should be, at most; what is no number is far.
struct Farthest {
  double by = 0;
  std::string where;

  void take(double got, double expected, const Place& at, int dimensions) {
    const double off = std::abs(got - expected);
    if (off <= by) return;
    by = std::isnan(off) ? std::numeric_limits<double>::infinity() : off;
    where = fmt::format("({}, {}, {}) in {}: {} is not {}", at[0], at[1], at[2], dimensions, got, expected);
  }
};

class InBoth : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Dimensions, InBoth, testing::Values(2, 3));

TEST(Hash, TheReferenceIsLookup3) {
  // The values that Jenkins' lookup3.c prints.
  EXPECT_EQ(hashOfText("Four score and seven years ago", 0), 0x17770551U);
  EXPECT_EQ(hashOfText("Four score and seven years ago", 1), 0xcd628161U);
}

TEST(Hash, ShortOnesHaveTheLowBitsOfTheComplement) {
  constexpr size_t kWords = 10000;
  std::mt19937 random(3);
  Arguments words;
  for (size_t i = 0; i < kWords; ++i) {
    for (const char* word : {"x", "y", "not_z"})
      words[word].push_back(i == 0 ? 0xffffffffU : static_cast<uint32_t>(random()));
  }
  const auto all = runNode<double>("hash_final", words, kWords)[0];
  const auto low = runNode<double>("hash_final_24", words, kWords)[0];
  const auto least = runNode<double>("hash_final_6", words, kWords)[0];
  for (size_t i = 0; i < kWords; ++i) {
    const uint32_t complement = ~static_cast<uint32_t>(all[i]);
    EXPECT_EQ(complement & 0xffffffU, static_cast<uint32_t>(low[i]) & 0xffffffU);
    EXPECT_EQ(complement & 63U, static_cast<uint32_t>(least[i]) & 63U);
  }
}

TEST_P(InBoth, NoiseIsTheDefinitions) {
  const int n = GetParam();
  const auto places = somePlaces(kPoints, n, 1e9F, 1);
  for (int channels = 1; channels <= 4; ++channels) {
    const auto got = runNode<float>(fmt::format("noise{}d<{}>", n, kTypes[channels - 1]),
                                    {{place(n), componentsOf(places, n)}}, kPoints)[0];
    Farthest farthest;
    for (size_t i = 0; i < kPoints; ++i) {
      const auto expected = noise(n, channels, places[i]);
      for (int c = 0; c < channels; ++c)
        farthest.take(got[i * static_cast<size_t>(channels) + static_cast<size_t>(c)],
                      expected[static_cast<size_t>(c)], places[i], n);
    }
    EXPECT_LT(farthest.by, kAllowed) << channels << " channels at " << farthest.where;
  }
}

TEST_P(InBoth, AmplitudeAndPivotAreTheDefinitions) {
  const int n = GetParam();
  const auto places = somePlaces(1000, n, 100, 2);
  const auto got = runNode<double>(
      fmt::format("noise{}d<vec2>", n),
      {{place(n), componentsOf(places, n)}, {"amplitude", {2, -3}}, {"pivot", {0.25}}}, 1000)[0];
  for (size_t i = 0; i < 1000; ++i) {
    const auto expected = noise(n, 2, places[i]);
    EXPECT_NEAR(got[2 * i], 0.25 + 2 * expected[0], kAllowed);
    EXPECT_NEAR(got[2 * i + 1], 0.25 - 3 * expected[1], kAllowed);
  }
}

TEST_P(InBoth, FractalIsTheDefinitions) {
  const int n = GetParam();
  constexpr size_t kFewer = kPoints / 4;
  const auto places = somePlaces(kFewer, n, 1e4F, 3);
  for (int channels = 1; channels <= 4; ++channels) {
    for (const auto& [octaves, lacunarity, diminish] :
         {std::tuple{3, 2.0F, 0.5F}, {5, 1.75F, -0.75F}, {0, 2.0F, 0.5F}}) {
      const auto got = runNode<float>(fmt::format("fractal{}d<{}>", n, kTypes[channels - 1]),
                                      {{place(n), componentsOf(places, n)},
                                       {"octaves", {double(octaves)}},
                                       {"lacunarity", {lacunarity}},
                                       {"diminish", {diminish}}},
                                      kFewer)[0];
      Farthest farthest;
      for (size_t i = 0; i < kFewer; ++i) {
        const auto expected = fractal(n, channels, places[i], octaves, lacunarity, diminish);
        for (int c = 0; c < channels; ++c)
          farthest.take(got[i * static_cast<size_t>(channels) + static_cast<size_t>(c)],
                        expected[static_cast<size_t>(c)], places[i], n);
      }
      EXPECT_LT(farthest.by, kAllowed)
          << channels << " channels, " << octaves << " octaves at " << farthest.where;
    }
  }
}

TEST_P(InBoth, OctavesAreBounded) {
  const int n = GetParam();
  const auto places = somePlaces(200, n, 100, 4);
  const auto octaves = [&](double count) {
    return runNode<float>(fmt::format("fractal{}d<float>", n),
                          {{place(n), componentsOf(places, n)}, {"octaves", {count}}}, 200)[0];
  };
  EXPECT_EQ(octaves(1000000000), octaves(32));
  EXPECT_EQ(octaves(-1000000000), octaves(0));
  EXPECT_EQ(octaves(0), std::vector<float>(200));
  // One for each point.
  std::vector<double> counts;
  for (int i = 0; i < 200; ++i) counts.push_back(i % 7 - 2);
  const auto each = octaves(3);
  const auto got = runNode<float>(fmt::format("fractal{}d<float>", n),
                                  {{place(n), componentsOf(places, n)}, {"octaves", counts}}, 200)[0];
  for (size_t i = 0; i < 200; ++i) {
    const auto expected = fractal(n, 1, places[i], std::max(static_cast<int>(counts[i]), 0), 2, 0.5);
    EXPECT_NEAR(got[i], expected[0], kAllowed);
  }
  EXPECT_EQ(got[5], each[5]);
}

TEST_P(InBoth, CellNoiseIsTheDefinitions) {
  const int n = GetParam();
  const auto places = somePlaces(kPoints, n, 2e9F, 5);
  const auto got =
      runNode<float>(fmt::format("cellnoise{}d", n), {{place(n), componentsOf(places, n)}}, kPoints)[0];
  for (size_t i = 0; i < kPoints; ++i)
    ASSERT_EQ(got[i], static_cast<float>(cellNoise(n, places[i]))) << places[i][0] << ' ' << places[i][1];
}

TEST_P(InBoth, WorleyNoiseIsTheDefinitions) {
  const int n = GetParam();
  const size_t points = n == 2 ? kPoints / 2 : kPoints / 5;
  const auto places = somePlaces(points, n, 1e9F, 6);
  for (const auto& [metric, jitter] :
       {std::pair{0, 1.0}, {0, 0.3}, {0, 2.5}, {0, 0.0}, {1, 1.0}, {2, 1.0}, {3, 1.0}, {3, 2.5}}) {
    std::vector<Worley> expected;
    for (const Place& place : places) expected.push_back(worley(n, place, jitter, metric));
    for (int channels = 1; channels <= 3; ++channels) {
      const Arguments arguments{
          {place(n), componentsOf(places, n)}, {"jitter", {jitter}}, {"metric", {double(metric)}}};
      const auto got =
          runNode<float>(fmt::format("worleynoise{}d<{}>", n, kTypes[channels - 1]), arguments, points)[0];
      Farthest farthest;
      for (size_t i = 0; i < got.size(); ++i) {
        const size_t point = i / static_cast<size_t>(channels);
        farthest.take(got[i], expected[point].distances[i % static_cast<size_t>(channels)], places[point], n);
      }
      EXPECT_LT(farthest.by, kAllowed)
          << "metric " << metric << ", jitter " << jitter << " at " << farthest.where;
    }
  }
}

TEST_P(InBoth, SolidWorleyNoiseIsTheDefinitions) {
  const int n = GetParam();
  const size_t points = kPoints / 4;
  const auto places = somePlaces(points, n, 1000, 7);
  size_t compared = 0;
  for (int channels = 1; channels <= 3; ++channels) {
    const auto got =
        runNode<float>(fmt::format("worleynoise{}d<{}>", n, kTypes[channels - 1]),
                       {{place(n), componentsOf(places, n)}, {"jitter", {0.9}}, {"style", {1}}}, points)[0];
    for (size_t i = 0; i < points; ++i) {
      const Worley expected = worley(n, places[i], 0.9F, 0);
      if (expected.margin < 1e-4) continue;  // rounding decides there
      ++compared;
      for (int c = 0; c < channels; ++c) {
        const double right = channels == 1 ? expected.number : expected.numbers[static_cast<size_t>(c)];
        ASSERT_EQ(got[i * static_cast<size_t>(channels) + static_cast<size_t>(c)], static_cast<float>(right))
            << places[i][0] << ' ' << places[i][1] << ' ' << places[i][2];
      }
    }
  }
  EXPECT_GT(compared, points * 3 * 95 / 100);
}

TEST(Flake, IsTheDefinitions) {
  constexpr size_t kFlakes = 20000;
  const auto places = somePlaces(kFlakes, 3, 10, 8);
  for (const double coverage : {0.5, 1.0, 0.0}) {
    const auto got = runNode<float>("flake3d",
                                    {{"position", componentsOf(places, 3)},
                                     {"size", {0.25}},
                                     {"roughness", {0.5}},
                                     {"coverage", {coverage}}},
                                    kFlakes);
    size_t found = 0;
    size_t compared = 0;
    for (size_t i = 0; i < kFlakes; ++i) {
      const Flake expected = flake(places[i], 0.25, 0.5, coverage);
      if (expected.margin < 1e-4) continue;
      ++compared;
      found += expected.presence > 0 ? 1 : 0;
      ASSERT_EQ(got[2][i], static_cast<float>(expected.presence))
          << places[i][0] << ' ' << places[i][1] << ' ' << places[i][2];
      ASSERT_EQ(got[1][i], static_cast<float>(expected.rand));
      ASSERT_NEAR(got[0][i], expected.id, 1);
      for (size_t k = 0; k < 3; ++k) ASSERT_NEAR(got[3][3 * i + k], expected.normal[k], 1e-4);
    }
    EXPECT_GT(compared, kFlakes / 2);
    EXPECT_EQ(found == 0, coverage == 0);
    EXPECT_EQ(found > compared * 9 / 10, coverage == 1);
  }
}

TEST(Random, NumbersAndColorsAreTheDefinitions) {
  std::vector<double> numbers;
  std::vector<double> wholes;
  for (int i = -500; i < 500; ++i) {
    numbers.push_back(static_cast<float>(i * 0.37));
    wholes.push_back(i * 4000000.0);
  }
  const auto got = runNode<float>("randomfloat<float>",
                                  {{"in", numbers}, {"min", {-2}}, {"max", {3}}, {"seed", {17}}}, 1000)[0];
  const auto of_wholes = runNode<float>("randomfloat<int>", {{"in", wholes}, {"seed", {-5}}}, 1000)[0];
  for (size_t i = 0; i < 1000; ++i) {
    const float scaled = static_cast<float>(numbers[i]) * 4096;
    EXPECT_NEAR(got[i], -2 + 5 * cellNoise(2, {scaled, 17, 0}), kAllowed);
    EXPECT_NEAR(of_wholes[i], cellNoise(2, {static_cast<float>(wholes[i]), -5, 0}), kAllowed);
  }
  const auto colors = runNode<float>(
      "randomcolor<float>",
      {{"in", numbers}, {"seed", {2}}, {"brightnesslow", {0.5}}, {"saturationlow", {0.25}}}, 1000)[0];
  for (size_t i = 0; i < 1000; ++i) {
    const float scaled = static_cast<float>(numbers[i]) * 4096;
    const auto number = [&](float seed) { return cellNoise(2, {scaled, seed, 0}); };
    const double h = 6 * (number(416) - std::floor(number(416)));
    const double s = 0.25 + 0.75 * number(1525);
    const double v = 0.5 + 0.5 * number(1816);
    const double f = h - std::floor(h);
    const double p = v * (1 - s);
    const double q = v * (1 - s * f);
    const double t = v * (1 - s * (1 - f));
    const double sextants[6][3] = {{v, t, p}, {q, v, p}, {p, v, t}, {p, q, v}, {t, p, v}, {v, p, q}};
    for (size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(colors[3 * i + k], sextants[static_cast<size_t>(h)][k], kAllowed);
  }
}

TEST(Unified, KindsAreTheNodes) {
  constexpr size_t kFew = 2000;
  const auto places = somePlaces(kFew, 3, 100, 9);
  const Arguments at3{{"position", componentsOf(places, 3)}};
  const auto kind = [&](double type) {
    Arguments arguments = at3;
    arguments["type"] = {type};
    arguments["clampoutput"] = {0};
    return runNode<float>("unifiednoise3d", arguments, kFew)[0];
  };
  const auto perlins = kind(0);
  const auto cells = kind(1);
  const auto worleys = kind(2);
  const auto fractals = kind(3);
  EXPECT_EQ(kind(-1), perlins);
  EXPECT_EQ(kind(4), std::vector<float>(kFew));
  for (size_t i = 0; i < kFew; ++i) {
    EXPECT_NEAR(perlins[i], 0.5 + 0.5 * noise(3, 1, places[i])[0], kAllowed);
    EXPECT_NEAR(cells[i], cellNoise(3, places[i]), kAllowed);
    EXPECT_NEAR(worleys[i], worley(3, places[i], 1, 0).distances[0], kAllowed);
    EXPECT_NEAR(fractals[i], fractal(3, 1, places[i], 3, 2, 0.5)[0], kAllowed);
  }
  // In the plane the fractal is that of space, and where cells are turned is what the jitter says.
  const auto plane = runNode<double>("unifiednoise2d",
                                     {{"texcoord", componentsOf(places, 2)},
                                      {"type", {3}},
                                      {"jitter", {0.999}},
                                      {"outmin", {-1}},
                                      {"outmax", {2}}},
                                     kFew)[0];
  for (size_t i = 0; i < kFew; ++i) {
    const double value =
        fractal(3, 1, {places[i][0], places[i][1], static_cast<float>((0.999 - 1) * 90000)}, 3, 2, 0.5)[0];
    EXPECT_NEAR(plane[i], std::clamp(-1 + 3 * value, -1.0, 2.0), 1e-3);
  }
}

}  // namespace
}  // namespace lacquer::test::patterns_test
