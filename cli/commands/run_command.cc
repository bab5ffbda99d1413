#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "app/answer.h"
#include "app/interrupt.h"
#include "app/results.h"
#include "app/results_text.h"
#include "cli/command.h"
#include "cli/commands/commands.h"
#include "cli/program_options.h"
#include "cli/program_runs.h"
#include "cli/progress.h"
#include "cli/rig_backend.h"
#include "evaluation/budget/pipeline_budget.h"
#include "evaluation/run/evaluate.h"
#include "evaluation/run/pipeline_choice.h"
#include "reports/recordings/prediction_report.h"
#include "reports/results/budget_report.h"
#include "reports/results/ground_truth_text.h"
#include "reports/results/results_answer.h"

namespace simbench::cli {
namespace {

constexpr const char* kRunExamples = R"(
Examples:
  simbench run --scenario 18cam_6host_45fps
  simbench run --scenario 18cam_6host_45fps --seeds 1000 --pipelines yoon2021_both,genlock
  simbench run --scenario my_rig.json --set /network/latency_fixed_ms=0.2 --format markdown
  simbench run --scenario 3cam_1host_30fps --format json > results.json
  simbench run --scenario 3cam_1host_30fps --format tidy > seeds.csv
  simbench run --scenario 18cam_6host_45fps_lan --pipelines yoon2021_both --budget
  simbench run --scenario 3cam_1host_30fps -o results/monday
  simbench run --scenario 18cam_6host_45fps --pipelines chrony+hull_300+yoon2021,yoon2021_both
  simbench run --scenario 18cam_6host_45fps_lan --program mine=my_daemon.json --seeds 4
  simbench run --scenario 18cam_6host_45fps --backend hardware --rig rig.json --key-file rig.key

On a real rig it captures each pipeline --seeds times (default: once) and prints the simulator's
prediction for the same scenario beside the measured values.

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 5 a program failed in every seed,
130 interrupted.)";

struct RunOptions {
  std::string scenario;
  evaluation::EvaluationOptions evaluation;
  BackendOptions backend;
  std::vector<std::string> sets;
  ProgramOptions programs;
  std::string rank_by;
  std::string format;
  std::string output;
  bool budget = false;
  bool no_levers = false;
  bool certify = false;
  bool quiet = false;
  bool verbose = false;
  std::vector<std::string> command;

  app::Detail detail() const {
    return quiet ? app::Detail::kAnswer : verbose ? app::Detail::kAll : app::Detail::kScreen;
  }
};

std::optional<evaluation::Results> evaluate(const scenarios::Scenario& scenario,
                                            const evaluation::SourceFactory& make_source,
                                            const evaluation::EvaluationOptions& options,
                                            const Watch& watch = {}) {
  return watched<evaluation::Results>(
      [&](const evaluation::Progress& progress) {
        return evaluation::evaluate(scenario, make_source, options, progress);
      },
      watch);
}

std::optional<evaluation::Results> simulate(const scenarios::Scenario& scenario,
                                            evaluation::EvaluationOptions options) {
  options.share_captures = true;
  return evaluate(
      scenario, [&] { return app::simulated_world(scenario); }, options);
}

// A rig makes one capture after the other.
std::optional<evaluation::Results> measure_rig(const scenarios::Scenario& scenario,
                                               const RunOptions& options) {
  evaluation::EvaluationOptions evaluation = options.evaluation;
  evaluation.jobs = 1;
  evaluation.keep_pulses = !options.output.empty();
  if (options.certify) evaluation.certify = evaluation::assumptions_of(scenario);
  return evaluate(scenario,
                  [&]() -> std::unique_ptr<RecordingSource> {
                    return app::interruptible(make_rig_source(options.backend, scenario));
                  },
                  evaluation, {.waits_for_end = true});
}

// An error budget of every pipeline in place of the table.
int run_budgets(const RunOptions& options, const scenarios::Scenario& scenario) {
  reports::BudgetReport report = {.scenario = scenario.name,
                                  .derivation = scenario.derivation,
                                  .first_seed = options.evaluation.first_seed,
                                  .seeds = options.evaluation.seeds,
                                  .budgets = {}};
  std::vector<scenarios::Pipeline> pipelines;
  for (const evaluation::PipelineChoice& choice :
       evaluation::choose_pipelines(scenario, options.evaluation.pipelines)) {
    pipelines.push_back(choice.pipeline);
  }
  using Budgets = std::vector<evaluation::PipelineBudget>;
  std::optional<Budgets> budgets = watched<Budgets>([&](const evaluation::Progress& progress) {
    return evaluation::pipeline_budgets(scenario, pipelines, app::simulated_world,
                                        options.evaluation, progress);
  });
  if (!budgets) return kInterrupted;
  report.budgets = std::move(*budgets);
  print_result_in(options.format, [&report](const std::string& format) {
    return format == "json" ? reports::budget_json(report)
                            : reports::drawn_as(format, reports::budget_document(report));
  });
  const bool has_failed = std::ranges::any_of(
      report.budgets, [](const auto& budget) { return !budget.stages.failed.empty(); });
  return has_failed ? kProgramFailed : kOk;
}

// Refuses options that cannot be combined with --budget.
void check_budget_options(const RunOptions& options) {
  if (!options.budget) return;
  if (options.format == "csv" || options.format == "tidy") {
    throw scenarios::InputError(
        fmt::format("--format: found '{}', allowed with --budget: table, markdown, latex, json",
                    options.format));
  }
  if (!options.output.empty()) {
    throw scenarios::InputError("--output: a result archive holds no budget; use --format json");
  }
  if (options.backend.backend == "hardware") {
    throw scenarios::InputError("--budget: only in the simulator, which can idealise each stage");
  }
}

std::string text_with_prediction(const evaluation::Results& measured,
                                 const evaluation::Results& simulated,
                                 const scenarios::Scenario& scenario, const RunOptions& options) {
  if (options.format == "json") return reports::json_with_prediction(measured, simulated);
  return app::results_text(measured, scenario, options.format, options.detail(),
                           reports::results_answer(measured),
                           {reports::prediction_block(measured, simulated)});
}

// Throws if there was no capture at all: a table of dashes is no result.
void check_anything_was_captured(const evaluation::Results& measured) {
  for (const evaluation::Row& row : measured.rows) {
    for (const evaluation::SeedScore& seed : row.seeds) {
      if (seed.recorded) return;
    }
  }
  std::string why = "nothing could be captured";
  for (const std::string& line : reports::note_lines(measured)) why += "\n  " + line;
  throw scenarios::InputError(why);
}

// The same pipelines on the rig, with the simulator's prediction beside them.
int run_on_rig(const RunOptions& options, const scenarios::Scenario& scenario,
               app::RunArchive archive) {
  archive.open(options.output);
  std::optional<evaluation::Results> measured = measure_rig(scenario, options);
  if (!measured) return kInterrupted;
  app::rank_by(options.rank_by, *measured);
  check_anything_was_captured(*measured);
  print_warnings(measured->warnings);
  if (archive.write(*measured, scenario)) print_note("results written to " + options.output);
  const std::optional<evaluation::Results> predicted = simulate(
      scenario, {.seeds = evaluation::kFewestOutside,  // so that a measured value can be outside
                 .jobs = options.evaluation.jobs,
                 .pipelines = options.evaluation.pipelines});
  if (!predicted) return kInterrupted;
  print_result(text_with_prediction(*measured, *predicted, scenario, options));
  return status_of(*measured);
}

// Empty for a format without an answer; nothing after an interruption.
std::optional<reports::ResultsAnswer> answer_of(const evaluation::Results& results,
                                                const scenarios::Scenario& scenario,
                                                const RunOptions& options) {
  const bool shows_none = options.format == "csv" || options.format == "tidy";
  if (shows_none && options.output.empty()) return reports::ResultsAnswer{};
  if (options.no_levers) {
    return app::run_answer(results, scenario, {.levers = false}, nullptr);
  }
  return watched<reports::ResultsAnswer>([&](const evaluation::Progress& progress) {
    return app::run_answer(results, scenario, {.jobs = options.evaluation.jobs}, progress);
  });
}

int run(RunOptions options) {
  check_budget_options(options);
  app::RunArchive archive(options.command);
  const scenarios::Scenario scenario =
      load_with_programs(options.scenario, options.sets, options.programs,
                         options.evaluation.pipelines, evaluation::AdHoc::kHostSyncToo);
  evaluation::check_pipelines(scenario);
  print_warnings(scenarios::warnings(scenario));
  if (is_hardware(options.backend)) return run_on_rig(options, scenario, std::move(archive));
  if (const std::string note =
          programs_note(scenario, options.evaluation.pipelines, options.evaluation.seeds);
      !note.empty()) {
    print_note(note);
  }
  if (options.budget) return run_budgets(options, scenario);
  archive.open(options.output);
  evaluation::EvaluationOptions evaluation = options.evaluation;
  evaluation.keep_pulses = !options.output.empty();
  if (options.certify) evaluation.certify = evaluation::assumptions_of(scenario);
  std::optional<evaluation::Results> results = simulate(scenario, evaluation);
  if (!results) return kInterrupted;
  app::rank_by(options.rank_by, *results);
  print_warnings(results->warnings);
  const std::optional<reports::ResultsAnswer> answer = answer_of(*results, scenario, options);
  // Whoever interrupts the search for levers has the results all the same.
  if (archive.write(*results, scenario, answer ? &*answer : nullptr)) {
    print_note("results written to " + options.output);
  }
  if (!answer) return kInterrupted;
  print_result(app::results_text(*results, scenario, options.format, options.detail(), *answer));
  return status_of(*results);
}

}  // namespace

void add_run_command(CommandLine& line) {
  auto options = std::make_shared<RunOptions>();
  options->command = line.arguments;
  evaluation::EvaluationOptions& evaluation = options->evaluation;
  Command command(line, "run",
                  "Run every pipeline of a scenario over many seeds and print the table");
  command.scenario(options->scenario);
  const Option seeds =
      command.count("--seeds", evaluation.seeds,
                    "How many seeds, that is, runs of each pipeline. Default: 32; on a real rig 1");
  command.seed("--first-seed", evaluation.first_seed, "The first seed. Default: 1");
  command.jobs(evaluation.jobs);
  command.pipelines(evaluation.pipelines);
  command.sets(options->sets);
  command.rank_by(options->rank_by);
  command.python();
  add_program_options(command, options->programs);
  add_backend_options(command, options->backend);
  command.format(options->format, {"table", "markdown", "latex", "csv", "tidy", "json"});
  command.output("-o,--output", "DIR", options->output,
                 "Write a result archive to this folder: manifest.json, results.json,\n"
                 "frames.csv, hosts.csv. Replaces an earlier archive there");
  const Option quiet =
      command.flag("--quiet", options->quiet, "Print the answer alone: one paragraph");
  command
      .flag("--verbose", options->verbose,
            "Print all metrics, their meaning and the paper's claims")
      .excludes(quiet);
  command.flag("--no-levers", options->no_levers,
               "Do not look for what would improve the best pipeline, which takes as long as\nthe "
               "run itself");
  const Option certify =
      command.flag("--certify", options->certify,
                   "A column beside AMD: no two frames of 95 % of the sets were exposed further\n"
                   "apart, for sure; `simbench certify` says what limits it");
  command
      .flag("--budget", options->budget,
            "Instead of the table, divide each pipeline's error among the stages that\n"
            "cause it, and that of its host clocks between world and algorithm (136 runs for\n"
            "every seed)")
      .excludes(certify);
  command.footer(kRunExamples);
  command.runs([options] { return run(*options); },
               [options, seeds] {
                 if (options->backend.backend == "hardware" && !seeds.given()) {
                   options->evaluation.seeds = 1;
                 }
               });
}

}  // namespace simbench::cli
