#include "evaluation/statistics/paired_metrics.h"

#include <cmath>

#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

constexpr double kMicrosecondMs = 0.001;  // the last digit of the tables
constexpr double kRecallStep = 0.001;

}  // namespace

const std::array<PairedMetric, kPairedMetrics>& paired_metrics() {
  static constexpr std::array<PairedMetric, kPairedMetrics> kMetrics = {{
      {"amd_ms",
       "AMD",
       "ms",
       false,
       kMicrosecondMs,
       {.relative = 0.02, .absolute = kMicrosecondMs},
       [](const Row& row) -> const Series& { return row.amd_ms; }},
      {"rmdv_ms",
       "RMDV",
       "ms",
       false,
       kMicrosecondMs,
       {.relative = 0.02, .absolute = kMicrosecondMs},
       [](const Row& row) -> const Series& { return row.rmdv_ms; }},
      {"absolute_error_ms",
       "absolute error",
       "ms",
       false,
       kMicrosecondMs,
       {.relative = 0.02, .absolute = kMicrosecondMs},
       [](const Row& row) -> const Series& { return row.absolute_error_ms; }},
      {"seed_recall",
       "recall",
       "",
       true,
       kRecallStep,
       {.relative = 0.01, .absolute = 0.005},
       [](const Row& row) -> const Series& { return row.seed_recall; }},
  }};
  return kMetrics;
}

double PairedMetric::table_value(const std::vector<double>& values) const {
  return higher_is_better ? mean_of_existing(values) : median(values);
}

}  // namespace simbench::evaluation
