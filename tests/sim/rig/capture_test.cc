#include "sim/rig/capture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "tests/sim/rig/ideal_scenario.h"

namespace simbench::sim {
namespace {

// Keeps what a capture hands over, in the simplest form.
class Frames final : public RecordingSink {
 public:
  struct Frame {
    FrameRecord record;
    FrameTruth truth;
  };
  void on_start(const RigLayout& layout) override { layout_ = layout; }
  void on_frame(const FrameRecord& frame, const FrameTruth* truth) override {
    frames.push_back({frame, *truth});
  }
  void on_pulse(const PulseTruth& truth) override { pulses.push_back(truth.pulse); }
  void on_adjustment(const ClockAdjustment&) override {}
  void on_poll(const DevicePoll&) override {}
  void on_exchange(std::uint32_t, const Exchange&) override {}
  void on_outcome(const SyncOutcome&) override {}

  std::vector<Frame> of(std::uint32_t camera, StreamKind kind = StreamKind::kDepth) const {
    std::vector<Frame> found;
    for (const Frame& f : frames) {
      if (f.record.camera == camera && f.record.stream == kind) found.push_back(f);
    }
    return found;
  }
  const RigLayout& layout() const { return layout_; }

  std::vector<Frame> frames;
  std::vector<std::int64_t> pulses;

 private:
  RigLayout layout_;
};

// Runs a capture that starts at true zero, with exact host clocks.
Frames capture(const scenarios::Scenario& scenario, std::uint64_t seed = 1) {
  Engine engine;
  std::vector<std::unique_ptr<SystemClock>> clocks;
  std::vector<SystemClock*> views;
  for (std::uint32_t host = 0; host < static_cast<std::uint32_t>(scenario.hosts.count); ++host) {
    clocks.push_back(std::make_unique<SystemClock>(host, OscillatorModel(0.0)));
    views.push_back(clocks.back().get());
  }
  Frames frames;
  Capture capture(scenario, seed, engine, views, frames);
  frames.on_start(capture.layout());
  bool ended = false;
  capture.start(TrueTime{}, [&] { ended = true; });
  engine.run();
  EXPECT_TRUE(ended);
  return frames;
}

double ms_of(HostTime t) { return to_ms(t.time_since_epoch()); }

TEST(Capture, AddsUpTheWayOfAFrame) {
  const Frames result = capture(ideal_scenario());
  EXPECT_EQ(result.layout().first_pulse, 45);
  EXPECT_EQ(result.layout().pulses, 90);
  EXPECT_EQ(result.pulses.size(), 90u);
  ASSERT_EQ(result.frames.size(), 2u * 135);
  for (const auto& [record, truth] : result.frames) {
    const double pulse_ms = static_cast<double>(truth.pulse) * 1e3 / 45;
    // Exposure 4 ms, latency 8 ms, transfer 2 ms.
    EXPECT_NEAR(ms_of(record.arrival), pulse_ms + 14, 2e-6);
    EXPECT_EQ(record.backend, record.arrival);
    EXPECT_NEAR(to_ms(truth.mid_exposure().time_since_epoch()), pulse_ms + 2, 2e-6);
    EXPECT_NEAR(ms_of(truth.reference), pulse_ms + 2, 2e-6);
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
  const Frames result = capture(s);
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

TEST(Capture, ExposureOfTheHostAndOfTheCameraScaleWithThePeriod) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.count = 6;
  s.cameras.cameras_per_host = 3;
  s.cameras.exposure_host_periods = 0.2;
  const Frames by_host = capture(s, 5);
  EXPECT_EQ(by_host.of(0)[0].record.exposure_us, by_host.of(2)[0].record.exposure_us);
  EXPECT_NE(by_host.of(0)[0].record.exposure_us, by_host.of(3)[0].record.exposure_us);
  s.trigger.rate_hz = 15;
  s.cameras.streams[0].mode_rate_hz = 30;
  const Frames slower = capture(s, 5);
  const double extra_45 = by_host.of(0)[0].record.exposure_us - 4000.0;
  const double extra_15 = slower.of(0)[0].record.exposure_us - 4000.0;
  EXPECT_NEAR(extra_15 / extra_45, 3, 0.01);
}

TEST(Capture, SlaveExposuresOfAnyLengthArriveAtTheSameTime) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.sync_mode = "slave";
  s.trigger.rate_hz = 90;
  const Frames brief = capture(s);
  s.cameras.exposure_ms = 9;
  const Frames lengthy = capture(s);
  ASSERT_EQ(brief.frames.size(), lengthy.frames.size());
  for (std::size_t i = 0; i < brief.frames.size(); ++i) {
    EXPECT_EQ(brief.frames[i].record.arrival, lengthy.frames[i].record.arrival);
    EXPECT_EQ(brief.frames[i].truth.exposure_end, lengthy.frames[i].truth.exposure_end);
  }
}

TEST(Capture, ASlaveWithoutPulsesRunsFree) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.sync_mode = "slave";
  s.trigger.rate_hz = 90;
  s.trigger.pauses = {{.at_ms = 500, .duration_ms = 300}};
  const Frames result = capture(s);
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
  const Frames result = capture(s);
  EXPECT_EQ(result.of(0).size(), 135u - 13);  // slots 23 to 35 are due in [500, 800) ms
}

TEST(Capture, ColourFollowsInFullSlaveOnly) {
  scenarios::Scenario s = ideal_scenario();
  s.trigger.rate_hz = 90;
  s.cameras.streams.push_back(s.cameras.streams[0]);
  s.cameras.streams[1].kind = "colour";
  s.cameras.sync_mode = "full_slave";
  for (const auto& frame : capture(s).of(0, StreamKind::kColour)) {
    EXPECT_NE(frame.truth.pulse, kNoPulse);
  }
  s.cameras.sync_mode = "slave";
  const Frames slave = capture(s);
  for (const auto& frame : slave.of(0, StreamKind::kDepth)) EXPECT_NE(frame.truth.pulse, kNoPulse);
  ASSERT_FALSE(slave.of(0, StreamKind::kColour).empty());
  for (const auto& frame : slave.of(0, StreamKind::kColour)) {
    EXPECT_EQ(frame.truth.pulse, kNoPulse);
  }
}

TEST(Capture, TheModelSaysWhichStreamsFollowASlavesTrigger) {
  scenarios::Scenario s = ideal_scenario();
  s.trigger.rate_hz = 30;
  s.cameras.streams[0].mode_rate_hz = 30;
  s.cameras.streams.push_back(s.cameras.streams[0]);
  s.cameras.streams[1].kind = "colour";
  s.cameras.sync_mode = "slave";
  for (const auto& [model, follows] : {std::pair{"azure_kinect", true}, std::pair{"d435", false}}) {
    s.cameras.model = model;
    const auto frames = capture(s).of(0, StreamKind::kColour);
    ASSERT_FALSE(frames.empty());
    for (const auto& frame : frames) EXPECT_EQ(frame.truth.pulse != kNoPulse, follows) << model;
  }
}

TEST(Capture, StaggeredGenlockCamerasStartWithDifferentPulses) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.common_start = false;
  s.cameras.start_spread_ms = 900;
  const Frames result = capture(s);
  EXPECT_NE(result.of(0)[0].truth.pulse, result.of(1)[0].truth.pulse);
  EXPECT_EQ(result.of(0)[0].record.counter, 0u);
  EXPECT_EQ(result.of(1)[0].record.counter, 0u);
}

TEST(Capture, FramesShareAFairBus) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.count = 3;
  s.cameras.cameras_per_host = 3;
  s.hosts.count = 1;
  s.usb.sharing = "fair";
  for (const auto& [record, truth] : capture(s).frames) {
    EXPECT_NEAR(ms_of(record.arrival), static_cast<double>(truth.pulse) * 1e3 / 45 + 12 + 6, 3e-6);
  }
  s.usb.sharing = "fifo";
  const Frames fifo = capture(s);
  EXPECT_NEAR(ms_of(fifo.of(0)[0].record.arrival), 14, 2e-6);
  EXPECT_NEAR(ms_of(fifo.of(1)[0].record.arrival), 16, 2e-6);
  EXPECT_NEAR(ms_of(fifo.of(2)[0].record.arrival), 18, 2e-6);
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
       {std::pair{"fifo", 63.0}, std::pair{"fair", 63.0}, std::pair{"dedicated", 21.0}}) {
    s.usb.sharing = sharing;
    s.usb.bandwidth_mb_per_s = bandwidth_mb_per_s;
    EXPECT_NEAR(static_cast<double>(capture(s).frames.size()) / offered, 2.0 / 3, 0.01) << sharing;
  }
}

TEST(Capture, LosesFramesWithTheirProbabilityAndTheCounterTells) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.drop_probability = 0.1;
  s.timeline.frames = 4000;
  const Frames result = capture(s, 3);
  const double exposed = 2.0 * (4000 + 45);
  EXPECT_NEAR(static_cast<double>(result.frames.size()), 0.9 * exposed,
              5 * std::sqrt(exposed * 0.09))
      << "seed 3";
  for (const auto& [record, truth] : result.frames) EXPECT_EQ(record.counter, truth.pulse);
}

TEST(Capture, ACameraVanishesAndReturns) {
  scenarios::Scenario s = ideal_scenario();
  s.faults = {{.kind = "camera_vanishes",
               .camera = 1,
               .host = 0,
               .at_ms = 1000,
               .duration_ms = 500,
               .step_ms = 0}};
  const Frames result = capture(s);
  EXPECT_EQ(result.of(0).size(), 135u);
  EXPECT_EQ(result.of(1).size(), 135u - 23);  // slots 45 to 67
}

TEST(Capture, AStepOfAHostsClockMovesItsArrivals) {
  scenarios::Scenario s = ideal_scenario();
  s.faults = {{.kind = "clock_step",
               .camera = 0,
               .host = 1,
               .at_ms = 1500,
               .duration_ms = 0,
               .step_ms = 7}};
  for (const auto& [record, truth] : capture(s).frames) {
    const double arrival_ms = static_cast<double>(truth.pulse) * 1e3 / 45 + 14;
    const double step_ms = record.camera == 1 && arrival_ms >= 1500 ? 7 : 0;
    EXPECT_NEAR(ms_of(record.arrival), arrival_ms + step_ms, 2e-6);
    EXPECT_NEAR(to_ms(record.arrival_steady.time_since_epoch()), arrival_ms, 2e-6);
  }
}

TEST(Capture, TheFirstFrameMayComeLate) {
  scenarios::Scenario s = ideal_scenario();
  s.faults = {{.kind = "late_first_frame",
               .camera = 0,
               .host = 0,
               .at_ms = 0,
               .duration_ms = 5,
               .step_ms = 0}};
  const auto frames = capture(s).of(0);
  EXPECT_NEAR(ms_of(frames[0].record.arrival), 19, 2e-6);
  EXPECT_NEAR(ms_of(frames[1].record.arrival), 1e3 / 45 + 14, 2e-6);
}

TEST(Capture, ArrivalsAreQuantisedDownwards) {
  scenarios::Scenario s = ideal_scenario();
  s.hosts.clock.arrival_quantum_ms = 1;
  for (const auto& [record, truth] : capture(s).frames) {
    const double exact_ms = static_cast<double>(truth.pulse) * 1e3 / 45 + 14;
    EXPECT_EQ(record.arrival.time_since_epoch().count() % 1'000'000, 0);
    EXPECT_NEAR(ms_of(record.arrival), std::floor(exact_ms + 1e-6), 1e-9);
  }
}

TEST(Capture, TheDeviceClockWrapsDuringACapture) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.clock_epoch_max_ms = 2 * 4294967.296;
  s.cameras.oscillator.skew_sigma_ppm = 20;
  s.timeline.frames = 45 * 4300;  // longer than 2^32 us
  s.cameras.count = 1;
  s.hosts.count = 1;
  const auto frames = capture(s).of(0);
  int wraps = 0;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const std::uint32_t step = frames[i].record.sensor.us - frames[i - 1].record.sensor.us;
    EXPECT_NEAR(step, 22222, 3);  // modulo 2^32
    wraps += frames[i].record.sensor.us < frames[i - 1].record.sensor.us ? 1 : 0;
  }
  EXPECT_EQ(wraps, 1);
}

TEST(Capture, ExposuresAreUnsteadyAfterTheStartOnly) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.unstable_start_ms = 500;
  s.cameras.unstable_start_jitter_sigma_ms = 1;
  double largest_before = 0;
  for (const auto& [record, truth] : capture(s).frames) {
    const double pulse_ms = static_cast<double>(truth.pulse) * 1e3 / 45;
    const double late_ms = to_ms(truth.exposure_start.time_since_epoch()) - pulse_ms;
    if (pulse_ms < 500) {
      EXPECT_GE(late_ms, -2e-6);
      largest_before = std::max(largest_before, late_ms);
    } else {
      EXPECT_NEAR(late_ms, 0, 2e-6);
    }
  }
  EXPECT_GT(largest_before, 0.5);
}

TEST(Capture, ARollingShutterLastsLongerThanItsExposure) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.streams[0].shutter = "rolling";
  s.cameras.streams[0].readout_ms = 6;
  for (const auto& [record, truth] : capture(s).frames) {
    const double pulse_us = static_cast<double>(truth.pulse) * 1e6 / 45;
    // Rows begin between 0 and 6 ms after the pulse and last 4 ms each.
    EXPECT_EQ(truth.exposure_end - truth.exposure_start, from_ms(10));
    EXPECT_EQ(record.exposure_us, 4000u);
    EXPECT_NEAR(record.sensor.us, pulse_us + 5000, 1);  // middle of the middle row
    EXPECT_NEAR(record.frame.us, pulse_us + 4000, 1);   // the first row is read out
    EXPECT_NEAR(ms_of(record.arrival), pulse_us * 1e-3 + 10 + 8 + 2, 2e-6);
  }
  s.cameras.streams[0].shutter = "global";
  EXPECT_EQ(capture(s).frames[0].truth.exposure_end, TrueTime(from_ms(4)));
}

TEST(Capture, AutoExposureStepsTheExposuresOfEachCamera) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.auto_exposure = {.step_interval_exponential_ms = 300, .min_ms = 1, .max_ms = 7};
  const Frames result = capture(s);
  std::vector<std::uint32_t> differing(2);
  for (const std::uint32_t camera : {0u, 1u}) {
    const auto frames = result.of(camera);
    EXPECT_EQ(frames[0].record.exposure_us, 4000u);
    for (std::size_t i = 1; i < frames.size(); ++i) {
      EXPECT_EQ((frames[i].truth.exposure_end - frames[i].truth.exposure_start).count() / 1000,
                frames[i].record.exposure_us);
      differing[camera] += frames[i].record.exposure_us != frames[i - 1].record.exposure_us ? 1 : 0;
    }
    // 3 s are 10 steps on average.
    EXPECT_GT(differing[camera], 2u);
    EXPECT_LT(differing[camera], 25u);
  }
  EXPECT_NE(result.of(0).back().record.exposure_us, result.of(1).back().record.exposure_us);
}

TEST(Capture, LatencyOfACameraIsItsOwnAndConstant) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.latency_camera_max_ms = 5;
  const Frames result = capture(s);
  double first_ms[2] = {};
  for (const auto& [record, truth] : result.frames) {
    const double extra_ms =
        ms_of(record.arrival) - static_cast<double>(truth.pulse) * 1e3 / 45 - 14;
    if (truth.pulse == 0) first_ms[record.camera] = extra_ms;
    EXPECT_NEAR(extra_ms, first_ms[record.camera], 3e-6);
    EXPECT_GE(extra_ms, -2e-6);
    EXPECT_LT(extra_ms, 5);
  }
  EXPECT_GT(std::abs(first_ms[0] - first_ms[1]), 1e-3);
}

TEST(Capture, CamerasWarmUpFromTheirStart) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.oscillator.self_heating_ppm = 100;
  s.cameras.oscillator.self_heating_time_constant_s = 1;
  const auto frames = capture(s).of(0);
  const double s_on = static_cast<double>(frames.back().truth.pulse) / 45 + 0.002;
  const double ahead_us = 100 * (s_on - 1 + std::exp(-s_on));
  EXPECT_NEAR(frames.back().record.sensor.us, s_on * 1e6 + ahead_us, 1.01);
  EXPECT_GT(ahead_us, 190);
}

}  // namespace
}  // namespace simbench::sim
