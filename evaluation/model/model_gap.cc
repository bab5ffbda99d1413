#include "evaluation/model/model_gap.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

GapSide side_of(const Series& series) {
  GapSide side;
  side.series = make_series(series.values);
  side.count = static_cast<std::size_t>(std::count_if(
      series.values.begin(), series.values.end(), [](double value) { return !std::isnan(value); }));
  for (std::size_t i = 0; i < kGapQuantiles.size(); ++i) {
    side.quantiles[i] = quantile(series.values, kGapQuantiles[i]);
  }
  return side;
}

ModelGapRow compare(const std::string& pipeline, const Metric& metric, const Row& measured_row,
                    const Row& simulated_row) {
  const Series& measured = metric.series(measured_row);
  const Series& simulated = metric.series(simulated_row);
  ModelGapRow row;
  row.pipeline = pipeline;
  row.metric = metric.id;
  row.measured = side_of(measured);
  row.simulated = side_of(simulated);
  row.ks = ks_distance(measured.values, simulated.values);
  row.ks_critical = ks_critical_distance(row.measured.count, row.simulated.count);
  const double found = row.measured.series.median;
  row.median_gap = (row.simulated.series.median - found) / found;
  if (found > kSmallestJudgedMs && !std::isnan(row.median_gap)) {
    row.within_20_percent = std::abs(row.median_gap) <= kLargestGap;
  }
  return row;
}

}  // namespace

std::vector<ModelGapRow> model_gap(const Results& measured, const Results& simulated) {
  std::vector<ModelGapRow> rows;
  for (const Row& found : measured.rows) {
    const auto predicted =
        std::find_if(simulated.rows.begin(), simulated.rows.end(),
                     [&](const Row& row) { return row.pipeline == found.pipeline; });
    if (predicted == simulated.rows.end()) continue;
    for (const char* id : kGapMetrics) {
      ModelGapRow row = compare(found.pipeline, metric(id), found, *predicted);
      if (row.measured.count + row.simulated.count > 0) rows.push_back(std::move(row));
    }
  }
  return rows;
}

}  // namespace simbench::evaluation
