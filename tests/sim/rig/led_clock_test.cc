#include "sim/rig/led_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/nonempty.h"
#include "tests/sim/rig/ideal_scenario.h"
#include "tests/sim/rig/kept_world.h"
#include "tests/sim/rig/test_world.h"
#include "tests/sim/rig/written_recording.h"

namespace simbench::sim {
namespace {

// Exposures of 4 ms at 45 Hz; the pulses last 3 s.
scenarios::Scenario led_scenario() {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.led_clock = scenarios::LedClockModel{.step_ms = 1};
  return s;
}

KeptLists seen(const scenarios::Scenario& s, std::uint64_t seed = 1) {
  KeptLists kept;
  run_world(s, nullptr, kept, seed);
  return kept;
}

const FrameTruth& truth_of(const KeptLists& kept, const KeptLists::Sighting& sighting) {
  return kept.frames.at(sighting.frame).truth;
}

// What the LED clock is ahead of true time by, if it is exact: between the two, whatever the image.
std::pair<Nanoseconds, Nanoseconds> bounds_of_zero(const KeptLists& kept) {
  Nanoseconds low = Nanoseconds::min();
  Nanoseconds high = Nanoseconds::max();
  for (const auto& sighting : kept.sightings) {
    const FrameTruth& truth = truth_of(kept, sighting);
    const Nanoseconds before =
        Nanoseconds(sighting.led.led_start_ns) - truth.exposure_start.time_since_epoch();
    const Nanoseconds after =
        Nanoseconds(sighting.led.led_end_ns) - truth.exposure_end.time_since_epoch();
    low = std::max(low, before);
    high = std::min(high, after);
  }
  return {low, high};
}

TEST(LedClock, SightingsHaveTheTrueExposureWithinAStep) {
  const KeptLists kept = seen(led_scenario());
  ASSERT_GT(kept.sightings.size(), 100U);
  const auto [low, high] = bounds_of_zero(kept);
  // The arc covers the exposure, and each of its ends is less than a step beyond.
  EXPECT_LE(low, high);
  EXPECT_LT(high - low, from_ms(0.3)) << "a ninth of a step each, as 45 Hz goes over the steps";
  for (const auto& sighting : nonempty(kept.sightings)) {
    const FrameTruth& truth = truth_of(kept, sighting);
    const Nanoseconds start =
        Nanoseconds(sighting.led.led_start_ns) - truth.exposure_start.time_since_epoch();
    const Nanoseconds end =
        Nanoseconds(sighting.led.led_end_ns) - truth.exposure_end.time_since_epoch();
    EXPECT_GT(start, low - from_ms(1));
    EXPECT_LT(end, high + from_ms(1));
    EXPECT_EQ(sighting.led.led_start_ns % 1'000'000, 0);
    EXPECT_EQ(sighting.led.led_end_ns % 1'000'000, 0);
  }
}

TEST(LedClock, ASightingComesAfterItsFrame) {
  const KeptLists kept = seen(led_scenario());
  for (const auto& sighting : nonempty(kept.sightings)) {
    const FrameRecord& frame = kept.frames.at(sighting.frame).record;
    EXPECT_EQ(sighting.led.camera, frame.camera);
    EXPECT_EQ(sighting.led.sensor, frame.sensor);
  }
}

// An exposure of 4 ms lights 5 LEDs, if it does not begin with a step. Lost are those whose first
// is one of the ring's first two, or whose last is the last one of the ring, or beyond.
TEST(LedClock, ImagesByTheRingsEndAreLost) {
  scenarios::Scenario s = led_scenario();
  s.timeline.frames = 45 * 60;
  s.trigger.rate_hz = 44.971;  // all over the ring
  const KeptLists kept = seen(s);
  for (const auto& sighting : nonempty(kept.sightings)) {
    const std::int64_t first = sighting.led.led_start_ns / 1'000'000 % 100;
    const std::int64_t last = (sighting.led.led_end_ns / 1'000'000 - 1) % 100;
    EXPECT_GE(first, 2);
    EXPECT_LE(last, 98);
    EXPECT_LT(first, last);
  }
  const double lost =
      1 - static_cast<double>(kept.sightings.size()) / static_cast<double>(kept.frames.size());
  EXPECT_NEAR(lost, 0.07, 0.01);
}

TEST(LedClock, ExposuresAsLongAsTheRingAreNeverRead) {
  scenarios::Scenario s = led_scenario();
  s.cameras.led_clock->step_ms = 0.04;  // a turn in 4 ms
  EXPECT_TRUE(seen(s).sightings.empty());
}

TEST(LedClock, IsInViewInItsWindows) {
  scenarios::Scenario s = led_scenario();
  const auto shown = [&s](double first_ms, double last_ms) {
    s.cameras.led_clock->first_ms = first_ms;
    s.cameras.led_clock->last_ms = last_ms;
    const KeptLists kept = seen(s);
    std::vector<double> at_ms;
    for (const auto& sighting : kept.sightings) {
      // Without host synchronisation the capture starts after 100 ms.
      at_ms.push_back(to_ms(truth_of(kept, sighting).mid_exposure().time_since_epoch()) - 100);
    }
    return at_ms;
  };
  const std::vector<double> always = shown(0, 0);
  const double end_ms = always.back();
  for (const double ms : nonempty(shown(500, 0))) EXPECT_LT(ms, 500);
  for (const double ms : nonempty(shown(0, 500))) EXPECT_GT(ms, end_ms - 505);
  const std::vector<double> both = shown(500, 500);
  EXPECT_TRUE(
      std::ranges::all_of(both, [end_ms](double ms) { return ms < 500 || ms > end_ms - 505; }));
  EXPECT_EQ(both.size(), shown(500, 0).size() + shown(0, 500).size());
}

TEST(LedClock, IsLookedAtOnceInAnInterval) {
  scenarios::Scenario s = led_scenario();
  s.cameras.led_clock->interval_ms = 200;
  const KeptLists kept = seen(s);
  std::set<std::pair<std::uint32_t, std::int64_t>> intervals;
  for (const auto& sighting : nonempty(kept.sightings)) {
    const Nanoseconds at =
        truth_of(kept, sighting).mid_exposure().time_since_epoch() - from_ms(100);
    EXPECT_TRUE(intervals.emplace(sighting.led.camera, at / from_ms(200)).second);
    // It is the interval's first frame.
    EXPECT_LT(to_ms(at % from_ms(200)), 1e3 / 45 + 1e-6);
  }
  // Some images of the 16 intervals cannot be read.
  EXPECT_GT(intervals.size(), 20U);
  EXPECT_LE(intervals.size(), 32U);
}

TEST(LedClock, MissedAndWrongReadingsHaveTheirShares) {
  scenarios::Scenario s = led_scenario();
  s.timeline.frames = 45 * 60;
  const std::size_t readable = seen(s).sightings.size();
  const auto [low, high] = bounds_of_zero(seen(s));
  s.cameras.led_clock->missed_probability = 0.4;
  s.cameras.led_clock->wrong_probability = 0.1;
  const KeptLists kept = seen(s);
  const auto n = static_cast<double>(readable);
  const auto read = static_cast<double>(kept.sightings.size());
  EXPECT_NEAR(read / n, 0.6, 5 * std::sqrt(0.24 / n));
  int late = 0;
  int early = 0;
  for (const auto& sighting : nonempty(kept.sightings)) {
    const Nanoseconds ahead = Nanoseconds(sighting.led.led_start_ns) -
                              truth_of(kept, sighting).exposure_start.time_since_epoch();
    const double turns = to_ms(ahead - low) / 100;
    EXPECT_NEAR(turns, std::round(turns), 0.011);
    if (std::round(turns) == 1) ++late;
    if (std::round(turns) == -1) ++early;
  }
  EXPECT_NEAR((late + early) / read, 0.1, 5 * std::sqrt(0.09 / read));
  EXPECT_NEAR(late, early, 5 * std::sqrt(late + early));
  EXPECT_LE(low, high);
}

TEST(LedClock, ItsRateIsItsOwnAndTheSameForAll) {
  scenarios::Scenario s = led_scenario();
  s.timeline.frames = 45 * 60;
  s.cameras.led_clock->skew_sigma_ppm = 200;
  std::set<double> rates_ppm;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const LedClock clock(s, seed, TrueTime(from_ms(60'000)));
    const double rate_ppm =
        to_ms(clock.at(TrueTime(from_ms(1000))) - clock.at(TrueTime{}) - from_ms(1000)) * 1e3;
    EXPECT_NE(rate_ppm, 0);
    EXPECT_LT(std::abs(rate_ppm), 5 * 200);
    rates_ppm.insert(rate_ppm);
    const KeptLists kept = seen(s, seed);
    for (const auto& sighting : nonempty(kept.sightings)) {
      const TrueTime start = truth_of(kept, sighting).exposure_start - from_ms(100);
      const double early_ms = to_ms(clock.at(start) - Nanoseconds(sighting.led.led_start_ns));
      EXPECT_GE(early_ms, 0);
      EXPECT_LT(early_ms, 1);
    }
  }
  EXPECT_EQ(rates_ppm.size(), 3U);
}

TEST(LedClock, ARollingShutterShowsTheRowOfTheBoard) {
  scenarios::Scenario s = led_scenario();
  s.cameras.count = 20;
  s.cameras.cameras_per_host = 10;
  s.cameras.streams[0].shutter = scenarios::ShutterKind::kRolling;
  s.cameras.streams[0].readout_ms = 8;
  const auto middles_ms = [&s] {
    const KeptLists kept = seen(s);
    std::vector<double> late_ms;
    const LedClock clock(s, 1, TrueTime(from_ms(10'000)));
    for (const auto& sighting : kept.sightings) {
      const Nanoseconds middle = clock.at(truth_of(kept, sighting).mid_exposure() - from_ms(100));
      late_ms.push_back(to_ms(sighting.led.middle() - middle));
    }
    return late_ms;
  };
  for (const double late_ms : nonempty(middles_ms())) EXPECT_NEAR(late_ms, 0, 1);
  s.cameras.led_clock->row_spread_share = 0.5;  // up to a quarter of the readout each way
  const std::vector<double> late_ms = middles_ms();
  ASSERT_FALSE(late_ms.empty());
  const auto [least, most] = std::ranges::minmax(late_ms);
  EXPECT_LT(least, -1.1);
  EXPECT_GT(least, -3);
  EXPECT_GT(most, 1.1);
  EXPECT_LT(most, 3);
}

TEST(LedClock, MovesNobodyElsesNumbersAndRepeats) {
  scenarios::Scenario s = led_scenario();
  s.usb.delivery_jitter_transfers = 0.5;
  s.cameras.led_clock->missed_probability = 0.5;
  const auto text = [&s] {
    WrittenRecording written;
    make_simulation(s)->record({.seed = 3, .pipeline = "test"}, written);
    return written.text;
  };
  const std::string with = text();
  EXPECT_EQ(with, text());
  std::string left;
  for (std::size_t at = 0; at < with.size();) {
    const std::size_t next = with.find('\n', at) + 1;
    if (!with.substr(at).starts_with("led,")) left += with.substr(at, next - at);
    at = next;
  }
  s.cameras.led_clock.reset();
  EXPECT_EQ(left, text());
  EXPECT_LT(left.size(), with.size());
}

// An observer makes the capture report frame by frame.
TEST(LedClock, FramesInBlocksOrAloneShowTheSame) {
  const scenarios::Scenario s = led_scenario();
  WrittenRecording blocks;
  make_simulation(s)->record({.seed = 3, .pipeline = "test"}, blocks);
  WrittenRecording single;
  KeptWorld observer(from_ms(10));
  make_simulation(s)->record({.seed = 3, .pipeline = "test", .observer = &observer}, single);
  EXPECT_FALSE(observer.frames.empty());
  EXPECT_EQ(blocks.text, single.text);
}

}  // namespace
}  // namespace simbench::sim
