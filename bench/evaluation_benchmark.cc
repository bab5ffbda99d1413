// Time per frame of scoring a capture: 18 cameras on 6 hosts, 225 frames of warm-up and 480
// evaluated, as in 18cam_6host_45fps; the kept recording is played into the scorer.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <memory>
#include <utility>

#include "algorithms/device_time/yoon2021.h"
#include "algorithms/gathering/gatherers.h"
#include "evaluation/scoring/pipeline_scorer.h"
#include "recording/event.h"

namespace {

using simbench::Nanoseconds;
using simbench::evaluation::PipelineScorer;
using simbench::evaluation::ScorerSetup;

constexpr std::int64_t kPeriodNs = 22'222'222;
constexpr std::int64_t kWarmUpPulses = 225;
constexpr std::int64_t kPulses = 480;
constexpr std::uint32_t kHosts = 6;
constexpr std::uint32_t kCameras = 18;

// Up to a millisecond, different for every frame.
std::int64_t jitter_ns(std::int64_t pulse, std::uint32_t camera) {
  return (pulse * 7919 + camera * 104'729) % 1'000'000;
}

simbench::KeptRecording make_recording() {
  simbench::RigLayout layout = {.hosts = kHosts,
                                .cameras = {},
                                .frame_rate_hz = 45,
                                .first_pulse = kWarmUpPulses,
                                .pulses = kPulses};
  for (std::uint32_t camera = 0; camera < kCameras; ++camera) {
    layout.cameras.push_back({.host = camera / 3});
  }
  simbench::KeptRecording kept;
  kept.on_start(layout);
  const Nanoseconds no_errors[kHosts] = {};
  for (std::int64_t pulse = 0; pulse < kWarmUpPulses + kPulses; ++pulse) {
    const std::int64_t mid_ns = pulse * kPeriodNs;
    kept.on_pulse({.pulse = pulse, .at = {}, .host_errors = no_errors});
    for (std::uint32_t camera = 0; camera < kCameras; ++camera) {
      simbench::FrameRecord frame;
      frame.camera = camera;
      frame.sensor.us = static_cast<std::uint32_t>(mid_ns / 1000);
      frame.arrival = simbench::HostTime(Nanoseconds(mid_ns + jitter_ns(pulse, camera)));
      simbench::FrameTruth truth;
      truth.pulse = pulse;
      truth.reference = simbench::HostTime(Nanoseconds(mid_ns));
      truth.own_host = truth.reference;
      kept.on_frame(frame, &truth);
    }
  }
  return kept;
}

ScorerSetup setup_for(bool genlock, bool offline) {
  ScorerSetup setup;
  setup.genlock = genlock;
  setup.make_estimator = [] { return simbench::make_regression(simbench::RegressionWindow{30}); };
  if (offline) setup.make_second_estimator = [] { return simbench::make_offline_regression(); };
  setup.make_gatherer = [](const simbench::GatheringSetup& gathering) {
    return simbench::make_yoon2021_gatherer(gathering);
  };
  return setup;
}

void score_capture(benchmark::State& state, bool genlock, bool offline) {
  const simbench::KeptRecording recording = make_recording();
  const ScorerSetup setup = setup_for(genlock, offline);
  for (auto iteration : state) {
    PipelineScorer scorer(setup);
    recording.play(scorer);
    benchmark::DoNotOptimize(scorer.finish());
  }
  const auto frames = static_cast<double>(kCameras * (kWarmUpPulses + kPulses));
  state.counters["per_frame"] = benchmark::Counter(
      frames, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void play_only(benchmark::State& state) {
  class Nothing final : public simbench::RecordingSink {
   public:
    void on_start(const simbench::RigLayout&) override {}
    void on_frame(const simbench::FrameRecord& frame, const simbench::FrameTruth*) override {
      benchmark::DoNotOptimize(frame.camera);
    }
    void on_pulse(const simbench::PulseTruth&) override {}
    void on_adjustment(const simbench::ClockAdjustment&) override {}
    void on_poll(const simbench::DevicePoll&) override {}
    void on_exchange(std::uint32_t, const simbench::Exchange&) override {}
    void on_outcome(const simbench::SyncOutcome&) override {}
  };
  const simbench::KeptRecording recording = make_recording();
  for (auto iteration : state) {
    Nothing nothing;
    recording.play(nothing);
  }
}

BENCHMARK(play_only)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(score_capture, truth, false, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(score_capture, genlock_check, true, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(score_capture, genlock_check_and_offline, true, true)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
