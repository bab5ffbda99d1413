// Captures whose exposures are steered: the controls of algorithms/ports/frame_control.h against
// the true exposures of the simulated world.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "algorithms/ports/capture_alignment.h"
#include "algorithms/ports/host_sync.h"
#include "algorithms/registry.h"
#include "recording/event.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"
#include "tests/recording/test_sink.h"

namespace simbench::sim {
namespace {

constexpr double kFramePeriodMs = 1e3 / 30;

// The true exposures of each camera, in order.
class Exposures final : public TestSink {
 public:
  void on_start(const RigLayout& layout) override { middles.resize(layout.cameras.size()); }
  void on_event(const RecordingEvent& event) override {
    if (const auto* report = std::get_if<AlignmentReport>(&event)) reports.push_back(*report);
  }

  // The lengths of a camera's frames that differ from the usual one by more than 0.1 ms.
  std::vector<double> unusual_ms(std::size_t camera) const {
    std::vector<double> lengths;
    for (std::size_t i = 1; i < middles[camera].size(); ++i) {
      const double length_ms = middles[camera][i] - middles[camera][i - 1];
      if (std::abs(length_ms - kFramePeriodMs) > 0.1) lengths.push_back(length_ms);
    }
    return lengths;
  }
  // The largest range of a pulse that all cameras have.
  double worst_spread_ms(std::int64_t from_pulse) const {
    double worst = 0;
    for (const auto& [pulse, all] : by_pulse) {
      if (pulse < from_pulse || all.size() != middles.size()) continue;
      const auto [low, high] = std::ranges::minmax(all);
      worst = std::max(worst, high - low);
    }
    return worst;
  }

  std::vector<std::vector<double>> middles;
  std::map<std::int64_t, std::vector<double>> by_pulse;
  std::vector<AlignmentReport> reports;

 private:
  void frame_came(const FrameRecord& frame, const FrameTruth* truth) override {
    middles[frame.camera].push_back(to_ms(truth->mid_exposure().time_since_epoch()));
    by_pulse[truth->pulse].push_back(middles[frame.camera].back());
  }
};

scenarios::Scenario short_rig() {
  return scenarios::load_scenario("18cam_6host_30fps_without_trigger",
                                  {{"/timeline/warm_up_ms", "3000"},
                                   {"/timeline/frames", "90"},
                                   {"/cameras/drop_probability", "0"}});
}

// What a test wants of each camera, on each host.
class Scripted : public CaptureAlignment {
 public:
  Task<void> run_master(Host& host, std::vector<PeerId> /*slaves*/) override { return all(host); }
  Task<void> run_slave(Host& host, PeerId /*master*/) override { return all(host); }

 protected:
  virtual Task<void> steer(Host& host, FrameControl& camera) = 0;

 private:
  Task<void> all(Host& host) {
    for (FrameControl* const camera : host.frame_controls()) {
      co_await host.sleep_for(from_ms(1));
      co_await steer(host, *camera);
    }
  }
};

RecordingCost record_steered(const scenarios::Scenario& scenario, CaptureAlignment* alignment,
                             RecordingSink& sink, std::uint64_t seed = 1) {
  const HostSyncEntry* entry = find_algorithm<HostSyncEntry>("oracle");
  const auto host_sync = entry->make(check_parameters(entry->info.parameters, {}));
  return make_simulation(scenario)->record({.seed = seed,
                                            .pipeline = "trigger_tree",
                                            .host_sync = host_sync.get(),
                                            .capture_alignment = alignment},
                                           sink);
}

std::unique_ptr<CaptureAlignment> registered(const std::string& name) {
  const CaptureAlignmentEntry* entry = find_algorithm<CaptureAlignmentEntry>(name);
  return entry->make(check_parameters(entry->info.parameters, {}));
}

TEST(SteeredCapture, WithoutAnAlignmentTheTriggerExposes) {
  Exposures exposures;
  record_steered(short_rig(), nullptr, exposures);
  EXPECT_LT(exposures.worst_spread_ms(90), 0.005);
}

TEST(SteeredCapture, NobodySteers) {
  Exposures exposures;
  record_steered(short_rig(), registered("free_run").get(), exposures);
  EXPECT_GT(exposures.worst_spread_ms(90), 10);
  for (std::size_t camera = 0; camera < exposures.middles.size(); ++camera) {
    EXPECT_TRUE(exposures.unusual_ms(camera).empty());
  }
  // Every frame has the pulse of the nearest exposure of camera 0.
  for (const auto& [pulse, all] : exposures.by_pulse) {
    if (pulse >= 0) {
      EXPECT_LE(all.size(), 18U) << pulse;
    }
  }
}

TEST(SteeredCapture, TheLimitIsAGranule) {
  Exposures exposures;
  record_steered(short_rig(), registered("oracle").get(), exposures);
  EXPECT_LE(exposures.worst_spread_ms(90), 0.01001);
}

class LongerFrame final : public Scripted {
  Task<void> steer(Host& host, FrameControl& camera) override {
    const std::optional<FrameArrival> frame =
        co_await camera.next_frame(host.steady_clock().now() + from_ms(2000));
    EXPECT_TRUE(frame.has_value());
    const FrameControlReply reply = co_await camera.adjust_frame(from_ms(5));
    EXPECT_TRUE(reply.is_accepted()) << reply.refused;
    EXPECT_EQ(reply.length, camera.limits().nearest(from_ms(kFramePeriodMs + 5)));
  }
};

TEST(SteeredCapture, OneFrameOfEachCameraIsLonger) {
  Exposures exposures;
  LongerFrame longer;
  record_steered(short_rig(), &longer, exposures);
  for (std::size_t camera = 0; camera < exposures.middles.size(); ++camera) {
    const std::vector<double> unusual = exposures.unusual_ms(camera);
    ASSERT_EQ(unusual.size(), 1U) << "camera " << camera;
    EXPECT_NEAR(unusual.front(), kFramePeriodMs + 5, 0.02);
  }
}

TEST(SteeredCapture, LostControlsChangeNothing) {
  scenarios::Scenario scenario = short_rig();
  scenario.cameras.frame_control->loss_probability = 1;
  Exposures exposures;
  LongerFrame longer;
  record_steered(scenario, &longer, exposures);
  EXPECT_TRUE(exposures.unusual_ms(3).empty());
}

class Refused final : public Scripted {
  Task<void> steer(Host& host, FrameControl& camera) override {
    const FrameControlReply short_one = co_await camera.set_frame_length(from_ms(1));
    const FrameControlReply inserted = co_await camera.insert_frame(from_ms(40));
    const HostTime now = co_await host.clock().now();
    const FrameControlReply late = co_await camera.start_at(now - from_ms(1));
    host.report_alignment({.camera = camera.camera(),
                           .aligned = false,
                           .controls = 0,
                           .message = short_one.refused + "|" + inserted.refused + "|" +
                                      (late.is_accepted() ? "" : "late")});
  }
};

TEST(SteeredCapture, WhatACameraCannotDoIsRefusedAndChangesNothing) {
  scenarios::Scenario scenario = short_rig();
  scenario.cameras.frame_control->insert_frame = false;
  Exposures exposures;
  Refused refused;
  record_steered(scenario, &refused, exposures);
  ASSERT_EQ(exposures.reports.size(), 18U);
  EXPECT_EQ(exposures.reports.front().message,
            "found a frame of 1.000000 ms, allowed: 17.000000 ms to 70.000000 ms|the camera has no "
            "control insert_frame|late");
  EXPECT_TRUE(exposures.unusual_ms(0).empty());
}

class StartedAtOnce final : public Scripted {
  Task<void> steer(Host& host, FrameControl& camera) override {
    const HostTime now = co_await host.clock().now();
    const auto second = HostTime(std::chrono::ceil<std::chrono::seconds>(now.time_since_epoch()));
    co_await camera.start_at(second + std::chrono::seconds(1) +
                             camera.camera() * camera.limits().frame_length);
  }
};

TEST(SteeredCapture, CamerasStartAtTheirHostsTime) {
  scenarios::Scenario scenario = short_rig();
  scenario.cameras.frame_control->start_jitter_sigma_us = 0;
  scenario.cameras.oscillator = {};
  scenario.cameras.oscillator.wander_step_ms = 10;
  scenario.hosts.count = 18;
  scenario.cameras.cameras_per_host = 1;
  Exposures exposures;
  StartedAtOnce started;
  record_steered(scenario, &started, exposures);
  // A camera starts whole frames after the first one.
  EXPECT_LT(exposures.worst_spread_ms(130), 0.5);
}

// A clock that is 50 ppm fast makes frames that are 50 ppm short; the cameras' own oscillators do
// not count.
TEST(SteeredCapture, FramesByTheHostsOscillatorAreAsLongAsItSays) {
  const scenarios::Scenario scenario = scenarios::load_scenario(
      "5phone_wifi_30fps", {{"/timeline/frames", "300"},
                            {"/hosts/clock/skew_of_host_ppm", "[0, 50, -50, 20, 0]"},
                            {"/hosts/clock/oscillator/white_frequency_ppb", "0"},
                            {"/hosts/clock/oscillator/random_walk_ppb_per_sqrt_s", "0"},
                            {"/cameras/oscillator/skew_sigma_ppm", "1000"}});
  Exposures exposures;
  record_steered(scenario, registered("free_run").get(), exposures);
  const double skews_ppm[] = {0, 50, -50, 20, 0};
  for (std::size_t camera = 0; camera < 5; ++camera) {
    const std::vector<double>& middles = exposures.middles[camera];
    ASSERT_GT(middles.size(), 300U);
    const double mean_ms =
        (middles.back() - middles.front()) / static_cast<double>(middles.size() - 1);
    // 33.32 ms in whole lines of 8 us.
    EXPECT_NEAR(mean_ms * (1 + skews_ppm[camera] * 1e-6), 33.32, 33.32e-6) << camera;
  }
}

TEST(SteeredCapture, TheSameSeedGivesTheSameWorld) {
  Exposures first;
  Exposures second;
  const RecordingCost a = record_steered(short_rig(), registered("phase_rate").get(), first, 7);
  const RecordingCost b = record_steered(short_rig(), registered("phase_rate").get(), second, 7);
  EXPECT_EQ(a.trace_hash, b.trace_hash);
  EXPECT_EQ(first.middles, second.middles);
}

TEST(SteeredCapture, PhaseRateAlignsWithOneDisturbedFrame) {
  Exposures exposures;
  record_steered(short_rig(), registered("phase_rate").get(), exposures);
  EXPECT_LT(exposures.worst_spread_ms(130), 0.1);
  for (std::size_t camera = 0; camera < exposures.middles.size(); ++camera) {
    EXPECT_LE(exposures.unusual_ms(camera).size(), 3U) << "camera " << camera;
  }
}

}  // namespace
}  // namespace simbench::sim
