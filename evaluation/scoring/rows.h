// From the scores of all seeds to one row of the table, with what the paper published beside it.
//
// A seed without a recording keeps its place: its values are NaN in every series, so that rows stay
// paired by seed, and the row has its notes.
#ifndef SIMBENCH_EVALUATION_SCORING_ROWS_H_
#define SIMBENCH_EVALUATION_SCORING_ROWS_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/scoring/pulse_spread.h"
#include "evaluation/scoring/results.h"
#include "scenarios/scenario.h"

namespace simbench::evaluation {

// What rows of one scenario share.
struct RowSetting {
  double gathering_interval_ms = 0;  // T_int
  std::size_t sources = 0;
  MedianKind median = MedianKind::kUpperMiddle;
};

RowSetting row_setting(const scenarios::Scenario& scenario);

// The score of a seed of which no recording could be made, and why: every quantity is NaN.
SeedScore missing_score(std::uint64_t seed, const std::string& reason);

// The row over these seeds, which must still have their pulses (for the margin).
Row make_row(const scenarios::Pipeline& pipeline, std::vector<SeedScore> seeds,
             const RowSetting& setting);

// A published result against the seeds of a row.
PublishedComparison compare(const scenarios::Published& published, const Row& row,
                            const RowSetting& setting);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SCORING_ROWS_H_
