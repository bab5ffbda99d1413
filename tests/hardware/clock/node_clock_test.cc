// The oscillator of a node: the monotonic clock at a skew.
#include "hardware/clock/node_clock.h"

#include <gtest/gtest.h>

namespace simbench::hardware {
namespace {

MonotonicTime at_ms(double ms) { return MonotonicTime(from_ms(ms)); }

TEST(NodeOscillatorTest, TheDefaultIsTheMonotonicClock) {
  const NodeOscillator none;
  EXPECT_EQ(none.steady(at_ms(12.5)), SteadyTime(from_ms(12.5)));
  EXPECT_EQ(none.when(SteadyTime(from_ms(12.5))), at_ms(12.5));
}

TEST(NodeOscillatorTest, RunsAtItsSkewFromItsZero) {
  const NodeOscillator fast{at_ms(1000), SteadyTime(from_ms(7)), 30};
  EXPECT_EQ(fast.steady(at_ms(1000)), SteadyTime(from_ms(7)));
  EXPECT_EQ(fast.steady(at_ms(101'000)), SteadyTime(from_ms(100'007 + 3)));
  EXPECT_EQ(fast.steady(at_ms(0)), SteadyTime(from_ms(-993 - 0.03)));
}

TEST(NodeOscillatorTest, WhenFindsTheFirstInstantOfAReading) {
  for (const double ppm : {-30.0, 0.0, 17.3, 500.0}) {
    const NodeOscillator oscillator{at_ms(1e6), SteadyTime(from_ms(-5)), ppm};
    for (const double ms : {-2000.0, -5.0, 0.0001, 501.25, 3.6e7}) {
      const MonotonicTime found = oscillator.when(SteadyTime(from_ms(ms)));
      EXPECT_GE(oscillator.steady(found), SteadyTime(from_ms(ms)));
      EXPECT_LT(oscillator.steady(found - Nanoseconds(1)), SteadyTime(from_ms(ms)));
    }
  }
}

TEST(NodeOscillatorTest, WhatIsCenturiesAwayIsNever) {
  const NodeOscillator slow{at_ms(1e6), SteadyTime(from_ms(-5)), -30};
  EXPECT_EQ(slow.when(SteadyTime::max()), MonotonicTime::max());
  EXPECT_EQ(slow.when(SteadyTime::min()), MonotonicTime::min());
}

}  // namespace
}  // namespace simbench::hardware
