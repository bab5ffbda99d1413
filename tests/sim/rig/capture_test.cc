// The way of a frame through a capture, and what may happen to it.
#include "sim/rig/capture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/nonempty.h"
#include "tests/sim/rig/captured_frames.h"
#include "tests/sim/rig/ideal_scenario.h"

namespace simbench::sim {
namespace {

TEST(Capture, AddsUpTheWayOfAFrame) {
  const CapturedFrames result = capture(ideal_scenario());
  EXPECT_EQ(result.layout().first_pulse, 45);
  EXPECT_EQ(result.layout().pulses, 90);
  EXPECT_EQ(result.pulses.size(), 90u);
  ASSERT_EQ(result.frames.size(), 2u * 135);
  for (const auto& [record, truth] : result.frames) {
    const double pulse_ms = static_cast<double>(truth.pulse) * 1e3 / 45;
    // Exposure 4 ms, latency 8 ms, transfer 2 ms.
    EXPECT_NEAR(host_ms_of(record.arrival), pulse_ms + 14, 2e-6);
    EXPECT_EQ(record.backend, record.arrival);
    EXPECT_NEAR(to_ms(truth.mid_exposure().time_since_epoch()), pulse_ms + 2, 2e-6);
    EXPECT_NEAR(host_ms_of(truth.reference), pulse_ms + 2, 2e-6);
    EXPECT_EQ(truth.own_host, truth.reference);
    EXPECT_EQ(record.exposure_us, 4000u);
    EXPECT_NEAR(record.sensor.us, pulse_ms * 1e3 + 2000, 1);
    EXPECT_NEAR(record.frame.us, pulse_ms * 1e3 + 4000, 1);
    EXPECT_EQ(record.counter, truth.pulse);
  }
}

TEST(Capture, DeliversInOrderOfArrival) {
  scenarios::Scenario s = ideal_scenario();
  s.usb.delivery_jitter_transfers = 30;  // 60 ms on average: later than the next frame
  const CapturedFrames result = capture(s);
  EXPECT_TRUE(std::is_sorted(
      result.frames.begin(), result.frames.end(),
      [](const auto& a, const auto& b) { return a.record.arrival < b.record.arrival; }));
  for (const std::uint32_t camera : {0u, 1u}) {
    const auto frames = result.of(camera);
    EXPECT_TRUE(std::is_sorted(frames.begin(), frames.end(), [](const auto& a, const auto& b) {
      return a.record.counter < b.record.counter;
    })) << "frames of one camera must not overtake each other";
  }
}

TEST(Capture, SlaveExposuresOfAnyLengthArriveAtTheSameTime) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.sync_mode = scenarios::SyncMode::kSlave;
  s.trigger.rate_hz = 90;
  const CapturedFrames brief = capture(s);
  s.cameras.exposure_ms = 9;
  const CapturedFrames lengthy = capture(s);
  ASSERT_EQ(brief.frames.size(), lengthy.frames.size());
  for (std::size_t i = 0; i < brief.frames.size(); ++i) {
    EXPECT_EQ(brief.frames[i].record.arrival, lengthy.frames[i].record.arrival);
    EXPECT_EQ(brief.frames[i].truth.exposure_end, lengthy.frames[i].truth.exposure_end);
  }
}

TEST(Capture, ASlaveWithoutPulsesRunsFree) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.sync_mode = scenarios::SyncMode::kSlave;
  s.trigger.rate_hz = 90;
  s.trigger.pauses = {{.at_ms = 500, .duration_ms = 300}};
  const CapturedFrames result = capture(s);
  const auto frames = result.of(0);
  const auto free = std::count_if(frames.begin(), frames.end(),
                                  [](const auto& f) { return f.truth.pulse == kNoPulse; });
  // The last pulse before the pause is at 489 ms; three periods later the stream runs free, until
  // the pulse at 800 ms.
  EXPECT_NEAR(static_cast<double>(free), (800 - 522.2) / 11.11, 1);
  EXPECT_NE(frames.back().truth.pulse, kNoPulse);
}

TEST(Capture, GenlockWithoutPulsesWaits) {
  scenarios::Scenario s = ideal_scenario();
  s.trigger.pauses = {{.at_ms = 500, .duration_ms = 300}};
  const CapturedFrames result = capture(s);
  EXPECT_EQ(result.of(0).size(), 135u - 13);  // slots 23 to 35 are due in [500, 800) ms
}

TEST(Capture, ColourFollowsInFullSlaveOnly) {
  scenarios::Scenario s = ideal_scenario();
  s.trigger.rate_hz = 90;
  s.cameras.streams.push_back(s.cameras.streams[0]);
  s.cameras.streams[1].kind = StreamKind::kColour;
  s.cameras.sync_mode = scenarios::SyncMode::kFullSlave;
  for (const auto& frame : nonempty(capture(s).of(0, StreamKind::kColour))) {
    EXPECT_NE(frame.truth.pulse, kNoPulse);
  }
  s.cameras.sync_mode = scenarios::SyncMode::kSlave;
  const CapturedFrames slave = capture(s);
  for (const auto& frame : nonempty(slave.of(0, StreamKind::kDepth))) {
    EXPECT_NE(frame.truth.pulse, kNoPulse);
  }
  for (const auto& frame : nonempty(slave.of(0, StreamKind::kColour))) {
    EXPECT_EQ(frame.truth.pulse, kNoPulse);
  }
}

TEST(Capture, StaggeredGenlockCamerasStartWithDifferentPulses) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.common_start = false;
  s.cameras.start_spread_ms = 900;
  const CapturedFrames result = capture(s);
  EXPECT_NE(result.of(0)[0].truth.pulse, result.of(1)[0].truth.pulse);
  EXPECT_EQ(result.of(0)[0].record.counter, 0u);
  EXPECT_EQ(result.of(1)[0].record.counter, 0u);
}

TEST(Capture, FramesShareAFairBus) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.count = 3;
  s.cameras.cameras_per_host = 3;
  s.hosts.count = 1;
  s.usb.sharing = scenarios::UsbSharing::kFair;
  for (const auto& [record, truth] : nonempty(capture(s).frames)) {
    EXPECT_NEAR(host_ms_of(record.arrival), static_cast<double>(truth.pulse) * 1e3 / 45 + 12 + 6,
                3e-6);
  }
  s.usb.sharing = scenarios::UsbSharing::kFifo;
  const CapturedFrames fifo = capture(s);
  EXPECT_NEAR(host_ms_of(fifo.of(0)[0].record.arrival), 14, 2e-6);
  EXPECT_NEAR(host_ms_of(fifo.of(1)[0].record.arrival), 16, 2e-6);
  EXPECT_NEAR(host_ms_of(fifo.of(2)[0].record.arrival), 18, 2e-6);
}

TEST(Capture, AnOverloadedBusLosesWhatItCannotCarry) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.count = 3;
  s.cameras.cameras_per_host = 3;
  s.hosts.count = 1;
  s.timeline.frames = 900;
  const double offered = 3.0 * 945;
  // A camera offers 45 x 0.7 = 31.5 MB/s. The bus carries two thirds of what is asked of it.
  for (const auto& [sharing, bandwidth_mb_per_s] :
       {std::pair{scenarios::UsbSharing::kFifo, 63.0},
        std::pair{scenarios::UsbSharing::kFair, 63.0},
        std::pair{scenarios::UsbSharing::kDedicated, 21.0}}) {
    s.usb.sharing = sharing;
    s.usb.bandwidth_mb_per_s = bandwidth_mb_per_s;
    EXPECT_NEAR(static_cast<double>(capture(s).frames.size()) / offered, 2.0 / 3, 0.01)
        << to_text(sharing);
  }
}

TEST(Capture, LosesFramesWithTheirProbabilityAndTheCounterTells) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.drop_probability = 0.1;
  s.timeline.frames = 4000;
  const CapturedFrames result = capture(s, 3);
  const double exposed = 2.0 * (4000 + 45);
  EXPECT_NEAR(static_cast<double>(result.frames.size()), 0.9 * exposed,
              5 * std::sqrt(exposed * 0.09))
      << "seed 3";
  for (const auto& [record, truth] : result.frames) EXPECT_EQ(record.counter, truth.pulse);
}

TEST(Capture, ACameraVanishesAndReturns) {
  scenarios::Scenario s = ideal_scenario();
  s.faults = {scenarios::CameraVanishes{.camera = 1, .at_ms = 1000, .duration_ms = 500}};
  const CapturedFrames result = capture(s);
  EXPECT_EQ(result.of(0).size(), 135u);
  EXPECT_EQ(result.of(1).size(), 135u - 23);  // slots 45 to 67
}

TEST(Capture, AStepOfAHostsClockMovesItsArrivals) {
  scenarios::Scenario s = ideal_scenario();
  s.faults = {scenarios::ClockStep{.host = 1, .at_ms = 1500, .step_ms = 7}};
  for (const auto& [record, truth] : nonempty(capture(s).frames)) {
    const double arrival_ms = static_cast<double>(truth.pulse) * 1e3 / 45 + 14;
    const double step_ms = record.camera == 1 && arrival_ms >= 1500 ? 7 : 0;
    EXPECT_NEAR(host_ms_of(record.arrival), arrival_ms + step_ms, 2e-6);
    EXPECT_NEAR(to_ms(record.arrival_steady.time_since_epoch()), arrival_ms, 2e-6);
  }
}

TEST(Capture, TheFirstFrameMayComeLate) {
  scenarios::Scenario s = ideal_scenario();
  s.faults = {scenarios::LateFirstFrame{.camera = 0, .duration_ms = 5}};
  const auto frames = capture(s).of(0);
  EXPECT_NEAR(host_ms_of(frames[0].record.arrival), 19, 2e-6);
  EXPECT_NEAR(host_ms_of(frames[1].record.arrival), 1e3 / 45 + 14, 2e-6);
}

TEST(Capture, ArrivalsAreQuantisedDownwards) {
  scenarios::Scenario s = ideal_scenario();
  s.hosts.clock.arrival_quantum_ms = 1;
  for (const auto& [record, truth] : nonempty(capture(s).frames)) {
    const double exact_ms = static_cast<double>(truth.pulse) * 1e3 / 45 + 14;
    EXPECT_EQ(record.arrival.time_since_epoch().count() % 1'000'000, 0);
    EXPECT_NEAR(host_ms_of(record.arrival), std::floor(exact_ms + 1e-6), 1e-9);
  }
}

}  // namespace
}  // namespace simbench::sim
