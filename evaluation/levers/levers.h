// Levers: what a user of a rig can change to improve its best pipeline, each tried.
//
// Problem: a user wants to know what to do next: another algorithm, other settings, or money.
//
// Naive attempt: divide the error among the stages (evaluation/budget) and advise a better largest
// stage.
//
// Why it fails: a share is no effect. A stage that is 45 % of an error may have nothing that a user
// could do about it, an algorithm that costs nothing may take away more than any purchase, and an
// ideal stage is not for sale.
//
// Key idea: make the change and look. Each lever is a run of the same seeds with that change
// alone, which a user can repeat: `--pipelines` takes the lever's pipeline, `--set` its sets.
//
// Tried are
//  - the registered algorithms of each stage that this rig can run, simbench's own, one stage
//    exchanged at a time, with the variants of device_time; what a measured calibration would do
//    is a lever of its own, and so is the best of host_sync and device_time together;
//  - changes of the rig (rig_changes.h).
//
// First all are screened over seeds behind those of the results: algorithms at one, the best of
// each stage and the changes at kScreeningLeverSeeds. The most promising ones then run over the
// seeds of the results. Selection and verdict therefore have no seed in common, and the verdicts
// are corrected for each other (compare_together()). A lever is listed if it is better by this test
// and by at least kSmallestGain in the median, or if it finds pulses that were missing, and makes
// neither the absolute error nor the hosts' clocks worse: a smaller AMD alone can hide what
// differs.
//
// Pipelines of programs and worlds that are too large (LeverOptions::most_events) are not searched.
//
// Errors: EvaluationCancelled. A change that its world forbids is left out; an algorithm that fails
// in this world, which nobody asked for, ends the search and not the run (Levers::problem). Cost:
// some 80 runs of algorithms, 40 of variants and changes over kScreeningLeverSeeds seeds, and at
// most kMostVerified runs as long as those of a row.
//
//   const std::optional<Levers> levers =
//       find_levers(scenario, results, *best_of(results), make_world, {}, nullptr);
//   if (levers && !levers->effective.empty()) print(levers->effective.front().what);
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/run/evaluate.h"
#include "evaluation/scoring/results.h"
#include "evaluation/statistics/paired.h"
#include "scenarios/loader.h"

namespace simbench::evaluation {

inline constexpr std::uint64_t kScreeningLeverSeeds = 4;
inline constexpr std::uint64_t kMostLeverSeeds = 64;
inline constexpr double kSmallestGain = 0.05;  // of what is to be improved
inline constexpr std::size_t kMostVerified = 8;

struct LeverOptions {
  double most_events = 40e6;
  unsigned jobs = 0;
};

struct Lever {
  std::string what;      // "device_time regression_30_exposure_corrected"
  std::string pipeline;  // as --pipelines takes it
  std::vector<scenarios::Override> sets{};
  // Medians over the seeds of what the rows are ranked by, before and after.
  double from = kNan;
  double to = kNan;
  // The share of the pulses due that is not found whole; NaN: unknown.
  double missing_from = kNan;
  double missing_to = kNan;
  PairedComparison effect{};  // of the change on what is ranked

  bool finds_pulses() const { return missing_to < missing_from * (1 - kSmallestGain); }
};

struct Levers {
  std::uint64_t seeds = 0;         // of a lever, from the first of the results on
  std::size_t algorithms = 0;      // tried
  std::size_t changes = 0;         // of the rig, tried
  std::vector<Lever> effective{};  // the most effective first
  std::string problem{};           // why they are not known; then there is nothing else
};

// The share of the pulses due that the row has no whole set of; NaN: it is not known.
double missing_share(const Row& row);

// `best` is a row of the results of this scenario. Nothing: levers were not looked for.
std::optional<Levers> find_levers(const scenarios::Scenario& scenario, const Results& results,
                                  const Row& best, const WorldFactory& make_world,
                                  const LeverOptions& options, const Progress& progress);

}  // namespace simbench::evaluation
