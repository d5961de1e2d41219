// What holds of every distribution, and of every table.
#include "photometry/distribution.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "lacquer.h"

namespace lacquer::test {
namespace {

using photometry::Distribution;
using photometry::Measured;
using photometry::Symmetry;
using photometry::Table;
using photometry::Vec3;
using photometry::Web;

Measured measured(Web web, std::vector<double> vertical, std::vector<double> horizontal,
                  const std::function<double(double vertical, double horizontal)>& candela) {
  Measured made{"", web, std::move(vertical), std::move(horizontal), {}};
  for (const double h : made.horizontal) {
    for (const double v : made.vertical) made.candela.push_back(candela(v, h));
  }
  return made;
}

std::vector<double> steps(double from, double to, size_t count) {
  std::vector<double> all;
  for (size_t i = 0; i <= count; ++i)
    all.push_back(from + (to - from) * static_cast<double>(i) / static_cast<double>(count));
  return all;
}

/// Uneven ones.
std::vector<double> uneven(double from, double to) {
  std::vector<double> all;
  for (const double t : {0.0, 0.05, 0.1, 0.2, 0.45, 0.5, 0.8, 1.0}) all.push_back(from + (to - from) * t);
  return all;
}

/// The same integral by a sum over small parts of the sphere.
double summed(const Distribution& of) {
  constexpr int kParts = 400;
  double sum = 0;
  for (int i = 0; i < kParts; ++i) {
    const double z = -1 + (2 * i + 1.0) / kParts;
    for (int j = 0; j < 2 * kParts; ++j) {
      const double turn = M_PI * (j + 0.5) / kParts;
      const double ring = std::sqrt(1 - z * z);
      sum += of.at({ring * std::cos(turn), ring * std::sin(turn), z});
    }
  }
  return sum * 4 * M_PI / (2.0 * kParts * kParts);
}

double wavy(double v, double h) {
  return 100 + 40 * std::sin(0.05 * v) + 30 * std::cos(h * (M_PI / 180) + 1);
}

/// All ranges of angles that the standards have.
std::vector<Measured> everyKind(const std::function<double(double, double)>& shape = wavy) {
  std::vector<Measured> all;
  for (const double last : {0.0, 90.0, 180.0, 360.0}) {
    all.push_back(
        measured(Web::C, uneven(0, 180), last == 0 ? std::vector<double>{0} : uneven(0, last), shape));
    all.push_back(
        measured(Web::C, uneven(0, 90), last == 0 ? std::vector<double>{0} : uneven(0, last), shape));
  }
  all.push_back(measured(Web::C, uneven(90, 180), uneven(90, 270), shape));
  for (const Web web : {Web::B, Web::A}) {
    for (const double v : {-90.0, 0.0}) {
      for (const double h : {-90.0, 0.0}) all.push_back(measured(web, uneven(v, 90), uneven(h, 90), shape));
    }
  }
  return all;
}

TEST(Distribution, AUniformOneHasFourPiLumensPerCandela) {
  const auto seven = [](double, double) { return 7.0; };
  EXPECT_NEAR(Distribution(measured(Web::C, {0, 180}, {0}, seven)).lumens(), 4 * M_PI * 7, 1e-9);
  EXPECT_NEAR(Distribution(measured(Web::C, uneven(0, 180), uneven(0, 90), seven)).lumens(), 4 * M_PI * 7,
              1e-9);
  EXPECT_NEAR(Distribution(measured(Web::C, uneven(0, 90), uneven(90, 270), seven)).lumens(), 2 * M_PI * 7,
              1e-9);
  for (const Web web : {Web::A, Web::B}) {
    EXPECT_NEAR(Distribution(measured(web, {-90, 90}, {-90, 90}, seven)).lumens(), 2 * M_PI * 7, 1e-9);
    EXPECT_NEAR(Distribution(measured(web, uneven(0, 90), uneven(0, 90), seven)).lumens(), 2 * M_PI * 7,
                1e-9);
  }
}

/// Half of a sphere's Lambertian light of 1 cd straight on: pi lumens, but for the lines between the angles.
TEST(Distribution, ACosineHasPiLumensPerCandela) {
  const auto cosine = [](double v, double) { return std::cos(v * M_PI / 180); };
  EXPECT_NEAR(Distribution(measured(Web::C, steps(0, 90, 900), {0}, cosine)).lumens(), M_PI, 1e-5);
}

TEST(Distribution, LumensAreTheIntegralOfWhatShines) {
  for (const Measured& one : everyKind()) {
    const Distribution of(one);
    EXPECT_NEAR(of.lumens(), summed(of), 2e-3 * of.lumens())
        << "type "
        << "CBA"[static_cast<int>(one.web)] << ", " << one.vertical.front() << ", " << one.horizontal.back();
  }
}

/// At the file's own angles its own candela, and symmetry where it says so.
TEST(Distribution, HasTheFilesCandelaAtItsAngles) {
  for (const Measured& one : everyKind()) {
    const Distribution of(one);
    const auto direction = [&](double v, double h) -> Vec3 {
      v *= M_PI / 180;
      h *= M_PI / 180;
      if (one.web == Web::C) return {std::sin(v) * std::cos(h), std::sin(v) * std::sin(h), -std::cos(v)};
      if (one.web == Web::B) return {std::cos(h) * std::sin(v), -std::sin(h), -std::cos(h) * std::cos(v)};
      return {std::sin(v), -std::cos(v) * std::sin(h), -std::cos(v) * std::cos(h)};
    };
    for (size_t h = 0; h < one.horizontal.size(); ++h) {
      for (size_t v = 0; v < one.vertical.size(); ++v) {
        const double angle = one.vertical[v], turn = one.horizontal[h];
        // At a pole all turns are one direction, of one of them the candela.
        const double latitude = one.web == Web::B ? turn : angle;
        if (one.web == Web::C ? angle == 0 || angle == 180 : std::abs(latitude) == 90) continue;
        EXPECT_NEAR(of.at(direction(angle, turn)), one.candela[h * one.vertical.size() + v], 1e-4)
            << "type "
            << "CBA"[static_cast<int>(one.web)] << " at " << angle << ", " << turn;
      }
    }
  }
}

TEST(Distribution, NodesAreWhereTheValuesAre) {
  // Alike for all turns, which are one direction at a pole.
  for (const Measured& one : everyKind([](double v, double) { return 100 + 40 * std::sin(0.05 * v); })) {
    const Distribution of(one);
    double most = 0;
    for (size_t i = 0; i < of.nodes(); ++i) most = std::max(most, of.at(of.node(i)));
    EXPECT_NEAR(most, of.peak(), 1e-4);
  }
}

TEST(ProfileTable, IsTheDistributionAtItsTexelsAndNearItBetween) {
  for (const Measured& one : everyKind()) {
    const Distribution of(one);
    const Table table = photometry::tableOf(of, 64, 32);
    ASSERT_EQ(table.texels.size(), 64U * 32U);
    const double error = photometry::errorsOf(table, of).most;
    for (uint32_t y = 0; y < 32; ++y) {
      for (uint32_t x = 0; x < 64; ++x) {
        const double u = (x + 0.5) / 64, v = (y + 0.5) / 32;
        const double exact = of.at(photometry::directionAt(u, v)) / of.peak();
        EXPECT_NEAR(table.texels[size_t{64} * y + x], exact, 1e-6);
        EXPECT_NEAR(photometry::lookUp(table, u, v), exact, 1e-6);
        const double edge = of.at(photometry::directionAt(u + 0.5 / 64, v)) / of.peak();
        EXPECT_LE(std::abs(photometry::lookUp(table, u + 0.5 / 64, v) - edge), error + 1e-9);
      }
    }
  }
}

/// Without edges the error falls with the square of a texel's size where the light is smooth, and with its
/// size where lines meet.
TEST(ProfileTable, IsBetterWhenItIsLarger) {
  const Distribution of(measured(Web::C, steps(0, 180, 36), steps(0, 360, 36), [](double v, double h) {
    return 100 + 50 * std::cos(v * M_PI / 180) + 20 * std::sin(v * M_PI / 180) * std::sin(h * M_PI / 180);
  }));
  const double coarse = photometry::errorsOf(photometry::tableOf(of, 32, 16), of).most;
  const double fine = photometry::errorsOf(photometry::tableOf(of, 256, 128), of).most;
  EXPECT_LT(coarse, 0.02);
  EXPECT_LT(fine, coarse / 4);
  EXPECT_LT(photometry::errorsOf(photometry::tableOf(of, 256, 128), of).mean, fine / 4);
  std::printf("error of a smooth profile: %.2g at 32 x 16, %.2g at 256 x 128\n", coarse, fine);
}

TEST(ProfileTable, OfNothingIsDark) {
  const Distribution of(measured(Web::C, {0, 180}, {0}, [](double, double) { return 0.0; }));
  const Table table = photometry::tableOf(of, 4, 1);
  EXPECT_EQ(table.texels, std::vector<float>(4, 0));
  EXPECT_EQ(photometry::errorsOf(table, of).most, 0);
}

TEST(ProfileTable, OfTheLeastLightIsThatOfAnyOther) {
  const Distribution of(measured(Web::C, {0, 90}, {0}, [](double, double) { return 1e-310; }));
  const Table table = photometry::tableOf(of, 4, 1);
  EXPECT_EQ(table.texels, (std::vector<float>{1, 1, 0, 0}));
}

TEST(Lm63, LineEndsOfAllSystemsAndAMarkInFrontAreAlike) {
  const std::string unix_text =
      "IESNA:LM-63-1995\n[TEST] none\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 10\n0 180\n0\n100 50\n";
  std::string dos, mac;
  for (const char c : unix_text) {
    dos += c == '\n' ? "\r\n" : std::string(1, c);
    mac += c == '\n' ? '\r' : c;
  }
  for (const std::string& text : {unix_text, dos + "\x1A", mac, "\xEF\xBB\xBF" + unix_text,
                                  unix_text.substr(0, unix_text.size() - 1), unix_text + "  \n"}) {
    Diagnostics warnings;
    const auto read = photometry::readLm63(text, {}, warnings);
    ASSERT_TRUE(read) << format(read.error()[0]);
    EXPECT_TRUE(warnings.empty());
    EXPECT_EQ(read->candela, (std::vector<double>{100, 50}));
    EXPECT_EQ(read->standard, "LM-63-1995");
  }
}

/// A file that is cut anywhere is refused, or has no fewer values than it says.
TEST(Lm63, AFileThatIsCutIsRefused) {
  const std::string text =
      "IESNA:LM-63-1995\nTILT=NONE\n1 -1 1 3 2 1 2 0 0 0\n1 1 10\n0 90 180\n0 90\n100 50 25\n10 20 30\n";
  for (size_t length = 0; length + 2 < text.size(); ++length) {
    Diagnostics warnings;
    const auto read = photometry::readLm63(std::string_view(text).substr(0, length), {}, warnings);
    EXPECT_TRUE(!read || length + 3 == text.size()) << length;
    EXPECT_TRUE(read || !read.error().empty());
  }
}

}  // namespace
}  // namespace lacquer::test
