#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>
#include <random>

#include "targets/clike.h"

namespace lacquer::targets {

TEST(Literal, ReadsAsAPersonWouldWriteIt) {
  EXPECT_EQ(floatLiteral(0).text, "0.0");
  EXPECT_EQ(floatLiteral(1).text, "1.0");
  EXPECT_EQ(floatLiteral(-1).text, "-1.0");
  EXPECT_EQ(floatLiteral(0.04).text, "0.04");
  EXPECT_EQ(floatLiteral(1.0 / 3).text, "0.33333334");
  EXPECT_EQ(floatLiteral(1e-7).text, "1e-7");
  EXPECT_EQ(floatLiteral(-2.5e-10).text, "-2.5e-10");
  EXPECT_EQ(floatLiteral(1e30).text, "1e30");
  EXPECT_EQ(floatLiteral(65504).text, "65504.0");
  EXPECT_EQ(floatLiteral(1e-300).text, "0.0");
}

TEST(Literal, StaysWithinFloat) {
  EXPECT_EQ(floatLiteral(1e300).text, "3.4028235e38");
  EXPECT_EQ(floatLiteral(-HUGE_VAL).text, "-3.4028235e38");
  // Between the largest float and half a step beyond, where rounding alone would do.
  EXPECT_EQ(floatLiteral(3.4028235e38).text, "3.4028235e38");
}

TEST(Literal, BindsLikeItsSign) {
  EXPECT_EQ(floatLiteral(2).precedence, Precedence::Postfix);
  EXPECT_EQ(floatLiteral(-2).precedence, Precedence::Unary);
  EXPECT_EQ(parenthesized(floatLiteral(-2), Precedence::Postfix), "(-2.0)");
  EXPECT_EQ(parenthesized(floatLiteral(2), Precedence::Postfix), "2.0");
}

TEST(Literal, ReadsBackAsTheSameFloat) {
  std::mt19937 random(1);
  for (int k = 0; k < 200000; ++k) {
    const float x = std::bit_cast<float>(static_cast<uint32_t>(random()));
    if (!std::isfinite(x)) continue;
    const std::string text = floatLiteral(x).text;
    ASSERT_EQ(std::strtof(text.c_str(), nullptr), x) << text;
    // Compilers read a double and round it: twice rounded must be the same float, too.
    ASSERT_EQ(static_cast<float>(std::strtod(text.c_str(), nullptr)), x) << text;
    ASSERT_TRUE(text.find('.') != std::string::npos || text.find('e') != std::string::npos) << text;
    ASSERT_EQ(text.find('+'), std::string::npos) << text;
  }
}

}  // namespace lacquer::targets
