// The cost of one frame set of a reconstruction and of its parts: the rays of 18 depth maps of
// 848x480, Poisson's surface, all of it; with hosts together, and half a second apart, which makes
// several people of one. Times are of one thread, beside the peak memory of the process so far.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <memory>

#include "reconstruction/desync_pattern.h"
#include "reconstruction/libraries/quiet_errors.h"
#include "reconstruction/libraries/set_reconstruction.h"
#include "reconstruction/libraries/surface.h"
#include "reconstruction/subject.h"
#include "scenarios/loader.h"

namespace simbench::reconstruction {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr double kAtSeconds = 1;

struct Rig {
  scenarios::Scenario scenario = scenarios::load_scenario("18cam_6host_30fps_studio");
  std::unique_ptr<Subject> subject = make_person(scenario.studio->subject, 1.0);
  SetReconstruction studio{scenario, *subject, kSeed};

  evaluation::ExposureSet set(benchmark::State& state) const {
    const auto desync_ms = static_cast<double>(state.range(0));
    return desynchronised_set(scenario, kSeed, desync_ms, kAtSeconds, 0);
  }
};

void report_memory(benchmark::State& state) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  constexpr double kKilobytesPerMegabyte = 1024;
  state.counters["peak_MB"] = static_cast<double>(usage.ru_maxrss) / kKilobytesPerMegabyte;
}

void depth_maps(benchmark::State& state) {
  Rig rig;
  const evaluation::ExposureSet set = rig.set(state);
  for (auto _ : state) {
    for (std::size_t camera = 0; camera < set.cameras.size(); ++camera) {
      benchmark::DoNotOptimize(rig.studio.measure(camera, *set.cameras[camera]));
    }
  }
  report_memory(state);
}
BENCHMARK(depth_maps)->Arg(0)->Arg(547)->Unit(benchmark::kSecond)->UseRealTime();

void poisson(benchmark::State& state) {
  Rig rig;
  const QuietErrors quiet;
  const evaluation::ExposureSet set = rig.set(state);
  const StudioRig studio(rig.scenario, kSeed);
  OrientedPoints points;
  for (std::size_t camera = 0; camera < set.cameras.size(); ++camera) {
    constexpr double kMetresPerMm = 1e-3;
    add_points(rig.studio.measure(camera, *set.cameras[camera]), studio.cameras()[camera],
               rig.scenario.studio->point_spacing_mm * kMetresPerMm, points);
  }
  for (auto _ : state) benchmark::DoNotOptimize(poisson_surface(points));
  report_memory(state);
}
BENCHMARK(poisson)->Arg(0)->Arg(547)->Unit(benchmark::kSecond)->UseRealTime();

void frame_set(benchmark::State& state) {
  Rig rig;
  const QuietErrors quiet;
  const evaluation::ExposureSet set = rig.set(state);
  for (auto _ : state) {
    ErrorStatistics errors;
    benchmark::DoNotOptimize(rig.studio.reconstruct(set, errors));
  }
  report_memory(state);
}
BENCHMARK(frame_set)->Arg(0)->Arg(547)->Unit(benchmark::kSecond)->UseRealTime();

}  // namespace
}  // namespace simbench::reconstruction
