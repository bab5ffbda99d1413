#include "algorithms/ports/time.h"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <cmath>
#include <vector>

namespace simbench {
namespace {

std::vector<double> values() {
  std::vector<double> all = {0.0,    -0.0,       0.5, 0.49999999999999994, 1.5, 2.5,
                             1e-300, 0x1p52 + 1, 9e18};
  boost::random::mt19937_64 engine(5);
  for (double largest = 1; largest < 1e17; largest *= 10) {
    boost::random::uniform_real_distribution<double> value(0, largest);
    for (int i = 0; i < 100; ++i) {
      all.push_back(value(engine));
      all.push_back(std::floor(all.back()) + 0.5);
    }
  }
  return all;
}

TEST(Time, NanosecondsAreRoundedAsTheStandardLibraryRounds) {
  for (const double value : values()) {
    for (const double ns : {value, -value}) {
      EXPECT_EQ(from_ns(ns).count(), std::llround(ns)) << ns;
      EXPECT_EQ(static_cast<double>(from_ns_down(ns).count()), std::floor(ns)) << ns;
      EXPECT_EQ(static_cast<double>(from_ns_up(ns).count()), std::ceil(ns)) << ns;
    }
  }
}

TEST(Time, FloorDivisionRoundsDown) {
  EXPECT_EQ(floor_div(7, 3), 2);
  EXPECT_EQ(floor_div(6, 3), 2);
  EXPECT_EQ(floor_div(-6, 3), -2);
  EXPECT_EQ(floor_div(-7, 3), -3);
}

TEST(Time, UnitsConvertToWholeNanoseconds) {
  EXPECT_EQ(from_ms(-1.5).count(), -1'500'000);
  EXPECT_EQ(from_us(0.0005).count(), 1);
  EXPECT_EQ(to_ms(from_ms(9e9)), 9e9);
}

}  // namespace
}  // namespace simbench
