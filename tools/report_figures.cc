#include "tools/report_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

#include "recording/version.h"
#include "reports/figures/figure_catalogue.h"
#include "reports/figures/result_figures.h"
#include "scenarios/loader.h"
#include "tools/figure_source.h"

namespace simbench::tools {
namespace {

using reports::Archive;
using reports::Figure;
using reports::FigureScope;
using reports::ReportedArchive;

constexpr const char* kBudget = "budget";

std::vector<std::string> pipelines_in_detail(const Archive& archive, const ReportDetail& detail) {
  std::vector<std::string> pipelines = detail.pipelines;
  if (!pipelines.empty()) return pipelines;
  for (const evaluation::Row& row : archive.results.rows) pipelines.push_back(row.pipeline);
  if (pipelines.size() > kMostRuns) pipelines.resize(kMostRuns);
  return pipelines;
}

std::uint64_t bounded_seeds(const std::optional<std::uint64_t>& wanted, const Archive& archive,
                            std::uint64_t runs_for_each) {
  const std::uint64_t fitting =
      std::clamp<std::uint64_t>(kMostRuns / runs_for_each, 1, kDefaultSeeds);
  return std::min(wanted.value_or(fitting), archive.results.seed_count);
}

// By id, in two kinds: what every seed has its own of, and what is there once.
std::vector<std::string> figures_of(bool per_seed) {
  std::vector<std::string> ids;
  for (const reports::FigureEntry& entry : reports::figure_catalogue()) {
    const bool of_seed = entry.scope == FigureScope::kSeed || entry.scope == FigureScope::kRun;
    if (of_seed == per_seed && entry.id != kBudget) ids.push_back(entry.id);
  }
  return ids;
}

// One call of archive_figures for each step, so that progress can be told and Ctrl-C is heard.
std::vector<FigureOptions> steps_of(const Archive& archive, const ReportDetail& detail,
                                    std::size_t archives) {
  const std::vector<std::string> pipelines = pipelines_in_detail(archive, detail);
  const std::uint64_t runs = pipelines.size() * archives;
  const std::uint64_t seeds = bounded_seeds(detail.seeds, archive, runs);
  const std::uint64_t budget_seeds = bounded_seeds(detail.budget_seeds, archive, runs);
  std::vector<FigureOptions> steps = {{.pipelines = pipelines, .figures = figures_of(false)}};
  for (std::uint64_t i = 0; i < seeds; ++i) {
    steps.push_back({.seeds = {archive.results.first_seed + i},
                     .pipelines = pipelines,
                     .figures = figures_of(true)});
  }
  for (const std::string& pipeline : pipelines) {
    if (budget_seeds == 0) break;
    steps.push_back({.pipelines = {pipeline}, .budget_seeds = budget_seeds, .figures = {kBudget}});
  }
  return steps;
}

std::string detail_note(const Archive& archive, const ReportDetail& detail, std::size_t archives) {
  const std::vector<std::string> pipelines = pipelines_in_detail(archive, detail);
  const std::uint64_t seeds = bounded_seeds(detail.seeds, archive, pipelines.size() * archives);
  std::string note;
  if (seeds < archive.results.seed_count) {
    note = fmt::format(
        "Tables and distributions are of all {} seeds; stamps, clocks and single pulses are shown "
        "of the first {} (--seeds-in-detail).",
        archive.results.seed_count, seeds);
  }
  if (pipelines.size() < archive.results.rows.size()) {
    note += fmt::format("{}In detail: {} of {} pipelines (--pipelines).", note.empty() ? "" : " ",
                        pipelines.size(), archive.results.rows.size());
  }
  return note;
}

std::string version_note(const Archive& archive) {
  if (archive.version == version() && archive.commit == commit()) return "";
  return fmt::format(
      "The results are of simbench {} ({}), the figures of {} ({}), which ran the seeds again.",
      archive.version, archive.commit, version(), commit());
}

void add(std::vector<std::string>& notes, const std::string& note) {
  const bool known = std::find(notes.begin(), notes.end(), note) != notes.end();
  if (!note.empty() && !known) notes.push_back(note);
}

std::size_t place_in_catalogue(const Figure& figure) {
  const auto& catalogue = reports::figure_catalogue();
  const auto entry = std::find_if(catalogue.begin(), catalogue.end(),
                                  [&](const auto& each) { return each.id == figure.id; });
  return static_cast<std::size_t>(entry - catalogue.begin());
}

void draw(ReportedArchive& reported, const std::vector<FigureOptions>& steps,
          const evaluation::Progress& progress) {
  for (std::size_t i = 0; i < steps.size(); ++i) {
    progress(i, steps.size());
    ArchiveFigures made = archive_figures(reported.archive, steps[i]);
    std::move(made.figures.begin(), made.figures.end(), std::back_inserter(reported.figures));
    for (const std::string& note : made.notes) add(reported.notes, note);
  }
  progress(steps.size(), steps.size());
  std::stable_sort(reported.figures.begin(), reported.figures.end(),
                   [](const Figure& a, const Figure& b) {
                     return place_in_catalogue(a) < place_in_catalogue(b);
                   });
}

// What needs no scenario.
void draw_results_only(ReportedArchive& reported, const std::string& reason) {
  reported.figures = reports::distributions(reported.archive);
  reported.notes = {reason};
}

}  // namespace

ReportedArchive with_figures(Archive archive, const ReportDetail& detail, std::size_t archives,
                             const evaluation::Progress& progress) {
  ReportedArchive reported{.archive = std::move(archive)};
  if (reported.archive.scenario_json.empty()) {
    draw_results_only(
        reported,
        "A results.json alone, without its manifest.json, does not say which scenario "
        "it is of: only the tables and the distributions over seeds can be shown.");
    return reported;
  }
  reports::read_seed_details(reported.archive);
  add(reported.notes, detail_note(reported.archive, detail, archives));
  add(reported.notes, version_note(reported.archive));
  try {
    draw(reported, steps_of(reported.archive, detail, archives), progress);
  } catch (const scenarios::InputError& error) {
    draw_results_only(
        reported, fmt::format("Only the tables and the distributions over seeds can be shown: {}",
                              error.what()));
  }
  return reported;
}

}  // namespace simbench::tools
