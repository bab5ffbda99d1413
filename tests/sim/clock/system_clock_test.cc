#include "sim/clock/system_clock.h"

#include <gtest/gtest.h>

#include <vector>

#include "sim/clock/clock_interface.h"
#include "sim/engine/random.h"
#include "tests/sim/at_ms.h"

namespace simbench::sim {
namespace {

// Whatever a simulated host may have.
OscillatorModel noisy_oscillator() {
  return OscillatorModel({.skew_sigma_ppm = 30,
                          .white_frequency_ppb = 50,
                          .random_walk_ppb_per_sqrt_s = 50,
                          .wander_step_ms = 10},
                         7, "host1");
}

TEST(SystemClockTest, ReadsItsOffsetAndTheSteadyEpochAtTrueZero) {
  const SystemClock clock(1, OscillatorModel(10e-6), from_ms(250), SteadyTime(from_ms(7)));
  EXPECT_EQ(clock.read(TrueTime{}), host_ms(250));
  EXPECT_EQ(clock.steady(TrueTime{}), SteadyTime(from_ms(7)));
  EXPECT_EQ(clock.read(at_ms(-1e6)), host_ms(-1e6 + 250 - 10));
}

TEST(SystemClockTest, EveryPastReadingIsThatOfItsTime) {
  SystemClock clock(1, noisy_oscillator(), from_ms(250));
  std::vector<HostTime> seen;
  for (int i = 0; i < 500; ++i) {
    clock.slew(at_ms(i * 100), from_ms(i % 2 == 0 ? 0.04 : -0.04), 500'000);
    clock.settle(at_ms(i * 100 + 90));
    seen.push_back(clock.read(at_ms(i * 100 + 90)));
  }
  for (int i = 499; i >= 0; --i) {
    EXPECT_EQ(clock.read(at_ms(i * 100 + 90)), seen[static_cast<std::size_t>(i)]) << i;
  }
}

TEST(SystemClockTest, DeadlinesOfANoisyClockInvertBeyondASlew) {
  SystemClock clock(1, noisy_oscillator(), from_ms(250));
  clock.adjust_frequency(at_ms(100), -20'000);
  clock.slew(at_ms(200), from_ms(3), 500'000);
  for (const double ms : {450.5, 460.0, 1234.567891, 6452.0, 60'000.0}) {
    const TrueTime found = clock.when(host_ms(ms), at_ms(200));
    EXPECT_GE(clock.read(found), host_ms(ms));
    EXPECT_LT(clock.read(found - Nanoseconds(1)), host_ms(ms));
  }
}

TEST(SystemClockTest, SteadyClockIsTheOscillatorAndIsNeverSet) {
  SystemClock clock(1, OscillatorModel(10e-6), from_ms(250), SteadyTime(from_ms(7)));
  clock.set(at_ms(1), host_ms(9999));
  clock.adjust_frequency(at_ms(2), 1e6);
  EXPECT_EQ(clock.steady(at_ms(1e6)), SteadyTime(from_ms(1e6 + 10 + 7)));
}

TEST(SystemClockTest, SteadyDeadlinesInvert) {
  const SystemClock clock(1, noisy_oscillator(), {}, SteadyTime(from_ms(500)));
  for (const double ms : {-2000.0, 499.9999, 500.0, 501.25, 20'000.125}) {
    const TrueTime found = clock.when(SteadyTime(from_ms(ms)));
    EXPECT_GE(clock.steady(found), SteadyTime(from_ms(ms)));
    EXPECT_LT(clock.steady(found - Nanoseconds(1)), SteadyTime(from_ms(ms)));
  }
}

TEST(SystemClockTest, FollowerHasTheMastersClocksAndReportsItsAdjustments) {
  SystemClock master(0, OscillatorModel(10e-6));
  SystemClock slave(1, OscillatorModel(-20e-6), from_ms(300), SteadyTime(from_ms(40)));
  slave.follow(master);
  std::vector<ClockAdjustment> log;
  slave.observe([&](const ClockAdjustment& entry) { log.push_back(entry); });
  slave.set(at_ms(3), host_ms(1e6));
  slave.adjust_frequency(at_ms(3), 1e6);
  slave.slew(at_ms(3), from_ms(1), 1e6);
  EXPECT_FALSE(slave.settles_at());
  master.set(at_ms(5), host_ms(777));
  for (const double ms : {0.0, 4.0, 5.0, 1e5}) {
    EXPECT_EQ(slave.read(at_ms(ms)), master.read(at_ms(ms)));
    EXPECT_EQ(slave.steady(at_ms(ms)), master.steady(at_ms(ms)));
  }
  EXPECT_EQ(slave.when(host_ms(800), at_ms(6)), master.when(host_ms(800), at_ms(6)));
  ASSERT_EQ(log.size(), 1u);
  EXPECT_EQ(log[0].host, 1u);
  EXPECT_EQ(log[0].after, host_ms(777));
}

TEST(ClockInterfaceTest, ReadingsRoundDownToTheTickThenToTheResolution) {
  const ClockInterface interface(from_ms(15.625), from_ms(4), from_ms(1));
  EXPECT_EQ(interface.read(host_ms(3.999)), host_ms(-12));  // the tick of -11.625 ms
  EXPECT_EQ(interface.read(host_ms(4)), host_ms(4));
  EXPECT_EQ(interface.read(host_ms(19.624)), host_ms(4));
  EXPECT_EQ(interface.read(host_ms(19.625)), host_ms(19));
  EXPECT_EQ(interface.tick_of(host_ms(30)), host_ms(19.625));
  EXPECT_EQ(interface.set_to(host_ms(30.7)), host_ms(30));
  EXPECT_EQ(interface.set_to(host_ms(-30.7)), host_ms(-31));
}

TEST(GranularityTest, RoundsDownAsADivisionDoes) {
  RandomStream draw(1, "times");
  const auto rounded = [](std::int64_t ns, std::int64_t unit) {
    return Granularity(Nanoseconds(unit)).round_down(HostTime(Nanoseconds(ns)));
  };
  for (const std::int64_t unit :
       {std::int64_t{1}, std::int64_t{2}, std::int64_t{3}, std::int64_t{100},
        std::int64_t{1'000'000}, std::int64_t{15'625'000}, (std::int64_t{1} << 62) - 1,
        std::int64_t{1} << 62}) {
    for (int i = 0; i < 2000; ++i) {
      const int shift = static_cast<int>(draw.below(64));
      const auto ns = static_cast<std::int64_t>(draw()) >> shift;
      if (ns < -(std::int64_t{1} << 62)) continue;
      ASSERT_EQ(rounded(ns, unit), HostTime(Nanoseconds(floor_div(ns, unit) * unit)))
          << ns << " in steps of " << unit;
    }
  }
  EXPECT_EQ(rounded(-7, 0), HostTime(Nanoseconds(-7)));
}

TEST(ClockInterfaceTest, ZeroIsContinuous) {
  const ClockInterface interface({}, {}, {});
  EXPECT_EQ(interface.read(HostTime(Nanoseconds(123'457))), HostTime(Nanoseconds(123'457)));
  EXPECT_EQ(interface.set_to(HostTime(Nanoseconds(-7))), HostTime(Nanoseconds(-7)));
}

}  // namespace
}  // namespace simbench::sim
