// BLAKE2b against libsodium's, and against values that others have published.
#include "support/digest.h"

#include <gtest/gtest.h>
#include <sodium.h>

#include <random>

namespace lacquer::test {
namespace {

TEST(Digest, IsBlake2b) {
  EXPECT_EQ(hexOf(digestOf("")), "0e5751c026e543b2e8ab2eb06099daa1d1e5df47778f7787faab45cdf12fe3a8");
  EXPECT_EQ(hexOf(digestOf("abc")), "bddd813c634239723171ef3fee98579b94964e3bb1cb3e427262c8c068d52319");
  EXPECT_EQ(hexOf(digestOf("abc"), 4), "bddd813c");
}

/// Every length around the block's 128 bytes, and some longer ones.
TEST(Digest, IsThatOfLibsodium) {
  std::mt19937 random(1);
  for (size_t size = 0; size < 1100; size += size < 400 ? 1 : 37) {
    std::string bytes(size, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    Digest expected{};
    ASSERT_EQ(
        crypto_generichash(expected.data(), expected.size(),
                           reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), nullptr, 0),
        0);
    EXPECT_EQ(digestOf(bytes), expected) << size;
  }
}

}  // namespace
}  // namespace lacquer::test
