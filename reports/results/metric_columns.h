// What tables and figures show of the metrics (evaluation/scoring/metrics.h): in which tables each
// stands and at which place, its headings, its legend. A metric without an entry is in no table.
//
//   for (const evaluation::Metric* metric : table_metrics(&TablePlaces::truth)) {
//     use(column_of(*metric).heading, metric->value(row));
//   }
#pragma once

#include <vector>

#include "evaluation/scoring/metrics.h"

namespace simbench::reports {

// The metric's place, from 1, among the columns or panels of each report; 0: it is not shown.
struct TablePlaces {
  int summary = 0;         // the few of the first table
  int paper = 0;           // the paper's metrics
  int truth = 0;           // metrics that need true time
  int time_errors = 0;     // the hosts' time errors
  int alignment = 0;       // exposures that are steered
  int colour = 0;          // depth against colour
  int certificates = 0;    // beside AMD, where captures are certified
  int sessions = 0;        // sessions of Algorithms 1 and 2
  int sets = 0;            // gathered sets
  int clocks = 0;          // runs of the hosts' clocks
  int response = 0;        // the table of a sweep
  int response_panel = 0;  // the figure of a sweep
};

// "\n" breaks a heading.
struct MetricColumn {
  const char* id = "";  // the metric's
  TablePlaces tables{};
  const char* heading = "";
  const char* band_heading = nullptr;  // without one, the median stands alone
  const char* legend = "";
  bool legend_continues = false;  // on the line of the metric before it
};

MetricColumn column_of(const evaluation::Metric& metric,
                       evaluation::ResultKind kind = evaluation::ResultKind::kCaptures);

// The columns of a table, in their order.
std::vector<const evaluation::Metric*> table_metrics(
    int TablePlaces::*table, evaluation::ResultKind kind = evaluation::ResultKind::kCaptures);

// Adds a column of captures at the end during its lifetime. For tests; not while others use
// columns.
class ScopedMetricColumn {
 public:
  explicit ScopedMetricColumn(const MetricColumn& column);
  ~ScopedMetricColumn();
  ScopedMetricColumn(const ScopedMetricColumn&) = delete;
  ScopedMetricColumn& operator=(const ScopedMetricColumn&) = delete;
};

}  // namespace simbench::reports
