#include "reports/results/program_gap.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "evaluation/run/leaderboard.h"
#include "evaluation/scoring/metrics.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::Metric;
using evaluation::Results;
using evaluation::Row;

std::vector<const Metric*> compared_metrics(evaluation::ResultKind kind) {
  if (kind == evaluation::ResultKind::kClockRuns) {
    return {&evaluation::metric("clock_spread_ms", kind), &evaluation::metric("rms_te_ms", kind)};
  }
  return {&evaluation::metric("amd_ms"), &evaluation::metric("host_error_ms")};
}

std::string ratio_text(const Metric& metric, const Row& program, const Row& model) {
  const double ratio =
      evaluation::paired_ratio(metric.series(program), metric.series(model)).median;
  return fmt::format("{} ({:+.0f} %)", number_text(ratio), 100 * (ratio - 1));
}

}  // namespace

std::optional<Block> program_gap_block(const Results& results) {
  const std::vector<const Metric*> metrics = compared_metrics(results.kind);
  std::vector<Column> columns = {{"program", Align::kLeft}, {"model", Align::kLeft}};
  for (const Metric* metric : metrics) {
    for (const char* what : {"program", "model", "ratio"}) {
      columns.push_back({fmt::format("{}\n{}", metric->title, what)});
    }
  }
  Table table(std::move(columns), 2);
  for (const Row& row : results.rows) {
    const Row* const model = row.model.empty() ? nullptr : find_row(results.rows, row.model);
    if (model == nullptr) continue;
    std::vector<std::string> cells = {row.pipeline, model->pipeline};
    for (const Metric* metric : metrics) {
      cells.push_back(number_text(metric->series(row).median));
      cells.push_back(number_text(metric->series(*model).median));
      cells.push_back(ratio_text(*metric, row, *model));
    }
    table.add(std::move(cells));
  }
  if (table.rows.empty()) return std::nullopt;
  return Block{.heading = "Programs beside their models, in ms; the ratio is the program's value "
                          "divided by the model's, seed by seed, its median",
               .table = std::move(table)};
}

}  // namespace simbench::reports
