#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>

#include "app/answer.h"
#include "app/fit_task.h"
#include "app/fitted_ranking.h"
#include "app/interrupt.h"
#include "app/results_text.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/input_options.h"
#include "cli/progress.h"
#include "evaluation/fit/fit_check.h"
#include "evaluation/run/evaluate.h"
#include "reports/recordings/fit_report.h"
#include "reports/results/results_answer.h"
#include "reports/text/output_file.h"
#include "sim/rig/simulation.h"

namespace simbench::cli {
namespace {

constexpr const char* kFitExamples = R"(
Takes a recording folder (simbench record, or a real rig's), or the bags and CSV files that
`simbench replay` takes. Writes a scenario file: the recording gives the drift of each camera, the
distribution and correlation of the delivery delay and the dropped frames; with exchanges between
hosts also the network's latency and the hosts' rates. A base scenario gives the rest. Prints the
evidence of each value, what stamps cannot show, and how the simulated model compares with the
recording, also with a half to which it was not fitted.

Examples:
  simbench fit monday -o model.json
  simbench --scenario model.json
  simbench fit monday --pipeline two_way_hull --seed 3 -o model.json
  simbench fit *.bag -o model.json --rank              what would a better algorithm give?
  simbench fit left.csv right.csv --one-host --base my_rig.json -o model.json --format json

Exit status: 0 ok, 1 internal error, 2 bad usage or input,
130 interrupted.)";

constexpr const char* kRankingLimits =
    "  Spreads and sets rest on the recording. Absolute errors also rest on the base: no stamp "
    "shows "
    "the\n  constant part of the delay. So do host clocks, unless the recording has their "
    "exchanges.";

struct FitOptions {
  std::vector<std::string> inputs;
  InputOptions files;
  std::string output;
  app::FitChoice choice;
  bool rank = false;
  bool verbose = false;
  std::uint64_t seeds = 8;
  unsigned jobs = 0;
  std::string format;
};

// Nothing after Ctrl-C.
std::optional<app::FitTask> task_of(const FitOptions& options) {
  return watched_reading<app::FitTask>([&](const ReadProgress& progress) {
    return app::fit_task(options.inputs, options.choice, file_options(options.files), progress);
  });
}

// The model under every pipeline.
struct Ranked {
  app::FittedRanking ranking{};
  evaluation::Results results{};

  std::string text(const std::string& format, bool verbose) const {
    return app::results_text(results, ranking.scenario, format,
                             verbose ? app::Detail::kAll : app::Detail::kScreen,
                             reports::results_answer(results));
  }
};

// Nothing after Ctrl-C.
std::optional<Ranked> ranked(const scenarios::Scenario& model, const FitOptions& options) {
  app::FittedRanking ranking = app::ranking_of(model);
  for (const std::string& text : ranking.left_out) print_note("not ranked: " + text);
  auto results = watched<evaluation::Results>(
      [&](const evaluation::Progress& progress) {
        return evaluation::evaluate(
            ranking.scenario, [&] { return app::simulated_world(ranking.scenario); },
            {.seeds = options.seeds, .jobs = options.jobs}, progress);
      },
      {.unit = "run"});
  if (!results) return std::nullopt;
  print_warnings(results->warnings);
  return Ranked{std::move(ranking), std::move(*results)};
}

// What is printed, in this format: the fit alone, or with the ranking; "json" has the ranking
// alone, "fit_json" the fit, for a program that wants both.
std::string fit_text(const reports::FitReport& report, const std::optional<Ranked>& ranking,
                     const std::string& format, bool verbose) {
  if (format == "fit_json" || (format == "json" && !ranking)) return reports::fit_json(report);
  if (!ranking) return reports::fit_table(report);
  if (format == "json" || format == "csv") return ranking->text(format, verbose);
  return fmt::format("{}\nWhat every algorithm would give on this rig\n{}\n\n{}",
                     reports::fit_table(report), kRankingLimits, ranking->text(format, verbose));
}

int run_fit(const FitOptions& options) {
  reports::OutputFile output(options.output);
  reports::FitReport report;
  try {
    const std::optional<app::FitTask> chosen = task_of(options);
    if (!chosen) return kInterrupted;
    const app::FitTask& task = *chosen;
    for (const std::string& note : task.notes) print_note(note);
    report.inputs = options.inputs;
    report.capture = task.capture;
    report.base = task.base.scenario.name;
    report.model = options.output;
    for (const evaluation::FitCamera& camera : task.input.cameras) {
      report.cameras.push_back(camera.name);
    }
    report.study =
        evaluation::study_fit(task.input, task.base, options.output, sim::make_simulation);
  } catch (const evaluation::FitError& error) {
    throw scenarios::InputError(error.what());
  }
  output.write(report.study.model.text);
  output.publish();
  const scenarios::Scenario& model = report.study.model.scenario;
  std::optional<Ranked> ranking;
  if (options.rank) {
    ranking = ranked(model, options);
    if (!ranking) return kInterrupted;
  }
  print_result_in(options.format, [&](const std::string& format) {
    return fit_text(report, ranking, format, options.verbose);
  });
  return kOk;
}

}  // namespace

void add_fit_command(CommandLine& line) {
  auto options = std::make_shared<FitOptions>();
  Command command(line, "fit",
                  "Fit a scenario to a recording: the simulator with a rig's own numbers");
  command.texts("inputs", "INPUT...", options->inputs, kInputsText).required();
  command
      .output("-o,--output", "FILE.json", options->output,
              "The scenario file to write. Replaces an earlier file")
      .required();
  command.text("--base", "SCENARIO", options->choice.base,
               "Scenario (name or file) that gives what is not fitted.\n"
               "Default: the recording's own; for files a built-in one with their counts "
               "and rate");
  command.text("--pipeline", "NAME", options->choice.pipeline,
               "Pipeline of the capture, in a folder with several. Default: the first");
  command.whole_number("--seed", "K", options->choice.seed, 0,
                       std::numeric_limits<std::uint64_t>::max(),
                       "Likewise: seed of the capture, or its repetition on a rig");
  add_input_options(command, options->files);
  command.flag("--one-host", options->choice.one_host,
               "One computer stamped all arrivals, even if the files name several hosts");
  command.flag(
      "--rank", options->rank,
      "Then simulate the model under every pipeline of the leaderboard that it can run, and\n"
      "rank them (with --format json: print the ranking alone)");
  command.flag("--verbose", options->verbose, "With --rank: all rows, all metrics");
  command.count("--seeds", options->seeds, "With --rank: runs of each pipeline. Default: 8");
  command.jobs(options->jobs);
  command.format(options->format, {"table", "json"});
  command.footer(kFitExamples);
  command.runs([options] { return run_fit(*options); });
}

}  // namespace simbench::cli
