// From the scores of all seeds to one row of the table, with the paper's published values.
//
// A seed without a recording keeps its place, so that rows stay paired by seed: its values are NaN
// in every series, and the row has its notes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/scoring/pulse_spread.h"
#include "evaluation/scoring/results.h"
#include "scenarios/scenario.h"

namespace simbench::evaluation {

// The settings that the rows of one scenario share.
struct RowSetting {
  double gathering_interval_ms = 0;  // T_int
  std::size_t sources = 0;
  MedianKind median = MedianKind::kUpperMiddle;
  ResultKind kind = ResultKind::kCaptures;
};

RowSetting row_setting(const scenarios::Scenario& scenario);

// Returns the score of a seed without a recording, every quantity NaN, with the reason in its
// notes.
SeedScore missing_score(std::uint64_t seed, const std::string& reason);

// Returns the row over these seeds, which must still have their pulses (for the margin).
Row make_row(const scenarios::Pipeline& pipeline, std::vector<SeedScore> seeds,
             const RowSetting& setting);

// Returns over how many seeds the row's median of a metric is: those that have a value.
std::size_t scored_seeds(const Row& row, const Metric& metric);
// Returns over how many seeds the row has an AMD; where none has, over how many it has the metric
// that most seeds have.
std::size_t scored_seeds(const Row& row);

// Whether the row has pulses but no AMD: those of a single camera.
bool has_single_camera(const Row& row);

// Compares a published result with the seeds of a row.
PublishedComparison compare(const scenarios::Published& published, const Row& row,
                            const RowSetting& setting);

}  // namespace simbench::evaluation
