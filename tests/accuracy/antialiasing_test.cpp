// What specular_antialiasing takes off; a part of the test of the documents, whose table has the same
// numbers.
#include <gtest/gtest.h>

#include "accuracy/antialiasing.h"

namespace lacquer::accuracy {
namespace {

/// Where it does not help nothing gets worse; the lobes of a map's taps are near the mean.
TEST(SpecularAntialiasing, IsNearerToTheMeanOfAPixel) {
  constexpr std::array kWith = {0.9, 0.95, 0.95, 1.02}, kMappedWith = {0.99, 1.07, 1.02, 0.98};
  constexpr std::array kLobes = {0.65, 1.02, 1.02, 1.02}, kMappedLobes = {0.3, 0.34, 0.42, 0.56};
  for (const Bumpy& material : bumpyMaterials()) {
    for (size_t i = 0; i < 4; ++i) {
      const Aliasing& errors = aliasing(material, distancesOf(material)[i]);
      EXPECT_LT(errors.with / errors.without, (material.mapped ? kMappedWith : kWith)[i])
          << material.name << " " << i;
      EXPECT_LT(errors.lobes / errors.without, (material.mapped ? kMappedLobes : kLobes)[i])
          << material.name << " " << i;
    }
  }
}

}  // namespace
}  // namespace lacquer::accuracy
