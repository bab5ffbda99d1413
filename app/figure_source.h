// Makes figures: of a result archive, whose runs it repeats in the simulator for what an archive
// does not hold, of a recording folder, or of a scenario alone; and what a report shows of an
// archive, within bounds of time and size.
//
// A run is a pure function of scenario, pipeline and seed, so a repeated run is the archive's. Its
// AMD is still compared with the archive's: another version of simbench may give another run. The
// figures of that pipeline and seed are then left out, with a note. An archive without a
// manifest (a results.json alone) gets only the figures of what it holds.
//
//   reports::Archive archive = reports::read_archive("results/monday");
//   const ArchiveFigures made = archive_figures(archive, {.seeds = {1, 2}});
//
// Cost: a run of each pipeline for every seed shown, some 10 ms each for 18 cameras; an error
// budget is 136 runs a seed. Progress counts runs.
//
// Errors: scenarios::InputError (an unknown seed, pipeline or figure; a scenario that this version
// does not take), RecordingCancelled, what the simulator throws.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/recordings.h"
#include "evaluation/run/evaluate.h"
#include "reports/archive/archive.h"
#include "reports/figures/figure.h"
#include "reports/page/html_report.h"
#include "scenarios/scenario.h"

namespace simbench::app {

struct FigureOptions {
  std::vector<std::uint64_t> seeds{};    // to show in detail; empty: the first of the archive
  std::vector<std::string> pipelines{};  // to show in detail; empty: all
  std::uint64_t budget_seeds = 0;        // for error budgets (136 runs each); 0: no budgets
  std::vector<std::string> figures{};    // by id or alias; empty: all
  // Whether digital_clocks shows a rig of depth and colour in all sync modes of its cameras
  // (sync_mode_worlds.h); else in its own. Not of recordings.
  bool all_sync_modes = false;
};

bool is_of_one_pipeline(const reports::FigureEntry& entry);
// The pipelines that a figure shows where nobody names any: all (empty), or of a figure of one
// pipeline that of the paper's figure, else the usual one. `known`: those that there are.
std::vector<std::string> usual_pipelines(const reports::FigureEntry& entry,
                                         const std::vector<std::string>& known);

struct ArchiveFigures {
  // In the order of the catalogue; figures of one id by seed, then by pipeline as in the archive.
  // Figures over all seeds come first without, then with a pipeline.
  std::vector<reports::Figure> figures;
  std::vector<std::string> notes;  // what a reader of the figures has to know; mostly none
};

// Reads the archive's seed details if it has none yet (reports::read_seed_details). `progress` may
// be null.
ArchiveFigures archive_figures(reports::Archive& archive, const FigureOptions& options,
                               const evaluation::Progress& progress = nullptr);

// The same without an archive. Evaluates `over_seeds` seeds first, from options.seeds (empty: 1)
// on, where figures over seeds are wanted.
ArchiveFigures scenario_figures(const scenarios::Scenario& scenario, const FigureOptions& options,
                                std::uint64_t over_seeds,
                                const evaluation::Progress& progress = nullptr);

// Draws the figures of a recording, whose captures stand in place of runs: without budgets, which
// need other worlds. Throws also RecordingFailed.
ArchiveFigures recording_figures(const RecordedRun& run, const FigureOptions& options,
                                 const evaluation::Progress& progress = nullptr);

struct ReportDetail {
  // How many seeds, from the first; nothing: kDefaultSeeds, fewer where there are many pipelines.
  std::optional<std::uint64_t> seeds{};
  std::optional<std::uint64_t> budget_seeds{};  // likewise; 0: no error budgets
  std::vector<std::string> pipelines{};         // empty: all of the archive
};

inline constexpr std::uint64_t kDefaultSeeds = 4;
// The most runs (pipeline and seed) that a report shows in detail without a stated number of seeds:
// about 3 MB of figures of 18 cameras.
inline constexpr std::uint64_t kMostRuns = 32;

// Returns the detail with every choice made, for one of `archives` that share the bounds.
ReportDetail bounded(const ReportDetail& detail, const reports::Archive& archive,
                     std::size_t archives);

// The archive with its figures and notes. `detail` is what bounded() returned. What cannot be drawn
// (no manifest, a scenario that this version does not take) is left out, with a note.
reports::ReportedArchive with_figures(reports::Archive archive, const ReportDetail& detail,
                                      const evaluation::Progress& progress);

// States what is not shown in full; empty if everything is.
std::string detail_note(const reports::Archive& archive, const ReportDetail& detail);

}  // namespace simbench::app
