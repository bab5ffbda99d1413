#include "reports/sweep/sweep_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "evaluation/statistics/statistics.h"
#include "recording/number_in.h"
#include "recording/text_fields.h"
#include "recording/version.h"
#include "reports/archive/archive.h"
#include "reports/figures/figure_parts.h"
#include "reports/results/csv.h"
#include "reports/results/json.h"
#include "reports/results/metric_columns.h"
#include "reports/sweep/sweep_parts.h"
#include "reports/text/json_node.h"
#include "reports/text/metric_text.h"
#include "reports/text/number_text.h"
#include "reports/text/time_text.h"

namespace simbench::reports {
namespace {

using evaluation::Metric;
using evaluation::ResponseRow;
using evaluation::SweepPlan;
using evaluation::SweepRun;
using evaluation::SweepScore;

// The columns that identify the run.
std::string run_header(const SweepPlan& plan) {
  std::string header;
  for (const std::string& pointer : plan.pointers()) header.append(csv_cell(pointer)).append(",");
  return header + "pipeline,seed";
}

std::string run_cells(const SweepPlan& plan, const SweepRun& run) {
  std::string cells;
  for (const std::string& value : plan.values(run.point)) cells.append(csv_cell(value)).append(",");
  return cells + fmt::format("{},{}", csv_cell(plan.pipelines[run.pipeline]), run.seed);
}

// A value of an axis: a number where it is one, else a word.
Json value_of(const std::string& text) {
  Json value = Json::parse(text, nullptr, false);
  return value.is_discarded() ? Json(text) : value;
}

constexpr std::array<std::int64_t, 8> kSeedCounts = {8, 16, 32, 64, 128, 256, 512, 1024};
constexpr std::array<double, 4> kWanted = {0.20, 0.10, 0.05, 0.02};

bool is_of_single_camera(const ResponseRow& row) {
  return row.kind == evaluation::ResultKind::kCaptures && row.of("complete_pulses").median > 0 &&
         evaluation::count_of_existing(row.of("amd_ms").values) == 0;
}

// The seeds behind the medians of a point.
ScoredSeeds scored_seeds_at(const ResponseRow& row, const std::vector<const Metric*>& metrics) {
  ScoredSeeds seeds{.all = row.series.front().values.size()};
  for (const Metric* metric : metrics) {
    if (metric->is_series()) {
      seeds.add(evaluation::count_of_existing(row.of(metric->sweep).values));
    }
  }
  return seeds;
}

std::string percent_text(double share) {
  return std::isnan(share) ? "-" : fmt::format("{:.1f} %", share * 100);
}

std::string response_legend(const SweepPlan& plan, const std::vector<const Metric*>& metrics) {
  if (!of_clocks(plan)) {
    return "Medians over the seeds; precision and recall over all of them. Margin: the gathering "
           "interval less the 99.9 % quantile of a seed's spreads.";
  }
  std::string text = fmt::format("Medians over the seeds, measured from {} to {} s.",
                                 plan.clock_period.from_s, plan.clock_period.duration_s);
  for (const Metric* metric : metrics) {
    const char* const legend = column_of(*metric, plan.kind).legend;
    if (*legend != '\0') text.append(" ").append(legend);
  }
  if (text.back() == ';') text.back() = '.';
  return text;
}

// The place of each step of the first axis on x.
struct XAxis {
  std::string label;
  std::vector<double> at;                 // by step
  std::vector<std::string> categories{};  // if they are words
};

XAxis x_axis(const SweepPlan& plan) {
  const evaluation::SweepAxis& axis = plan.axes.front();
  XAxis x;
  x.label = axis.pointers.front();
  for (const std::string& text : axis.values.front()) {
    const std::optional<double> value = number_in<double>(text);
    if (!value) {
      x.categories = axis.values.front();
      x.at.resize(axis.steps());
      std::iota(x.at.begin(), x.at.end(), 0.0);
      x.label += " (in the order given)";
      return x;
    }
    x.at.push_back(*value);
  }
  return x;
}

// "tick_ms" of "/hosts/clock/tick_ms": a legend has little room.
std::string last_key(const std::string& pointer) { return pointer.substr(pointer.rfind('/') + 1); }

// The label of a curve: the pipeline, and the steps of the other axes.
std::string curve_label(const SweepPlan& plan, const ResponseRow& row) {
  std::string label =
      plan.pipelines.size() > 1 || plan.axes.size() < 2 ? plan.pipelines[row.pipeline] : "";
  const std::vector<std::size_t> steps = plan.steps(row.point);
  for (std::size_t axis = 1; axis < plan.axes.size(); ++axis) {
    if (!label.empty()) label += ", ";
    label += fmt::format("{}={}", last_key(plan.axes[axis].pointers.front()),
                         plan.axes[axis].values.front()[steps[axis]]);
  }
  return label;
}

std::string axis_label(const SweepPlan& plan, const Metric& metric) {
  if (metric.is_share()) return fmt::format("{}, %", metric.title);
  // Names of clock metrics are longer than an axis; the panel's title has them.
  if (of_clocks(plan)) return fmt::format("median [5-95 %], {}", metric.unit);
  return fmt::format("median {} [5-95 %], {}", metric.title, metric.unit);
}

// A point of a curve, with its band; shares are of all seeds together.
void add_response(const ResponseRow& row, const Metric& metric, double at, FigureSeries& series) {
  series.add(at, shown_value(metric, row.value(metric)));
  if (metric.is_share()) return;
  series.low.push_back(shown_value(metric, row.of(metric.sweep).p05));
  series.high.push_back(shown_value(metric, row.of(metric.sweep).p95));
}

// The points of several curves in one category, in order from the left.
void set_side_by_side(FigurePanel& panel) {
  constexpr double kShare = 0.7;  // of the room of a category
  const double step = kShare / static_cast<double>(panel.series.size());
  double shift = (step - kShare) / 2;
  for (FigureSeries& series : panel.series) {
    for (double& x : series.x) x += shift;
    shift += step;
  }
}

FigurePanel response_panel(const SweepPlan& plan, const std::vector<ResponseRow>& rows,
                           const XAxis& x, const Metric& metric) {
  std::vector<std::string> labels;  // in the order of the rows
  std::map<std::string, std::map<double, const ResponseRow*>> curves;
  for (const ResponseRow& row : rows) {
    const std::string label = curve_label(plan, row);
    if (!curves.contains(label)) labels.push_back(label);
    curves[label][x.at[plan.steps(row.point).front()]] = &row;
  }
  FigurePanel panel = {
      .title = capitalised(metric.title), .x_label = x.label, .y_label = axis_label(plan, metric)};
  panel.categories = x.categories;
  for (const std::string& label : labels) {
    FigureSeries* series =
        add_curve(panel, label, x.categories.empty() ? Mark::kMarkedLine : Mark::kPoints);
    if (series == nullptr) break;
    for (const auto& [at, row] : curves[label]) add_response(*row, metric, at, *series);
  }
  if (!x.categories.empty()) set_side_by_side(panel);
  return panel;
}

}  // namespace

std::string sweep_manifest(const SweepPlan& plan, const std::string& study) {
  Json axes = Json::array();
  for (const evaluation::SweepAxis& axis : plan.axes) {
    Json pointers = Json::object();
    for (std::size_t i = 0; i < axis.pointers.size(); ++i) {
      Json& values = pointers[axis.pointers[i]] = Json::array();
      for (const std::string& value : axis.values[i]) values.push_back(value_of(value));
    }
    axes.push_back(std::move(pointers));
  }
  Json manifest = {{"schema_version", 1},
                   {"program", "simbench"},
                   {"kind", "sweep"},
                   {"version", version()},
                   {"commit", commit()}};
  if (!study.empty()) manifest["study"] = study;
  if (of_clocks(plan)) {
    manifest["results"] = kClockRunsName;
    manifest["from_s"] = plan.clock_period.from_s;
    manifest["duration_s"] = plan.clock_period.duration_s;
  }
  manifest["axes"] = std::move(axes);
  manifest["pipelines"] = plan.pipelines;
  manifest["seeds"] = {{"first", plan.first_seed}, {"count", plan.seeds}};
  state_derivation(plan.derivation, manifest);
  manifest["scenario"] = Json::parse(plan.scenario_json);
  return file_text(manifest);
}

std::string sweep_csv(const SweepPlan& plan, const std::vector<SweepScore>& scores) {
  std::string csv = run_header(plan);
  for (const evaluation::Metric* metric : evaluation::sweep_metrics(plan.kind)) {
    csv.append(",").append(metric->sweep);
  }
  const bool has_failures =
      std::ranges::any_of(scores, [](const SweepScore& score) { return !score.failed.empty(); });
  if (has_failures) csv += ",failed";
  const LineEnds ends(plan.derivation);
  csv += ends.header;
  for (std::size_t index = 0; index < scores.size(); ++index) {
    csv += run_cells(plan, plan.run(index));
    for (const double value : scores[index].values) csv.append(",").append(csv_cell(value));
    if (has_failures) csv.append(",").append(csv_cell(scores[index].failed));
    csv += ends.line;
  }
  return csv;
}

std::string sweep_hosts_csv(const SweepPlan& plan, const std::vector<SweepScore>& scores) {
  const LineEnds ends(plan.derivation);
  std::string csv = run_header(plan) + ",host,host_error_ms" + ends.header;
  for (std::size_t index = 0; index < scores.size(); ++index) {
    const std::string cells = run_cells(plan, plan.run(index));
    const std::vector<double>& errors = scores[index].host_errors_ms;
    for (std::size_t host = 0; host < errors.size(); ++host) {
      csv += fmt::format("{},{},{}{}", cells, host, csv_cell(errors[host]), ends.line);
    }
  }
  return csv;
}

Block response_block(const SweepPlan& plan, const std::vector<ResponseRow>& rows) {
  const std::vector<const Metric*> metrics = table_metrics(&TablePlaces::response, plan.kind);
  std::vector<Column> columns = point_columns(plan);
  const std::size_t keys = columns.size();
  const bool lack_seeds = std::any_of(rows.begin(), rows.end(), [&](const ResponseRow& row) {
    return scored_seeds_at(row, metrics).lack();
  });
  if (lack_seeds) columns.push_back({"seeds"});
  for (const Metric* metric : metrics) {
    const MetricColumn column = column_of(*metric, plan.kind);
    columns.push_back({column.heading});
    if (metric == metrics.front()) columns.push_back({column.band_heading});
  }
  Table table(std::move(columns), keys);
  for (const ResponseRow& row : rows) {
    std::vector<std::string> cells = point_cells(plan, row);
    if (lack_seeds) cells.push_back(scored_seeds_text(scored_seeds_at(row, metrics)));
    for (const Metric* metric : metrics) {
      cells.push_back(metric_text(*metric, row.value(*metric)));
      if (metric != metrics.front()) continue;
      const evaluation::Series& series = row.of(metric->sweep);
      table.sparklines[cells.size()].push_back(seeds_sparkline(series));
      cells.push_back(interval_text(*metric, series.p05, series.p95));
    }
    table.add(std::move(cells));
  }
  Block block{.heading = sweep_heading(plan),
              .table = std::move(table),
              .prose = {response_legend(plan, metrics)}};
  if (lack_seeds) block.prose.emplace_back(kScoredSeedsLegend);
  if (std::any_of(rows.begin(), rows.end(), is_of_single_camera)) {
    block.prose.emplace_back(kSingleCameraLegend);
  }
  return block;
}

Block host_order_block(const SweepPlan& plan, const std::vector<ResponseRow>& rows) {
  std::size_t hosts = 0;
  for (const ResponseRow& row : rows) hosts = std::max(hosts, row.hosts.size());
  std::vector<Column> columns = point_columns(plan);
  const std::size_t keys = columns.size();
  for (std::size_t host = 1; host < hosts; ++host) columns.push_back({fmt::format("{}", host)});
  Table table(std::move(columns), keys);
  for (const ResponseRow& row : rows) {
    std::vector<std::string> cells = point_cells(plan, row);
    for (std::size_t host = 1; host < hosts; ++host) {
      cells.push_back(host < row.hosts.size() ? time_text(row.hosts[host].median) : "");
    }
    table.add(std::move(cells));
  }
  return {.heading = "Clock error of each slave, in the order of their sessions",
          .table = std::move(table),
          .prose = {"The median over the seeds of a host's |mean clock error| during "
                    "the capture. Host 1 is synchronised first and has run free the longest."}};
}

Block seeds_needed_block(const SweepPlan& plan, const std::vector<ResponseRow>& rows) {
  std::vector<Column> columns = point_columns(plan);
  const std::size_t keys = columns.size();
  columns.push_back({"AMD"});
  std::vector<std::int64_t> counts;
  for (const std::int64_t count : kSeedCounts) {
    if (count <= static_cast<std::int64_t>(plan.seeds)) counts.push_back(count);
  }
  for (const std::int64_t count : counts) {
    columns.push_back({fmt::format("+-\nn = {}", count)});
  }
  for (const double wanted : kWanted) {
    columns.push_back({fmt::format("seeds for\n+-{:.0f} %", wanted * 100)});
  }
  Table table(std::move(columns), keys);
  for (const ResponseRow& row : rows) {
    const std::vector<double>& values = row.of("amd_ms").values;
    std::vector<std::string> cells = point_cells(plan, row);
    cells.push_back(time_text(row.of("amd_ms").median));
    for (const std::int64_t count : counts) {
      cells.push_back(percent_text(evaluation::median_interval(values, count).relative));
    }
    for (const double wanted : kWanted) {
      const std::optional<std::int64_t> seeds = evaluation::seeds_for(values, wanted);
      cells.push_back(seeds ? count_text(*seeds) : "-");
    }
    table.add(std::move(cells));
  }
  return {.heading =
              fmt::format("How far the median AMD of n seeds is from that of all {}", plan.seeds),
          .table = std::move(table),
          .prose = {
              "In 95 % of studies with n seeds the median lies within +- this percentage. The "
              "last columns show the inverse: the seeds needed for a percentage; beyond the seeds "
              "run they use the distribution of these. Differences between pipelines need fewer "
              "seeds: they are paired by seed."}};
}

Figure response_figure(const SweepPlan& plan, const std::vector<ResponseRow>& rows) {
  Figure figure = new_sweep_figure(plan, "sweep", "response");
  if (plan.points() < 2) {
    figure.absent = "a single point has no response";
    return figure;
  }
  const XAxis x = x_axis(plan);
  for (const Metric* metric : table_metrics(&TablePlaces::response_panel, plan.kind)) {
    figure.panels.push_back(response_panel(plan, rows, x, *metric));
    const bool may_be_log = metric->better == evaluation::Better::kLower;
    if (may_be_log) use_log_scale_if_wide(figure.panels.back());
  }
  const std::size_t curves = rows.size() / plan.axes.front().steps();
  if (curves > kMostCurves) {
    figure.caption +=
        fmt::format(" Only the first {} of {} curves are drawn.", kMostCurves, curves);
  }
  return figure;
}

Figure host_order_figure(const SweepPlan& plan, const std::vector<ResponseRow>& rows) {
  Figure figure =
      new_sweep_figure(plan, "sweep_host_order", "clock error in the order of the sessions");
  FigurePanel panel = {.title = "Clock error of the slaves",
                       .x_label = "host, in the order of the sessions",
                       .y_label = "median |mean clock error| [5-95 %], ms"};
  for (const ResponseRow& row : rows) {
    std::string label = plan.pipelines[row.pipeline];
    for (const scenarios::Override& value : plan.overrides(row.point)) {
      label += fmt::format(", {}={}", last_key(value.pointer), value.value);
    }
    FigureSeries* series = add_curve(panel, label, Mark::kMarkedLine);
    if (series == nullptr) break;
    for (std::size_t host = 1; host < row.hosts.size(); ++host) {
      series->add(static_cast<double>(host), row.hosts[host].median, row.hosts[host].p05,
                  row.hosts[host].p95);
    }
  }
  use_log_scale_if_wide(panel);
  figure.panels = {std::move(panel)};
  return figure;
}

Figure seeds_needed_figure(const SweepPlan& plan, const std::vector<ResponseRow>& rows) {
  Figure figure = new_sweep_figure(plan, "sweep_seeds_needed", "seeds needed");
  FigurePanel panel = {.title = "95 % interval of the median AMD",
                       .x_label = "seeds",
                       .y_label = "+-, % of the median"};
  for (const ResponseRow& row : rows) {
    FigureSeries* series = add_curve(panel, curve_label(plan, row), Mark::kMarkedLine);
    if (series == nullptr) break;
    for (std::size_t seeds = 8; seeds <= plan.seeds; seeds += std::max<std::size_t>(1, seeds / 8)) {
      const auto interval =
          evaluation::median_interval(row.of("amd_ms").values, static_cast<std::int64_t>(seeds));
      series->add(static_cast<double>(seeds), interval.relative * 100);
    }
  }
  use_log_scale_if_wide(panel);
  figure.panels = {std::move(panel)};
  return figure;
}

}  // namespace simbench::reports
