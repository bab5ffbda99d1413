// Time per frame of the estimators of device_time.
//
// A scored run stamps some 13,000 frames within its 5 ms.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "algorithms/device_time/equation1.h"
#include "algorithms/device_time/regression.h"

namespace {

using simbench::DeviceSample;

// 45 FPS, a device 50 ppm fast, arrivals that jitter by up to 2 ms.
std::vector<DeviceSample> recording(std::int64_t frames) {
  std::vector<DeviceSample> samples;
  for (std::int64_t i = 0; i < frames; ++i) {
    const std::int64_t exposed_ns = i * 22'222'222;
    const std::int64_t jitter_ns = (i * 7919) % 2000 * 1000;
    samples.push_back({.sensor = simbench::DeviceTime(
                           simbench::Microseconds(exposed_ns / 1000 + exposed_ns / 20'000'000)),
                       .arrival = simbench::HostTime(simbench::Nanoseconds(
                           1'700'000'000'000'000'000 + exposed_ns + jitter_ns)),
                       .arrival_steady = {},
                       .exposure_us = 5000});
  }
  return samples;
}

// Every iteration stamps a whole recording with a new estimator, as a run does.
template <class Make>
void stamp_recordings(benchmark::State& state, Make make) {
  const std::vector<DeviceSample> samples = recording(705);
  for (auto iteration : state) {
    const auto estimator = make();
    if (estimator->offline()) estimator->learn(samples);
    for (const DeviceSample& sample : samples) {
      benchmark::DoNotOptimize(estimator->stamp(sample));
    }
  }
  const auto frames = state.iterations() * static_cast<std::int64_t>(samples.size());
  state.SetItemsProcessed(frames);
  state.counters["s_per_frame"] = benchmark::Counter(
      static_cast<double>(frames), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void regression_30(benchmark::State& state) {
  stamp_recordings(state, [] { return simbench::make_regression(simbench::RegressionWindow{30}); });
}
BENCHMARK(regression_30);

void regression_offline(benchmark::State& state) {
  stamp_recordings(state, [] { return simbench::make_offline_regression(); });
}
BENCHMARK(regression_offline);

void eq1_interval_previous(benchmark::State& state) {
  stamp_recordings(state, [] {
    return simbench::make_equation1(simbench::Equation1Reading::kIntervalPrevious);
  });
}
BENCHMARK(eq1_interval_previous);

}  // namespace
