#include "app/figure_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "app/answer.h"
#include "app/interrupt.h"
#include "app/sync_mode_worlds.h"
#include "evaluation/budget/pipeline_budget.h"
#include "evaluation/run/jobs.h"
#include "evaluation/run/leaderboard.h"
#include "evaluation/run/pipeline_choice.h"
#include "evaluation/run/run_detail.h"
#include "recording/collected.h"
#include "recording/program_failure.h"
#include "recording/version.h"
#include "reports/clocks/clock_report.h"
#include "reports/figures/figure.h"
#include "reports/figures/result_figures.h"
#include "reports/figures/run_figures.h"
#include "reports/figures/seed_figures.h"
#include "reports/results/results_answer.h"
#include "scenarios/loader.h"

namespace simbench::app {
namespace {

using evaluation::PipelineChoice;
using evaluation::Row;
using evaluation::RunDetail;
using reports::Archive;
using reports::Figure;
using reports::FigureEntry;
using reports::FigureScope;
using reports::FigureSource;
using reports::ReportedArchive;
using scenarios::InputError;
using scenarios::Scenario;

// Values of AMD that differ by more than this share are of different runs: archives have every
// digit.
constexpr double kSameAmd = 1e-9;

constexpr const char* kBudget = "budget";
constexpr const char* kClocks = "digital_clocks";
constexpr std::size_t kMostNotes = 6;

// The ids of the wanted figures.
std::vector<std::string> wanted_ids(const FigureOptions& options) {
  std::vector<std::string> ids;
  if (options.figures.empty()) {
    for (const FigureEntry& entry : reports::figure_catalogue()) ids.push_back(entry.id);
  }
  for (const std::string& name : options.figures) ids.push_back(reports::figure_named(name).id);
  return ids;
}

// Refuses numbers of the paper that are of another frame rate.
void check_rates(const FigureOptions& options, const Scenario& scenario) {
  for (const std::string& name : options.figures) {
    reports::check_rate(reports::figure_named(name), name, scenario.trigger.rate_hz);
  }
}

// The pipeline's AMD at this seed; nothing if the results have none.
std::optional<double> amd_of(const evaluation::Results& results, const std::string& pipeline,
                             std::uint64_t seed) {
  const Row* const row = evaluation::find_row(results.rows, pipeline);
  if (row == nullptr || seed < results.first_seed) return std::nullopt;
  const std::uint64_t index = seed - results.first_seed;
  if (index >= row->amd_ms.values.size()) return std::nullopt;
  return row->amd_ms.values[index];
}

bool same_amd(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) == std::isnan(b);
  return std::abs(a - b) <= kSameAmd * std::max(std::abs(a), std::abs(b));
}

class FigureMaker {
 public:
  FigureMaker(const Archive& archive, const FigureOptions& options,
              const evaluation::Progress& progress)
      : archive_(archive), options_(options), progress_(progress), wanted_(wanted_ids(options)) {}

  // The frame rate of all figures, which tells which of the paper's they are.
  void set_rate(double rate_hz) { rate_hz_ = rate_hz; }

  // Takes runs from this in place of the simulator.
  void take_runs_from(evaluation::WorldFactory make_world) { make_world_ = std::move(make_world); }

  bool wants(const std::string& id) const {
    return std::find(wanted_.begin(), wanted_.end(), id) != wanted_.end();
  }

  // The figures of what the archive holds.
  void add_result_figures() {
    if (archive_.results.rows.empty()) return;
    FigureSource source = source_of_archive();
    if (archive_.results.rows.size() == 1) source.pipeline = archive_.results.rows.front().pipeline;
    if (wants("distributions")) add(reports::distributions(archive_), source);
    if (wants("host_order")) add(reports::host_order(archive_), source);
    if (!wants("frame_errors")) return;
    for (const std::uint64_t seed : options_.seeds) {
      add({reports::frame_errors(archive_, seed)}, source);
    }
  }

  // The figures that need the runs again.
  void add_run_figures(const Scenario& scenario) {
    const std::vector<PipelineChoice> choices =
        evaluation::choose_pipelines(scenario, options_.pipelines);
    std::vector<ModeWorld> modes;
    if (options_.all_sync_modes && wants(kClocks)) modes = sync_mode_worlds(scenario, made_.notes);
    const bool of_one_mode = wants(kClocks) && modes.empty();
    for (const std::uint64_t seed : options_.seeds) {
      if (wants_scope(FigureScope::kRun) || wants("synchronisation") || of_one_mode) {
        add_seed(scenario, choices, seed, of_one_mode);
      }
      if (!modes.empty()) add_clocks_of(modes, seed);
    }
    if (!wants(kBudget) || options_.budget_seeds == 0) return;
    add_budgets(scenario, choices);
  }

  void note(std::string text) { made_.notes.push_back(std::move(text)); }

  ArchiveFigures finish() {
    std::stable_sort(made_.figures.begin(), made_.figures.end(),
                     [](const Figure& a, const Figure& b) { return place(a) < place(b); });
    return std::move(made_);
  }

 private:
  static std::ptrdiff_t place(const Figure& figure) {
    return reports::find_figure(figure.id) - reports::figure_catalogue().data();
  }

  bool wants_scope(FigureScope scope) const {
    return std::any_of(wanted_.begin(), wanted_.end(), [scope](const std::string& id) {
      return reports::find_figure(id)->scope == scope;
    });
  }

  FigureSource source_of_archive() const {
    const evaluation::Results& results = archive_.results;
    return {.scenario = results.scenario,
            .derivation = results.derivation,
            .first_seed = results.first_seed,
            .seeds = results.seed_count,
            .version = archive_.version,
            .commit = archive_.commit};
  }

  FigureSource source_of_repeated_run() const {
    FigureSource source = source_of_archive();
    source.version = version();
    source.commit = commit();
    return source;
  }

  // `source`: of all these figures, but for the pipeline and seed that a figure names itself.
  void add(std::vector<Figure> figures, const FigureSource& source) {
    for (Figure& figure : figures) {
      if (!wants(figure.id)) continue;
      figure.source = source;
      if (rate_hz_) place_in_paper(figure, *rate_hz_);
      if (!figure.pipeline.empty()) figure.source.pipeline = figure.pipeline;
      if (figure.seed) {
        figure.source.first_seed = *figure.seed;
        figure.source.seeds = 1;
      }
      made_.figures.push_back(std::move(figure));
    }
  }

  // Which of the paper's figures it is; and if none is at this rate, which there are.
  static void place_in_paper(Figure& figure, double rate_hz) {
    const FigureEntry& entry = *reports::find_figure(figure.id);
    figure.paper = paper_numbers(entry, rate_hz);
    if (!figure.paper.empty() || !figure.absent.empty()) return;
    for (const reports::PaperRate& each : entry.rates) {
      figure.caption += fmt::format(" The paper's {} is at {:g} Hz, as {}.", each.paper,
                                    each.rate_hz, each.scenario);
    }
  }

  // Adds the runs of a rig in several sync modes.
  void add_clocks_of(const std::vector<ModeWorld>& modes, std::uint64_t seed) {
    std::vector<RunDetail> runs;
    for (const ModeWorld& mode : modes) {
      const std::unique_ptr<RecordingSource> source = make_world_(mode.scenario);
      for (const PipelineChoice& choice :
           evaluation::choose_pipelines(mode.scenario, mode.pipelines)) {
        RunDetail run = evaluation::run_detail(mode.scenario, choice, seed, *source);
        if (is_of_its_pipeline(run)) runs.push_back(std::move(run));
      }
    }
    add({reports::digital_clocks(runs)}, source_of_repeated_run());
  }

  void add_seed(const Scenario& scenario, const std::vector<PipelineChoice>& choices,
                std::uint64_t seed, bool with_clocks) {
    std::vector<RunDetail> made(choices.size());
    std::mutex mutex;  // of the progress
    const auto make_worker = [&]() -> evaluation::Job {
      // Keeps the cameras' half of the seed for the next pipeline.
      const std::shared_ptr<RecordingSource> source = make_world_(scenario);
      return [&, source](std::size_t i) {
        made[i] = evaluation::run_detail(scenario, choices[i], seed, *source);
        const std::lock_guard lock(mutex);
        if (progress_) progress_(++runs_, options_.seeds.size() * choices.size());
      };
    };
    evaluation::run_jobs_with_workers(choices.size(), {}, make_worker);
    std::vector<RunDetail> runs;
    for (RunDetail& run : made) {
      if (is_of_its_pipeline(run) && is_the_archives(run)) runs.push_back(std::move(run));
    }
    const FigureSource source = source_of_repeated_run();
    for (const RunDetail& run : runs) add(reports::run_figures(run), source);
    if (options_.figures == std::vector<std::string>{reports::kCodeFigure} &&
        !scenario.trigger.code) {
      note("the scenario's trigger has no code (/trigger/code)");
    }
    if (runs.empty()) return;
    std::vector<Figure> compared = reports::seed_figures(runs);
    if (!with_clocks)
      std::erase_if(compared, [](const Figure& each) { return each.id == kClocks; });
    add(std::move(compared), source);
  }

  void add_budgets(const Scenario& scenario, const std::vector<PipelineChoice>& choices) {
    const evaluation::EvaluationOptions seeds = {.first_seed = options_.seeds.front(),
                                                 .seeds = options_.budget_seeds};
    FigureSource source = source_of_repeated_run();
    source.first_seed = seeds.first_seed;
    source.seeds = seeds.seeds;
    const std::vector<scenarios::Pipeline> pipelines =
        collected(choices, &PipelineChoice::pipeline);
    for (const evaluation::PipelineBudget& budget :
         evaluation::pipeline_budgets(scenario, pipelines, make_world_, seeds, progress_)) {
      if (!budget.stages.failed.empty()) {
        note(fmt::format("{}: {}; it has no budget", budget.stages.pipeline, budget.stages.failed));
        continue;
      }
      add({reports::budget_figure(budget)}, source);
    }
  }

  // Where a real program ended, what clocks and stamps do is not the pipeline's.
  bool is_of_its_pipeline(const RunDetail& run) {
    if (run.score.program_failures.empty()) return true;
    note(fmt::format("{}, seed {}: a program ended: {}; figures of this run are left out",
                     run.pipeline, run.seed, failure_text(run.score.program_failures.front())));
    return false;
  }

  bool is_the_archives(const RunDetail& run) {
    const std::optional<double> amd = amd_of(archive_.results, run.pipeline, run.seed);
    if (!amd || same_amd(*amd, run.score.amd_ms)) return true;
    note(fmt::format(
        "{}, seed {}: the archive's AMD is {} ms, but this version of simbench finds {} ms (the "
        "archive is of version {}, commit {}); figures of this run are left out",
        run.pipeline, run.seed, *amd, run.score.amd_ms, archive_.version, archive_.commit));
    return false;
  }

  const Archive& archive_;
  const FigureOptions& options_;
  const evaluation::Progress& progress_;
  std::vector<std::string> wanted_;
  evaluation::WorldFactory make_world_ = simulated_world;
  std::optional<double> rate_hz_;
  std::uint64_t runs_ = 0;
  ArchiveFigures made_;
};

void check_seeds(const Archive& archive, const FigureOptions& options) {
  const std::uint64_t first = archive.results.first_seed;
  for (const std::uint64_t seed : options.seeds) {
    if (seed >= first && seed - first < archive.results.seed_count) continue;
    throw InputError(fmt::format("{}: found no seed {}, allowed: {} to {}", archive.path, seed,
                                 first, first + archive.results.seed_count - 1));
  }
}

// The archive's scenario with the archive's pipelines alone, in the archive's order.
Scenario scenario_of(const Archive& archive) {
  Scenario scenario =
      scenarios::load_scenario_text(archive.scenario_json, archive.path + "/manifest.json");
  std::vector<scenarios::Pipeline> pipelines;
  for (const Row& row : archive.results.rows) {
    for (const scenarios::Pipeline& pipeline : scenario.pipelines) {
      if (pipeline.name == row.pipeline) pipelines.push_back(pipeline);
    }
  }
  scenario.pipelines = std::move(pipelines);
  return scenario;
}

std::string files_note(const Archive& archive) {
  return fmt::format(
      "{} is of files, whose capture cannot be simulated: figures of frames are left out; "
      "`simbench "
      "figure NAME FILES -o FILE` draws them from the files themselves",
      archive.path);
}

Archive archive_without_runs(const Scenario& scenario, const std::string& path) {
  Archive archive;
  archive.path = path;
  archive.results.scenario = scenario.name;
  archive.results.derivation = scenario.derivation;
  return archive;
}

bool has_seed_details(const Archive& archive) {
  return std::any_of(archive.results.rows.begin(), archive.results.rows.end(),
                     [](const Row& row) { return !row.seeds.empty(); });
}

}  // namespace

bool is_of_one_pipeline(const FigureEntry& entry) {
  return entry.scope == FigureScope::kRun || entry.scope == FigureScope::kPipeline;
}

std::vector<std::string> usual_pipelines(const FigureEntry& entry,
                                         const std::vector<std::string>& known) {
  if (!is_of_one_pipeline(entry) || known.empty()) return {};
  if (std::ranges::count(known, entry.pipeline) > 0) return {entry.pipeline};
  return {evaluation::usual_pipeline(known)};
}

ArchiveFigures archive_figures(Archive& archive, const FigureOptions& options,
                               const evaluation::Progress& progress) {
  if (archive.results.kind == evaluation::ResultKind::kClockRuns) {
    throw scenarios::InputError(archive.path +
                                ": found an archive of `simbench clocks`, allowed: of `simbench "
                                "run`; `simbench report` draws the figure of this one");
  }
  FigureOptions chosen = options;
  if (chosen.seeds.empty()) chosen.seeds = {archive.results.first_seed};
  check_seeds(archive, chosen);
  const bool has_manifest = !archive.scenario_json.empty();
  if (has_manifest && !has_seed_details(archive)) reports::read_seed_details(archive);
  const bool of_files = reports::is_of_files(archive);
  std::optional<Scenario> scenario;  // whose runs can be repeated
  if (has_manifest && !of_files) scenario = scenario_of(archive);
  FigureMaker maker(archive, chosen, progress);
  if (scenario) {
    check_rates(options, *scenario);
    maker.set_rate(scenario->trigger.rate_hz);
  }
  maker.add_result_figures();
  if (of_files) {
    maker.note(files_note(archive));
  } else if (scenario) {
    maker.add_run_figures(*scenario);
  } else {
    maker.note(
        fmt::format("{} has no manifest: figures that need a repeated run are left out; `simbench "
                    "run --output DIR` writes archives that have one",
                    archive.path));
  }
  return maker.finish();
}

ArchiveFigures recording_figures(const RecordedRun& run, const FigureOptions& options,
                                 const evaluation::Progress& progress) {
  FigureOptions chosen = options;
  if (chosen.seeds.empty()) chosen.seeds = {run.first_seed()};
  chosen.pipelines = run.chosen(options.pipelines);
  chosen.budget_seeds = 0;
  Archive archive = archive_without_runs(run.scenario(), run.path());
  archive.results.first_seed = run.first_seed();
  archive.results.seed_count = run.seeds();
  check_seeds(archive, chosen);
  check_rates(options, run.scenario());
  FigureMaker maker(archive, chosen, progress);
  maker.set_rate(run.scenario().trigger.rate_hz);
  if (maker.wants("distributions") || maker.wants("host_order") || maker.wants("frame_errors")) {
    archive.results = run.evaluate(chosen.pipelines, {.keep_pulses = true}, progress);
  }
  const std::vector<PipelineChoice> choices =
      evaluation::choose_pipelines(run.scenario(), chosen.pipelines);
  maker.take_runs_from([&](const Scenario&) { return run.source(choices); });
  maker.add_result_figures();
  maker.add_run_figures(run.scenario());
  return maker.finish();
}

ArchiveFigures scenario_figures(const Scenario& scenario, const FigureOptions& options,
                                std::uint64_t over_seeds, const evaluation::Progress& progress) {
  FigureOptions chosen = options;
  if (chosen.seeds.empty()) chosen.seeds = {1};
  check_rates(options, scenario);
  Archive archive = archive_without_runs(scenario, scenario.name);
  FigureMaker maker(archive, chosen, progress);
  maker.set_rate(scenario.trigger.rate_hz);
  const bool over = maker.wants("distributions") || maker.wants("host_order");
  if (over || maker.wants("frame_errors")) {
    const auto [first, last] = std::minmax_element(chosen.seeds.begin(), chosen.seeds.end());
    const std::uint64_t shown = *last - *first + 1;
    archive.results = evaluation::evaluate(
        scenario, [&] { return simulated_world(scenario); },
        {.first_seed = *first,
         .seeds = over ? std::max(over_seeds, shown) : shown,
         .pipelines = chosen.pipelines,
         .keep_pulses = true,
         .share_captures = true},
        progress);
  }
  maker.add_result_figures();
  maker.add_run_figures(scenario);
  return maker.finish();
}

namespace {

// A call of archive_figures and its share of the work.
struct Step {
  FigureOptions options;
  std::uint64_t runs = 0;
};

// All figures but error budgets, then the budgets.
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
  const bool has_worlds = !reports::is_of_files(archive);
  if (budget_seeds == 0 || detail.pipelines.empty() || !has_worlds) return steps;
  Step budgets;
  budgets.options.pipelines = detail.pipelines;
  budgets.options.budget_seeds = budget_seeds;
  budgets.options.figures = {kBudget};
  budgets.runs = budget_seeds * detail.pipelines.size() * evaluation::kBudgetRuns;
  steps.push_back(budgets);
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

// The figures of what the archive holds; runs nothing.
void draw_stored(ReportedArchive& reported, const FigureOptions& options) {
  std::string scenario = std::exchange(reported.archive.scenario_json, {});
  reported.figures = archive_figures(reported.archive, options).figures;
  reported.archive.scenario_json = std::move(scenario);
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
  if (reported.archive.results.kind == evaluation::ResultKind::kClockRuns) {
    reported.answer = reports::clock_answer(reported.archive.results);
    reported.figures = {reports::clock_figure(reports::clock_results_of(reported.archive))};
    return reported;
  }
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
    reported.answer =
        reports::is_of_files(reported.archive)
            ? reports::results_answer(reported.archive.results).text
            : run_answer(reported.archive.results, scenario_of(reported.archive), {}, nullptr).text;
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
  if (archive.results.kind == evaluation::ResultKind::kClockRuns) return note;
  if (detail.seeds < archive.results.seed_count) {
    note = fmt::format(
        "Tables and distributions cover all {} seeds; stamps, clocks and single pulses are shown "
        "for the first {} (--seeds-in-detail).",
        archive.results.seed_count, *detail.seeds);
  }
  if (detail.pipelines.size() < archive.results.rows.size()) {
    note += fmt::format("{}In detail: {} of {} pipelines (--pipelines).", note.empty() ? "" : " ",
                        detail.pipelines.size(), archive.results.rows.size());
  }
  return note;
}

}  // namespace simbench::app
