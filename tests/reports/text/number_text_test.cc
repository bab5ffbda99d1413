#include "reports/text/number_text.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/reports/sample_results.h"

namespace simbench::reports {
namespace {

TEST(NumberText, HasThreeSignificantDigits) {
  EXPECT_EQ(number_text(0.0042), "0.00420");
  EXPECT_EQ(number_text(2.438), "2.44");
  EXPECT_EQ(number_text(-29.5), "-29.5");
  EXPECT_EQ(number_text(547.5033), "548");
  EXPECT_EQ(number_text(36000), "36000");
  EXPECT_EQ(number_text(0.000042), "4.20e-05");
  EXPECT_EQ(number_text(1.6e9), "1.60e+09");
}

TEST(NumberText, HasThreeDigitsWhereItIsRoundedUp) {
  EXPECT_EQ(number_text(9.997), "10.0");
  EXPECT_EQ(number_text(0.09997), "0.100");
  EXPECT_EQ(number_text(99.97), "100");
}

TEST(NumberText, ZeroHasNoSign) {
  EXPECT_EQ(number_text(0), "0");
  EXPECT_EQ(number_text(-0.0), "0");
}

TEST(NumberText, WhatIsNotFiniteIsADash) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double value : {kNaN, kInfinity, -kInfinity}) {
    EXPECT_EQ(number_text(value), "-");
    EXPECT_EQ(share_text(value), "-");
    EXPECT_EQ(short_text(value), "-");
  }
}

TEST(NumberText, WhatDoesNotExistIsADash) {
  EXPECT_EQ(number_text(kNaN), "-");
  EXPECT_EQ(share_text(kNaN), "-");
  EXPECT_EQ(percentile_text({kNaN, 0, 100}), "-");
}

TEST(NumberText, ASharePretendsNothing) {
  EXPECT_EQ(share_text(0), "0 %");
  EXPECT_EQ(share_text(1), "100 %");
  EXPECT_EQ(share_text(0.5), "50.0 %");
  EXPECT_EQ(share_text(0.99999), "> 99.9 %");
  EXPECT_EQ(share_text(0.00001), "< 0.1 %");
}

TEST(NumberText, Percentiles) { EXPECT_EQ(percentile_text({33.3, 18, 51.2}), "33 % [18-51]"); }

TEST(NumberText, CountsAreGroupedByThousands) {
  EXPECT_EQ(count_text(0), "0");
  EXPECT_EQ(count_text(999), "999");
  EXPECT_EQ(count_text(1000), "1 000");
  EXPECT_EQ(count_text(-100), "-100");
  EXPECT_EQ(count_text(1234567), "1 234 567");
}

TEST(NumberText, LargeNumbersInShort) {
  EXPECT_EQ(short_text(950), "950");
  EXPECT_EQ(short_text(999.4), "999");
  EXPECT_EQ(short_text(999.7), "1 k");
  EXPECT_EQ(short_text(999'700), "1 M");
  EXPECT_EQ(short_text(12345), "12.3 k");
  EXPECT_EQ(short_text(4.56e6), "4.56 M");
  EXPECT_EQ(short_text(1.2e9), "1.2 G");
}

TEST(NumberText, NounsFollowTheirCount) {
  EXPECT_EQ(counted(1, "seed"), "1 seed");
  EXPECT_EQ(counted(0, "seed"), "0 seeds");
  EXPECT_EQ(counted_seeds(7, 1), "1 seed (7)");
  EXPECT_EQ(counted_seeds(1, 32), "32 seeds (1-32)");
}

TEST(NumberText, TitlesBeginWithACapital) {
  EXPECT_EQ(capitalised("absolute error"), "Absolute error");
  EXPECT_EQ(capitalised("AMD"), "AMD");
}

}  // namespace
}  // namespace simbench::reports
