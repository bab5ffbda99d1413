// The cameras' half of a world: the same frames as event by event, in periods, kept or not.
#include "sim/rig/camera_world.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <string>
#include <vector>

#include "recording/event.h"
#include "recording/event_text.h"
#include "sim/rig/simulation.h"
#include "tests/nonempty.h"
#include "tests/sim/rig/event_by_event.h"
#include "tests/sim/rig/ideal_scenario.h"
#include "tests/sim/rig/test_world.h"

namespace simbench::sim {
namespace {

// Six cameras on two hosts, two controllers each, with what makes frames unlike each other.
scenarios::Scenario lively_scenario() {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.count = 6;
  s.cameras.cameras_per_host = 3;
  s.usb.cameras_per_controller = 2;
  s.usb.delivery_jitter_transfers = 0.5;
  s.usb.host_jitter_transfers = 0.3;
  s.usb.host_jitter_correlation = 0.9;
  s.usb.kernel_copy_exponential_ms = 0.1;
  s.trigger.pulse_jitter_sigma_us = 5;
  s.trigger.cable_delay_max_us = 50;
  s.cameras.latency_camera_max_ms = 1;
  s.cameras.oscillator.skew_sigma_ppm = 20;
  return s;
}

// A world from anywhere: sync modes, buses with and without enough bandwidth, losses, faults. Its
// jitter keeps events from falling into one nanosecond, where their order is the world's choice.
scenarios::Scenario world_of(unsigned seed) {
  std::mt19937 random(seed);  // NOLINT(cert-msc32-c,cert-msc51-cpp): a seed repeats
  const auto one_of = [&random](auto... choices) {
    const std::array all{choices...};
    return all[random() % all.size()];
  };
  scenarios::Scenario s = lively_scenario();
  using scenarios::SyncMode;
  s.timeline.frames = 60;
  s.cameras.sync_mode =
      one_of(SyncMode::kGenlock, SyncMode::kSlave, SyncMode::kFullSlave, SyncMode::kDefault);
  s.trigger.rate_hz = one_of(30.0, 45.0, 90.0);
  if (random() % 2 == 0) {
    s.cameras.streams.push_back(s.cameras.streams[0]);
    s.cameras.streams[1].kind = StreamKind::kColour;
    s.cameras.streams[1].shutter = scenarios::ShutterKind::kRolling;
    s.cameras.streams[1].readout_ms = 6;
  }
  s.usb.sharing = one_of(scenarios::UsbSharing::kDedicated, scenarios::UsbSharing::kFifo,
                         scenarios::UsbSharing::kFair);
  s.usb.bandwidth_mb_per_s = one_of(40.0, 90.0, 350.0);
  s.usb.buffered_frames = one_of(1, 2, 4);
  s.usb.spike_probability = one_of(0.0, 0.1);
  s.usb.spike_max_transfers = 20;
  s.cameras.drop_probability = one_of(0.0, 0.0, 0.1);
  s.cameras.exposure_ms = one_of(1.0, 8.0);
  s.cameras.common_start = random() % 2 == 0;
  s.cameras.start_spread_ms = 300;
  s.cameras.unstable_start_ms = one_of(0.0, 200.0);
  s.cameras.unstable_start_jitter_sigma_ms = 2;
  s.trigger.missed_pulse_probability = one_of(0.0, 0.05);
  if (random() % 3 == 0) s.trigger.pauses = {{.at_ms = 700, .duration_ms = 250}};
  if (random() % 3 == 0) {
    s.hosts.load_burst = {.rate_hz = 4, .duration_exponential_ms = 50, .latency_ms = 8};
  }
  if (random() % 3 == 0) {
    s.faults = {scenarios::CameraVanishes{.camera = 1, .at_ms = 400, .duration_ms = 300},
                scenarios::LateFirstFrame{.camera = 0, .duration_ms = 90}};
  }
  s.usb.hold_mode_periods = one_of(0.0, 0.7, 1.0, 2.5);
  return s;
}

std::vector<SimFrame> frames_of(CameraWorld& world) {
  std::vector<SimFrame> frames;
  TrueTime begin{};
  for (std::size_t i = 0; const CameraPeriod* period = world.period(i); ++i) {
    for (const SimFrame& frame : period->frames) {
      EXPECT_TRUE(frame.at >= begin && frame.at < period->end);
      frames.push_back(frame);
    }
    begin = period->end;
  }
  return frames;
}

bool are_same(const SimFrame& a, const SimFrame& b) {
  return a.stream == b.stream && a.counter == b.counter && a.exposure_us == b.exposure_us &&
         a.stamp_noise_ns == b.stamp_noise_ns && a.fate == b.fate && a.pulse == b.pulse &&
         a.exposure_start == b.exposure_start && a.exposure_end == b.exposure_end &&
         a.transferred == b.transferred && a.copied == b.copied && a.at == b.at &&
         (a.fate == FrameFate::kLostInCamera || a.offered == b.offered);
}

std::string text_of(const SimFrame& frame) {
  const auto ms = [](TrueTime at) { return to_ms(at.time_since_epoch()); };
  return fmt::format(
      "stream {} counter {} fate {} pulse {}: exposed {} to {}, offered {}, transferred {}, at {}",
      frame.stream, frame.counter, static_cast<int>(frame.fate), frame.pulse,
      ms(frame.exposure_start), ms(frame.exposure_end), ms(frame.offered), ms(frame.transferred),
      ms(frame.at));
}

TEST(CameraWorld, StagesGiveWhatEventsGive) {
  std::size_t lost = 0;
  for (unsigned seed = 1; seed <= 150; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const scenarios::Scenario scenario = world_of(seed);
    const std::vector<SimFrame> expected = EventByEvent(scenario, seed).run();
    CameraWorld world(scenario, seed);
    const std::vector<SimFrame> frames = frames_of(world);
    ASSERT_EQ(frames.size(), expected.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      ASSERT_TRUE(are_same(frames[i], expected[i]))
          << "frame " << i << " of " << frames.size() << "\n"
          << text_of(frames[i]) << "\n"
          << text_of(expected[i]);
      lost += frames[i].fate == FrameFate::kLostOnUsb ? 1 : 0;
    }
  }
  EXPECT_GT(lost, 1000u) << "overloaded buses are among them";
}

TEST(CameraWorld, NeedNotBeKept) {
  const scenarios::Scenario scenario = lively_scenario();
  CameraWorld kept(scenario, 1);
  CameraWorld streamed(scenario, 1, TrueTime{}, {}, 0);
  const std::vector<SimFrame> all = nonempty(frames_of(kept));
  const std::vector<SimFrame> passing = frames_of(streamed);
  EXPECT_TRUE(std::equal(all.begin(), all.end(), passing.begin(), passing.end(), are_same));
  EXPECT_TRUE(kept.is_whole());
  EXPECT_FALSE(streamed.is_whole());
  const std::vector<SimFrame> again = frames_of(kept);
  EXPECT_TRUE(std::equal(all.begin(), all.end(), again.begin(), again.end(), are_same));
  EXPECT_EQ(kept.trace_hash(), streamed.trace_hash());
}

std::vector<std::string> lines_of(const KeptRecording& recording) {
  std::vector<std::string> lines;
  for (const KeptEvent& event : recording.events()) lines.push_back(to_line(event));
  return lines;
}

// Adjusts its clock all the time, so that what is recorded between two frames differs.
Task<void> adjust(Host& host, double ppb) {
  for (;;) {
    co_await host.sleep_for(from_ms(3));
    co_await host.clock().adjust_frequency(ppb);
  }
}

// Ends after a while, so that the capture starts at another time.
class Brief final : public HostSync {
 public:
  explicit Brief(double ms) : ms_(ms) {}
  Task<void> run_master(Host& host, std::vector<PeerId>) override {
    return host.sleep_for(from_ms(ms_));
  }
  Task<void> run_slave(Host& host, PeerId) override { return host.sleep_for(from_ms(1)); }

 private:
  double ms_;
};

void expect_same_as_alone(const scenarios::Scenario& scenario, RecordingSource& shared,
                          std::uint64_t seed, HostSync& host_sync) {
  const RecordingRequest request = {.seed = seed, .pipeline = "p", .host_sync = &host_sync};
  KeptRecording alone;
  KeptRecording together;
  const RecordingCost cost = make_simulation(scenario)->record(request, alone);
  EXPECT_EQ(shared.record(request, together).trace_hash, cost.trace_hash);
  EXPECT_EQ(lines_of(together), lines_of(alone));
}

TEST(CameraWorld, SharedByRunsGivesEachWhatItGetsAlone) {
  scenarios::Scenario with_bursts = lively_scenario();
  with_bursts.hosts.load_burst = {.rate_hz = 4, .duration_exponential_ms = 50, .latency_ms = 8};
  for (const scenarios::Scenario& scenario : {lively_scenario(), with_bursts}) {
    const auto shared = make_simulation(scenario);
    for (const std::uint64_t seed : {1u, 2u, 1u}) {
      for (const double ppb : {0.0, 1e3, -2e5}) {
        Service service([ppb](Host& host) { return adjust(host, ppb); });
        expect_same_as_alone(scenario, *shared, seed, service);
      }
      for (const double ms : {0.5, 333.3, 0.5, 1234.5678}) {
        Brief brief(ms);
        expect_same_as_alone(scenario, *shared, seed, brief);
      }
    }
  }
}

// The same capture, in the cameras' half, at whatever time it starts; only stamps differ.
TEST(CameraWorld, AnotherStartGivesTheSameFramesAndOtherStamps) {
  const scenarios::Scenario scenario = lively_scenario();
  KeptLists early;
  KeptLists late;
  Brief at_once(0.5);
  Brief after_a_while(50'000);
  run_world(scenario, &at_once, early);
  run_world(scenario, &after_a_while, late);
  ASSERT_EQ(nonempty(early.frames).size(), late.frames.size());
  const Nanoseconds shift =
      late.frames[0].truth.exposure_start - early.frames[0].truth.exposure_start;
  EXPECT_GT(shift, from_ms(49'000));
  std::size_t other_stamps = 0;
  for (std::size_t i = 0; i < early.frames.size(); ++i) {
    EXPECT_EQ(late.frames[i].record.camera, early.frames[i].record.camera);
    EXPECT_EQ(late.frames[i].truth.exposure_end - early.frames[i].truth.exposure_end, shift);
    other_stamps += late.frames[i].record.sensor != early.frames[i].record.sensor ? 1 : 0;
  }
  EXPECT_GT(other_stamps, early.frames.size() / 2) << "50 s at 20 ppm are a millisecond";
}

// What is recorded comes in the order in which it happened, however the capture lags behind.
TEST(CameraWorld, ReportsComeInTheirOrder) {
  const scenarios::Scenario scenario = lively_scenario();
  Service service([](Host& host) { return adjust(host, 0); });
  KeptRecording recording;
  make_simulation(scenario)->record({.seed = 1, .pipeline = "p", .host_sync = &service}, recording);
  HostTime last{};
  std::size_t changes = 0;
  bool was_frame = false;
  for (const KeptEvent& event : recording.events()) {
    const auto* frame = event_as<FrameEvent>(event);
    const auto* adjustment = event_as<ClockAdjustment>(event);
    if (adjustment != nullptr && adjustment->host != 0) continue;
    if (frame == nullptr && adjustment == nullptr) continue;
    const HostTime at = frame != nullptr ? frame->truth->delivered : adjustment->before;
    EXPECT_GE(at, last);
    last = at;
    changes += was_frame != (frame != nullptr) ? 1 : 0;
    was_frame = frame != nullptr;
  }
  EXPECT_GT(changes, 100u);
}

}  // namespace
}  // namespace simbench::sim
