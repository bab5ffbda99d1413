#include "sim/camera/shutter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/sim/at_ms.h"

namespace simbench::sim {
namespace {

constexpr double kModePeriod90 = 1e9 / 90;

ShutterSettings settings_of(ShutterMode mode, double mode_period_ns, double exposure_ms = 4) {
  return {.mode = mode,
          .mode_period_ns = mode_period_ns,
          .exposure = from_ms(exposure_ms),
          .readout = Nanoseconds(0),
          .trigger_to_exposure = Nanoseconds(0),
          .guard_fraction = 0.02,
          .free_run_after_periods = 3};
}

// The slots of those of `pulses` regular pulses that the shutter answers.
std::vector<std::int64_t> answered(const ShutterSettings& settings, double pulse_period_ns,
                                   int pulses) {
  Shutter shutter(settings, TrueTime{});
  std::vector<std::int64_t> slots;
  for (int slot = 0; slot < pulses; ++slot) {
    const TrueTime at{Nanoseconds(std::llround(slot * pulse_period_ns))};
    if (const auto exposure = shutter.on_pulse(at, slot)) slots.push_back(exposure->pulse);
  }
  return slots;
}

TEST(TriggeredShutter, ExposesFromThePulseOn) {
  ShutterSettings settings = settings_of(ShutterMode::kTriggered, kModePeriod90);
  settings.trigger_to_exposure = from_ms(0.02);
  Shutter shutter(settings, TrueTime{});
  const auto exposure = shutter.on_pulse(at_ms(100), 9);
  ASSERT_TRUE(exposure);
  EXPECT_EQ(exposure->start, at_ms(100.02));
  EXPECT_EQ(exposure->end, at_ms(104.02));
  EXPECT_EQ(shutter.next_timer(), TrueTime::max()) << "it waits for pulses without limit";
}

// At the rate of its mode it answers each pulse, where genlock answers every second one.
TEST(TriggeredShutter, AnswersEveryPulseUpToItsModeRate) {
  const ShutterSettings settings = settings_of(ShutterMode::kTriggered, kModePeriod90);
  const std::vector<std::int64_t> all = {0, 1, 2, 3, 4};
  EXPECT_EQ(answered(settings, kModePeriod90, 5), all);
  EXPECT_EQ(answered(settings, 7 * kModePeriod90, 5), all);
  EXPECT_EQ(answered(settings, kModePeriod90 / 2, 5), (std::vector<std::int64_t>{0, 2, 4}));
}

TEST(GenlockShutter, ExposureStartsWithThePulse) {
  ShutterSettings settings = settings_of(ShutterMode::kGenlock, kModePeriod90);
  settings.trigger_to_exposure = from_ms(0.79);
  Shutter shutter(settings, TrueTime{});
  const auto exposure = shutter.on_pulse(at_ms(100), 9);
  ASSERT_TRUE(exposure);
  EXPECT_EQ(exposure->pulse, 9);
  EXPECT_EQ(exposure->start, at_ms(100.79));
  EXPECT_EQ(exposure->end, at_ms(104.79));
}

TEST(GenlockShutter, AnswersEveryPulseAtHalfTheModeRate) {
  EXPECT_EQ(answered(settings_of(ShutterMode::kGenlock, kModePeriod90), 2 * kModePeriod90, 5),
            (std::vector<std::int64_t>{0, 1, 2, 3, 4}));
}

TEST(GenlockShutter, RefusesATriggerAtTheFullModeRate) {
  EXPECT_EQ(answered(settings_of(ShutterMode::kGenlock, kModePeriod90), kModePeriod90, 8),
            (std::vector<std::int64_t>{0, 2, 4, 6}));
}

TEST(GenlockShutter, ASlowCameraWithoutGuardHalvesTheRateAgain) {
  // Its own two periods last 50 ppm longer than the trigger's one.
  ShutterSettings slow = settings_of(ShutterMode::kGenlock, kModePeriod90 * (1 + 50e-6));
  EXPECT_EQ(answered(slow, 2 * kModePeriod90, 6), (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5}));
  slow.guard_fraction = 0;
  EXPECT_EQ(answered(slow, 2 * kModePeriod90, 6), (std::vector<std::int64_t>{0, 2, 4}));
}

TEST(GenlockShutter, AnExposureBeyondTheCycleMissesPulses) {
  EXPECT_EQ(answered(settings_of(ShutterMode::kGenlock, kModePeriod90, 23), 2 * kModePeriod90, 5),
            (std::vector<std::int64_t>{0, 2, 4}));
}

TEST(GenlockShutter, WaitsForPulsesWithoutLimitAndKnowsNoneBeforeItsStart) {
  Shutter shutter(settings_of(ShutterMode::kGenlock, kModePeriod90), at_ms(50));
  EXPECT_EQ(shutter.next_timer(), TrueTime::max());
  EXPECT_FALSE(shutter.on_pulse(at_ms(49.9), 0));
  EXPECT_TRUE(shutter.on_pulse(at_ms(3.6e6), 1));
}

TEST(SlaveShutter, ExposureEndsAtAFixedPhaseWhateverItsLength) {
  for (const double exposure_ms : {1.0, 4.0, 11.0}) {
    Shutter shutter(settings_of(ShutterMode::kSlave, kModePeriod90, exposure_ms), TrueTime{});
    const auto exposure = shutter.on_pulse(at_ms(20), 1);
    ASSERT_TRUE(exposure);
    EXPECT_EQ(exposure->end, at_ms(20) + Nanoseconds(11111111)) << exposure_ms << " ms";
    EXPECT_EQ(exposure->end - exposure->start, from_ms(exposure_ms));
  }
}

TEST(SlaveShutter, FollowsPulsesAtTheModeRate) {
  // 500 ppm fast, as support advises.
  EXPECT_EQ(answered(settings_of(ShutterMode::kSlave, kModePeriod90), kModePeriod90 / 1.0005, 4),
            (std::vector<std::int64_t>{0, 1, 2, 3}));
}

// No two exposures of a row overlap.
TEST(SlaveShutter, AnExposureBeyondThePeriodMissesPulses) {
  EXPECT_EQ(answered(settings_of(ShutterMode::kSlave, kModePeriod90, 12), kModePeriod90, 8),
            (std::vector<std::int64_t>{0, 2, 4, 6}));
}

TEST(SlaveShutter, RunsFreeWithoutPulsesAndIsTakenBack) {
  const double period_ns = 10e6;
  Shutter shutter(settings_of(ShutterMode::kSlave, period_ns), TrueTime{});
  ASSERT_TRUE(shutter.on_pulse(at_ms(5), 0));
  EXPECT_EQ(shutter.next_timer(), at_ms(30));
  EXPECT_FALSE(shutter.on_timer(at_ms(30)));  // three periods after the pulse are not over
  ASSERT_EQ(shutter.next_timer(), at_ms(35));
  for (int frame = 0; frame < 4; ++frame) {
    const TrueTime due = at_ms(35 + 10 * frame);
    ASSERT_EQ(shutter.next_timer(), due);
    const auto exposure = shutter.on_timer(due);
    ASSERT_TRUE(exposure);
    EXPECT_EQ(exposure->pulse, kNoPulse);
    EXPECT_EQ(exposure->end, due + from_ms(10));
  }
  ASSERT_EQ(shutter.next_timer(), at_ms(75));
  EXPECT_FALSE(shutter.on_pulse(at_ms(70), 1));  // in the middle of a free-running frame
  const auto taken_back = shutter.on_pulse(at_ms(74.9), 2);
  ASSERT_TRUE(taken_back);
  EXPECT_EQ(taken_back->pulse, 2);
  EXPECT_FALSE(shutter.on_timer(at_ms(75)));
  EXPECT_EQ(shutter.next_timer(), at_ms(104.9));
}

// Exposure 4 ms, and the last row begins 9 ms after the first.
TEST(RollingShutter, LastsFromTheFirstRowsStartToTheLastRowsEnd) {
  ShutterSettings settings = settings_of(ShutterMode::kGenlock, kModePeriod90);
  settings.readout = from_ms(9);
  Shutter genlock(settings, TrueTime{});
  const auto started = genlock.on_pulse(at_ms(100), 0);
  ASSERT_TRUE(started);
  EXPECT_EQ(started->start, at_ms(100));
  EXPECT_EQ(started->end, at_ms(113));

  settings.mode = ShutterMode::kSlave;
  Shutter slave(settings, TrueTime{});
  const auto ended = slave.on_pulse(at_ms(100), 0);
  ASSERT_TRUE(ended);
  EXPECT_EQ(ended->end, at_ms(100) + Nanoseconds(11111111));
  EXPECT_EQ(ended->end - ended->start, from_ms(13));

  settings.mode = ShutterMode::kFreeRunning;
  Shutter free_running(settings, at_ms(50));
  const auto unbound = free_running.on_timer(at_ms(50));
  ASSERT_TRUE(unbound);
  EXPECT_EQ(unbound->end, at_ms(50) + Nanoseconds(11111111));
  EXPECT_EQ(unbound->end - unbound->start, from_ms(13));
}

TEST(RollingShutter, GenlockIgnoresPulsesWhileItReadsOut) {
  ShutterSettings settings = settings_of(ShutterMode::kGenlock, kModePeriod90);
  settings.readout = from_ms(18.2);  // 22.2 ms in all: just within the period
  EXPECT_EQ(answered(settings, 2 * kModePeriod90, 4), (std::vector<std::int64_t>{0, 1, 2, 3}));
  settings.readout = from_ms(18.3);
  EXPECT_EQ(answered(settings, 2 * kModePeriod90, 5), (std::vector<std::int64_t>{0, 2, 4}));
}

TEST(Shutter, ANewExposureTimeCountsFromTheNextExposureOn) {
  Shutter shutter(settings_of(ShutterMode::kGenlock, kModePeriod90), TrueTime{});
  ASSERT_EQ(shutter.on_pulse(at_ms(0), 0)->end, at_ms(4));
  shutter.set_exposure(from_ms(6));
  EXPECT_EQ(shutter.on_pulse(at_ms(30), 1)->end, at_ms(36));
}

TEST(FreeRunningShutter, AnExposureBeyondThePeriodTakesTwo) {
  Shutter shutter(settings_of(ShutterMode::kFreeRunning, kModePeriod90, 12), TrueTime{});
  const TrueTime first = shutter.next_timer();
  ASSERT_TRUE(shutter.on_timer(first));
  EXPECT_NEAR(to_ms(shutter.next_timer() - first), 2e3 / 90, 1e-6);
}

TEST(FreeRunningShutter, KeepsItsOwnRateWithoutAccumulatingRoundingErrors) {
  Shutter shutter(settings_of(ShutterMode::kFreeRunning, kModePeriod90), at_ms(3));
  EXPECT_FALSE(shutter.on_pulse(at_ms(3), 0));
  for (int frame = 0; frame < 90 * 60; ++frame) {
    const auto exposure = shutter.on_timer(shutter.next_timer());
    ASSERT_TRUE(exposure);
    ASSERT_EQ(exposure->pulse, kNoPulse);
  }
  EXPECT_EQ(shutter.next_timer(), at_ms(60003));
}

}  // namespace
}  // namespace simbench::sim
