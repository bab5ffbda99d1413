// Time of each estimator of stability over all octaves of a million points, and of all of them.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>

#include "evaluation/stability/stability.h"

namespace {

using simbench::evaluation::Deviation;
using simbench::evaluation::TimeErrorSeries;

constexpr std::size_t kPoints = 1'000'000;

// A clock that wanders, by a generator of its own: the values do not matter.
const TimeErrorSeries& wandering() {
  static const TimeErrorSeries series = [] {
    TimeErrorSeries made{.interval_s = 1, .pieces = {{}}};
    std::uint64_t state = 1;
    double x_s = 1;
    for (std::size_t i = 0; i < kPoints; ++i) {
      state = state * 6'364'136'223'846'793'005 + 1'442'695'040'888'963'407;
      x_s += 1e-18 * static_cast<double>(static_cast<std::int64_t>(state) >> 30);
      made.pieces[0].x_s.push_back(x_s);
    }
    return made;
  }();
  return series;
}

void over_octaves(benchmark::State& state, Deviation deviation) {
  const TimeErrorSeries& series = wandering();
  for (auto iteration : state) {
    benchmark::DoNotOptimize(deviation_over_octaves(series, deviation));
  }
}

void all_of_them(benchmark::State& state) {
  const TimeErrorSeries& series = wandering();
  for (auto iteration : state) benchmark::DoNotOptimize(stability_of(series));
}

void steps(benchmark::State& state) {
  const TimeErrorSeries& series = wandering();
  for (auto iteration : state) benchmark::DoNotOptimize(steps_of(series));
}

BENCHMARK_CAPTURE(over_octaves, adev, Deviation::kAdev)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(over_octaves, adev_plain, Deviation::kAdevPlain)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(over_octaves, mdev, Deviation::kMdev)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(over_octaves, hdev, Deviation::kHdev)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(over_octaves, hdev_plain, Deviation::kHdevPlain)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(over_octaves, tdev, Deviation::kTdev)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(over_octaves, mtie, Deviation::kMtie)->Unit(benchmark::kMillisecond);
BENCHMARK(steps)->Unit(benchmark::kMillisecond);
BENCHMARK(all_of_them)->Unit(benchmark::kMillisecond);

}  // namespace
