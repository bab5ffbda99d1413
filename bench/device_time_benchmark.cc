// Time per frame of every registered device_time estimator, over a minute of world A at 45 fps with
// its polls (device_time_worlds.h).
//
// References in the same run: raw_arrival, which is the cost of the loop alone, and
// hull_300_recomputed, the windowed hull computed anew for each frame. hull_300_convex is the
// window's worst case, a stream in which every frame is a vertex. A scored run of 5 ms stamps some
// 13,000 frames.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "algorithms/device_time/hull.h"
#include "algorithms/device_time/offset_stream.h"
#include "algorithms/device_time/variants.h"
#include "algorithms/registry.h"
#include "bench/device_time_worlds.h"
#include "laws/lower_hull.h"

namespace simbench {
namespace {

// The lower hull of the last 300 frames, computed anew for each frame.
class RecomputedHull final : public DeviceTimeEstimator {
 public:
  GlobalTime stamp(const DeviceSample& sample) override {
    if (points_.empty()) anchor_ = SampleAnchor(sample);
    if (points_.size() == kFrames) points_.erase(points_.begin());
    points_.push_back(anchor_.point(sample));
    hull_.clear();
    for (const LinePoint& point : points_) hull_.add(point);
    return anchor_.stamp(sample.sensor, middle_line(hull_.vertices()).at(points_.back().x));
  }

 private:
  static constexpr std::size_t kFrames = 300;
  SampleAnchor anchor_{DeviceSample{}};
  std::vector<LinePoint> points_;
  LowerHull hull_;
};

DeviceTimeRun minute() {
  DeviceTimeWorld world;
  world.length_s = 60;
  return make_device_time_run(world, 1);
}

DeviceTimeRun convex_minute() {
  DeviceTimeRun run = minute();
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    run.frames[i].arrival = HostTime(
        Nanoseconds(nanoseconds_of(run.frames[i].sensor) + static_cast<std::int64_t>(10 * i * i)));
  }
  return run;
}

// Every iteration stamps the whole run with a new estimator.
template <class Make>
void stamp_run(benchmark::State& state, const DeviceTimeRun& run, Make make) {
  for (auto iteration : state) {
    const auto estimator = make();
    std::size_t polled = 0;
    if (estimator->offline()) estimator->learn(run.frames);
    for (const DeviceSample& frame : run.frames) {
      for (; polled < run.polls.size() && run.polls[polled].t1 <= frame.arrival; ++polled) {
        estimator->on_poll(run.polls[polled]);
      }
      benchmark::DoNotOptimize(estimator->stamp(frame));
    }
  }
  const auto frames = state.iterations() * static_cast<std::int64_t>(run.frames.size());
  state.SetItemsProcessed(frames);
  state.counters["s_per_frame"] = benchmark::Counter(
      static_cast<double>(frames), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void register_benchmarks() {
  for (const DeviceTimeEntry& entry : algorithms<DeviceTimeEntry>()) {
    if (!entry.make) continue;
    benchmark::RegisterBenchmark(entry.info.name.c_str(), [&entry](benchmark::State& state) {
      stamp_run(state, minute(),
                [&entry] { return entry.make(check_parameters(entry.info.parameters, {})); });
    });
  }
  benchmark::RegisterBenchmark(
      "hull_switch_10s_steady_exposure_corrected", [](benchmark::State& state) {
        stamp_run(state, minute(),
                  [] { return on_steady_clock(exposure_corrected(make_switching_hull({}))); });
      });
  benchmark::RegisterBenchmark("hull_300_convex", [](benchmark::State& state) {
    stamp_run(state, convex_minute(), [] { return make_window_hull({}); });
  });
  benchmark::RegisterBenchmark("hull_300_recomputed", [](benchmark::State& state) {
    stamp_run(state, minute(), [] { return std::make_unique<RecomputedHull>(); });
  });
}

}  // namespace
}  // namespace simbench

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  simbench::register_benchmarks();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
