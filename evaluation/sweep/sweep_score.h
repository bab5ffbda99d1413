// What a sweep keeps of one run, as numbers and as text, and what it makes of all seeds of a point.
//
// The text is what goes into the log of finished runs and from one machine to another: the cells of
// the run's line in sweep.csv, then a semicolon, then the mean clock error of every host. Numbers
// are the shortest that read back as the same double, so the text loses nothing.
#ifndef SIMBENCH_EVALUATION_SWEEP_SWEEP_SCORE_H_
#define SIMBENCH_EVALUATION_SWEEP_SWEEP_SCORE_H_

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/scoring/results.h"
#include "evaluation/sweep/sweep_plan.h"

namespace simbench::evaluation {

// NaN is a value that does not exist.
struct SweepScore {
  std::vector<double> values;            // by sweep_metrics() (evaluation/scoring/metrics.h)
  std::vector<double> host_errors_ms{};  // signed mean, by host

  SweepScore();  // zero in every column

  // By the name of the column, which must exist: "amd_ms", "emitted_sets".
  double at(std::string_view column) const;
  double& at(std::string_view column);
};

// Of a row with this one seed.
SweepScore sweep_score(const Row& row);

std::string text_of(const SweepScore& score);
// Nothing if it is no such text.
std::optional<SweepScore> score_of(std::string_view text);
// The part of the text before the semicolon: cells for a CSV.
std::string_view cells_of(std::string_view text);

// How a sweep's metrics respond to what was swept: one pipeline at one point, over all seeds.
struct ResponseRow {
  std::size_t point = 0;
  std::size_t pipeline = 0;
  std::vector<Series> series{};  // of every column of sweep.csv, over the seeds
  double precision = 0;          // over all seeds, as recall
  double recall = 0;
  std::vector<Series> hosts{};  // |mean clock error| of each host; the master's is first

  // By the name of the column, which must exist: of("amd_ms").median.
  const Series& of(std::string_view column) const;
};

// A row for each point and pipeline, in the order of the plan. `scores`: of all runs of the plan.
std::vector<ResponseRow> response(const SweepPlan& plan, const std::vector<SweepScore>& scores);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SWEEP_SWEEP_SCORE_H_
