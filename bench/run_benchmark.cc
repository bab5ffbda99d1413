// One full run of a pipeline: the world from the first synchronisation message to the last frame,
// device time, gathering and scores; in CPU time, by pipeline. The argument is the seed.
//
//   run_benchmark --benchmark_filter=yoon2021_both
#include <benchmark/benchmark.h>

#include <cstdint>
#include <string>

#include "cli/process.h"
#include "evaluation/run/evaluate.h"
#include "scenarios/loader.h"
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
