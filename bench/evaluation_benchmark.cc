// Time per frame of scoring a capture, handed over in blocks of a pulse each as the simulator does:
// 18 cameras on 6 hosts with 225 pulses of warm-up and 480 evaluated, as in 18cam_6host_45fps, and
// 18,000 cameras on 6,000 hosts.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "algorithms/device_time/yoon2021.h"
#include "algorithms/gathering/gatherers.h"
#include "evaluation/scoring/pipeline_scorer.h"
#include "recording/recording.h"

namespace {

using simbench::Nanoseconds;
using simbench::evaluation::PipelineScorer;
using simbench::evaluation::ScorerSetup;

constexpr std::int64_t kPeriodNs = 22'222'222;

// Up to a millisecond, different for every frame.
std::int64_t jitter_ns(std::int64_t pulse, std::uint32_t camera) {
  return (pulse * 7919 + camera * 104'729) % 1'000'000;
}

struct Capture {
  simbench::RigLayout layout;
  std::vector<simbench::FrameRecord> frames;  // pulse by pulse, in order of delivery
  std::vector<simbench::FrameTruth> truths;
};

Capture make_capture(std::uint32_t cameras, std::int64_t warm_up_pulses, std::int64_t pulses) {
  Capture capture;
  capture.layout = {.hosts = cameras / 3,
                    .cameras = {},
                    .frame_rate_hz = 45,
                    .first_pulse = warm_up_pulses,
                    .pulses = pulses};
  std::vector<std::uint32_t> order(cameras);
  std::iota(order.begin(), order.end(), 0);
  for (const std::uint32_t camera : order) capture.layout.cameras.push_back({.host = camera / 3});
  for (std::int64_t pulse = 0; pulse < warm_up_pulses + pulses; ++pulse) {
    const std::int64_t mid_ns = pulse * kPeriodNs;
    std::ranges::sort(order, {}, [pulse](std::uint32_t c) { return jitter_ns(pulse, c); });
    for (const std::uint32_t camera : order) {
      simbench::FrameRecord frame;
      frame.camera = camera;
      frame.sensor.us = static_cast<std::uint32_t>(mid_ns / 1000);
      frame.arrival = simbench::HostTime(Nanoseconds(mid_ns + jitter_ns(pulse, camera)));
      simbench::FrameTruth truth;
      truth.pulse = pulse;
      truth.reference = simbench::HostTime(Nanoseconds(mid_ns));
      truth.own_host = truth.reference;
      capture.frames.push_back(frame);
      capture.truths.push_back(truth);
    }
  }
  return capture;
}

void play(const Capture& capture, simbench::RecordingSink& sink) {
  sink.on_start(capture.layout);
  const std::size_t cameras = capture.layout.cameras.size();
  simbench::RecordingEvent event =
      simbench::PulseTruth{.host_errors = std::vector<Nanoseconds>(capture.layout.hosts)};
  for (std::size_t begin = 0; begin < capture.frames.size(); begin += cameras) {
    std::get<simbench::PulseTruth>(event).pulse = static_cast<std::int64_t>(begin / cameras);
    sink.on_event(event);
    sink.on_frames(std::span(capture.frames).subspan(begin, cameras),
                   std::span(capture.truths).subspan(begin, cameras));
  }
}

ScorerSetup setup_for(bool genlock, bool offline) {
  ScorerSetup setup;
  setup.genlock = genlock;
  setup.make_estimator = [](std::size_t) {
    return simbench::make_regression(simbench::RegressionWindow{30});
  };
  if (offline)
    setup.make_second_estimator = [](std::size_t) { return simbench::make_offline_regression(); };
  setup.make_gatherer = [](const simbench::GatheringSetup& gathering) {
    return simbench::make_yoon2021_gatherer(gathering);
  };
  return setup;
}

void score_capture(benchmark::State& state, const Capture& capture, bool genlock, bool offline) {
  const ScorerSetup setup = setup_for(genlock, offline);
  for (auto iteration : state) {
    PipelineScorer scorer(setup);
    play(capture, scorer);
    benchmark::DoNotOptimize(scorer.finish());
  }
  state.counters["per_frame"] = benchmark::Counter(
      static_cast<double>(capture.frames.size()),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void small(benchmark::State& state, bool genlock, bool offline) {
  score_capture(state, make_capture(18, 225, 480), genlock, offline);
}

void large(benchmark::State& state) {
  score_capture(state, make_capture(18'000, 10, 90), false, false);
}

BENCHMARK_CAPTURE(small, truth, false, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(small, genlock_check, true, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(small, genlock_check_and_offline, true, true)->Unit(benchmark::kMicrosecond);
BENCHMARK(large)->Unit(benchmark::kMillisecond);

}  // namespace
