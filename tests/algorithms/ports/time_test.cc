#include "algorithms/ports/time.h"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <cmath>
#include <cstdint>
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

// The register shows the low 32 bits of whole microseconds of the steady clock.
TEST(Time, AStampOfASteadyClockIsTheNearestReading) {
  const auto at = [](std::int64_t ns) { return SteadyTime(Nanoseconds(ns)); };
  EXPECT_EQ(age_of({.us = 70}, at(100'999)), Nanoseconds(30'999));
  EXPECT_EQ(steady_of({.us = 70}, at(100'999)), at(70'000));
  EXPECT_EQ(steady_of({.us = 130}, at(100'999)), at(130'000)) << "later";
  EXPECT_EQ(steady_of({.us = 0xffff'fff0}, at(5'000)), at(-16'000)) << "before the wrap";
  EXPECT_EQ(steady_of({.us = 5}, at(kDeviceRegisterNs - 1'000)), at(kDeviceRegisterNs + 5'000));
  EXPECT_EQ(steady_of({.us = 5}, at(-1'500)), at(5'000));
  EXPECT_EQ(age_of({.us = 5}, at(-1'500)), Nanoseconds(-6'500));
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
