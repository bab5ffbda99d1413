#include "app/paper.h"

#include <fmt/format.h>

#include <chrono>
#include <cstddef>
#include <utility>

#include "algorithms/ports/assert.h"
#include "app/answer.h"
#include "app/figure_source.h"
#include "app/interrupt.h"
#include "recording/collected.h"
#include "reports/paper/paper_page.h"
#include "reports/text/block.h"
#include "reports/text/json_node.h"
#include "reports/text/plain_text.h"
#include "scenarios/loader.h"

namespace simbench::app {
namespace {

using reports::Archive;
using reports::Figure;
using reports::FigureEntry;
using reports::PaperResults;
using reports::PaperRun;

constexpr const char* kAt15Fps = "18cam_6host_15fps";
constexpr const char* kAt45Fps = "18cam_6host_45fps";

// Half of the work that `all` counts: the first half, or the second.
evaluation::Progress half_of(const evaluation::Progress& all, std::uint64_t half) {
  if (!all) return nullptr;
  return [&all, half](std::uint64_t done, std::uint64_t total) {
    all(half * total + done, 2 * total);
  };
}

PaperRun run_rate(const char* name, const char* table, const PaperOptions& options,
                  const evaluation::Progress& progress) {
  PaperRun run{.table = table, .scenario = scenarios::load_scenario(name, {}), .results = {}};
  run.results = evaluation::evaluate(
      run.scenario, [&] { return simulated_world(run.scenario); },
      {.first_seed = options.first_seed,
       .seeds = options.seeds,
       .jobs = options.jobs,
       .keep_pulses = true,
       .share_captures = true},
      progress);
  return run;
}

// The ids of the figures about results alone that the paper has not.
std::vector<std::string> other_result_figures() {
  std::vector<std::string> ids;
  for (const FigureEntry& entry : reports::figure_catalogue()) {
    const bool is_of_results = entry.scope == reports::FigureScope::kResults;
    if (entry.paper.empty() && is_of_results) ids.push_back(entry.id);
  }
  return ids;
}

// One of the paper's figures, by its id or by the number that it has at one rate, of the world that
// it is drawn of by itself.
Figure paper_figure(const FigureEntry& entry, const std::string& name, std::uint64_t seed) {
  const scenarios::Scenario scenario =
      scenarios::load_scenario(reports::scenario_of_figure(entry, name), {});
  const std::vector<std::string> known = collected(scenario.pipelines, &scenarios::Pipeline::name);
  const FigureOptions options = {.seeds = {seed},
                                 .pipelines = usual_pipelines(entry, known),
                                 .figures = {name},
                                 .all_sync_modes = true};
  std::vector<Figure> drawn = scenario_figures(scenario, options, 1).figures;
  SIMBENCH_ASSERT(drawn.size() == 1, "one figure of one seed and pipeline");
  return std::move(drawn.front());
}

std::vector<Figure> paper_figures(std::uint64_t seed, const evaluation::Progress& progress) {
  std::vector<Figure> figures;
  const std::vector<FigureEntry>& catalogue = reports::figure_catalogue();
  for (std::size_t done = 0; done < catalogue.size(); ++done) {
    const FigureEntry& entry = catalogue[done];
    if (progress) progress(done, catalogue.size());
    for (const reports::PaperRate& rate : entry.rates) {
      figures.push_back(paper_figure(entry, rate.alias, seed));
      figures.back().id = rate.alias;  // alternatives of one figure have one id
    }
    if (!entry.paper.empty() && entry.rates.empty()) {
      figures.push_back(paper_figure(entry, entry.id, seed));
    }
  }
  return figures;
}

reports::ReportedArchive reported(const PaperRun& run, Archive archive) {
  reports::ReportedArchive all{.archive = std::move(archive)};
  all.figures = archive_figures(all.archive, {.figures = other_result_figures()}).figures;
  all.answer = run_answer(run.results, run.scenario, {}, nullptr).text;
  return all;
}

std::string text_of(const PaperResults& results) {
  const reports::FilePage page;
  return plain(reports::paper_document(results));
}

}  // namespace

PaperResults run_paper(const PaperOptions& options, const evaluation::Progress& progress) {
  return {.at_15_fps = run_rate(kAt15Fps, "Table 2", options, half_of(progress, 0)),
          .at_45_fps = run_rate(kAt45Fps, "Table 3", options, half_of(progress, 1))};
}

PaperFolder::PaperFolder(const std::string& path, std::vector<std::string> command)
    : path_(path),
      provenance_{.command = std::move(command),
                  .started = std::chrono::system_clock::now(),
                  .finished = {}},
      output_(path, {"paper.html", "paper.txt", "paper.json", kAt15Fps, kAt45Fps}) {}

void PaperFolder::write(PaperResults& results, const evaluation::Progress& progress) {
  provenance_.finished = std::chrono::system_clock::now();
  std::vector<reports::ReportedArchive> archives;
  results.figures = paper_figures(results.at_15_fps.results.first_seed, progress);
  for (const PaperRun* run : {&results.at_15_fps, &results.at_45_fps}) {
    Archive archive = reports::kept_archive(path_ + "/" + run->scenario.name, run->results,
                                            run->scenario, provenance_);
    archives.push_back(reported(*run, std::move(archive)));
  }
  output_.file(reports::kManifest)
      << reports::manifest_json(provenance_, reports::Json{{"kind", "paper"}});
  const std::string html = reports::paper_html(
      {.results = results, .archives = std::move(archives), .command = provenance_.command});
  output_.file("paper.html") << html;
  output_.file("paper.txt") << text_of(results);
  output_.file("paper.json") << reports::paper_json(results);
  for (const PaperRun* run : {&results.at_15_fps, &results.at_45_fps}) {
    reports::write_archive_files(output_, run->scenario.name + "/", run->results, run->scenario,
                                 provenance_);
  }
  output_.publish();
}

}  // namespace simbench::app
