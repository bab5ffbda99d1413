// engine_workloads: the workloads of docs/reference/event_engine.md section 1.
//
//   engine_workloads [reference] w1 TIMERS EVENTS
//   engine_workloads [reference] w2 CAMERAS MS
//   engine_workloads compare [--pairs N]
//
// w1 and w2 print one row: engine,workload,size,events,seconds,ns_per_event,rss_kb,checksum,
// order_checksum. Exit status: 0 ok, 1 internal error, 2 usage.
#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "bench/engine_workloads/compare.h"
#include "bench/engine_workloads/workload.h"

namespace simbench::bench {
namespace {

constexpr const char* kUsage =
    "usage: engine_workloads [reference] w1 TIMERS EVENTS\n"
    "       engine_workloads [reference] w2 CAMERAS MS\n"
    "       engine_workloads compare [--pairs N]\n";

struct Arguments {
  std::uint32_t timers = 0;
  std::uint64_t events = 0;
  std::uint32_t cameras = 0;
  std::int64_t duration_ms = 0;
  int pairs = 7;
};

void add_workloads(CLI::App& app, Arguments& arguments) {
  app.require_subcommand(1);
  CLI::App* const hold = app.add_subcommand("w1", "Timers, each rearmed when it expires");
  hold->add_option("timers", arguments.timers)->required()->check(CLI::Range(1, 10'000'000));
  hold->add_option("events", arguments.events)
      ->required()
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1'000'000'000'000}));
  CLI::App* const rig = app.add_subcommand("w2", "Cameras whose frames pass to their hosts");
  rig->add_option("cameras", arguments.cameras)->required()->check(CLI::Range(3, 10'000'000));
  rig->add_option("ms", arguments.duration_ms)->required()->check(CLI::Range(1, 1'000'000'000));
}

std::int64_t peak_memory_kb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

void print_row(const char* engine, const char* workload, std::uint32_t size,
               const WorkloadResult& result) {
  fmt::print("{},{},{},{},{:.4f},{:.2f},{},{:016x},{:016x}\n", engine, workload, size,
             result.events, result.seconds,
             1e9 * result.seconds / static_cast<double>(result.events), peak_memory_kb(),
             result.checksum, result.order_checksum);
}

void run_workload(const CLI::App& app, const Arguments& arguments, bool is_reference) {
  const char* const engine = is_reference ? "reference" : "simbench";
  if (app.got_subcommand("w1")) {
    const auto run = is_reference ? run_hold_reference : run_hold;
    print_row(engine, "w1", arguments.timers, run(arguments.timers, arguments.events));
  } else {
    const auto run = is_reference ? run_rig_reference : run_rig;
    print_row(engine, "w2", arguments.cameras, run(arguments.cameras, arguments.duration_ms));
  }
}

int fail_usage(const char* message) {
  fmt::print(stderr, "engine_workloads: {}\n{}", message, kUsage);
  return 2;
}

int run(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Event engine workloads");
  add_workloads(app, arguments);
  CLI::App* const reference = app.add_subcommand("reference", "The same without an engine");
  add_workloads(*reference, arguments);
  CLI::App* const compare = app.add_subcommand("compare", "Both sides in interleaved pairs");
  compare->add_option("--pairs", arguments.pairs)->check(CLI::Range(1, 1000));
  try {
    app.parse(argc, argv);
    if (*compare) {
      fmt::print("{}", compare_with_reference(arguments.pairs));
    } else {
      run_workload(*reference ? *reference : app, arguments, reference->parsed());
    }
  } catch (const CLI::CallForHelp&) {
    fmt::print("{}", kUsage);
  } catch (const CLI::ParseError& error) {
    return fail_usage(error.what());
  } catch (const std::invalid_argument& error) {
    return fail_usage(error.what());
  }
  return 0;
}

}  // namespace
}  // namespace simbench::bench

int main(int argc, char** argv) {
  try {
    return simbench::bench::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "engine_workloads: {}\n", error.what());
    return 1;
  }
}
