#include "reports/sweep/sweep_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <numeric>
#include <utility>

#include "evaluation/statistics/statistics.h"

namespace simbench::reports {
namespace {

using evaluation::ResponseRow;
using evaluation::SweepPlan;

constexpr double kLogFromRatio = 50;  // of the largest value to the smallest
constexpr std::size_t kMostCurves = 24;

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
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || stop != text.data() + text.size()) {
      x.categories = axis.values.front();
      x.at.resize(axis.steps());
      std::iota(x.at.begin(), x.at.end(), 0.0);
      x.label += " (in the order given)";
      return x;
    }
    x.at.push_back(value);
  }
  return x;
}

// "tick_ms" of "/hosts/clock/tick_ms": a legend has little room.
std::string last_key(const std::string& pointer) { return pointer.substr(pointer.rfind('/') + 1); }

// What tells the curves of a panel apart: the pipeline, and where the other axes stand.
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

using Metric = std::function<double(const ResponseRow&)>;

void use_log_scale_if_wide(FigurePanel& panel) {
  double low = INFINITY;
  double high = 0;
  for (const FigureSeries& series : panel.series) {
    for (const double y : series.y) {
      if (std::isnan(y)) continue;
      low = std::min(low, y);
      high = std::max(high, y);
    }
  }
  panel.log_y = low > 0 && high > kLogFromRatio * low;
}

FigurePanel response_panel(const SweepPlan& plan, const std::vector<ResponseRow>& rows,
                           const XAxis& x, const std::string& title, const std::string& y_label,
                           const Metric& metric) {
  std::vector<std::string> labels;  // in the order of the rows
  std::map<std::string, std::map<double, double>> curves;
  for (const ResponseRow& row : rows) {
    const std::string label = curve_label(plan, row);
    if (!curves.contains(label)) labels.push_back(label);
    curves[label][x.at[plan.steps(row.point).front()]] = metric(row);
  }
  FigurePanel panel = {.title = title, .x_label = x.label, .y_label = y_label};
  panel.categories = x.categories;
  for (const std::string& label : labels) {
    if (panel.series.size() == kMostCurves) break;
    FigureSeries series;
    series.label = label;
    series.mark = x.categories.empty() ? Mark::kLine : Mark::kBars;
    for (const auto& [at, value] : curves[label]) {
      series.x.push_back(at);
      series.y.push_back(value);
    }
    series.colour = static_cast<int>(panel.series.size());
    panel.series.push_back(std::move(series));
  }
  return panel;
}

Figure new_figure(const SweepPlan& plan, const std::string& id, const std::string& title) {
  Figure figure;
  figure.id = id;
  figure.title = plan.pipelines.size() > 1
                     ? fmt::format("{}: {}", plan.scenario, title)
                     : fmt::format("{}, {}: {}", plan.scenario, plan.pipelines.front(), title);
  figure.caption = fmt::format("{} points, {} seeds each.", plan.points(), plan.seeds);
  return figure;
}

}  // namespace

Figure response_figure(const SweepPlan& plan, const std::vector<ResponseRow>& rows) {
  Figure figure = new_figure(plan, "sweep", "response");
  if (plan.points() < 2) {
    figure.absent = "one point has no response";
    return figure;
  }
  const XAxis x = x_axis(plan);
  const auto add = [&](const std::string& title, const std::string& y_label, const Metric& metric) {
    figure.panels.push_back(response_panel(plan, rows, x, title, y_label, metric));
  };
  add("AMD", "median AMD, ms", [](const ResponseRow& row) { return row.of("amd_ms").median; });
  use_log_scale_if_wide(figure.panels.back());
  add("Absolute error", "median absolute error, ms",
      [](const ResponseRow& row) { return row.of("absolute_error_ms").median; });
  use_log_scale_if_wide(figure.panels.back());
  add("Recall of the frame sets", "recall, %",
      [](const ResponseRow& row) { return row.recall * 100; });
  add("Margin of gathering", "median margin, ms",
      [](const ResponseRow& row) { return row.of("margin_ms").median; });
  const std::size_t curves = rows.size() / plan.axes.front().steps();
  if (curves > kMostCurves) {
    figure.caption +=
        fmt::format(" Only the first {} of {} curves are drawn.", kMostCurves, curves);
  }
  return figure;
}

Figure host_order_figure(const SweepPlan& plan, const std::vector<ResponseRow>& rows) {
  Figure figure = new_figure(plan, "sweep_host_order", "clock error in the order of the sessions");
  FigurePanel panel = {.title = "Clock error of the slaves",
                       .x_label = "host, in the order of the sessions",
                       .y_label = "median |mean clock error|, ms"};
  for (const ResponseRow& row : rows) {
    if (panel.series.size() == kMostCurves) break;
    FigureSeries series;
    series.mark = Mark::kLine;
    series.label = plan.pipelines[row.pipeline];
    for (const scenarios::Override& value : plan.overrides(row.point)) {
      series.label += fmt::format(", {}={}", last_key(value.pointer), value.value);
    }
    for (std::size_t host = 1; host < row.hosts.size(); ++host) {
      series.x.push_back(static_cast<double>(host));
      series.y.push_back(row.hosts[host].median);
    }
    series.colour = static_cast<int>(panel.series.size());
    panel.series.push_back(std::move(series));
  }
  use_log_scale_if_wide(panel);
  figure.panels.push_back(std::move(panel));
  return figure;
}

Figure seeds_needed_figure(const SweepPlan& plan, const std::vector<ResponseRow>& rows) {
  Figure figure = new_figure(plan, "sweep_seeds_needed", "seeds needed");
  FigurePanel panel = {.title = "95 % interval of the median AMD",
                       .x_label = "seeds",
                       .y_label = "+-, % of the median"};
  for (const ResponseRow& row : rows) {
    if (panel.series.size() == kMostCurves) break;
    FigureSeries series;
    series.label = curve_label(plan, row);
    series.mark = Mark::kLine;
    for (std::size_t seeds = 8; seeds <= plan.seeds; seeds += std::max<std::size_t>(1, seeds / 8)) {
      const auto interval =
          evaluation::median_interval(row.of("amd_ms").values, static_cast<std::int64_t>(seeds));
      series.x.push_back(static_cast<double>(seeds));
      series.y.push_back(interval.relative * 100);
    }
    series.colour = static_cast<int>(panel.series.size());
    panel.series.push_back(std::move(series));
  }
  use_log_scale_if_wide(panel);
  figure.panels.push_back(std::move(panel));
  return figure;
}

}  // namespace simbench::reports
