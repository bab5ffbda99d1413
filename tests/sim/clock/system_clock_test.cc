#include "sim/clock/system_clock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sim/clock/clock_interface.h"
#include "sim/engine/random.h"

namespace simbench::sim {
namespace {

TrueTime at_ms(double ms) { return TrueTime(from_ms(ms)); }
HostTime host_ms(double ms) { return HostTime(from_ms(ms)); }
double reads_ms(const SystemClock& clock, TrueTime t) {
  return to_ms(clock.read(t).time_since_epoch());
}

TEST(SystemClockTest, PerfectClockReadsTrueTimePlusItsOffset) {
  const SystemClock clock(0, OscillatorModel(0), from_ms(-3));
  for (const double ms : {-1e7, -0.5, 0.0, 2.5, 1e9}) {
    EXPECT_EQ(clock.read(at_ms(ms)), host_ms(ms - 3));
  }
}

TEST(SystemClockTest, LinearClockGainsItsSkew) {
  const SystemClock clock(1, OscillatorModel(10e-6), from_ms(250));
  EXPECT_EQ(clock.read(at_ms(1e6)), host_ms(1e6 + 250 + 10));
  EXPECT_EQ(clock.read(at_ms(-1e6)), host_ms(-1e6 + 250 - 10));
  EXPECT_EQ(clock.read(TrueTime(Nanoseconds(150'000))), HostTime(Nanoseconds(250'150'001)));
}

TEST(SystemClockTest, SteadyClockIsTheOscillatorAndIsNeverSet) {
  SystemClock clock(1, OscillatorModel(10e-6), from_ms(250), SteadyTime(from_ms(7)));
  clock.set(at_ms(1), host_ms(9999));
  clock.adjust_frequency(at_ms(2), 1e6);
  EXPECT_EQ(clock.steady(at_ms(1e6)), SteadyTime(from_ms(1e6 + 10 + 7)));
}

TEST(SystemClockTest, SteppedClockReadsTheNewValueFromTheStepOn) {
  SystemClock clock(1, OscillatorModel(0));
  clock.set(at_ms(10), host_ms(1000));
  clock.set(at_ms(20), host_ms(500));
  EXPECT_EQ(clock.read(at_ms(10)), host_ms(1000));
  EXPECT_EQ(clock.read(at_ms(20)), host_ms(500));
  EXPECT_EQ(clock.read(at_ms(50)), host_ms(530));
}

TEST(SystemClockTest, ThePastIsReadUnderTheSettingsOfThePast) {
  SystemClock clock(1, OscillatorModel(0));
  clock.set(at_ms(10), host_ms(1000));
  clock.set(at_ms(20), host_ms(500));
  EXPECT_EQ(clock.read(at_ms(50)), host_ms(530));
  EXPECT_EQ(clock.read(at_ms(19)), host_ms(1009));
  EXPECT_EQ(clock.read(at_ms(10) - Nanoseconds(1)), host_ms(10) - Nanoseconds(1));
  EXPECT_EQ(clock.read(at_ms(-5)), host_ms(-5));
  EXPECT_EQ(clock.read(at_ms(20)), host_ms(500));
}

TEST(SystemClockTest, ChangeOfRateGoesOnFromTheReading) {
  SystemClock clock(1, OscillatorModel(0), from_ms(5));
  clock.adjust_frequency(at_ms(1000), 500'000);
  EXPECT_EQ(clock.read(at_ms(1000)), host_ms(1005));
  EXPECT_EQ(clock.read(at_ms(3000)), host_ms(3005 + 1));
  clock.adjust_frequency(at_ms(3000), -500'000);
  EXPECT_EQ(clock.read(at_ms(5000)), host_ms(5005));
}

TEST(SystemClockTest, RateAppliesToWhatTheOscillatorCounts) {
  SystemClock clock(1, OscillatorModel(0.001));
  clock.adjust_frequency(at_ms(0), 1e6);
  EXPECT_EQ(clock.read(at_ms(1000)), host_ms(1000 * 1.001 * 1.001));
}

TEST(SystemClockTest, TinyRatesAddUpOverManyAdjustments) {
  SystemClock clock(1, OscillatorModel(0));
  for (int i = 0; i < 10'000; ++i) clock.adjust_frequency(at_ms(i * 0.1), i % 2 == 0 ? 1.0 : 3.0);
  // 2 ppb on average over 1 s: 2 ns, in pieces of 1e-4 ns that no step rounds away.
  EXPECT_EQ(clock.read(at_ms(1000) + Nanoseconds(10)), HostTime(from_ms(1000)) + Nanoseconds(12));
}

TEST(SystemClockTest, PeriodicSkewIsATriangleAroundTrueTime) {
  SystemClock clock(1, OscillatorModel(0));
  for (int s = 0; s < 100; ++s) clock.adjust_frequency(at_ms(s * 1e3), s % 2 == 0 ? 1e5 : -1e5);
  for (int s = 0; s < 100; ++s) {
    for (const int part_ms : {0, 250, 500, 750}) {
      const double expected_ms = (s % 2 == 0 ? part_ms : 1000 - part_ms) * 1e-4;
      EXPECT_NEAR(reads_ms(clock, at_ms(s * 1e3 + part_ms)), s * 1e3 + part_ms + expected_ms, 2e-6);
    }
  }
}

TEST(SystemClockTest, SlewAddsItsOffsetAndEndsByItself) {
  SystemClock clock(1, OscillatorModel(0));
  clock.slew(at_ms(1000), from_ms(2), 500'000);  // 2 ms at 500 ppm: 4 s
  EXPECT_EQ(clock.read(at_ms(3000)), host_ms(3001));
  EXPECT_EQ(clock.read(at_ms(5000)), host_ms(5002));
  EXPECT_EQ(clock.read(at_ms(60'000)), host_ms(60'002));
  EXPECT_EQ(clock.settles_at(), at_ms(5000));
}

TEST(SystemClockTest, SlewBackwardsNeverStepsBack) {
  SystemClock clock(1, OscillatorModel(0));
  clock.slew(at_ms(0), from_ms(-1), 100'000'000);  // 10 ms at -10 %
  HostTime before = clock.read(at_ms(0));
  for (int us = 1; us < 20'000; ++us) {
    const HostTime now = clock.read(at_ms(us * 1e-3));
    ASSERT_GE(now, before);
    before = now;
  }
  EXPECT_EQ(clock.read(at_ms(20)), host_ms(19));
}

TEST(SystemClockTest, AnotherSlewReplacesTheRestOfTheFirst) {
  SystemClock clock(1, OscillatorModel(0));
  clock.slew(at_ms(0), from_ms(2), 500'000);
  clock.slew(at_ms(1000), from_ms(-1), 500'000);
  EXPECT_EQ(clock.read(at_ms(1000)), host_ms(1000.5));
  EXPECT_EQ(clock.read(at_ms(9000)), host_ms(8999.5));
}

TEST(SystemClockTest, ASlewOfNothingEndsTheOneBefore) {
  SystemClock clock(1, OscillatorModel(0));
  clock.slew(at_ms(1000), from_ms(2), 500'000);
  clock.slew(at_ms(3000), from_ms(0), 0);
  EXPECT_EQ(clock.read(at_ms(60'000)), host_ms(60'001));
}

TEST(SystemClockTest, AStepEndsASlewAndKeepsTheRate) {
  SystemClock clock(1, OscillatorModel(0));
  clock.adjust_frequency(at_ms(0), 1e6);
  clock.slew(at_ms(0), from_ms(2), 500'000);
  clock.set(at_ms(1000), host_ms(0));
  EXPECT_EQ(clock.read(at_ms(2000)), host_ms(1001));
  EXPECT_FALSE(clock.settles_at());
}

TEST(SystemClockTest, AChangeOfRateLeavesASlewItsOffset) {
  SystemClock clock(1, OscillatorModel(0));
  clock.slew(at_ms(0), from_ms(2), 500'000);
  clock.adjust_frequency(at_ms(1000), 1e6);
  EXPECT_EQ(clock.settles_at(), at_ms(4000));
  EXPECT_NEAR(reads_ms(clock, at_ms(6000)), 6000 + 2 + 5, 2e-6);
}

TEST(SystemClockTest, WhenFindsTheFirstInstantOfAReading) {
  SystemClock clock(1, OscillatorModel(35e-6), from_ms(250));
  clock.adjust_frequency(at_ms(100), -20'000);
  clock.slew(at_ms(200), from_ms(3), 500'000);
  for (const double ms : {450.5, 460.0, 1234.567891, 6452.0, 60'000.0}) {
    const TrueTime found = clock.when(host_ms(ms), at_ms(200));
    EXPECT_GE(clock.read(found), host_ms(ms));
    EXPECT_LT(clock.read(found - Nanoseconds(1)), host_ms(ms));
  }
}

TEST(SystemClockTest, WhenAReadingIsPastIsNow) {
  SystemClock clock(1, OscillatorModel(0));
  clock.set(at_ms(10), host_ms(1000));
  EXPECT_EQ(clock.when(host_ms(1000), at_ms(30)), at_ms(30));
  EXPECT_EQ(clock.when(host_ms(20), at_ms(30)), at_ms(30));
}

TEST(SystemClockTest, SteadyDeadlinesInvert) {
  const scenarios::Oscillator noisy{.skew_sigma_ppm = 30,
                                    .white_frequency_ppb = 50,
                                    .random_walk_ppb_per_sqrt_s = 50,
                                    .wander_step_ms = 10};
  const SystemClock clock(1, OscillatorModel(noisy, 7, "host1"), {}, SteadyTime(from_ms(500)));
  for (const double ms : {-2000.0, 499.9999, 500.0, 501.25, 20'000.125}) {
    const TrueTime found = clock.when(SteadyTime(from_ms(ms)));
    EXPECT_GE(clock.steady(found), SteadyTime(from_ms(ms)));
    EXPECT_LT(clock.steady(found - Nanoseconds(1)), SteadyTime(from_ms(ms)));
  }
}

TEST(SystemClockTest, ObserverHearsSettingStepRateAndBothEndsOfASlew) {
  SystemClock clock(3, OscillatorModel(0), from_ms(5));
  std::vector<ClockAdjustment> log{clock.present(at_ms(1))};
  clock.observe([&](const ClockAdjustment& entry) { log.push_back(entry); });
  clock.set(at_ms(10), host_ms(100));
  clock.adjust_frequency(at_ms(20), 1000);
  clock.slew(at_ms(30), from_ms(1), 100'000'000);
  ASSERT_EQ(log.size(), 4u);
  clock.settle(at_ms(39));
  ASSERT_EQ(log.size(), 4u);
  clock.settle(at_ms(40));
  ASSERT_EQ(log.size(), 5u);
  for (const ClockAdjustment& entry : log) EXPECT_EQ(entry.host, 3u);
  EXPECT_EQ(log[0].at, SteadyTime(from_ms(1)));
  EXPECT_EQ(log[0].after, host_ms(6));
  EXPECT_EQ(log[1].before, host_ms(15));
  EXPECT_EQ(log[1].after, host_ms(100));
  EXPECT_EQ(log[2].before, log[2].after);
  EXPECT_DOUBLE_EQ(log[2].rate_ppb, 1000);
  EXPECT_DOUBLE_EQ(log[3].rate_ppb, 100'001'000);
  EXPECT_EQ(log[4].at, SteadyTime(from_ms(40)));
  EXPECT_EQ(log[4].before, log[4].after);
  EXPECT_DOUBLE_EQ(log[4].rate_ppb, 1000);
}

// The record must be enough to go from the steady clock to the system clock at any instant.
TEST(SystemClockTest, AdjustmentsReproduceTheClockFromItsSteadyClock) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomStream random(seed, "adjustments");
    SystemClock clock(1, OscillatorModel(random.normal(50e-6)), from_ms(random.normal(300)));
    std::vector<ClockAdjustment> log{clock.present(at_ms(0))};
    clock.observe([&](const ClockAdjustment& entry) { log.push_back(entry); });
    for (int i = 1; i <= 50; ++i) {
      const TrueTime at = at_ms(i * 100 + random.uniform(0, 50));
      switch (random.below(3)) {
        case 0:
          clock.set(at, host_ms(random.normal(1e4)));
          break;
        case 1:
          clock.adjust_frequency(at, random.normal(1e5));
          break;
        default:
          clock.slew(at, from_ms(random.normal(0.1)), 500'000);
          break;
      }
      clock.settle(at_ms(i * 100 + 99));
    }
    std::size_t entry = 0;
    for (int ms = 0; ms < 5099; ms += 7) {
      const SteadyTime steady = clock.steady(at_ms(ms));
      while (entry + 1 < log.size() && log[entry + 1].at <= steady) ++entry;
      const auto elapsed_ns = static_cast<double>((steady - log[entry].at).count());
      const HostTime expected =
          log[entry].after +
          Nanoseconds(std::llround(elapsed_ns * (1 + log[entry].rate_ppb * 1e-9)));
      ASSERT_LE(std::abs((clock.read(at_ms(ms)) - expected).count()), 2)
          << "seed " << seed << ", at " << ms << " ms";
    }
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

TEST(ClockInterfaceTest, ZeroIsContinuous) {
  const ClockInterface interface({}, {}, {});
  EXPECT_EQ(interface.read(HostTime(Nanoseconds(123'457))), HostTime(Nanoseconds(123'457)));
  EXPECT_EQ(interface.set_to(HostTime(Nanoseconds(-7))), HostTime(Nanoseconds(-7)));
}

}  // namespace
}  // namespace simbench::sim
