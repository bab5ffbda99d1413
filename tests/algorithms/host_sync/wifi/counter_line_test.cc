#include "algorithms/host_sync/wifi/counter_line.h"

#include <gtest/gtest.h>

#include "algorithms/host_sync/wifi/wifi_time.h"

namespace simbench {
namespace {

constexpr Nanoseconds kLineSecond{1'000'000'000};

TEST(CounterLine, FindsOffsetAndRate) {
  CounterLine line(60 * kLineSecond);
  for (int i = 0; i < 3; ++i) line.add(i * kLineSecond, Nanoseconds(7'000'000 + i * 10'000));
  EXPECT_FALSE(line.fit()) << "three readings are too few";
  line.add(3 * kLineSecond, Nanoseconds(7'030'000));
  ASSERT_TRUE(line.fit());
  EXPECT_NEAR(line.fit()->rate(), 10e-6, 1e-12);
  EXPECT_EQ(line.fit()->ahead(10 * kLineSecond), Nanoseconds(7'100'000));
}

TEST(CounterLine, ForgetsWhatIsOlderThanTheWindow) {
  CounterLine line(10 * kLineSecond);
  for (int i = 0; i < 40; ++i) {
    line.add(i * kLineSecond, Nanoseconds(i < 20 ? 1'000'000 : 0));
  }
  EXPECT_EQ(line.fit()->ahead(39 * kLineSecond), Nanoseconds(0));
}

TEST(CounterLine, BeginsAnewWhereTheCounterDid) {
  CounterLine line(60 * kLineSecond);
  for (int i = 0; i < 10; ++i) line.add(i * kLineSecond, Nanoseconds(0));
  line.add(10 * kLineSecond, kLineSecond);
  EXPECT_FALSE(line.fit());
  for (int i = 11; i < 14; ++i) line.add(i * kLineSecond, kLineSecond);
  EXPECT_EQ(line.fit()->ahead(14 * kLineSecond), kLineSecond);
}

// The flight of 50 ns cancels; half of the difference of the ends' lateness, 30 and 10 ns, stays.
TEST(FtmExchange, OffsetOfOneExchange) {
  const auto tsf = [](int ns) { return TsfTime(Nanoseconds(1'000'000 + ns)); };
  const auto radio = [](int ns) { return HardwareTime(Nanoseconds(ns)); };
  EXPECT_EQ(tsf_ahead({.t1 = tsf(0), .t2 = radio(50), .t3 = radio(10'050), .t4 = tsf(10'100)}),
            Nanoseconds(1'000'000));
  EXPECT_EQ(tsf_ahead({.t1 = tsf(0), .t2 = radio(50 + 30), .t3 = radio(10'050), .t4 = tsf(10'110)}),
            Nanoseconds(1'000'000 - 10));
}

}  // namespace
}  // namespace simbench
