// Runs of the hosts' clocks alone for the package.

#include <chrono>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "app/clock_causes.h"
#include "app/interrupt.h"
#include "app/results.h"
#include "cli/figure_file.h"
#include "cli/program_runs.h"
#include "evaluation/clock_run/clock_evaluation.h"
#include "python/src/binding.h"
#include "python/src/bindings.h"
#include "python/src/run.h"
#include "python/src/work.h"
#include "reports/clocks/clock_report.h"
#include "reports/results/csv.h"
#include "scenarios/loader.h"

namespace simbench::python {
namespace {

struct ClockRun {
  evaluation::ClockResults results{};
  scenarios::Scenario scenario{};
  reports::Provenance provenance{};
  std::vector<std::string> notes{};
};

// `duration_s`: nothing: as the command chooses it.
std::shared_ptr<ClockRun> run_clocks(const RunRequest& request,
                                     std::optional<std::uint64_t> duration_s, std::uint64_t from_s,
                                     const Object& on_progress) {
  auto run = std::make_shared<ClockRun>();
  run->provenance.command = request.command;
  run->provenance.started = std::chrono::system_clock::now();
  run->scenario = load_scenario(request);
  evaluation::ClockOptions options{.from_s = from_s,
                                   .first_seed = request.first_seed,
                                   .seeds = request.seeds,
                                   .jobs = request.jobs,
                                   .pipelines = request.pipelines};
  const std::string period_note = cli::choose_duration(run->scenario, duration_s, options);
  evaluation::check_clock_options(run->scenario, options);
  options.cancel = &app::InterruptHandler::flag();
  using evaluation::ClockResults;
  run->results = watched<ClockResults>(on_progress, [&](const evaluation::Progress& progress) {
    return evaluation::evaluate_clocks(
        run->scenario, [&] { return app::simulated_clocks(run->scenario); }, options, progress);
  });
  run->results.period_note = period_note;
  run->results.causes =
      watched<evaluation::ClockCauses>(on_progress, [&](const evaluation::Progress& progress) {
        return app::causes_of(run->results, run->scenario, options, progress);
      });
  run->provenance.finished = std::chrono::system_clock::now();
  run->notes = scenarios::warnings(run->scenario);
  const std::vector<std::string>& more = run->results.results.warnings;
  run->notes.insert(run->notes.end(), more.begin(), more.end());
  return run;
}

void save_clocks(const ClockRun& run, const std::string& folder) {
  reports::OutputFolder output(folder, reports::clock_archive_files());
  reports::write_clock_archive(output, run.results, run.scenario, run.provenance);
}

std::string series_csv(const ClockRun& run) {
  std::ostringstream text;
  reports::write_series_csv(run.results, text);
  return text.str();
}

// Draws ADEV, TDEV and MTIE over tau to a .svg or .pdf file, by gnuplot.
void draw_clocks(const ClockRun& run, const std::string& path) {
  cli::FigureFile(path).draw(reports::clock_figure(run.results));
}

std::string clock_html(const ClockRun& run) {
  const reports::Document document = reports::clock_document(run.results, run.scenario.summary);
  return html(reports::clock_answer(run.results)) + html(document.blocks);
}

}  // namespace

void bind_clocks(const Object& module) {
  add_class<ClockRun>(
      module, "simbench._simbench.ClockRun",
      {.properties = {property("notes", [](const ClockRun& run) { return run.notes; })},
       .methods = {
           method("csv", [](const ClockRun& run) { return reports::clock_csv(run.results); }),
           method("tidy_csv",
                  [](const ClockRun& run) { return reports::tidy_csv(run.results.results); }),
           method("json", [](const ClockRun& run) { return reports::clock_json(run.results); }),
           method("series_csv", callable<&series_csv>),
           method("text",
                  [](const ClockRun& run) {
                    return app::clock_text(run.results, run.scenario, "table");
                  }),
           method("html", callable<&clock_html>), method("draw", callable<&draw_clocks>),
           method("save", callable<&save_clocks>)}});
  add_functions(module, {function("run_clocks", callable<&run_clocks>)});
}

}  // namespace simbench::python
