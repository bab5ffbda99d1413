// The clock of both worlds: analytic expectations, then properties, then each other's.
#include "clocks/disciplined_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "hardware/clock/node_clock.h"
#include "sim/clock/system_clock.h"
#include "sim/engine/random.h"

namespace simbench::clocks {
namespace {

struct SimulatedWorld {
  using Oscillator = sim::HostOscillator;
  static Oscillator skewed(double ppm) { return {.model = sim::OscillatorModel(ppm * 1e-6)}; }
};

struct RealWorld {
  using Oscillator = hardware::NodeOscillator;
  static Oscillator skewed(double ppm) { return {MonotonicTime{}, SteadyTime{}, ppm}; }
};

HostTime host_ms(double ms) { return HostTime(from_ms(ms)); }

template <class World>
class DisciplinedClockTest : public testing::Test {
 protected:
  using Clock = DisciplinedClock<typename World::Oscillator>;
  using Instant = typename Clock::Instant;

  static Instant at_ms(double ms) { return Instant(from_ms(ms)); }
  static double reads_ms(const Clock& clock, Instant t) {
    return to_ms(clock.read(t).time_since_epoch());
  }
  // The clock of host 3, which reads `offset_ms` at the zero of its world.
  static Clock make(double skew_ppm = 0, double offset_ms = 0,
                    std::size_t history = Clock::kWholeHistory) {
    return {3, World::skewed(skew_ppm), at_ms(0), host_ms(offset_ms), history};
  }
};

using Worlds = testing::Types<SimulatedWorld, RealWorld>;
TYPED_TEST_SUITE(DisciplinedClockTest, Worlds);

TYPED_TEST(DisciplinedClockTest, PerfectClockReadsItsInstantsPlusItsOffset) {
  const auto clock = this->make(0, -3);
  for (const double ms : {-1e7, -0.5, 0.0, 2.5, 1e9}) {
    EXPECT_EQ(clock.read(this->at_ms(ms)), host_ms(ms - 3));
  }
}

TYPED_TEST(DisciplinedClockTest, ALeapIsAddedToAnUnfinishedSlew) {
  auto clock = this->make(0, 250);
  clock.slew(this->at_ms(1000), from_ms(2), 500'000);  // takes 4 s
  clock.leap(this->at_ms(3000), from_ms(-1000));
  EXPECT_NEAR(this->reads_ms(clock, this->at_ms(2999)), 3249 + 0.9995, 2e-6);
  EXPECT_NEAR(this->reads_ms(clock, this->at_ms(3000)), 2250 + 1, 2e-6);
  EXPECT_NEAR(this->reads_ms(clock, this->at_ms(9000)), 8250 + 2, 2e-6);
}

TYPED_TEST(DisciplinedClockTest, LinearClockGainsItsSkew) {
  const auto clock = this->make(10, 250);
  EXPECT_EQ(clock.read(this->at_ms(1e6)), host_ms(1e6 + 250 + 10));
  EXPECT_EQ(clock.read(this->at_ms(-1e6)), host_ms(-1e6 + 250 - 10));
  EXPECT_EQ(clock.read(this->at_ms(0.15)), HostTime(Nanoseconds(250'150'001)));
}

TYPED_TEST(DisciplinedClockTest, SteppedClockReadsTheNewValueFromTheStepOnAndThePastAsItWas) {
  auto clock = this->make();
  clock.set(this->at_ms(10), host_ms(1000));
  clock.set(this->at_ms(20), host_ms(500));
  EXPECT_EQ(clock.read(this->at_ms(20)), host_ms(500));
  EXPECT_EQ(clock.read(this->at_ms(50)), host_ms(530));
  EXPECT_EQ(clock.read(this->at_ms(19)), host_ms(1009));
  EXPECT_EQ(clock.read(this->at_ms(10)), host_ms(1000));
  EXPECT_EQ(clock.read(this->at_ms(10) - Nanoseconds(1)), host_ms(10) - Nanoseconds(1));
  EXPECT_EQ(clock.read(this->at_ms(-5)), host_ms(-5));
  EXPECT_EQ(clock.read(this->at_ms(20)), host_ms(500));
}

TYPED_TEST(DisciplinedClockTest, TheWholeHistoryIsKeptUnlessLimited) {
  auto clock = this->make();
  for (int i = 1; i <= 200; ++i) clock.set(this->at_ms(i * 10), host_ms(i * 1000));
  for (int i = 1; i <= 200; ++i) {
    EXPECT_EQ(clock.read(this->at_ms(i * 10 + 9)), host_ms(i * 1000 + 9)) << i;
  }
  EXPECT_EQ(clock.read(this->at_ms(5)), host_ms(5));
}

TYPED_TEST(DisciplinedClockTest, AHistoryOf64AdjustmentsForgetsWhatIsOlder) {
  auto clock = this->make(0, 0, 64);
  for (int i = 1; i <= 200; ++i) clock.set(this->at_ms(i * 10), host_ms(i * 1000));
  for (int i = 200 - 64; i <= 200; ++i) {
    EXPECT_EQ(clock.read(this->at_ms(i * 10 + 9)), host_ms(i * 1000 + 9)) << i;
  }
  // What is older is read as if the oldest kept had always been.
  EXPECT_EQ(clock.read(this->at_ms(0)), host_ms(136 * 1000 - 1360));
}

TYPED_TEST(DisciplinedClockTest, AShortHistoryKeepsThePlannedEndOfASlew) {
  auto clock = this->make(0, 0, 1);
  std::vector<ClockAdjustment> log;
  clock.observe([&](const ClockAdjustment& entry) { log.push_back(entry); });
  for (int i = 0; i < 5; ++i) {
    clock.slew(this->at_ms(i * 10'000), from_ms(2), 500'000);
    EXPECT_EQ(clock.read(this->at_ms(i * 10'000 + 2000)), host_ms(i * 10'002 + 2001));
    EXPECT_EQ(clock.read(this->at_ms(i * 10'000 + 9000)), host_ms(i * 10'002 + 9002));
    clock.settle(this->at_ms(i * 10'000 + 4000));
    EXPECT_EQ(clock.read(this->at_ms(i * 10'000 + 9000)), host_ms(i * 10'002 + 9002));
  }
  EXPECT_EQ(log.size(), 10u);
}

TYPED_TEST(DisciplinedClockTest, ChangeOfRateGoesOnFromTheReading) {
  auto clock = this->make(0, 5);
  clock.adjust_frequency(this->at_ms(1000), 500'000);
  EXPECT_EQ(clock.read(this->at_ms(1000)), host_ms(1005));
  EXPECT_EQ(clock.read(this->at_ms(3000)), host_ms(3005 + 1));
  clock.adjust_frequency(this->at_ms(3000), -500'000);
  EXPECT_EQ(clock.read(this->at_ms(5000)), host_ms(5005));
}

TYPED_TEST(DisciplinedClockTest, RateAppliesToWhatTheOscillatorCounts) {
  auto clock = this->make(1000, 5);
  clock.adjust_frequency(this->at_ms(0), 1e6);
  EXPECT_EQ(clock.read(this->at_ms(1000)), host_ms(5 + 1000 * 1.001 * 1.001));
}

TYPED_TEST(DisciplinedClockTest, TinyRatesAddUpOverManyAdjustments) {
  auto clock = this->make();
  for (int i = 0; i < 10'000; ++i) {
    clock.adjust_frequency(this->at_ms(i * 0.1), i % 2 == 0 ? 1.0 : 3.0);
  }
  // 2 ppb on average over 1 s: 2 ns, in pieces of 1e-4 ns that no setting rounds away.
  EXPECT_EQ(clock.read(this->at_ms(1000) + Nanoseconds(10)), host_ms(1000) + Nanoseconds(12));
}

TYPED_TEST(DisciplinedClockTest, ARateOfOnePartInABillionSurvivesADay) {
  auto clock = this->make();
  clock.adjust_frequency(this->at_ms(0), 1);
  EXPECT_EQ(clock.read(this->at_ms(86'400e3)), host_ms(86'400e3) + Nanoseconds(86'400));
}

TYPED_TEST(DisciplinedClockTest, PeriodicSkewIsATriangle) {
  auto clock = this->make();
  for (int s = 0; s < 100; ++s) {
    clock.adjust_frequency(this->at_ms(s * 1e3), s % 2 == 0 ? 1e5 : -1e5);
  }
  for (int s = 0; s < 100; ++s) {
    for (const int part_ms : {0, 250, 500, 750}) {
      const double expected_ms = (s % 2 == 0 ? part_ms : 1000 - part_ms) * 1e-4;
      EXPECT_NEAR(this->reads_ms(clock, this->at_ms(s * 1e3 + part_ms)),
                  s * 1e3 + part_ms + expected_ms, 2e-6);
    }
  }
}

TYPED_TEST(DisciplinedClockTest, SlewAddsItsOffsetAndEndsByItself) {
  auto clock = this->make();
  clock.slew(this->at_ms(1000), from_ms(2), 500'000);  // 2 ms at 500 ppm: 4 s
  EXPECT_EQ(clock.settles_at(), this->at_ms(5000));
  EXPECT_EQ(clock.read(this->at_ms(3000)), host_ms(3001));
  EXPECT_EQ(clock.read(this->at_ms(5000)), host_ms(5002));
  EXPECT_EQ(clock.read(this->at_ms(60'000)), host_ms(60'002));
  clock.settle(this->at_ms(5000));
  EXPECT_FALSE(clock.settles_at());
  EXPECT_EQ(clock.read(this->at_ms(3000)), host_ms(3001));
  EXPECT_EQ(clock.read(this->at_ms(60'000)), host_ms(60'002));
}

TYPED_TEST(DisciplinedClockTest, SlewBackwardsNeverStepsBack) {
  auto clock = this->make();
  clock.slew(this->at_ms(0), from_ms(-1), 100'000'000);  // 10 ms at -10 %
  HostTime before = clock.read(this->at_ms(0));
  for (int us = 1; us < 20'000; ++us) {
    const HostTime now = clock.read(this->at_ms(us * 1e-3));
    ASSERT_GE(now, before);
    before = now;
  }
  EXPECT_EQ(clock.read(this->at_ms(20)), host_ms(19));
}

TYPED_TEST(DisciplinedClockTest, AnotherSlewReplacesTheRestOfTheFirst) {
  auto clock = this->make();
  clock.slew(this->at_ms(0), from_ms(2), 500'000);
  clock.slew(this->at_ms(1000), from_ms(-1), 500'000);
  EXPECT_EQ(clock.read(this->at_ms(1000)), host_ms(1000.5));
  EXPECT_EQ(clock.read(this->at_ms(9000)), host_ms(8999.5));
}

TYPED_TEST(DisciplinedClockTest, ASlewOfNothingEndsTheOneBefore) {
  auto clock = this->make();
  clock.slew(this->at_ms(1000), from_ms(2), 500'000);
  clock.slew(this->at_ms(3000), from_ms(0), 0);
  EXPECT_FALSE(clock.settles_at());
  EXPECT_EQ(clock.read(this->at_ms(60'000)), host_ms(60'001));
}

TYPED_TEST(DisciplinedClockTest, AStepEndsASlewAndKeepsTheRate) {
  auto clock = this->make();
  clock.adjust_frequency(this->at_ms(0), 1e6);
  clock.slew(this->at_ms(0), from_ms(2), 500'000);
  clock.set(this->at_ms(1000), host_ms(0));
  EXPECT_EQ(clock.read(this->at_ms(2000)), host_ms(1001));
  EXPECT_FALSE(clock.settles_at());
}

TYPED_TEST(DisciplinedClockTest, AChangeOfRateLeavesASlewItsOffset) {
  auto clock = this->make();
  clock.slew(this->at_ms(0), from_ms(2), 500'000);
  clock.adjust_frequency(this->at_ms(1000), 1e6);
  EXPECT_EQ(clock.settles_at(), this->at_ms(4000));
  EXPECT_NEAR(this->reads_ms(clock, this->at_ms(6000)), 6000 + 2 + 5, 2e-6);
}

TYPED_TEST(DisciplinedClockTest, RestartIsAStepToRateZero) {
  auto clock = this->make();
  clock.adjust_frequency(this->at_ms(0), 1e6);
  clock.slew(this->at_ms(0), from_ms(2), 500'000);
  clock.restart(this->at_ms(1000), host_ms(50));
  EXPECT_EQ(clock.read(this->at_ms(3000)), host_ms(2050));
  EXPECT_EQ(clock.present(this->at_ms(3000)).rate_ppb, 0);
  EXPECT_FALSE(clock.settles_at());
  EXPECT_EQ(clock.read(this->at_ms(999)), host_ms(999 + 0.999 + 0.4995));
}

TYPED_TEST(DisciplinedClockTest, WhenFindsTheFirstInstantOfAReadingAlsoBeyondASlew) {
  auto clock = this->make(35, 250);
  clock.adjust_frequency(this->at_ms(100), -20'000);
  clock.slew(this->at_ms(200), from_ms(3), 500'000);
  for (const double ms : {450.5, 460.0, 1234.567891, 6452.0, 60'000.0}) {
    const auto found = clock.when(host_ms(ms), this->at_ms(200));
    EXPECT_GE(clock.read(found), host_ms(ms));
    EXPECT_LT(clock.read(found - Nanoseconds(1)), host_ms(ms));
  }
}

TYPED_TEST(DisciplinedClockTest, WhenAReadingIsPastIsNow) {
  auto clock = this->make();
  clock.set(this->at_ms(10), host_ms(1000));
  EXPECT_EQ(clock.when(host_ms(1000), this->at_ms(30)), this->at_ms(30));
  EXPECT_EQ(clock.when(host_ms(20), this->at_ms(30)), this->at_ms(30));
  EXPECT_EQ(clock.when(HostTime::min(), this->at_ms(30)), this->at_ms(30));
}

TYPED_TEST(DisciplinedClockTest, WhatIsCenturiesAwayIsNever) {
  auto clock = this->make(30, 1.8e12);
  EXPECT_EQ(clock.when(HostTime::max(), this->at_ms(5)), decltype(this->at_ms(5))::max());
  clock.set(this->at_ms(10), HostTime::max());
  EXPECT_GT(clock.read(this->at_ms(10)), host_ms(4e12));
  EXPECT_EQ(clock.when(HostTime::max(), this->at_ms(10)), this->at_ms(10));
  clock.set(this->at_ms(20), HostTime::min());
  EXPECT_LT(clock.read(this->at_ms(20)), host_ms(-4e12));
  clock.slew(this->at_ms(30), Nanoseconds::max(), 1e-3);
  EXPECT_FALSE(clock.settles_at());
  clock.slew(this->at_ms(40), Nanoseconds::min(), 4e8);
  EXPECT_LT(clock.read(this->at_ms(1040)), clock.read(this->at_ms(40)) + from_ms(601));
}

TYPED_TEST(DisciplinedClockTest, TheObserverIsNotifiedOfStepRateAndBothEndsOfASlewInOrder) {
  auto clock = this->make(0, 5);
  std::vector<ClockAdjustment> log{clock.present(this->at_ms(1))};
  clock.observe([&](const ClockAdjustment& entry) { log.push_back(entry); });
  clock.set(this->at_ms(10), host_ms(100));
  clock.adjust_frequency(this->at_ms(20), 1000);
  clock.slew(this->at_ms(30), from_ms(1), 100'000'000);
  ASSERT_EQ(log.size(), 4u);
  clock.settle(this->at_ms(39));
  ASSERT_EQ(log.size(), 4u);
  clock.settle(this->at_ms(40));
  ASSERT_EQ(log.size(), 5u);
  clock.slew(this->at_ms(50), from_ms(1), 100'000'000);
  clock.adjust_frequency(this->at_ms(70), 2000);  // the end of the slew comes before
  ASSERT_EQ(log.size(), 8u);
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
  EXPECT_EQ(log[6].at, SteadyTime(from_ms(60)));
  EXPECT_EQ(log[7].at, SteadyTime(from_ms(70)));
  EXPECT_DOUBLE_EQ(log[7].rate_ppb, 2000);
}

TYPED_TEST(DisciplinedClockTest, ARateThatIsNoClocksIsRefusedAndChangesNothing) {
  auto clock = this->make();
  clock.adjust_frequency(this->at_ms(1), 500);
  int notified = 0;
  clock.observe([&](const ClockAdjustment&) { ++notified; });
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double bad : {5e8, -5e8, nan, infinite, -infinite}) {
    EXPECT_THROW(clock.adjust_frequency(this->at_ms(2), bad), ClockError) << bad;
    EXPECT_THROW(clock.slew(this->at_ms(2), from_ms(1), bad), ClockError) << bad;
  }
  EXPECT_THROW(clock.slew(this->at_ms(2), from_ms(1), 0), ClockError);
  EXPECT_THROW(clock.slew(this->at_ms(2), from_ms(1), -5), ClockError);
  try {
    clock.adjust_frequency(this->at_ms(2), 7e8);
    FAIL() << "nothing was thrown";
  } catch (const ClockError& error) {
    EXPECT_STREQ(error.what(),
                 "clock: found a rate of 700000000 ppb, allowed less than 500000000 ppb in either "
                 "direction");
  }
  EXPECT_EQ(notified, 0);
  EXPECT_DOUBLE_EQ(clock.present(this->at_ms(3)).rate_ppb, 500);
}

// The exact course of a clock under the same adjustments, in long double and from its beginning.
class ExactClock {
 public:
  ExactClock(double skew_ppm, HostTime reads)
      : skew_(static_cast<long double>(skew_ppm) * 1e-6L), reads_ns_(nanoseconds_of(reads)) {}

  void advance(Nanoseconds to) {
    const long double counted = static_cast<long double>((to - at_).count()) * (1 + skew_);
    at_ = to;
    const long double slewed = slew_rate_ == 0 ? 0 : std::min(counted, slew_left_ns_ / slew_rate_);
    reads_ns_ += counted * (1 + frequency_) + slewed * slew_rate_;
    slew_left_ns_ -= slewed * slew_rate_;
    if (slewed < counted) slew_rate_ = slew_left_ns_ = 0;
  }
  void set(Nanoseconds /*at*/, HostTime value) {
    reads_ns_ = static_cast<long double>(nanoseconds_of(value));
    slew_rate_ = slew_left_ns_ = 0;
  }
  void adjust_frequency(Nanoseconds /*at*/, double ppb) {
    frequency_ = static_cast<long double>(ppb) * 1e-9L;
  }
  void slew(Nanoseconds /*at*/, Nanoseconds offset, double ppb) {
    slew_left_ns_ = static_cast<long double>(offset.count());
    slew_rate_ = std::copysign(static_cast<long double>(ppb) * 1e-9L, slew_left_ns_);
    if (offset.count() == 0) slew_rate_ = 0;
  }
  long double reads_ns() const { return reads_ns_; }

 private:
  long double skew_;
  Nanoseconds at_{};
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

template <class Clock, class Time>
void make_adjustment(const RandomAdjustment& adjustment, Time at, Clock& clock) {
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

TYPED_TEST(DisciplinedClockTest, FollowsExactArithmeticThroughRandomAdjustments) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    sim::RandomStream random(seed, "adjustments");
    const double skew_ppm = random.normal(50);
    // Without steps, which forget what was wrong, errors have 2000 adjustments to add up in.
    const bool may_step = seed % 2 == 0;
    auto clock = this->make(skew_ppm, 1e6);
    ExactClock exact(skew_ppm, host_ms(1e6));
    Nanoseconds elapsed{};
    for (int i = 0; i < 2000; ++i) {
      elapsed += Nanoseconds(static_cast<std::int64_t>(random.uniform(1, 5e8)));
      const auto at = this->at_ms(0) + elapsed;
      exact.advance(elapsed);
      const auto error_ns = static_cast<double>(nanoseconds_of(clock.read(at)) - exact.reads_ns());
      ASSERT_NEAR(error_ns, -0.5, 0.51 + 1e-3 * i) << "seed " << seed << ", adjustment " << i;
      const RandomAdjustment adjustment = random_adjustment(random, may_step);
      make_adjustment(adjustment, at, clock);
      make_adjustment(adjustment, elapsed, exact);
    }
  }
}

// What is reported must be enough to go from the steady clock to the system clock at any instant.
TYPED_TEST(DisciplinedClockTest, ReportsReproduceTheClockFromItsSteadyClock) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    sim::RandomStream random(seed, "log");
    auto clock = this->make(random.normal(50), random.normal(300));
    std::vector<ClockAdjustment> log{clock.present(this->at_ms(0))};
    clock.observe([&](const ClockAdjustment& entry) { log.push_back(entry); });
    for (int i = 1; i <= 50; ++i) {
      const auto at = this->at_ms(i * 100 + random.uniform(0, 50));
      make_adjustment(random_adjustment(random, true), at, clock);
      clock.settle(this->at_ms(i * 100 + 99));
    }
    std::size_t entry = 0;
    for (int ms = 0; ms < 5099; ms += 7) {
      const SteadyTime steady = clock.oscillator().steady(this->at_ms(ms));
      while (entry + 1 < log.size() && log[entry + 1].at <= steady) ++entry;
      const auto elapsed_ns = static_cast<double>((steady - log[entry].at).count());
      const HostTime expected =
          log[entry].after +
          Nanoseconds(std::llround(elapsed_ns * (1 + log[entry].rate_ppb * 1e-9)));
      ASSERT_LE(std::abs((clock.read(this->at_ms(ms)) - expected).count()), 2)
          << "seed " << seed << ", at " << ms << " ms";
    }
  }
}

// One clock for both worlds: the same adjustments give the same readings and reports.
TEST(DisciplinedClockWorldsTest, TheWorldsAgree) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    sim::RandomStream random(seed, "two worlds");
    const double skew_ppm = random.normal(50);
    const HostTime reads = host_ms(random.normal(300));
    DisciplinedClock real(3, RealWorld::skewed(skew_ppm), MonotonicTime{}, reads);
    DisciplinedClock simulated(3, SimulatedWorld::skewed(skew_ppm), TrueTime{}, reads);
    std::vector<ClockAdjustment> log;
    std::vector<ClockAdjustment> log_of_sim;
    real.observe([&](const ClockAdjustment& entry) { log.push_back(entry); });
    simulated.observe([&](const ClockAdjustment& entry) { log_of_sim.push_back(entry); });
    Nanoseconds at{};
    for (int i = 0; i < 300; ++i) {
      at += Nanoseconds(static_cast<std::int64_t>(random.uniform(1, 5e8)));
      ASSERT_LE(apart_ns(real.read(MonotonicTime(at)), simulated.read(TrueTime(at))), 1)
          << "seed " << seed << ", adjustment " << i;
      const RandomAdjustment adjustment = random_adjustment(random, true);
      make_adjustment(adjustment, MonotonicTime(at), real);
      make_adjustment(adjustment, TrueTime(at), simulated);
      const HostTime later = real.read(MonotonicTime(at)) + from_ms(random.uniform(-10, 1000));
      ASSERT_LE(apart_ns(real.when(later, MonotonicTime(at)), simulated.when(later, TrueTime(at))),
                2)
          << "seed " << seed << ", adjustment " << i;
    }
    ASSERT_EQ(log.size(), log_of_sim.size()) << "seed " << seed;
    for (std::size_t i = 0; i < log.size(); ++i) {
      EXPECT_LE(apart_ns(log[i].at, log_of_sim[i].at), 2) << "seed " << seed;
      EXPECT_LE(apart_ns(log[i].before, log_of_sim[i].before), 2) << "seed " << seed;
      EXPECT_LE(apart_ns(log[i].after, log_of_sim[i].after), 2) << "seed " << seed;
      EXPECT_DOUBLE_EQ(log[i].rate_ppb, log_of_sim[i].rate_ppb) << "seed " << seed;
    }
  }
}

// Remembers the furthest instant at which it was looked at.
struct WatchedOscillator {
  using Instant = MonotonicTime;
  double deviation_ns(Instant at) const {
    *furthest = std::max(*furthest, at);
    return to_ns(at.time_since_epoch()) * 1e-5;
  }
  SteadyTime steady(Instant at) const {
    return SteadyTime(at.time_since_epoch() + from_ns(deviation_ns(at)));
  }
  std::shared_ptr<Instant> furthest = std::make_shared<Instant>();
};

// 5e8 ms at 500 ppm take 31 years, through which nobody samples an oscillator's noise.
TEST(DisciplinedClockFarSlew, IsPlannedWhenItsEndIsNear) {
  const WatchedOscillator oscillator;
  DisciplinedClock clock(3, oscillator, MonotonicTime{}, HostTime{});
  std::vector<ClockAdjustment> log;
  clock.observe([&](const ClockAdjustment& entry) { log.push_back(entry); });
  clock.slew(MonotonicTime{}, from_ms(5e8), 500'000);
  EXPECT_EQ(*oscillator.furthest, MonotonicTime{});
  int looks = 0;
  MonotonicTime now{};
  for (std::optional<MonotonicTime> look; (look = clock.settles_at());) {
    ASSERT_GT(*look, now);
    ASSERT_LT(++looks, 40);
    now = *look;
    EXPECT_EQ(log.size(), 1U);
    clock.settle(now);
    EXPECT_LE(*oscillator.furthest, now + std::chrono::hours(25));
  }
  ASSERT_EQ(log.size(), 2U);
  EXPECT_EQ(log[1].rate_ppb, 0);
  const double ahead_ms =
      to_ms(clock.read(now) - HostTime(oscillator.steady(now).time_since_epoch()));
  EXPECT_NEAR(ahead_ms, 5e8, 1e-3);
}

TEST(FirstInstant, IsFoundFromAnyGuess) {
  for (const double guess : {-9e15, -1.0, 41.0, 42.0, 43.0, 1e15}) {
    int looks = 0;
    const TrueTime found = first_instant(TrueTime(from_ns(guess)), [&](TrueTime t) {
      ++looks;
      return t >= TrueTime(Nanoseconds(42));
    });
    EXPECT_EQ(found, TrueTime(Nanoseconds(42))) << guess;
    EXPECT_LT(looks, 120) << guess;
  }
}

TEST(FirstInstant, EndsWhereThereIsNone) {
  EXPECT_GT(first_instant(TrueTime{}, [](TrueTime) { return false; }),
            TrueTime(Nanoseconds(1L << 60)));
  EXPECT_LT(first_instant(TrueTime{}, [](TrueTime) { return true; }),
            TrueTime(Nanoseconds(-(1L << 59))));
}

}  // namespace
}  // namespace simbench::clocks
