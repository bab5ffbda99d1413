// One full run of a pipeline: the world from the first synchronisation message to the last frame,
// device time, gathering and scores; in CPU time, by pipeline.
//
// `frames` is a run without synchronisation, whose messages cost nothing then: what is left is a
// frame's way through the cameras' world, the clocks and the scorer. It prints the time of a frame,
// with the setting up of the world shared among them.
//
//   run_benchmark --benchmark_filter=yoon2021_both
//   run_benchmark --benchmark_filter=frames
#include <benchmark/benchmark.h>

#include <cstdint>
#include <string>

#include "cli/process.h"
#include "evaluation/run/evaluate.h"
#include "scenarios/loader.h"
#include "sim/rig/camera_world.h"
#include "sim/rig/simulation.h"

namespace simbench {
namespace {

void full_run(benchmark::State& state, const std::string& pipeline) {
  const scenarios::Scenario scenario = scenarios::load_scenario("18cam_6host_45fps");
  std::uint64_t seed = 1;
  std::uint64_t events = 0;
  for (auto _ : state) {
    const evaluation::Results results = evaluation::evaluate(
        scenario, [&] { return sim::make_simulation(scenario); },
        {.first_seed = seed++, .seeds = 1, .jobs = 1, .pipelines = {pipeline}}, {});
    events += results.performance.events;
  }
  state.counters["events/s"] =
      benchmark::Counter(static_cast<double>(events), benchmark::Counter::kIsRate);
}

void frames(benchmark::State& state, const std::string& name) {
  scenarios::Scenario scenario = scenarios::load_scenario(name);
  scenarios::Pipeline pipeline = scenario.pipelines.front();
  pipeline.host_sync = "oracle";
  pipeline.device_time = "regression_30";
  pipeline.gathering = "yoon2021";
  scenario.pipelines = {pipeline};
  const std::int64_t pulses = sim::evaluated_slots(scenario).last + 1;
  const auto frames_of_run = static_cast<double>(pulses * scenario.cameras.count) *
                             static_cast<double>(scenario.cameras.streams.size());
  std::uint64_t seed = 1;
  for (auto _ : state) {
    evaluation::evaluate(scenario, [&] { return sim::make_simulation(scenario); },
                         {.first_seed = seed++, .seeds = 1, .jobs = 1, .pipelines = {}}, {});
  }
  state.counters["s/frame"] = benchmark::Counter(
      frames_of_run, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

BENCHMARK_CAPTURE(frames, 18_cameras, std::string("18cam_6host_45fps"))
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frames, 18000_cameras, std::string("scale_18000cam_6000host_45fps"))
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(full_run, ntp_last_set, std::string("ntp_last_set"))
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(full_run, ntp_w32time, std::string("ntp_w32time"))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(full_run, yoon2021_both, std::string("yoon2021_both"))
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(full_run, oracle, std::string("oracle"))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(full_run, genlock, std::string("genlock"))->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace simbench

int main(int argc, char** argv) {
  simbench::cli::keep_freed_memory();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
