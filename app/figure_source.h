// Makes figures: from a result archive, whose runs it repeats in the simulator for what an archive
// does not hold, or from a scenario alone.
//
// A run is a pure function of scenario, pipeline and seed, so the repeated one is the archive's.
// Its AMD is compared with the archive's all the same: another version of simbench may give another
// run, and then the figures of that pipeline and seed are left out and a note says so. Of an
// archive without a manifest (a results.json alone) only what stands in it is drawn.
//
//   reports::Archive archive = reports::read_archive("results/monday");
//   const ArchiveFigures made = archive_figures(archive, {.seeds = {1, 2}});
//
// Cost: a run of each pipeline for every seed shown, 10 ms or so each for 18 cameras; an error
// budget is 128 runs a seed.
//
// Errors: scenarios::InputError (a seed, pipeline or figure that is not there; a scenario that this
// version does not take), cli::Interrupted, what the simulator throws.
#ifndef SIMBENCH_APP_FIGURE_SOURCE_H_
#define SIMBENCH_APP_FIGURE_SOURCE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/run/evaluate.h"
#include "reports/archive/archive.h"
#include "reports/figures/figure.h"
#include "scenarios/scenario.h"

namespace simbench::app {

struct FigureOptions {
  std::vector<std::uint64_t> seeds{};    // to show in detail; empty: the first of the archive
  std::vector<std::string> pipelines{};  // to show in detail; empty: all
  std::uint64_t budget_seeds = 0;        // for error budgets (128 runs each); 0: no budgets
  std::vector<std::string> figures{};    // by id or alias; empty: all
};

struct ArchiveFigures {
  // In the order of the catalogue; those of one id by seed, then by pipeline as in the archive.
  // Figures over all seeds come first without, then with a pipeline.
  std::vector<reports::Figure> figures;
  std::vector<std::string> notes;  // what a reader of the figures has to know; mostly none
};

// Reads the archive's seed details if it has none yet (reports::read_seed_details). `progress` may
// be null; it counts runs.
ArchiveFigures archive_figures(reports::Archive& archive, const FigureOptions& options,
                               const evaluation::Progress& progress = nullptr);

// The same without an archive: where figures over seeds are wanted it evaluates `over_seeds` of
// them first, from options.seeds (empty: 1) on.
ArchiveFigures scenario_figures(const scenarios::Scenario& scenario, const FigureOptions& options,
                                std::uint64_t over_seeds,
                                const evaluation::Progress& progress = nullptr);

}  // namespace simbench::app

#endif  // SIMBENCH_APP_FIGURE_SOURCE_H_
