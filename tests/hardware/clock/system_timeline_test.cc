// The clock of a node over explicit instants: analytic expectations, then properties, then sim's.
#include "hardware/clock/system_timeline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "sim/clock/system_clock.h"
#include "sim/engine/random.h"

namespace simbench::hardware {
namespace {

MonotonicTime at_ms(double ms) { return MonotonicTime(from_ms(ms)); }
HostTime host_ms(double ms) { return HostTime(from_ms(ms)); }
double reads_ms(const SystemTimeline& clock, MonotonicTime t) {
  return to_ms(clock.read(t).time_since_epoch());
}
NodeOscillator skewed(double ppm) { return {MonotonicTime{}, SteadyTime{}, ppm}; }
SystemTimeline timeline(double skew_ppm = 0, double offset_ms = 0) {
  return {3, skewed(skew_ppm), at_ms(0), host_ms(offset_ms)};
}

TEST(SystemTimelineTest, PerfectClockReadsMonotonicTimePlusItsOffset) {
  const SystemTimeline clock = timeline(0, -3);
  for (const double ms : {-0.5, 0.0, 2.5, 1e9}) EXPECT_EQ(clock.read(at_ms(ms)), host_ms(ms - 3));
}

TEST(SystemTimelineTest, LinearClockGainsItsSkew) {
  const SystemTimeline clock = timeline(10, 250);
  EXPECT_EQ(clock.read(at_ms(1e6)), host_ms(1e6 + 250 + 10));
  EXPECT_EQ(clock.read(MonotonicTime(Nanoseconds(150'000))), HostTime(Nanoseconds(250'150'001)));
}

TEST(SystemTimelineTest, SteppedClockReadsTheNewValueFromTheStepOnAndThePastAsItWas) {
  SystemTimeline clock = timeline();
  clock.set(at_ms(10), host_ms(1000));
  clock.set(at_ms(20), host_ms(500));
  EXPECT_EQ(clock.read(at_ms(20)), host_ms(500));
  EXPECT_EQ(clock.read(at_ms(50)), host_ms(530));
  EXPECT_EQ(clock.read(at_ms(19)), host_ms(1009));
  EXPECT_EQ(clock.read(at_ms(10)), host_ms(1000));
  EXPECT_EQ(clock.read(at_ms(10) - Nanoseconds(1)), host_ms(10) - Nanoseconds(1));
}

TEST(SystemTimelineTest, TheLast64AdjustmentsAreKept) {
  SystemTimeline clock = timeline();
  for (int i = 1; i <= 200; ++i) clock.set(at_ms(i * 10), host_ms(i * 1000));
  for (int i = 200 - 64; i <= 200; ++i) {
    EXPECT_EQ(clock.read(at_ms(i * 10 + 9)), host_ms(i * 1000 + 9)) << i;
  }
  // What is older is read as if the oldest kept had always been.
  EXPECT_EQ(clock.read(at_ms(0)), host_ms(136 * 1000 - 1360));
}

TEST(SystemTimelineTest, RateAppliesToWhatTheOscillatorCounts) {
  SystemTimeline clock = timeline(1000, 5);
  clock.adjust_frequency(at_ms(0), 1e6);
  EXPECT_EQ(clock.read(at_ms(1000)), host_ms(5 + 1000 * 1.001 * 1.001));
}

TEST(SystemTimelineTest, TinyRatesAddUpOverManyAdjustments) {
  SystemTimeline clock = timeline();
  for (int i = 0; i < 10'000; ++i) clock.adjust_frequency(at_ms(i * 0.1), i % 2 == 0 ? 1.0 : 3.0);
  // 2 ppb on average over 1 s: 2 ns, in pieces of 1e-4 ns that no setting rounds away.
  EXPECT_EQ(clock.read(at_ms(1000) + Nanoseconds(10)), HostTime(from_ms(1000)) + Nanoseconds(12));
}

TEST(SystemTimelineTest, ARateOfOnePartInABillionSurvivesADay) {
  SystemTimeline clock = timeline();
  clock.adjust_frequency(at_ms(0), 1);
  EXPECT_EQ(clock.read(at_ms(86'400e3)), host_ms(86'400e3) + Nanoseconds(86'400));
}

TEST(SystemTimelineTest, SlewAddsItsOffsetAndEndsByItself) {
  SystemTimeline clock = timeline();
  clock.slew(at_ms(1000), from_ms(2), 500'000);  // 2 ms at 500 ppm: 4 s
  EXPECT_EQ(clock.settles_at(), at_ms(5000));
  EXPECT_EQ(clock.read(at_ms(3000)), host_ms(3001));
  EXPECT_EQ(clock.read(at_ms(5000)), host_ms(5002));
  EXPECT_EQ(clock.read(at_ms(60'000)), host_ms(60'002));
  clock.settle(at_ms(5000));
  EXPECT_FALSE(clock.settles_at());
  EXPECT_EQ(clock.read(at_ms(3000)), host_ms(3001));
  EXPECT_EQ(clock.read(at_ms(60'000)), host_ms(60'002));
}

TEST(SystemTimelineTest, AnotherSlewReplacesTheRestOfTheFirst) {
  SystemTimeline clock = timeline();
  clock.slew(at_ms(0), from_ms(2), 500'000);
  clock.slew(at_ms(1000), from_ms(-1), 500'000);
  EXPECT_EQ(clock.read(at_ms(1000)), host_ms(1000.5));
  EXPECT_EQ(clock.read(at_ms(9000)), host_ms(8999.5));
}

TEST(SystemTimelineTest, ASlewOfNothingEndsTheOneBefore) {
  SystemTimeline clock = timeline();
  clock.slew(at_ms(1000), from_ms(2), 500'000);
  clock.slew(at_ms(3000), from_ms(0), 0);
  EXPECT_FALSE(clock.settles_at());
  EXPECT_EQ(clock.read(at_ms(60'000)), host_ms(60'001));
}

TEST(SystemTimelineTest, AStepEndsASlewAndKeepsTheRate) {
  SystemTimeline clock = timeline();
  clock.adjust_frequency(at_ms(0), 1e6);
  clock.slew(at_ms(0), from_ms(2), 500'000);
  clock.set(at_ms(1000), host_ms(0));
  EXPECT_EQ(clock.read(at_ms(2000)), host_ms(1001));
  EXPECT_FALSE(clock.settles_at());
}

TEST(SystemTimelineTest, AChangeOfRateLeavesASlewItsOffset) {
  SystemTimeline clock = timeline();
  clock.slew(at_ms(0), from_ms(2), 500'000);
  clock.adjust_frequency(at_ms(1000), 1e6);
  EXPECT_EQ(clock.settles_at(), at_ms(4000));
  EXPECT_NEAR(reads_ms(clock, at_ms(6000)), 6000 + 2 + 5, 2e-6);
}

TEST(SystemTimelineTest, RestartIsAStepToRateZero) {
  SystemTimeline clock = timeline();
  clock.adjust_frequency(at_ms(0), 1e6);
  clock.slew(at_ms(0), from_ms(2), 500'000);
  clock.restart(at_ms(1000), host_ms(50));
  EXPECT_EQ(clock.read(at_ms(3000)), host_ms(2050));
  EXPECT_EQ(clock.present(at_ms(3000)).rate_ppb, 0);
  EXPECT_FALSE(clock.settles_at());
  EXPECT_EQ(clock.read(at_ms(999)), host_ms(999 + 0.999 + 0.4995));
}

TEST(SystemTimelineTest, WhenFindsTheFirstInstantOfAReadingAlsoBeyondASlew) {
  SystemTimeline clock = timeline(35, 250);
  clock.adjust_frequency(at_ms(100), -20'000);
  clock.slew(at_ms(200), from_ms(3), 500'000);
  for (const double ms : {450.5, 460.0, 1234.567891, 6452.0, 60'000.0}) {
    const MonotonicTime found = clock.when(host_ms(ms), at_ms(200));
    EXPECT_GE(clock.read(found), host_ms(ms));
    EXPECT_LT(clock.read(found - Nanoseconds(1)), host_ms(ms));
  }
}

TEST(SystemTimelineTest, WhenAReadingIsPastIsNow) {
  SystemTimeline clock = timeline();
  clock.set(at_ms(10), host_ms(1000));
  EXPECT_EQ(clock.when(host_ms(1000), at_ms(30)), at_ms(30));
  EXPECT_EQ(clock.when(HostTime::min(), at_ms(30)), at_ms(30));
}

TEST(SystemTimelineTest, WhatIsCenturiesAwayIsNever) {
  SystemTimeline clock = timeline(30, 1.8e12);
  EXPECT_EQ(clock.when(HostTime::max(), at_ms(5)), MonotonicTime::max());
  clock.set(at_ms(10), HostTime::max());
  EXPECT_GT(clock.read(at_ms(10)), host_ms(4e12));
  EXPECT_EQ(clock.when(HostTime::max(), at_ms(10)), at_ms(10));
  clock.set(at_ms(20), HostTime::min());
  EXPECT_LT(clock.read(at_ms(20)), host_ms(-4e12));
  clock.slew(at_ms(30), Nanoseconds::max(), 1e-3);
  EXPECT_FALSE(clock.settles_at());
  clock.slew(at_ms(40), Nanoseconds::min(), 4e8);
  EXPECT_LT(clock.read(at_ms(1040)), clock.read(at_ms(40)) + from_ms(601));
}

TEST(SystemTimelineTest, ObserverHearsStepRateAndBothEndsOfASlewInOrder) {
  SystemTimeline clock = timeline(0, 5);
  std::vector<ClockAdjustment> log{clock.present(at_ms(1))};
  clock.observe([&](const ClockAdjustment& entry) { log.push_back(entry); });
  clock.set(at_ms(10), host_ms(100));
  clock.adjust_frequency(at_ms(20), 1000);
  clock.slew(at_ms(30), from_ms(1), 100'000'000);
  ASSERT_EQ(log.size(), 4u);
  clock.settle(at_ms(39));
  ASSERT_EQ(log.size(), 4u);
  clock.adjust_frequency(at_ms(50), 2000);  // the end of the slew comes before
  ASSERT_EQ(log.size(), 6u);
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
  EXPECT_EQ(log[5].at, SteadyTime(from_ms(50)));
  EXPECT_DOUBLE_EQ(log[5].rate_ppb, 2000);
}

TEST(SystemTimelineTest, ARateThatIsNoClocksIsRefusedAndChangesNothing) {
  SystemTimeline clock = timeline();
  clock.adjust_frequency(at_ms(1), 500);
  int told = 0;
  clock.observe([&](const ClockAdjustment&) { ++told; });
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double bad : {5e8, -5e8, nan, infinite, -infinite}) {
    EXPECT_THROW(clock.adjust_frequency(at_ms(2), bad), ClockError) << bad;
    EXPECT_THROW(clock.slew(at_ms(2), from_ms(1), bad), ClockError) << bad;
  }
  EXPECT_THROW(clock.slew(at_ms(2), from_ms(1), 0), ClockError);
  EXPECT_THROW(clock.slew(at_ms(2), from_ms(1), -5), ClockError);
  try {
    clock.adjust_frequency(at_ms(2), 7e8);
  } catch (const ClockError& error) {
    EXPECT_STREQ(error.what(),
                 "clock: found a rate of 700000000 ppb, allowed less than 500000000 ppb in either "
                 "direction");
  }
  EXPECT_EQ(told, 0);
  EXPECT_DOUBLE_EQ(clock.present(at_ms(3)).rate_ppb, 500);
}

// The exact course of a clock under the same adjustments, in long double and from its beginning.
class ExactClock {
 public:
  ExactClock(double skew_ppm, HostTime reads)
      : skew_(static_cast<long double>(skew_ppm) * 1e-6L), reads_ns_(nanoseconds_of(reads)) {}

  void advance(MonotonicTime to) {
    const long double counted = static_cast<long double>((to - at_).count()) * (1 + skew_);
    at_ = to;
    const long double slewed = slew_rate_ == 0 ? 0 : std::min(counted, slew_left_ns_ / slew_rate_);
    reads_ns_ += counted * (1 + frequency_) + slewed * slew_rate_;
    slew_left_ns_ -= slewed * slew_rate_;
    if (slewed < counted) slew_rate_ = slew_left_ns_ = 0;
  }
  void set(HostTime value) {
    reads_ns_ = static_cast<long double>(nanoseconds_of(value));
    slew_rate_ = slew_left_ns_ = 0;
  }
  void adjust_frequency(double ppb) { frequency_ = static_cast<long double>(ppb) * 1e-9L; }
  void slew(Nanoseconds offset, double ppb) {
    slew_left_ns_ = static_cast<long double>(offset.count());
    slew_rate_ = std::copysign(static_cast<long double>(ppb) * 1e-9L, slew_left_ns_);
    if (offset.count() == 0) slew_rate_ = 0;
  }
  long double reads_ns() const { return reads_ns_; }

 private:
  long double skew_;
  MonotonicTime at_{};
  long double reads_ns_;
  long double frequency_ = 0;
  long double slew_rate_ = 0;
  long double slew_left_ns_ = 0;
};

// One random adjustment, made on any clock through `adjust`.
struct RandomAdjustment {
  enum class Kind : std::uint8_t { kSet, kFrequency, kSlew } kind;
  HostTime value;
  double ppb;
  Nanoseconds offset;
};

RandomAdjustment random_adjustment(sim::RandomStream& random, bool may_step) {
  const auto kind = random.below(may_step ? 3 : 2);
  return {.kind = static_cast<RandomAdjustment::Kind>(2 - kind),
          .value = host_ms(random.normal(1e4)),
          .ppb = random.normal(1e5),
          .offset = random.below(8) == 0 ? Nanoseconds(0) : from_ms(random.normal(0.1))};
}

TEST(SystemTimelineTest, FollowsExactArithmeticThroughRandomAdjustments) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    sim::RandomStream random(seed, "adjustments");
    const double skew_ppm = random.normal(50);
    // Without steps, which forget what was wrong, errors have 2000 adjustments to add up in.
    const bool may_step = seed % 2 == 0;
    SystemTimeline clock = timeline(skew_ppm, 1e6);
    ExactClock exact(skew_ppm, host_ms(1e6));
    MonotonicTime at{};
    for (int i = 0; i < 2000; ++i) {
      at += Nanoseconds(static_cast<std::int64_t>(random.uniform(1, 5e8)));
      exact.advance(at);
      const auto error_ns = static_cast<double>(nanoseconds_of(clock.read(at)) - exact.reads_ns());
      ASSERT_NEAR(error_ns, -0.5, 0.51 + 1e-3 * i) << "seed " << seed << ", adjustment " << i;
      const RandomAdjustment adjustment = random_adjustment(random, may_step);
      switch (adjustment.kind) {
        case RandomAdjustment::Kind::kSet:
          clock.set(at, adjustment.value);
          exact.set(adjustment.value);
          break;
        case RandomAdjustment::Kind::kFrequency:
          clock.adjust_frequency(at, adjustment.ppb);
          exact.adjust_frequency(adjustment.ppb);
          break;
        case RandomAdjustment::Kind::kSlew:
          clock.slew(at, adjustment.offset, 500'000);
          exact.slew(adjustment.offset, 500'000);
          break;
      }
    }
  }
}

template <class Clock, class Time>
void make(const RandomAdjustment& adjustment, Time at, Clock& clock) {
  switch (adjustment.kind) {
    case RandomAdjustment::Kind::kSet:
      clock.set(at, adjustment.value);
      break;
    case RandomAdjustment::Kind::kFrequency:
      clock.adjust_frequency(at, adjustment.ppb);
      break;
    case RandomAdjustment::Kind::kSlew:
      clock.slew(at, adjustment.offset, 500'000);
      break;
  }
}

template <class TimeA, class TimeB>
std::int64_t apart_ns(TimeA a, TimeB b) {
  return std::abs((a.time_since_epoch() - b.time_since_epoch()).count());
}

// The two worlds agree on what an adjustment means, and on what is told of it.
TEST(SystemTimelineTest, AgreesWithTheSimulatedClock) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    sim::RandomStream random(seed, "two worlds");
    const double skew_ppm = random.normal(50);
    const double offset_ms = random.normal(300);
    SystemTimeline real = timeline(skew_ppm, offset_ms);
    sim::SystemClock simulated(3, sim::OscillatorModel(skew_ppm * 1e-6), from_ms(offset_ms));
    std::vector<ClockAdjustment> told;
    std::vector<ClockAdjustment> told_by_sim;
    real.observe([&](const ClockAdjustment& entry) { told.push_back(entry); });
    simulated.observe([&](const ClockAdjustment& entry) { told_by_sim.push_back(entry); });
    Nanoseconds at{};
    for (int i = 0; i < 300; ++i) {
      at += Nanoseconds(static_cast<std::int64_t>(random.uniform(1, 5e8)));
      ASSERT_LE(apart_ns(real.read(MonotonicTime(at)), simulated.read(TrueTime(at))), 1)
          << "seed " << seed << ", adjustment " << i;
      const RandomAdjustment adjustment = random_adjustment(random, true);
      make(adjustment, MonotonicTime(at), real);
      make(adjustment, TrueTime(at), simulated);
      const HostTime later = real.read(MonotonicTime(at)) + from_ms(random.uniform(-10, 1000));
      ASSERT_LE(apart_ns(real.when(later, MonotonicTime(at)), simulated.when(later, TrueTime(at))),
                2)
          << "seed " << seed << ", adjustment " << i;
    }
    ASSERT_EQ(told.size(), told_by_sim.size()) << "seed " << seed;
    for (std::size_t i = 0; i < told.size(); ++i) {
      EXPECT_LE(apart_ns(told[i].at, told_by_sim[i].at), 2) << "seed " << seed;
      EXPECT_LE(apart_ns(told[i].before, told_by_sim[i].before), 2) << "seed " << seed;
      EXPECT_LE(apart_ns(told[i].after, told_by_sim[i].after), 2) << "seed " << seed;
      EXPECT_DOUBLE_EQ(told[i].rate_ppb, told_by_sim[i].rate_ppb) << "seed " << seed;
    }
  }
}

// What is told must be enough to go from the steady clock to the system clock at any instant.
TEST(SystemTimelineTest, WhatIsToldReproducesTheClockFromItsSteadyClock) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    sim::RandomStream random(seed, "log");
    SystemTimeline clock = timeline(random.normal(50), random.normal(300));
    std::vector<ClockAdjustment> log{clock.present(at_ms(0))};
    clock.observe([&](const ClockAdjustment& entry) { log.push_back(entry); });
    for (int i = 1; i <= 30; ++i) {
      make(random_adjustment(random, true), at_ms(i * 100 + random.uniform(0, 50)), clock);
      clock.settle(at_ms(i * 100 + 99));
    }
    std::size_t entry = 0;
    for (int ms = 0; ms < 3099; ms += 7) {
      const SteadyTime steady = clock.oscillator().steady(at_ms(ms));
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

}  // namespace
}  // namespace simbench::hardware
