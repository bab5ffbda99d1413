#include "reports/sweep/sweep_parts.h"

#include <fmt/format.h>

#include <algorithm>

#include "reports/figures/figure_parts.h"

namespace simbench::reports {

using evaluation::ResponseRow;
using evaluation::SweepPlan;

namespace {

// "/hosts/clock/tick_ms" on three lines: columns of numbers are narrow.
std::string header_of(const std::string& pointer) {
  std::string header;
  for (const char c : pointer) {
    if (c == '/' && !header.empty()) header += '\n';
    header += c;
  }
  return header;
}

}  // namespace

std::string sweep_heading(const SweepPlan& plan) {
  return fmt::format("{}: {}, {}, {}{}", scenarios::named(plan.scenario, plan.derivation),
                     counted(plan.points(), "point"), counted(plan.pipelines.size(), "pipeline"),
                     counted(plan.seeds, "seed"),
                     of_clocks(plan) ? ", the hosts' clocks alone" : "");
}

std::vector<Column> value_columns(const SweepPlan& plan) {
  std::vector<Column> columns;
  for (const std::string& pointer : plan.pointers()) columns.push_back({header_of(pointer)});
  return columns;
}

std::vector<Column> point_columns(const SweepPlan& plan) {
  std::vector<Column> columns = value_columns(plan);
  columns.push_back({"pipeline", Align::kLeft});
  return columns;
}

std::vector<std::string> point_cells(const SweepPlan& plan, const ResponseRow& row) {
  std::vector<std::string> cells = plan.values(row.point);
  cells.push_back(plan.pipelines[row.pipeline]);
  return cells;
}

Figure new_sweep_figure(const SweepPlan& plan, const std::string& id, const std::string& title) {
  Figure figure;
  figure.id = id;
  figure.title = plan.pipelines.size() > 1
                     ? fmt::format("{}: {}", plan.scenario, title)
                     : fmt::format("{}, {}: {}", plan.scenario, plan.pipelines.front(), title);
  figure.source = {.scenario = plan.scenario,
                   .derivation = plan.derivation,
                   .pipeline = plan.pipelines.size() == 1 ? plan.pipelines.front() : "",
                   .first_seed = plan.first_seed,
                   .seeds = plan.seeds};
  figure.caption =
      fmt::format("{}, {} each.", counted(plan.points(), "point"), counted(plan.seeds, "seed"));
  return figure;
}

FigureSeries* add_curve(FigurePanel& panel, const std::string& label, Mark mark) {
  if (panel.series.size() == kMostCurves) return nullptr;
  const int colour = static_cast<int>(panel.series.size());
  return &panel.series.emplace_back(FigureSeries{.label = label, .mark = mark, .colour = colour});
}

void use_log_scale_if_wide(FigurePanel& panel) {
  const auto is_above_zero = [](const std::vector<double>& values) {
    return std::none_of(values.begin(), values.end(), [](double value) { return value <= 0; });
  };
  const bool are_above_zero =
      std::all_of(panel.series.begin(), panel.series.end(), [&](const FigureSeries& series) {
        return is_above_zero(series.y) && is_above_zero(series.low);
      });
  panel.log_y = are_above_zero && is_wide(panel);
}

}  // namespace simbench::reports
