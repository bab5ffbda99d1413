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
#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/engine_workloads/workload.h"

namespace simbench::bench {
namespace {

struct Case {
  const char* workload;
  std::uint32_t size;
  std::int64_t length;  // events of w1, ms of w2: long enough for some tens of milliseconds
  double target_ratio;
};

constexpr std::array<Case, 6> kCases = {{{"w1", 24, 2'000'000, 1.0},
                                         {"w1", 1000, 2'000'000, 0.75},
                                         {"w1", 100'000, 1'000'000, 0.4},
                                         {"w2", 18, 300'000, 0.65},
                                         {"w2", 1800, 3'000, 0.5},
                                         {"w2", 18'000, 400, 0.45}}};

WorkloadResult run_simbench(const Case& c) {
  return c.workload[1] == '1' ? run_hold(c.size, static_cast<std::uint64_t>(c.length))
                              : run_rig(c.size, c.length);
}

WorkloadResult run_reference(const Case& c) {
  return c.workload[1] == '1' ? run_hold_reference(c.size, static_cast<std::uint64_t>(c.length))
                              : run_rig_reference(c.size, c.length);
}

double ns_per_event(const WorkloadResult& result) {
  return 1e9 * result.seconds / static_cast<double>(result.events);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::string compare_case(const Case& c, int pairs) {
  std::vector<double> own_ns;
  std::vector<double> reference_ns;
  std::vector<double> ratios;
  for (int pair = 0; pair < pairs; ++pair) {
    WorkloadResult own;
    WorkloadResult reference;
    if (pair % 2 == 0) reference = run_reference(c);
    own = run_simbench(c);
    if (pair % 2 == 1) reference = run_reference(c);
    if (own.checksum != reference.checksum || own.order_checksum != reference.order_checksum) {
      throw std::runtime_error(fmt::format("{} {}: the checksums differ", c.workload, c.size));
    }
    own_ns.push_back(ns_per_event(own));
    reference_ns.push_back(ns_per_event(reference));
    ratios.push_back(own_ns.back() / reference_ns.back());
  }
  return fmt::format("{:<10} {:>12.2f} {:>13.2f} {:>7.3f} {:>7.2f}\n",
                     fmt::format("{} {}", c.workload, c.size), median(own_ns), median(reference_ns),
                     median(ratios), c.target_ratio);
}

// Runs every case `pairs` times on both sides, alternating which comes first, so that a machine
// that changes its pace favours no side. Returns a table: case, median ns per event of both sides,
// median of the pairs' ratios, target ratio. Throws std::runtime_error if the sides' checksums
// differ.
std::string compare_with_reference(int pairs) {
  std::string table = fmt::format("{:<10} {:>12} {:>13} {:>7} {:>7}\n", "case", "simbench ns",
                                  "reference ns", "ratio", "target");
  for (const Case& c : kCases) table += compare_case(c, pairs);
  return table;
}

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
             result.events, result.seconds, ns_per_event(result), peak_memory_kb(), result.checksum,
             result.order_checksum);
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
  CLI::App* const reference =
      app.add_subcommand("reference", "The same workloads without an engine");
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
