// OpenEXR as `lacquer bake` writes it, read again by the reader of pictures.
#include <gtest/gtest.h>

#include "bake/image.h"
#include "environment/panorama.h"

namespace lacquer::test {
namespace {

#ifdef LACQUER_OPENEXR
TEST(BakedOpenExr, readsBack) {
  baking::Image image{5, {}};
  for (uint32_t i = 0; i < 25; ++i) {
    const auto x = static_cast<float>(i);
    image.texels.push_back({x / 4, 100 * x, 1 / (x + 1), 0.5F});
  }
  for (const bool mips : {false, true}) {
    const std::vector<baking::Image> levels = mips ? baking::withLevels(image) : std::vector{image};
    EXPECT_EQ(levels.size(), mips ? 3U : 1U);
    for (const uint32_t bits : {16U, 32U}) {
      const Result<std::string> file = baking::openExrOf(levels, bits);
      ASSERT_TRUE(file);
      const Result<environment::Panorama> read =
          environment::readOpenExr(*file, 1000, {"baked.exr", 0, 0, {}});
      ASSERT_TRUE(read);
      ASSERT_EQ(read->width, 5U);
      ASSERT_EQ(read->height, 5U);
      for (size_t i = 0; i < 25; ++i) {
        for (size_t c = 0; c < 3; ++c) {
          const float expected = image.texels[i][c];
          // A half has eleven bits.
          EXPECT_NEAR(read->texels[i][c], expected, bits == 32 ? 0 : expected / 2048) << i;
        }
      }
      EXPECT_EQ(*file, *baking::openExrOf(levels, bits));
    }
  }
}
#endif

TEST(BakedLevels, keepTheMean) {
  baking::Image image{6, std::vector<std::array<float, 4>>(36)};
  for (size_t i = 0; i < 36; ++i) image.texels[i] = {static_cast<float>(i * i), 0, 0, 1};
  const std::vector<baking::Image> levels = baking::withLevels(image);
  ASSERT_EQ(levels.size(), 3U);
  EXPECT_EQ(levels[1].size, 3U);
  for (const baking::Image& level : levels) {
    double sum = 0;
    for (const auto& texel : level.texels) sum += texel[0];
    EXPECT_NEAR(sum / static_cast<double>(level.texels.size()), 35.0 * 71 / 6, 1e-3);
    EXPECT_NEAR(level.texels[0][3], 1, 1e-6);
  }
}

}  // namespace
}  // namespace lacquer::test
