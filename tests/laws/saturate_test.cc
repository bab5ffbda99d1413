#include "laws/saturate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <cmath>
#include <cstdint>

namespace simbench {
namespace {

TEST(SaturateRound, TakesTheEvenOneOfTwo) {
  EXPECT_EQ(saturate_round(0.5), 0);
  EXPECT_EQ(saturate_round(1.5), 2);
  EXPECT_EQ(saturate_round(-0.5), 0);
  EXPECT_EQ(saturate_round(-2.5), -2);
  EXPECT_EQ(saturate_round(-2.500001), -3);
}

TEST(SaturateRound, IsTheLibrarysWithinItsRange) {
  constexpr std::uint32_t kSeed = 3;
  boost::random::mt19937_64 random(kSeed);
  for (int i = 0; i < 100'000; ++i) {
    const auto whole = static_cast<double>(static_cast<std::int64_t>(random()));
    const double value = std::ldexp(whole, -static_cast<int>(random() % 70));
    ASSERT_EQ(saturate_round(value), std::llrint(std::clamp(value, -0x1p62, 0x1p62)))
        << value << ", seed " << kSeed;
  }
  for (const double value :
       {0x1p51, -0x1p51, 0x1p51 - 0.5, 0x1p51 - 0.25, 0x1p62, -0x1p62, 1e300}) {
    EXPECT_EQ(saturate_round(value), std::llrint(std::clamp(value, -0x1p62, 0x1p62))) << value;
    EXPECT_EQ(saturate_round(-value), std::llrint(std::clamp(-value, -0x1p62, 0x1p62))) << -value;
  }
}

}  // namespace
}  // namespace simbench
