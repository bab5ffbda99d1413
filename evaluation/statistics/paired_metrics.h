// The metrics that comparisons and gates are about, with what makes a change of each worth a word.
//
// What a metric's values over the seeds are reduced to in a table is its median. Recall is the
// exception: gathering mostly finds all sets of a seed or none, so a median stays at 100 % until
// half of the seeds are lost; its mean over the seeds stands in its place.
//
//   for (const PairedMetric& metric : paired_metrics()) use(metric.title, metric.of(row).values);
#ifndef SIMBENCH_EVALUATION_STATISTICS_PAIRED_METRICS_H_
#define SIMBENCH_EVALUATION_STATISTICS_PAIRED_METRICS_H_

#include <array>
#include <cstddef>
#include <vector>

#include "evaluation/scoring/results.h"

namespace simbench::evaluation {

struct PairedMetric {
  const char* name = "";   // of the member in results.json
  const char* title = "";  // for people
  const char* unit = "";   // "ms", or "" for a share
  bool higher_is_better = false;
  double smallest_step = 0;  // a smaller change means nothing, whatever its share
  GateMargin margin;         // unless a baseline says otherwise
  const Series& (*of)(const Row&) = nullptr;

  // The one value for all seeds; NaN if no seed has one.
  double table_value(const std::vector<double>& values) const;
};

inline constexpr std::size_t kPairedMetrics = 4;
const std::array<PairedMetric, kPairedMetrics>& paired_metrics();

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_STATISTICS_PAIRED_METRICS_H_
