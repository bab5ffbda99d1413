#include "cli/program_runs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "cli/messages.h"
#include "evaluation/clock_run/program_duration.h"
#include "evaluation/scoring/program_failures.h"
#include "recording/counted.h"

namespace simbench::cli {
namespace {

using scenarios::Pipeline;
using scenarios::Scenario;

constexpr std::size_t kMostNamed = 4;

// "ptp4l and phc2sys".
std::string names_of_programs(const scenarios::HostPrograms& programs) {
  std::vector<std::string> names;
  for (const auto* role : {&programs.master, &programs.slave}) {
    for (const auto& command : *role) {
      std::string name = scenarios::program_name(command);
      if (std::ranges::find(names, name) == names.end()) names.push_back(std::move(name));
    }
  }
  return fmt::format("{}", fmt::join(names, " and "));
}

double capture_s(const Scenario& scenario) {
  return 1e-3 * (scenario.timeline.wait_before_capture_ms + scenario.timeline.warm_up_ms +
                 static_cast<double>(scenario.timeline.frames) * scenario.trigger.period_ms());
}

}  // namespace

std::string programs_note(const Scenario& scenario, const std::vector<std::string>& names,
                          std::uint64_t seeds, std::optional<std::uint64_t> duration_s) {
  const std::vector<const Pipeline*> running = evaluation::program_pipelines(scenario, names);
  if (running.empty()) return "";
  std::vector<std::string> parts;
  for (const Pipeline* pipeline : running) {
    if (parts.size() == kMostNamed) {
      parts.push_back(fmt::format("{} more", running.size() - kMostNamed));
      break;
    }
    const double each_s = duration_s
                              ? static_cast<double>(*duration_s)
                              : pipeline->programs->run_before_capture_s + capture_s(scenario);
    parts.push_back(fmt::format("{} ({}, {:.0f} s each)", pipeline->name,
                                names_of_programs(*pipeline->programs), std::ceil(each_s)));
  }
  const std::size_t pipelines = names.empty() ? scenario.pipelines.size() : names.size();
  return fmt::format("simulates {} of {}: {}, of which {} {} real programs", counted(seeds, "seed"),
                     counted(scenario.hosts.count, "host"), counted(pipelines, "pipeline"),
                     fmt::join(parts, ", "), running.size() == 1 ? "runs" : "run");
}

std::string choose_duration(const Scenario& scenario, std::optional<std::uint64_t> stated_s,
                            evaluation::ClockOptions& options) {
  const bool has_programs = !evaluation::program_pipelines(scenario, options.pipelines).empty();
  if (stated_s) options.duration_s = *stated_s;
  if (!has_programs) return "";
  if (!stated_s) {
    options.duration_s =
        evaluation::program_duration_s(scenario, options.pipelines, options.from_s);
  }
  options.loses_master = evaluation::loss_is_worth_it(options.duration_s);
  if (stated_s && options.loses_master) return "";
  return fmt::format(
      "Simulated {} s{}, since real programs take long: --duration-s for {}.", options.duration_s,
      options.loses_master ? "" : ", without the loss of the master",
      options.loses_master
          ? "more"
          : fmt::format("more, from {} s on with that loss",
                        (evaluation::kMasterLostFor + evaluation::kRecovery).count() / kSecondNs));
}

int status_of(const evaluation::Results& results) {
  const bool has_failed = std::ranges::any_of(results.rows, evaluation::failed_in_all_seeds) ||
                          !results.programs_left_out.empty();
  return has_failed ? kProgramFailed : kOk;
}

}  // namespace simbench::cli
