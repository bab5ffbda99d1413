#include "app/report_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "app/figure_source.h"
#include "recording/version.h"
#include "reports/figures/figure.h"
#include "scenarios/loader.h"

namespace simbench::app {
namespace {

using reports::Archive;
using reports::ReportedArchive;

constexpr const char* kBudget = "budget";
constexpr std::uint64_t kRunsOfABudget = 128;  // a seed; only for the progress
constexpr std::size_t kMostNotes = 6;

// A call of archive_figures and its share of the work.
struct Step {
  FigureOptions options;
  std::uint64_t runs = 0;
};

// All figures but error budgets at once, then a budget for each pipeline.
std::vector<Step> steps_of(const Archive& archive, const ReportDetail& detail) {
  Step first;
  first.options.pipelines = detail.pipelines;
  for (const reports::FigureEntry& entry : reports::figure_catalogue()) {
    if (entry.id != kBudget) first.options.figures.push_back(entry.id);
  }
  for (std::uint64_t i = 0; i < detail.seeds.value_or(1); ++i) {
    first.options.seeds.push_back(archive.results.first_seed + i);
  }
  first.runs = first.options.seeds.size() * detail.pipelines.size();
  std::vector<Step> steps = {first};
  const std::uint64_t budget_seeds = detail.budget_seeds.value_or(0);
  for (const std::string& pipeline : detail.pipelines) {
    if (budget_seeds == 0) break;
    Step step;
    step.options.pipelines = {pipeline};
    step.options.budget_seeds = budget_seeds;
    step.options.figures = {kBudget};
    step.runs = budget_seeds * kRunsOfABudget;
    steps.push_back(step);
  }
  return steps;
}

std::string version_note(const Archive& archive) {
  if (archive.version == version() && archive.commit == commit()) return "";
  return fmt::format(
      "The results are of simbench {} ({}); simbench {} ({}) repeated the runs for the figures.",
      archive.version, archive.commit, version(), commit());
}

void draw(ReportedArchive& reported, const std::vector<Step>& steps,
          const evaluation::Progress& progress) {
  std::uint64_t all = 0;
  for (const Step& step : steps) all += step.runs;
  std::uint64_t before = 0;
  for (const Step& step : steps) {
    ArchiveFigures made = archive_figures(
        reported.archive, step.options, [&](std::uint64_t done, std::uint64_t total) {
          progress(before + step.runs * done / std::max<std::uint64_t>(total, 1), all);
        });
    std::move(made.figures.begin(), made.figures.end(), std::back_inserter(reported.figures));
    std::move(made.notes.begin(), made.notes.end(), std::back_inserter(reported.notes));
    before += step.runs;
  }
}

// What stands in the archive, without running anything.
void draw_stored(ReportedArchive& reported, const FigureOptions& options) {
  Archive stored = reported.archive;
  stored.scenario_json.clear();
  reported.figures = archive_figures(stored, options).figures;
}

void shorten(std::vector<std::string>& notes) {
  if (notes.size() <= kMostNotes) return;
  const std::size_t more = notes.size() - kMostNotes;
  notes.resize(kMostNotes);
  notes.push_back(fmt::format("... and {} more notes of this kind", more));
}

}  // namespace

ReportDetail bounded(const ReportDetail& detail, const Archive& archive, std::size_t archives) {
  ReportDetail chosen = detail;
  if (chosen.pipelines.empty()) {
    for (const evaluation::Row& row : archive.results.rows)
      chosen.pipelines.push_back(row.pipeline);
    if (chosen.pipelines.size() > kMostRuns) chosen.pipelines.resize(kMostRuns);
  }
  const std::uint64_t each = std::max<std::uint64_t>(chosen.pipelines.size() * archives, 1);
  const std::uint64_t fitting = std::clamp<std::uint64_t>(kMostRuns / each, 1, kDefaultSeeds);
  chosen.seeds = std::min(detail.seeds.value_or(fitting), archive.results.seed_count);
  chosen.budget_seeds = std::min(detail.budget_seeds.value_or(fitting), archive.results.seed_count);
  return chosen;
}

ReportedArchive with_figures(Archive archive, const ReportDetail& detail,
                             const evaluation::Progress& progress) {
  ReportedArchive reported{.archive = std::move(archive)};
  const std::vector<Step> steps = steps_of(reported.archive, detail);
  if (reported.archive.scenario_json.empty()) {
    reported.notes = {fmt::format(
        "{} has no manifest, which names the scenario: only the tables and the distributions over "
        "seeds can be shown; `simbench run --output DIR` writes archives that have one.",
        reported.archive.path)};
    draw_stored(reported, steps.front().options);
    return reported;
  }
  reports::read_seed_details(reported.archive);
  try {
    draw(reported, steps, progress);
    shorten(reported.notes);
    const std::string other = version_note(reported.archive);
    if (!other.empty()) reported.notes.insert(reported.notes.begin(), other);
  } catch (const scenarios::InputError& error) {
    reported.notes = {
        fmt::format("The runs cannot be repeated, so only what the archive holds is "
                    "shown: {}",
                    error.what())};
    draw_stored(reported, steps.front().options);
  }
  return reported;
}

std::string detail_note(const Archive& archive, const ReportDetail& detail) {
  std::string note;
  if (detail.seeds < archive.results.seed_count) {
    note = fmt::format(
        "Tables and distributions are of all {} seeds; stamps, clocks and single pulses are shown "
        "of the first {} (--seeds-in-detail).",
        archive.results.seed_count, *detail.seeds);
  }
  if (detail.pipelines.size() < archive.results.rows.size()) {
    note += fmt::format("{}In detail: {} of {} pipelines (--pipelines).", note.empty() ? "" : " ",
                        detail.pipelines.size(), archive.results.rows.size());
  }
  return note;
}

}  // namespace simbench::app
