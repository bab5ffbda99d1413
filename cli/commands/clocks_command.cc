#include <memory>
#include <optional>

#include "app/clock_causes.h"
#include "app/interrupt.h"
#include "app/results.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/figure_file.h"
#include "cli/program_options.h"
#include "cli/program_runs.h"
#include "cli/progress.h"
#include "evaluation/clock_run/clock_evaluation.h"
#include "reports/clocks/clock_report.h"

namespace simbench::cli {
namespace {

constexpr const char* kClocksExamples = R"(
Examples:
  simbench clocks --scenario 6host_star
  simbench clocks --scenario 6host_star --pipelines chrony,ntp --seeds 32 --format json > ntp.json
  simbench clocks --scenario 6host_lan_day --duration-s 86400 --figure day.svg
  simbench clocks --scenario my_rig.json -o results/clocks
  simbench clocks --scenario 6host_star --pipelines two_way_hull,huygens_software
  simbench clocks --scenario 6host_star --program chronyd --pipelines chrony --seeds 2

There are no cameras and no trigger: only hosts, clocks and network, from a cold start. After
--duration-s the master is unreachable for 600 s, then 3600 s show how the hosts recover.

Real programs (--program) take seconds for what an algorithm does in a moment: with them the default
is ten minutes, or what they are said to need, and runs shorter than 4200 s lose no master.

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 5 a program failed in every seed,
130 interrupted.)";

struct ClocksOptions {
  std::string scenario;
  evaluation::ClockOptions clocks;
  std::optional<std::uint64_t> duration_s;
  std::vector<std::string> sets;
  ProgramOptions programs;
  std::string format;
  std::string output;
  std::string figure;
  std::vector<std::string> command;
};

// With what follows the loss of the master.
std::uint64_t simulated_s(const evaluation::ClockOptions& options) {
  constexpr Nanoseconds kAfter = evaluation::kMasterLostFor + evaluation::kRecovery;
  const std::int64_t after_s = options.loses_master ? kAfter.count() / kSecondNs : 0;
  return options.duration_s + static_cast<std::uint64_t>(after_s);
}

int clocks(ClocksOptions options) {
  const FigureFile figure(options.figure);
  app::RunArchive archive(options.command);
  const scenarios::Scenario scenario =
      load_with_programs(options.scenario, options.sets, options.programs, options.clocks.pipelines,
                         evaluation::AdHoc::kHostSyncToo);
  const std::string period_note = choose_duration(scenario, options.duration_s, options.clocks);
  evaluation::check_clock_options(scenario, options.clocks);
  print_warnings(scenarios::warnings(scenario));
  archive.open(options.output);
  const evaluation::ClockPipelines pipelines = clock_pipelines(scenario, options.clocks);
  if (const std::string note = programs_note(scenario, pipelines.names, options.clocks.seeds,
                                             simulated_s(options.clocks));
      !note.empty()) {
    print_note(note);
  }
  evaluation::ClockOptions run = options.clocks;
  run.cancel = &app::InterruptHandler::flag();
  auto results = watched<evaluation::ClockResults>([&](const evaluation::Progress& progress) {
    return std::make_optional(evaluation::evaluate_clocks(
        scenario, [&] { return app::simulated_clocks(scenario); }, run, progress));
  });
  if (!results) return kInterrupted;
  results->period_note = period_note;
  auto causes = watched<evaluation::ClockCauses>(
      [&](const evaluation::Progress& progress) {
        return std::make_optional(app::causes_of(*results, scenario, run, progress));
      },
      {.unit = "cause"});
  if (causes) results->causes = std::move(*causes);
  print_warnings(results->results.warnings);
  // Whoever interrupts the search for causes has the results all the same.
  if (archive.write(*results, scenario)) print_note("results written to " + options.output);
  if (!causes) return kInterrupted;
  print_result(app::clock_text(*results, scenario, options.format));
  // Last: without gnuplot the results are there all the same.
  if (figure) {
    figure.draw(reports::clock_figure(*results));
    print_note(figure.path() + " written");
  }
  return status_of(results->results);
}

}  // namespace

void add_clocks_command(CommandLine& line) {
  auto options = std::make_shared<ClocksOptions>();
  options->command = line.arguments;
  evaluation::ClockOptions& clocks_options = options->clocks;
  Command command(line, "clocks",
                  "Run the hosts' clocks alone for hours: time error, stability, holdover");
  command.scenario(options->scenario);
  command.whole_number("--duration-s", "S", options->duration_s, 1, evaluation::kLongestClockRunS,
                       "Seconds from the cold start to the loss of the master. Default: 36000;\n"
                       "with real programs from 360 to 3600, mostly 600");
  command.whole_number("--from-s", "S", clocks_options.from_s, 0, evaluation::kLongestClockRunS,
                       "The second from which spread, errors and stability count. Default: 300");
  command.count("--seeds", clocks_options.seeds, "How many seeds. Default: 8");
  command.seed("--first-seed", clocks_options.first_seed, "The first seed. Default: 1");
  command.jobs(clocks_options.jobs);
  command.pipelines(clocks_options.pipelines, "a host_sync alone");
  command.sets(options->sets);
  command.python();
  add_program_options(command, options->programs);
  command.format(options->format, {"table", "markdown", "latex", "csv", "tidy", "json"});
  command.output("-o,--output", "DIR", options->output,
                 "Write a result archive to this folder: manifest.json, results.json, curves.csv,\n"
                 "series.csv (time errors of the first seed). Replaces an earlier archive there");
  command.output("--figure", "FILE", options->figure,
                 "Draw ADEV, TDEV and MTIE over tau to this file (.svg or .pdf, by gnuplot)");
  command.footer(kClocksExamples);
  command.runs([options] { return clocks(*options); });
}

}  // namespace simbench::cli
