#include "watch/clock_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace simbench::watch {
namespace {

using evaluation::ClockLogPoint;
using testing::ElementsAre;
using testing::IsEmpty;

ClockLogPoint point(int at_s, double error_s) {
  return {Microseconds(std::int64_t{at_s} * 1'000'000), error_s};
}

double noise(std::minstd_rand& chance) {
  return (static_cast<double>(chance() % 10001) - 5000) / 5000 * 1e-6;
}

TEST(ClockWatchTest, AStepIsKnownWithItsSecondSample) {
  for (const double step_s : {50e-6, -2e-3, 0.5}) {
    ClockWatch clock("clock of a", {});
    std::minstd_rand chance(5);
    for (int i = 0; i < 100; ++i) EXPECT_THAT(clock.add({point(i, noise(chance))}), IsEmpty());
    EXPECT_THAT(clock.add({point(100, step_s + noise(chance))}), IsEmpty());
    const auto events = clock.add({point(101, step_s + noise(chance))});
    ASSERT_EQ(events.size(), 1u) << step_s;
    EXPECT_EQ(events[0].kind, "clock_step");
    EXPECT_EQ(events[0].at_s, 100);
    for (int i = 102; i < 300; ++i) {
      EXPECT_THAT(clock.add({point(i, step_s + noise(chance))}), IsEmpty()) << i;
    }
    EXPECT_EQ(clock.steps(), 1);
  }
}

TEST(ClockWatchTest, ASingleOutlierIsNoStep) {
  ClockWatch clock("clock of a", {});
  std::minstd_rand chance(5);
  for (int i = 0; i < 300; ++i) {
    EXPECT_THAT(clock.add({point(i, noise(chance) + (i % 50 == 49 ? 1e-3 : 0))}), IsEmpty()) << i;
  }
}

TEST(ClockWatchTest, DriftAndNoiseAreNoSteps) {
  ClockWatch clock("clock of a", {});
  std::minstd_rand chance(7);
  double wander = 0;
  for (int i = 0; i < 20'000; ++i) {
    wander += noise(chance);
    EXPECT_THAT(clock.add({point(i, 20e-6 * i + wander)}), IsEmpty()) << i;
  }
}

// Most differences of a dense sawtooth are alike: its teeth are no steps.
TEST(ClockWatchTest, ASawtoothHasNoSteps) {
  for (const int tooth : {30, 40, 62}) {
    ClockWatch clock("clock of a", {});
    for (int i = 0; i < 500; ++i) {
      EXPECT_THAT(clock.add({point(i, 1e-6 * (i * tooth % 97) / 97)}), IsEmpty())
          << tooth << ' ' << i;
    }
  }
}

TEST(ClockWatchTest, ALogThatBeginsAnewIsNoStep) {
  ClockWatch clock("clock of a", {});
  std::minstd_rand chance(5);
  for (int i = 0; i < 50; ++i) clock.add({point(i, noise(chance))});
  clock.begin_anew();
  for (int i = 0; i < 50; ++i) EXPECT_THAT(clock.add({point(i, 0.3 + noise(chance))}), IsEmpty());
}

TEST(ClockWatchTest, AnErrorBeyondTheLimitIsAnAlarmUntilItIsBack) {
  ClockWatch clock("clock of a", 1.0);
  std::vector<std::string> kinds;
  std::minstd_rand chance(5);
  for (int i = 0; i < 100; ++i) {
    const double error_s = i >= 40 && i < 60 ? 40e-6 * (i - 30) + 1e-3 : 1e-6;
    for (const WatchEvent& event : clock.add({point(i, error_s + noise(chance))})) {
      if (event.kind == "clock_off") kinds.push_back(event.is_alarm ? "off" : "back");
    }
  }
  EXPECT_THAT(kinds, ElementsAre("off", "back"));
}

TEST(ClockWatchTest, WhatIsKeptIsBoundedAndItsSizeKnown) {
  ClockWatch clock("clock of a", {});
  std::minstd_rand chance(5);
  EXPECT_FALSE(clock.time_error());
  clock.add({point(0, 0.25)});
  EXPECT_NEAR(clock.time_error()->max_te_ms, 250, 1e-9);
  for (int i = 1; i < 10'000; ++i) clock.add({point(i, 1e-3 + noise(chance))});
  // The first one is no longer kept.
  EXPECT_NEAR(clock.time_error()->max_te_ms, 1.001, 1e-5);
  EXPECT_EQ(clock.samples(), 10'000);
}

}  // namespace
}  // namespace simbench::watch
