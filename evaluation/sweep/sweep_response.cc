#include "evaluation/sweep/sweep_response.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

#include "algorithms/ports/assert.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

Series series_of(std::span<const SweepScore> seeds, std::size_t column) {
  std::vector<double> values;
  values.reserve(seeds.size());
  for (const SweepScore& seed : seeds) values.push_back(seed.values[column]);
  return make_series(std::move(values));
}

double sum_of(std::span<const SweepScore> seeds, std::string_view column) {
  double sum = 0;
  for (const SweepScore& seed : seeds) sum += seed.at(column);
  return sum;
}

std::vector<Series> host_series(std::span<const SweepScore> seeds) {
  std::size_t hosts = 0;
  for (const SweepScore& seed : seeds) hosts = std::max(hosts, seed.host_errors_ms.size());
  std::vector<Series> all;
  for (std::size_t host = 0; host < hosts; ++host) {
    std::vector<double> errors;
    for (const SweepScore& seed : seeds) {
      errors.push_back(host < seed.host_errors_ms.size()
                           ? std::fabs(seed.host_errors_ms[host])
                           : std::numeric_limits<double>::quiet_NaN());
    }
    all.push_back(make_series(std::move(errors)));
  }
  return all;
}

}  // namespace

const Series& ResponseRow::of(std::string_view column) const {
  const auto columns = sweep_metrics();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i]->sweep == column) return series[i];
  }
  SIMBENCH_ASSERT(false, "a column of sweep.csv");
}

std::vector<ResponseRow> response(const SweepPlan& plan, const std::vector<SweepScore>& scores) {
  SIMBENCH_ASSERT(scores.size() == plan.runs(), "a score for every run");
  const std::size_t columns = sweep_metrics().size();
  std::vector<ResponseRow> rows;
  for (std::size_t first = 0; first < scores.size(); first += plan.seeds) {
    const std::span<const SweepScore> seeds = std::span(scores).subspan(first, plan.seeds);
    const SweepRun run = plan.run(first);
    const double pure = sum_of(seeds, "pure_sets");
    ResponseRow row{.point = run.point, .pipeline = run.pipeline};
    for (std::size_t i = 0; i < columns; ++i) row.series.push_back(series_of(seeds, i));
    row.precision = pure / sum_of(seeds, "emitted_sets");
    row.recall = pure / sum_of(seeds, "complete_pulses");
    row.hosts = host_series(seeds);
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace simbench::evaluation
