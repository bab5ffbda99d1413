#include "evaluation/sweep/sweep_standing.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace simbench::evaluation {
namespace {

double total(const ResponseRow& row, const char* column) {
  const std::vector<double>& values = row.of(column).values;
  return std::accumulate(values.begin(), values.end(), 0.0);
}

Outcome response_outcome(const ResponseRow& row) {
  return {.unsynchronised_hosts = total(row, "unsynchronised_hosts"),
          .sets = total(row, "sets"),
          .pure_sets = total(row, "pure_sets"),
          .complete_pulses = total(row, "complete_pulses")};
}

}  // namespace

RankedBy ranking_of(const SweepPlan& plan, const std::vector<ResponseRow>& rows) {
  if (plan.kind == ResultKind::kClockRuns) return RankedBy::kClockSpread;
  if (plan.ranked_by != RankedBy::kAmd) return plan.ranked_by;
  const bool has_amd = std::ranges::any_of(
      rows, [](const ResponseRow& row) { return !std::isnan(row.of("amd_ms").median); });
  return has_amd ? RankedBy::kAmd : RankedBy::kAbsoluteError;
}

std::vector<ResponseRow> without_failed(std::vector<ResponseRow> rows, RankedBy ranked_by) {
  const Metric& metric = ranked_metric(ranked_by);
  const auto has_failed = [ranked_by](const ResponseRow& row) {
    if (!row.failed.empty()) return true;
    return row.kind == ResultKind::kCaptures &&
           !failure_text(response_outcome(row), ranked_by).empty();
  };
  for (ResponseRow& row : rows) {
    if (!has_failed(row)) continue;
    Series& series = row.at(metric.sweep);
    series = make_series(std::vector<double>(series.values.size(), kNan));
  }
  return rows;
}

}  // namespace simbench::evaluation
