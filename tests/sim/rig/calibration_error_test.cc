// Computed calibrations are the delays of the simulated world, and its errors have their laws.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scenarios/calibration.h"
#include "scenarios/camera_groups.h"
#include "scenarios/loader.h"
#include "tests/nonempty.h"
#include "tests/sim/rig/captured_frames.h"
#include "tests/sim/rig/ideal_scenario.h"
#include "tests/sim/rig/test_world.h"

namespace simbench::sim {
namespace {

// From the end of the exposure of the middle row to the arrival, on average.
double mean_delay_ms(const scenarios::Scenario& scenario, const scenarios::Stream& stream,
                     std::size_t group = 0) {
  const std::vector<std::size_t> groups = scenarios::group_of_cameras(scenario.cameras);
  const double readout_ms =
      stream.shutter == scenarios::ShutterKind::kRolling ? stream.readout_ms : 0;
  double sum_ms = 0;
  int frames = 0;
  for (const CapturedFrames::Frame& frame : capture(scenario).frames) {
    if (frame.record.stream != stream.kind || groups[frame.record.camera] != group) continue;
    sum_ms += host_ms_of(frame.record.arrival) -
              to_ms(frame.truth.exposure_end.time_since_epoch()) + readout_ms / 2;
    ++frames;
  }
  EXPECT_GT(frames, 0);
  return sum_ms / frames;
}

// What no constant knows.
void take_noise_off(scenarios::Scenario& scenario) {
  scenario.cameras.calibration = {};
  scenario.cameras.unstable_start_jitter_sigma_ms = 0;
  scenario.usb.kernel_copy_exponential_ms = 0;
  scenario.usb.delivery_jitter_transfers = 0;
  scenario.usb.host_jitter_transfers = 0;
  scenario.usb.spike_probability = 0;
  scenario.hosts.load_burst = {};
  scenario.faults.clear();
}

TEST(Calibration, ComputedDelaysAreThoseOfEveryWorld) {
  for (const scenarios::BuiltinScenario& builtin : nonempty(scenarios::builtin_scenarios())) {
    SCOPED_TRACE(builtin.name);
    std::vector<scenarios::Override> overrides = {{"/timeline/frames", "200"}};
    if (builtin.name.starts_with("scale_")) {
      overrides.push_back({"/hosts/count", "2"});
      overrides.push_back({"/cameras/count", "6"});
    }
    scenarios::Scenario scenario = scenarios::load_scenario(builtin.name, overrides);
    take_noise_off(scenario);
    // 18 cameras that differ are few, of one seed.
    const bool differ = scenario.cameras.latency_camera_max_ms > 0 ||
                        scenario.cameras.exposure_camera_periods > 0 ||
                        scenario.trigger.cable_delay_max_us > 1000;
    const double allowed_ms = differ ? 0.6 : 0.06;
    for (std::size_t group = 0; group < scenarios::group_count(scenario.cameras); ++group) {
      const scenarios::Scenario alone = scenarios::group_alone(scenario, group);
      for (const scenarios::Stream& stream : alone.cameras.streams) {
        EXPECT_NEAR(scenarios::calibrated_delay_ms(alone, stream),
                    mean_delay_ms(scenario, stream, group), allowed_ms);
      }
    }
  }
}

TEST(Calibration, ComputedDelaysFollowTheSharingOfTheBus) {
  for (const scenarios::UsbSharing sharing :
       {scenarios::UsbSharing::kDedicated, scenarios::UsbSharing::kFair,
        scenarios::UsbSharing::kFifo}) {
    for (const std::int64_t cameras : {1, 2, 3}) {
      scenarios::Scenario scenario = ideal_scenario();
      scenario.hosts.count = 1;
      scenario.cameras.count = cameras;
      scenario.cameras.cameras_per_host = cameras;
      scenario.usb.sharing = sharing;
      scenario.cameras.sync_mode = scenarios::SyncMode::kFullSlave;
      scenario.trigger.rate_hz = 90;
      scenario.cameras.streams.push_back(scenario.cameras.streams.front());
      scenario.cameras.streams.back().kind = StreamKind::kColour;
      scenario.cameras.streams.back().height = 150;
      for (const scenarios::Stream& stream : scenario.cameras.streams) {
        EXPECT_NEAR(scenarios::calibrated_delay_ms(scenario, stream),
                    mean_delay_ms(scenario, stream), 0.006)
            << to_text(sharing) << ", " << cameras << " cameras, " << to_text(stream.kind);
      }
    }
  }
}

struct Moments {
  double mean = 0;
  double sigma = 0;
};

Moments moments(const std::vector<double>& values) {
  Moments found;
  for (const double value : values) found.mean += value / static_cast<double>(values.size());
  for (const double value : values) {
    found.sigma += (value - found.mean) * (value - found.mean) / static_cast<double>(values.size());
  }
  found.sigma = std::sqrt(found.sigma);
  return found;
}

// A rig of one host and three cameras whose frames arrive 10 ms after exposure, and the delays of
// the three.
std::vector<double> delays_ms(const scenarios::CalibrationError& error, std::uint64_t seed) {
  scenarios::Scenario scenario = ideal_scenario();
  scenario.timeline.frames = 2;
  scenario.hosts.count = 1;
  scenario.cameras.count = 3;
  scenario.cameras.cameras_per_host = 3;
  scenario.cameras.calibration = error;
  scenario.usb.delivery_quantiles_ms = {5, 5};
  const CapturedFrames frames = capture(scenario, seed);
  std::vector<double> delays;
  for (const std::uint32_t camera : {0U, 1U, 2U}) {
    const CapturedFrames::Frame frame = frames.of(camera).front();
    delays.push_back(host_ms_of(frame.record.arrival) -
                     to_ms(frame.truth.exposure_end.time_since_epoch()) - 15);
  }
  return delays;
}

constexpr std::uint64_t kErrorSeeds = 400;
// A standard deviation from 400 draws may be off by 4 of its own standard errors.
constexpr double kSigmaTolerance = 4 / 28.0;

TEST(CalibrationError, OfTheModelIsOneDrawPerSeed) {
  std::vector<double> errors_ms;
  for (std::uint64_t seed = 1; seed <= kErrorSeeds; ++seed) {
    const std::vector<double> delays = delays_ms({.delay_error_sigma_ms = 0.2}, seed);
    EXPECT_NEAR(delays[0], delays[1], 1e-5);
    EXPECT_NEAR(delays[0], delays[2], 1e-5);
    errors_ms.push_back(delays[0]);
  }
  const Moments found = moments(errors_ms);
  EXPECT_NEAR(found.mean, 0, 4 * 0.2 / 20);
  EXPECT_NEAR(found.sigma, 0.2, 0.2 * kSigmaTolerance);
}

TEST(CalibrationError, OfACameraIsOneDrawPerCameraAndSeed) {
  std::vector<double> errors_ms;
  std::vector<double> differences_ms;
  for (std::uint64_t seed = 1; seed <= kErrorSeeds; ++seed) {
    const std::vector<double> delays = delays_ms({.camera_delay_error_sigma_ms = 0.3}, seed);
    errors_ms.push_back(delays[0]);
    differences_ms.push_back(delays[2] - delays[1]);
  }
  EXPECT_NEAR(moments(errors_ms).mean, 0, 4 * 0.3 / 20);
  EXPECT_NEAR(moments(errors_ms).sigma, 0.3, 0.3 * kSigmaTolerance);
  EXPECT_NEAR(moments(differences_ms).sigma, 0.3 * std::sqrt(2), 0.3 * 1.5 * kSigmaTolerance);
}

TEST(CalibrationError, NoFrameArrivesBeforeItsTransferEnds) {
  scenarios::Scenario scenario = ideal_scenario();
  scenario.timeline.frames = 2;
  scenario.cameras.calibration.camera_delay_error_sigma_ms = 50;
  int at_once = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const CapturedFrames::Frame& frame : capture(scenario, seed).frames) {
      const double delay_ms =
          host_ms_of(frame.record.arrival) - to_ms(frame.truth.exposure_end.time_since_epoch());
      EXPECT_GE(delay_ms, 10 - 1e-5);
      at_once += delay_ms < 10 + 1e-5 ? 1 : 0;
    }
  }
  EXPECT_GT(at_once, 0);
}

TEST(CalibrationError, OfPollsIsOneDrawPerSeedHalfInEachDelay) {
  std::vector<double> errors_ms;
  for (std::uint64_t seed = 1; seed <= kErrorSeeds; ++seed) {
    scenarios::Scenario scenario = ideal_scenario();
    scenario.timeline.frames = 10;
    scenario.cameras.clock_poll = {.interval_ms = 100, .request_ms = 2, .reply_ms = 2};
    scenario.cameras.calibration.poll_asymmetry_error_sigma_ms = 0.5;
    KeptLists kept;
    run_world(scenario, nullptr, kept, seed);
    std::vector<double> of_seed_ms;
    for (const DevicePoll& poll : nonempty(kept.polls)) {
      EXPECT_EQ(poll.t1 - poll.t0, from_ms(4));
      // The capture begins at 100 ms, and the register cuts off half a microsecond on average.
      const double read_ms = 100 + (poll.device.us + 0.5) * 1e-3;
      of_seed_ms.push_back(2 * (read_ms - ms_of(poll.t0) - 2));
      EXPECT_NEAR(of_seed_ms.back(), of_seed_ms.front(), 2.1e-3);
    }
    errors_ms.push_back(of_seed_ms.front());
  }
  const Moments found = moments(errors_ms);
  EXPECT_NEAR(found.mean, 0, 4 * 0.5 / 20);
  EXPECT_NEAR(found.sigma, 0.5, 0.5 * kSigmaTolerance);
}

TEST(CalibrationError, NoDelayOfAPollIsNegative) {
  scenarios::Scenario scenario = ideal_scenario();
  scenario.cameras.clock_poll = {.interval_ms = 100, .request_ms = 0.1, .reply_ms = 0.1};
  scenario.cameras.calibration.poll_asymmetry_error_sigma_ms = 50;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    KeptLists kept;
    run_world(scenario, nullptr, kept, seed);
    for (const DevicePoll& poll : nonempty(kept.polls)) {
      EXPECT_GE(poll.t1, poll.t0);
      EXPECT_GE(100 + (poll.device.us + 1) * 1e-3, ms_of(poll.t0));
      EXPECT_LE(100 + poll.device.us * 1e-3, ms_of(poll.t1));
    }
  }
}

// An error of one kind changes nothing that it is not an error of.
TEST(CalibrationError, DrawsAreKeyed) {
  const auto written = [](const scenarios::CalibrationError& error) {
    scenarios::Scenario scenario = ideal_scenario();
    scenario.usb.delivery_jitter_transfers = 0.5;
    scenario.cameras.clock_poll = {.interval_ms = 100, .request_ms = 2, .reply_ms = 2};
    scenario.cameras.calibration = error;
    KeptLists kept;
    run_world(scenario, nullptr, kept, 5);
    return kept;
  };
  const KeptLists exact = written({});
  const KeptLists polls = written({.poll_asymmetry_error_sigma_ms = 0.5});
  const KeptLists delays = written({.delay_error_sigma_ms = 0.1});
  ASSERT_EQ(exact.frames.size(), polls.frames.size());
  for (std::size_t i = 0; i < nonempty(exact.frames).size(); ++i) {
    EXPECT_EQ(exact.frames[i].record.arrival, polls.frames[i].record.arrival);
    EXPECT_EQ(exact.frames[i].record.sensor, polls.frames[i].record.sensor);
  }
  ASSERT_EQ(exact.polls.size(), delays.polls.size());
  for (std::size_t i = 0; i < nonempty(exact.polls).size(); ++i) {
    EXPECT_EQ(exact.polls[i].device, delays.polls[i].device);
    EXPECT_EQ(exact.polls[i].t1, delays.polls[i].t1);
  }
  // All frames move alike.
  const Nanoseconds moved = delays.frames[0].record.arrival - exact.frames[0].record.arrival;
  EXPECT_NE(moved.count(), 0);
  for (std::size_t i = 0; i < exact.frames.size(); ++i) {
    EXPECT_EQ(delays.frames[i].record.arrival - exact.frames[i].record.arrival, moved);
  }
}

}  // namespace
}  // namespace simbench::sim
