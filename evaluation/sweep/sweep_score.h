// The score of one run of a sweep, as numbers and as text, and the response over all seeds of a
// point.
//
// The text is for the log of finished runs and for other machines: the cells of the run's line in
// sweep.csv, a semicolon, and the mean clock error of every host; of a run in which a real program
// ended too early, which has no values, another semicolon and the failure in words. Numbers are the
// shortest that read back as the same double, so the text loses nothing.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/scoring/results.h"
#include "evaluation/sweep/sweep_plan.h"

namespace simbench::evaluation {

// NaN: the value does not exist.
struct SweepScore {
  ResultKind kind = ResultKind::kCaptures;
  std::vector<double> values;            // by sweep_metrics(kind) (evaluation/scoring/metrics.h)
  std::vector<double> host_errors_ms{};  // signed mean, by host
  std::string
      failed{};  // "host 3, at 0.250000 s: chronyd: exited with status 1"; empty: it did not

  // Zero in every column.
  SweepScore() : SweepScore(ResultKind::kCaptures) {}
  explicit SweepScore(ResultKind of);

  // The value of a column, which must exist: "amd_ms", "sets".
  double& at(std::string_view column);
};

// Returns the score of a row with one seed.
SweepScore sweep_score(const Row& row, ResultKind kind = ResultKind::kCaptures);

std::string text_of(const SweepScore& score);
// Returns nothing for another text.
std::optional<SweepScore> score_of(std::string_view text, ResultKind kind = ResultKind::kCaptures);

// The response of the metrics to the swept values: one pipeline at one point, over all seeds.
struct ResponseRow {
  std::size_t point = 0;
  std::size_t pipeline = 0;
  ResultKind kind = ResultKind::kCaptures;
  std::vector<Series> series{};  // of every column of sweep.csv, over the seeds
  // What captures have over all seeds; margin_ms is the median of the seeds'.
  PooledValues pooled{};
  std::vector<Series> hosts{};  // |mean clock error| of each host; the master's is first
  // In how many seeds a real program ended too early, and the first failure in words.
  std::size_t failed_seeds = 0;
  std::string failed{};

  // The series of a column, which must exist: of("amd_ms").median.
  const Series& of(std::string_view column) const;
  Series& at(std::string_view column);
  // The value of a metric that is a column, over all seeds: its median, or the pooled number.
  double value(const Metric& metric) const;
};

// Returns a row for each point and pipeline, in the order of the plan. `scores`: of all runs.
std::vector<ResponseRow> response(const SweepPlan& plan, const std::vector<SweepScore>& scores);

}  // namespace simbench::evaluation
