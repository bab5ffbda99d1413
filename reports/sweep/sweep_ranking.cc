#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>

#include "evaluation/scoring/metrics.h"
#include "evaluation/sweep/ranking.h"
#include "evaluation/sweep/sweep_standing.h"
#include "reports/figures/figure_parts.h"
#include "reports/results/ground_truth_text.h"
#include "reports/results/metric_columns.h"
#include "reports/sweep/sweep_parts.h"
#include "reports/sweep/sweep_report.h"
#include "reports/text/metric_text.h"

namespace simbench::reports {
namespace {

using evaluation::Metric;
using evaluation::RankedPoint;
using evaluation::Ranking;
using evaluation::RankingFlip;
using evaluation::ResponseRow;
using evaluation::SweepPlan;

// "two_way_hull < chrony ~ ntp".
std::string order_text(const SweepPlan& plan, const RankedPoint& point) {
  std::string text = plan.pipelines[point.order.front()];
  for (std::size_t i = 1; i < point.order.size(); ++i) {
    text.append(point.is_apart[i - 1] ? " < " : " ~ ").append(plan.pipelines[point.order[i]]);
  }
  return text;
}

// The rows of a pipeline in order of the packets.
std::vector<const ResponseRow*> by_packets(const std::vector<ResponseRow>& rows,
                                           std::size_t pipeline) {
  std::vector<const ResponseRow*> own;
  for (const ResponseRow& row : rows) {
    if (row.pipeline == pipeline) own.push_back(&row);
  }
  std::ranges::stable_sort(own, {},
                           [](const ResponseRow* row) { return row->of("packets_per_s").median; });
  return own;
}

}  // namespace

std::string leading_text(const SweepPlan& plan, std::size_t point) {
  std::vector<std::string> texts;
  for (const scenarios::Override& value : plan.overrides(point)) {
    const bool leads = std::ranges::any_of(plan.axes, [&value](const evaluation::SweepAxis& axis) {
      return axis.pointers.front() == value.pointer;
    });
    if (leads) texts.push_back(fmt::format("{}={}", value.pointer, value.value));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::string flip_text(const SweepPlan& plan, const RankingFlip& flip) {
  return fmt::format("{} is better than {} up to {}, worse from {} on.",
                     plan.pipelines[flip.before], plan.pipelines[flip.after],
                     leading_text(plan, flip.last), leading_text(plan, flip.first));
}

Block ranking_block(const SweepPlan& plan, const std::vector<ResponseRow>& rows) {
  const evaluation::RankedBy by = evaluation::ranking_of(plan, rows);
  const Metric& metric = evaluation::ranked_metric(by);
  const Ranking ranking = evaluation::rank(plan, evaluation::without_failed(rows, by), metric);
  std::vector<Column> columns = value_columns(plan);
  const std::size_t keys = columns.size();
  columns.push_back({"best first", Align::kLeft});
  Table table(std::move(columns), keys);
  for (const RankedPoint& point : ranking.points) {
    std::vector<std::string> cells = plan.values(point.point);
    cells.push_back(order_text(plan, point));
    table.add(std::move(cells));
  }
  Block block{
      .heading = fmt::format("The order by {}", metric.title),
      .table = std::move(table),
      .prose = {"a < b: a is better than b; a ~ b: their differences, paired by seed, may be "
                "chance (t-tests of logarithms, 5 % for all pairs and points together)."}};
  if (plan.draws_load) block.prose.push_back(fmt::format("But {}.", kOwnLoad));
  if (ranking.flips.empty()) {
    block.prose.emplace_back("No two pipelines change places within these values.");
  }
  for (const RankingFlip& flip : ranking.flips) block.prose.push_back(flip_text(plan, flip));
  return block;
}

Block packets_block(const SweepPlan& plan, const std::vector<ResponseRow>& rows) {
  const Metric& metric = evaluation::ranked_metric(evaluation::ranking_of(plan, rows));
  const MetricColumn column = column_of(metric, plan.kind);
  Table table(
      {{"pipeline", Align::kLeft}, {"packets\nper s"}, {column.heading}, {column.band_heading}}, 1);
  for (std::size_t pipeline = 0; pipeline < plan.pipelines.size(); ++pipeline) {
    std::string last;
    for (const ResponseRow* row : by_packets(rows, pipeline)) {
      const auto& series = row->of(metric.sweep);
      std::vector<std::string> cells = {
          plan.pipelines[pipeline], number_text(row->of("packets_per_s").median),
          metric_text(metric, series.median), interval_text(metric, series.p05, series.p95)};
      // Where a method cannot ask more often, further points repeat it.
      const std::string text = fmt::format("{}", fmt::join(cells, " "));
      if (text != last) table.add(std::move(cells));
      last = text;
    }
  }
  return {.heading = fmt::format("{} over packets per second", capitalised(metric.title)),
          .table = std::move(table),
          .prose = {"Packets per second: of all hosts together. Medians over the seeds."}};
}

Figure packets_figure(const SweepPlan& plan, const std::vector<ResponseRow>& rows) {
  const Metric& metric = evaluation::ranked_metric(evaluation::ranking_of(plan, rows));
  Figure figure = new_sweep_figure(plan, "sweep_packets", "error over packets per second");
  FigurePanel panel = {.title = capitalised(metric.title),
                       .x_label = "packets per second of all hosts together",
                       .y_label = fmt::format("median [5-95 %], {}", metric.unit)};
  for (std::size_t pipeline = 0; pipeline < plan.pipelines.size(); ++pipeline) {
    FigureSeries* series = add_curve(panel, plan.pipelines[pipeline], Mark::kMarkedLine);
    if (series == nullptr) break;
    for (const ResponseRow* row : by_packets(rows, pipeline)) {
      const double packets_per_s = row->of("packets_per_s").median;
      // Nothing sent has no place on a logarithmic axis.
      if (!(packets_per_s > 0)) continue;
      if (!series->x.empty() && series->x.back() == packets_per_s) continue;
      series->add(packets_per_s, row->of(metric.sweep).median, row->of(metric.sweep).p05,
                  row->of(metric.sweep).p95);
    }
    if (series->x.empty()) panel.series.pop_back();
  }
  panel.log_x = true;
  use_log_scale_if_wide(panel);
  figure.panels = {std::move(panel)};
  return figure;
}

}  // namespace simbench::reports
