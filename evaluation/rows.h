// From the scores of all seeds to one row of the table, with what the paper published beside it.
#ifndef SIMBENCH_EVALUATION_ROWS_H_
#define SIMBENCH_EVALUATION_ROWS_H_

#include <cstddef>
#include <vector>

#include "evaluation/metrics.h"
#include "evaluation/results.h"
#include "scenarios/scenario.h"

namespace simbench::evaluation {

// What rows of one scenario share.
struct RowSetting {
  double gathering_interval_ms = 0;  // T_int
  std::size_t sources = 0;
  MedianKind median = MedianKind::kUpperMiddle;
};

RowSetting row_setting(const scenarios::Scenario& scenario);

// The row over these seeds, which must still have their pulses (for the margin).
Row make_row(const scenarios::Pipeline& pipeline, std::vector<SeedScore> seeds,
             const RowSetting& setting);

// A published result against the seeds of a row.
PublishedComparison compare(const scenarios::Published& published, const Row& row,
                            const RowSetting& setting);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_ROWS_H_
