// Texts that were made to have one XXH3 hash: what is addressed by content must tell them apart.
#include <gtest/gtest.h>

#include <filesystem>

#include "support/cases.h"
#include "support/key.h"

namespace lacquer::test {
namespace {

TEST(CollidingTexts, HaveKeysOfTheirOwn) {
  const auto folder = sourceFolder() / "../shared/attack/second/01";
  if (!std::filesystem::exists(folder / "A.gltf"))
    GTEST_SKIP() << "no ../shared/attack: no colliding texts are tried";
  const std::string a = readFile(folder / "A.gltf");
  const std::string b = readFile(folder / "B.gltf");
  EXPECT_NE(a, b);
  EXPECT_NE(keyOf(a), keyOf(b));
}

}  // namespace
}  // namespace lacquer::test
