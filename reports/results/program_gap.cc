#include <fmt/format.h>

#include <string>
#include <vector>

#include "evaluation/run/leaderboard.h"
#include "evaluation/scoring/metrics.h"
#include "reports/results/results_document.h"
#include "reports/text/metric_text.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::Metric;
using evaluation::Results;
using evaluation::Row;

struct Compared {
  const Metric* metric;
  const char* heading;
};

std::vector<Compared> compared_metrics(evaluation::ResultKind kind) {
  if (kind == evaluation::ResultKind::kClockRuns) {
    return {{&evaluation::metric("clock_spread_ms", kind), "spread"},
            {&evaluation::metric("rms_te_ms", kind), "RMS TE"}};
  }
  return {{&evaluation::metric("amd_ms"), "AMD"},
          {&evaluation::metric("host_error_ms"), "host error"}};
}

std::string ratio_text(const Metric& metric, const Row& program, const Row& model) {
  const double ratio =
      evaluation::paired_ratio(metric.series(program), metric.series(model)).median;
  return number_text(ratio);
}

}  // namespace

std::optional<Block> program_gap_block(const Results& results) {
  const std::vector<Compared> compared = compared_metrics(results.kind);
  std::vector<Column> columns = {{"program", Align::kLeft}, {"model", Align::kLeft}};
  for (const Compared& each : compared) {
    columns.push_back({fmt::format("{}\nprogram", each.heading)});
    columns.push_back({fmt::format("{}\nmodel", each.heading)});
    columns.push_back({fmt::format("{}\nratio", each.heading)});
  }
  Table table(std::move(columns), 2);
  for (const Row& row : results.rows) {
    const Row* const model = row.model.empty() ? nullptr : find_row(results.rows, row.model);
    if (model == nullptr) continue;
    std::vector<std::string> cells = {row.pipeline, model->pipeline};
    for (const Compared& each : compared) {
      if (!row.program_failures.empty()) {  // it has failed: what other seeds have is no comparison
        cells.insert(cells.end(),
                     {"-", metric_text(*each.metric, each.metric->series(*model).median), "-"});
        continue;
      }
      cells.push_back(metric_text(*each.metric, each.metric->series(row).median));
      cells.push_back(metric_text(*each.metric, each.metric->series(*model).median));
      cells.push_back(ratio_text(*each.metric, row, *model));
    }
    table.add(std::move(cells));
  }
  if (table.rows.empty()) return std::nullopt;
  return Block{.heading = "Programs beside their models",
               .table = std::move(table),
               .prose = {"ratio: the program's value divided by its model's, seed by seed; their "
                         "median."}};
}

}  // namespace simbench::reports
