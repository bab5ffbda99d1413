#include "tools/run_command.h"

#include <fmt/format.h>

#include <chrono>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>

#include "evaluation/evaluate.h"
#include "reports/archive.h"
#include "reports/csv.h"
#include "reports/json.h"
#include "reports/table.h"
#include "sim/rig/simulation.h"
#include "tools/exit_status.h"
#include "tools/interrupt.h"
#include "tools/progress.h"

namespace simbench::tools {
namespace {

constexpr const char* kExamples = R"(
Examples:
  simbench run --scenario 18cam_6host_45fps
  simbench run --scenario 18cam_6host_45fps --seeds 1000 --pipelines yoon2021_both,genlock
  simbench run --scenario my_rig.json --set /network/latency_fixed_ms=0.2 --format markdown
  simbench run --scenario 3cam_1host_30fps --format json > results.json
  simbench run --scenario 3cam_1host_30fps --output results/monday

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 130 interrupted.)";

struct RunOptions {
  std::string scenario;
  evaluation::EvaluationOptions evaluation;
  std::vector<std::string> sets;
  std::string format;
  std::string output;
  std::vector<std::string> command;
};

std::string formatted(const evaluation::Results& results, const std::string& summary,
                      const std::string& format) {
  if (format == "json") return reports::json(results);
  if (format == "csv") return reports::csv(results);
  if (format == "markdown") return reports::markdown(results, summary);
  return reports::table(results, summary);
}

// Runs until done or interrupted: then there are no results.
std::optional<evaluation::Results> evaluate(const scenarios::Scenario& scenario,
                                            const evaluation::EvaluationOptions& options) {
  const InterruptHandler handler;
  Progress progress(std::cerr, terminal_style(), "runs");
  std::uint64_t finished = 0;
  std::uint64_t all = 0;
  try {
    return evaluation::evaluate(
        scenario, [&] { return interruptible(sim::make_simulation(scenario)); }, options,
        [&](std::uint64_t done, std::uint64_t total) {
          finished = done;
          all = total;
          progress.update(done, total);
        });
  } catch (const std::exception&) {
    if (!InterruptHandler::raised()) throw;
  }
  progress.finish();
  std::cerr << fmt::format("interrupted after {} of {} runs; no result was written\n", finished,
                           all ? std::to_string(all) : "all");
  return std::nullopt;
}

int run(const RunOptions& options) {
  reports::Provenance provenance;
  provenance.command = options.command;
  provenance.started = std::chrono::system_clock::now();
  const scenarios::Scenario scenario =
      scenarios::load_scenario(options.scenario, overrides_of(options.sets));
  evaluation::check_pipelines(scenario);
  print_warnings(scenarios::warnings(scenario));
  std::unique_ptr<reports::OutputFolder> output;
  if (!options.output.empty()) output = std::make_unique<reports::OutputFolder>(options.output);

  evaluation::EvaluationOptions evaluation = options.evaluation;
  evaluation.keep_pulses = output != nullptr;
  const std::optional<evaluation::Results> results = evaluate(scenario, evaluation);
  if (!results) return kInterrupted;
  print_warnings(results->warnings);
  provenance.finished = std::chrono::system_clock::now();
  if (output) {
    reports::write_archive(*output, *results, scenario, provenance);
    std::cerr << "results written to " << options.output << '\n';
  }
  print_result(formatted(*results, scenario.summary, options.format));
  return kOk;
}

}  // namespace

void add_run_command(CLI::App& app, Action& action, std::vector<std::string> arguments) {
  CLI::App* command = app.add_subcommand(
      "run", "Run every pipeline of a scenario over many seeds and print the table");
  auto options = std::make_shared<RunOptions>();
  options->command = std::move(arguments);
  evaluation::EvaluationOptions& evaluation = options->evaluation;
  command
      ->add_option("--scenario", options->scenario,
                   "Name of a scenario (see `simbench list`) or path of a scenario file")
      ->type_name("SCENARIO")
      ->required();
  command
      ->add_option("--seeds", evaluation.seeds,
                   "How many seeds: runs of each pipeline. Default: 32")
      ->type_name("N")
      ->check(whole_number(1, 1'000'000));
  command->add_option("--first-seed", evaluation.first_seed, "The first seed. Default: 1")
      ->type_name("K")
      ->check(whole_number(0, std::numeric_limits<std::uint32_t>::max()));
  command->add_option("--jobs", evaluation.jobs, "Threads. Default: one for every core")
      ->type_name("N")
      ->check(whole_number(1, 4096));
  command
      ->add_option("--pipelines", evaluation.pipelines,
                   "Only these pipelines of the scenario, in this order")
      ->type_name("NAME,NAME")
      ->delimiter(',')
      ->allow_extra_args(false);
  add_set_option(*command, options->sets);
  add_format_option(*command, options->format, {"table", "markdown", "csv", "json"});
  command
      ->add_option("--output", options->output,
                   "Write a result archive to this folder: manifest.json, results.json,\n"
                   "frames.csv, hosts.csv. An earlier archive there is replaced")
      ->type_name("DIR");
  command->footer(kExamples);
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace simbench::tools
