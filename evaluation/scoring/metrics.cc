#include "evaluation/scoring/metrics.h"

#include <algorithm>

#include "algorithms/ports/assert.h"
#include "evaluation/scoring/metric_table.h"
#include "evaluation/scoring/results.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

std::vector<Metric>& registered(ResultKind kind) {
  const auto copy = [](std::span<const Metric> table) {
    return std::vector<Metric>(table.begin(), table.end());
  };
  static std::vector<Metric> captures = copy(metric_table(ResultKind::kCaptures));
  static std::vector<Metric> clocks = copy(metric_table(ResultKind::kClockRuns));
  return kind == ResultKind::kCaptures ? captures : clocks;
}

// The count in a row, const or not.
template <class AnyRow>
auto& count_in(AnyRow& row, const Place& place) {
  if (const auto* set = std::get_if<std::int64_t SetCounts::*>(&place)) return row.sets.**set;
  if (const auto* frame = std::get_if<std::int64_t FrameCounts::*>(&place)) {
    return row.frames.**frame;
  }
  return row.*std::get<std::int64_t RunCounts::*>(place);
}

}  // namespace

double Metric::of_seed(const MetricValues<double>& seed) const {
  return seed.*std::get<SeriesPlace>(place).seed;
}
double& Metric::of_seed(MetricValues<double>& seed) const {
  return seed.*std::get<SeriesPlace>(place).seed;
}

const Series& Metric::series(const Row& row) const { return row.*std::get<SeriesPlace>(place).row; }
Series& Metric::series(Row& row) const { return row.*std::get<SeriesPlace>(place).row; }

double Metric::number(const Row& row) const { return row.*std::get<double PooledValues::*>(place); }
double& Metric::number(Row& row) const { return row.*std::get<double PooledValues::*>(place); }

std::int64_t Metric::count(const Row& row) const { return count_in(row, place); }
std::int64_t& Metric::count(Row& row) const { return count_in(row, place); }

bool Metric::can_be(double value) const {
  if (is_share()) return !(value < 0 || value > 1);
  return !judged || !(value < 0);
}

const char* Metric::allowed() const {
  if (is_share()) return "a share from 0 to 1, or null";
  return judged ? "a number from 0, or null" : "a number or null";
}

bool Metric::is_known(const Row& row) const {
  return !is_count() || needs == Needs::kNothing || row.verified();
}

double Metric::value(const Row& row) const {
  if (is_time_until()) return median_time(series(row).values);
  if (is_series()) return series(row).median;
  if (!is_count()) return number(row);
  return is_known(row) ? static_cast<double>(count(row)) : kNan;
}

double Metric::table_value(const std::vector<double>& values) const {
  return is_share() ? mean_of_existing(values) : median(values);
}

std::span<const Metric> metrics(ResultKind kind) { return registered(kind); }

const Metric& metric(std::string_view id, ResultKind kind) {
  const auto all = metrics(kind);
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Metric& each) { return each.id == id; });
  SIMBENCH_ASSERT(found != all.end(), "a metric that there is");
  return *found;
}

std::vector<const Metric*> judged_metrics(ResultKind kind) {
  std::vector<const Metric*> judged;
  for (const Metric& each : metrics(kind)) {
    if (each.judged) judged.push_back(&each);
  }
  return judged;
}

std::vector<const Metric*> judged_metrics(ResultKind kind, std::span<const Row* const> rows) {
  std::vector<const Metric*> judged = judged_metrics(kind);
  std::erase_if(judged, [rows](const Metric* each) {
    return each->is_new && std::ranges::none_of(rows, [each](const Row* row) {
             return count_of_existing(each->series(*row).values) > 0;
           });
  });
  return judged;
}

std::vector<const Metric*> sweep_metrics(ResultKind kind) {
  std::vector<const Metric*> columns;
  for (const Metric& each : metrics(kind)) {
    if (each.sweep != nullptr) columns.push_back(&each);
  }
  std::stable_partition(columns.begin(), columns.end(),
                        [](const Metric* each) { return !each->is_count(); });
  return columns;
}

ScopedMetric::ScopedMetric(const Metric& metric) {
  registered(ResultKind::kCaptures).push_back(metric);
}
ScopedMetric::~ScopedMetric() { registered(ResultKind::kCaptures).pop_back(); }

}  // namespace simbench::evaluation
