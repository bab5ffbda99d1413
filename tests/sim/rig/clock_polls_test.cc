#include "sim/rig/clock_polls.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/nonempty.h"
#include "tests/sim/rig/ideal_scenario.h"
#include "tests/sim/rig/test_world.h"

namespace simbench::sim {
namespace {

scenarios::Scenario polled_scenario() {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.clock_poll = {.interval_ms = 100,
                          .request_ms = 0.3,
                          .request_exponential_ms = 0,
                          .reply_ms = 0.7,
                          .reply_exponential_ms = 0,
                          .tail_probability = 0,
                          .tail_max_ms = 0};
  return s;
}

KeptLists polled(const scenarios::Scenario& s, std::uint64_t seed = 1) {
  KeptLists kept;
  run_world(s, nullptr, kept, seed);
  return kept;
}

std::vector<DevicePoll> of_camera(const KeptLists& kept, std::uint32_t camera) {
  std::vector<DevicePoll> found;
  std::copy_if(kept.polls.begin(), kept.polls.end(), std::back_inserter(found),
               [camera](const DevicePoll& poll) { return poll.camera == camera; });
  return found;
}

// Without host synchronisation the capture starts after the pause; the register is 0 then.
constexpr double kCaptureStartMs = 100;

TEST(ClockPolls, AddUpExactlyWithoutJitter) {
  const KeptLists kept = polled(polled_scenario());
  for (const std::uint32_t camera : {0u, 1u}) {
    const auto polls = of_camera(kept, camera);
    // Pulses of 3 s and two periods more, a poll every 100 ms.
    EXPECT_NEAR(static_cast<double>(polls.size()), 30.4, 1);
    for (std::size_t i = 0; i < nonempty(polls).size(); ++i) {
      const DevicePoll& poll = polls[i];
      EXPECT_EQ(poll.t1 - poll.t0, from_ms(1));
      EXPECT_EQ(poll.t1_steady - poll.t0_steady, from_ms(1));
      const double read_us = (to_ms(poll.t0.time_since_epoch()) + 0.3 - kCaptureStartMs) * 1e3;
      EXPECT_EQ(poll.device.us, static_cast<std::uint32_t>(std::floor(read_us + 1e-6)));
      if (i > 0) {
        EXPECT_EQ(poll.t0 - polls[i - 1].t0, from_ms(100));
      }
    }
  }
  const auto first = of_camera(kept, 0);
  const auto second = of_camera(kept, 1);
  EXPECT_NE(first[0].t0, second[0].t0) << "each camera has a phase of its own";
}

TEST(ClockPolls, AreOnRecordInOrderOfTheirEndAndReadTheClockThroughItsInterface) {
  scenarios::Scenario s = polled_scenario();
  s.cameras.clock_poll.reply_exponential_ms = 20;
  s.hosts.clock.resolution_ms = 0.1;
  s.hosts.clock.arrival_quantum_ms = 1;
  const KeptLists kept = polled(s);
  EXPECT_TRUE(std::is_sorted(kept.polls.begin(), kept.polls.end(),
                             [](const auto& a, const auto& b) { return a.t1 < b.t1; }));
  bool off_the_millisecond = false;
  for (const DevicePoll& poll : nonempty(kept.polls)) {
    EXPECT_EQ(poll.t0.time_since_epoch().count() % 100'000, 0);
    off_the_millisecond |= poll.t0.time_since_epoch().count() % 1'000'000 != 0;
  }
  EXPECT_TRUE(off_the_millisecond) << "the arrival quantum is no matter of polls";
}

TEST(ClockPolls, APollLongerThanTheIntervalSkipsTheNext) {
  scenarios::Scenario s = polled_scenario();
  s.cameras.clock_poll.request_ms = 249.3;  // 250 ms in all
  const auto polls = of_camera(polled(s), 0);
  ASSERT_GT(polls.size(), 8u);
  for (std::size_t i = 1; i < polls.size(); ++i) {
    EXPECT_EQ(polls[i].t0 - polls[i - 1].t0, from_ms(300));
  }
  s.cameras.clock_poll.request_ms = 199.3;  // ends when the next but one is due
  const auto back_to_back = of_camera(polled(s), 0);
  for (std::size_t i = 1; i < back_to_back.size(); ++i) {
    EXPECT_EQ(back_to_back[i].t0, back_to_back[i - 1].t1);
  }
}

TEST(ClockPolls, DelaysHaveTheLawThatTheScenarioSays) {
  scenarios::Scenario s = polled_scenario();
  s.timeline.frames = 45 * 60;
  s.cameras.clock_poll.interval_ms = 10;
  s.cameras.clock_poll.request_exponential_ms = 0.2;
  s.cameras.clock_poll.reply_exponential_ms = 0.5;
  s.cameras.clock_poll.tail_probability = 0.1;
  s.cameras.clock_poll.tail_max_ms = 6;
  const KeptLists kept = polled(s, 7);
  double request_ms = 0;
  double reply_ms = 0;
  for (const DevicePoll& poll : kept.polls) {
    // The register cuts off half a microsecond on average.
    const double read_ms = kCaptureStartMs + (poll.device.us + 0.5) * 1e-3;
    request_ms += read_ms - to_ms(poll.t0.time_since_epoch());
    reply_ms += to_ms(poll.t1.time_since_epoch()) - read_ms;
  }
  const auto n = static_cast<double>(kept.polls.size());
  ASSERT_GT(n, 11'000);
  // Standard deviation of a request: exponential, and a tail of mean 3 and mean square 12.
  const double request_sigma = std::sqrt(0.2 * 0.2 + 0.1 * 12 - 0.3 * 0.3);
  EXPECT_NEAR(request_ms / n, 0.3 + 0.2 + 0.1 * 3, 5 * request_sigma / std::sqrt(n)) << "seed 7";
  EXPECT_NEAR(reply_ms / n, 0.7 + 0.5, 5 * 0.5 / std::sqrt(n)) << "seed 7";
}

TEST(ClockPolls, MoveNobodyElsesNumbersAndRepeat) {
  scenarios::Scenario s = polled_scenario();
  s.usb.delivery_jitter_transfers = 0.5;
  s.cameras.sensor_stamp_jitter_sigma_us = 2;
  s.cameras.oscillator.white_frequency_ppb = 10;
  const KeptLists with = polled(s, 3);
  const KeptLists again = polled(s, 3);
  s.cameras.clock_poll.interval_ms = 0;
  const KeptLists without = polled(s, 3);
  EXPECT_TRUE(without.polls.empty());
  ASSERT_EQ(with.frames.size(), without.frames.size());
  for (std::size_t i = 0; i < with.frames.size(); ++i) {
    EXPECT_EQ(with.frames[i].record.arrival, without.frames[i].record.arrival);
    EXPECT_EQ(with.frames[i].record.sensor, without.frames[i].record.sensor);
  }
  ASSERT_EQ(with.polls.size(), again.polls.size());
  for (std::size_t i = 0; i < with.polls.size(); ++i) {
    EXPECT_EQ(with.polls[i].t0, again.polls[i].t0);
    EXPECT_EQ(with.polls[i].t1, again.polls[i].t1);
    EXPECT_EQ(with.polls[i].device, again.polls[i].device);
  }
}

TEST(ClockPolls, CostOneEventEach) {
  scenarios::Scenario s = polled_scenario();
  KeptLists kept;
  const RecordingCost with = run_world(s, nullptr, kept);
  s.cameras.clock_poll.interval_ms = 0;
  KeptLists none;
  const RecordingCost without = run_world(s, nullptr, none);
  EXPECT_EQ(with.events, without.events + kept.polls.size());
}

TEST(ClockPolls, AVanishedCameraDoesNotAnswer) {
  scenarios::Scenario s = polled_scenario();
  s.faults = {scenarios::CameraVanishes{.camera = 1, .at_ms = 1000, .duration_ms = 500}};
  const KeptLists kept = polled(s);
  EXPECT_EQ(of_camera(kept, 1).size(), of_camera(polled(polled_scenario()), 1).size() - 5);
  for (const DevicePoll& poll : of_camera(kept, 1)) {
    EXPECT_TRUE(poll.device.us < 1'000'000 || poll.device.us >= 1'500'000) << poll.device.us;
  }
}

}  // namespace
}  // namespace simbench::sim
