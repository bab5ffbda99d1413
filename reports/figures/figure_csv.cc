#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "evaluation/statistics/statistics.h"
#include "reports/figures/figure.h"
#include "reports/results/csv.h"

namespace simbench::reports {
namespace {

std::string figure_line(std::string_view panel, std::string_view series, const std::string& x,
                        double y) {
  return fmt::format("{},{},{},{}\n", csv_cell(panel), csv_cell(series), x, csv_cell(y));
}

std::string curve_lines(const FigurePanel& panel, const FigureSeries& series,
                        const std::string& label, const std::vector<double>& y) {
  std::string text;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    const std::string x =
        panel.categories.empty()
            ? csv_cell(series.x[i])
            : csv_cell(panel.categories.at(static_cast<std::size_t>(std::llround(series.x[i]))));
    text += figure_line(panel.title, label, x, y[i]);
  }
  return text;
}

std::string panel_lines(const FigurePanel& panel) {
  std::string text;
  for (const FigureSeries& series : panel.series) {
    text += curve_lines(panel, series, series.label, series.y);
    if (series.low.empty()) continue;
    text += curve_lines(panel, series, series.label + ", 5 %", series.low);
    text += curve_lines(panel, series, series.label + ", 95 %", series.high);
  }
  for (const FigureLine& drawn : panel.lines) {
    text += figure_line(panel.title, drawn.label, drawn.vertical ? csv_cell(drawn.at) : "",
                        drawn.vertical ? evaluation::kNan : drawn.at);
  }
  for (const FigureSpan& span : panel.spans) {
    for (const double end : {span.from, span.to}) {
      text += figure_line(panel.title, span.label, csv_cell(end), evaluation::kNan);
    }
  }
  return text;
}

}  // namespace

std::string figure_csv(const Figure& figure) {
  std::string text = "panel,series,x,y\n";
  for (const FigurePanel& panel : figure.panels) text += panel_lines(panel);
  for (const PhotographRow& row : figure.photographs) {
    for (const Photograph& photograph : row.photographs) {
      for (const PhotographedReading& reading : photograph.readings) {
        text += figure_line(row.label, photograph.label, csv_cell(reading.text), reading.share);
      }
    }
  }
  return text;
}

}  // namespace simbench::reports
