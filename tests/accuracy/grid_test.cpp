// The grid of materials: its walks are those of the file, and `physical` is near to them.
#include <gtest/gtest.h>

#include <cmath>

#include "accuracy/grid.h"
#include "support/cases.h"

namespace lacquer::accuracy {
namespace {

void expectNear(const WalkedSeen& shown, const WalkedSeen& fresh, size_t material, bool& all) {
  const auto near = [&](double file, double mean, double deviation, const char* under) {
    const bool is = std::abs(file - mean) < 5 * deviation + 2e-3 * mean + 1e-4;
    all = all && is;
    EXPECT_TRUE(is || test::blessing()) << "material " << material << " under " << under << ": " << file
                                        << " in the file, " << mean << " now; LACQUER_BLESS=1 renews it";
  };
  for (size_t v = 0; v < kViews; ++v) {
    for (size_t c = 0; c < 3; ++c) {
      for (size_t k = 0; k < kLamps; ++k)
        near(shown.mean.lamps[v][k][c], fresh.mean.lamps[v][k][c], fresh.deviation.lamps[v][k][c], "a lamp");
      near(shown.mean.sky[v][c], fresh.mean.sky[v][c], fresh.deviation.sky[v][c], "the sky");
    }
  }
}

/// Of some materials, by other random numbers.
TEST(Grid, HasTheWalksOfTheFile) {
  bool all = std::filesystem::exists(walksFile());
  ASSERT_TRUE(all || test::blessing()) << walksFile() << " is not there; LACQUER_BLESS=1 makes it";
  if (all) {
    const std::vector<WalkedSeen> shown = readWalks();
    for (size_t i = 7; i < shown.size(); i += 29)
      expectNear(shown[i], walkGrid(gridMaterials()[i], {2000, 4000}, 100000 + i), i, all);
  }
  if (!all && test::blessing()) test::expectFile(walksFile(), walksText());
}

TEST(Grid, PhysicalIsNear) {
  const std::vector<WalkedSeen> walks = readWalks();
  const std::vector<bool> all(walks.size(), true);
  const GridErrors physical = gridErrors(gridOf("physical", gridMaterials()), walks, all);
  EXPECT_LT(physical.lamps, 0.072);
  EXPECT_LT(physical.sky, 0.046);
  EXPECT_LT(physical.lamps_noise, 0.01);
  EXPECT_LT(physical.sky_noise, 0.01);
}

}  // namespace
}  // namespace lacquer::accuracy
