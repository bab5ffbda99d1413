// simbench-first-table SCENARIO: prints what `simbench run --scenario SCENARIO` prints.
//
// Half of simbench is not needed for that - nodes and rigs, bags, pages, studies - and takes half
// of the time to compile. tools/run shows the first table in a fresh clone with this program, and
// builds simbench after it. It has no options and runs no scenario with programs.

#include <exception>
#include <string>

#include "app/answer.h"
#include "app/interrupt.h"
#include "app/results_text.h"
#include "cli/messages.h"
#include "cli/process.h"
#include "cli/progress.h"
#include "evaluation/run/evaluate.h"
#include "reports/text/plain_text.h"
#include "scenarios/loader.h"

namespace simbench::cli {
namespace {

int print_table_of(const std::string& name) {
  const scenarios::Scenario scenario = scenarios::load_scenario(name);
  evaluation::check_pipelines(scenario);
  print_warnings(scenarios::warnings(scenario));
  const auto results = watched<evaluation::Results>([&](const evaluation::Progress& progress) {
    return evaluation::evaluate(
        scenario, [&] { return app::simulated_world(scenario); }, {.share_captures = true},
        progress);
  });
  if (!results) return kInterrupted;
  print_warnings(results->warnings);
  const auto answer = watched<reports::ResultsAnswer>([&](const evaluation::Progress& progress) {
    return app::run_answer(*results, scenario, {}, progress);
  });
  if (!answer) return kInterrupted;
  print_result(app::results_text(*results, scenario, "table", app::Detail::kScreen, *answer));
  return kOk;
}

}  // namespace
}  // namespace simbench::cli

int main(int argc, char** argv) {
  namespace cli = simbench::cli;
  cli::keep_freed_memory();
  cli::hold_standard_descriptors();
  simbench::reports::set_page_width(cli::width_of_output());
  simbench::reports::set_page_colour(cli::colours_output());
  try {
    if (argc == 2) return cli::print_table_of(argv[1]);
    cli::print_error("usage: simbench-first-table SCENARIO");
  } catch (const std::exception& error) {
    cli::print_error(error.what());
  }
  return cli::kBadInput;
}
