#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <vector>

#include "evaluation/statistics/statistics.h"
#include "recording/text_fields.h"
#include "reports/figures/figure.h"
#include "reports/results/csv.h"

namespace simbench::reports {
namespace {

using Lines = std::vector<std::string>;

std::string figure_line(std::string_view panel, std::string_view series, const std::string& x,
                        double y) {
  return fmt::format("{},{},{},{}", csv_cell(panel), csv_cell(series), x, csv_cell(y));
}

void add_curve_lines(const FigurePanel& panel, const FigureSeries& series, const std::string& label,
                     const std::vector<double>& y, Lines& lines) {
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    const std::string x =
        panel.categories.empty()
            ? csv_cell(series.x[i])
            : csv_cell(panel.categories.at(static_cast<std::size_t>(std::llround(series.x[i]))));
    lines.push_back(figure_line(panel.title, label, x, y[i]));
  }
}

void add_panel_lines(const FigurePanel& panel, Lines& lines) {
  for (const FigureSeries& series : panel.series) {
    add_curve_lines(panel, series, series.label, series.y, lines);
    if (series.low.empty()) continue;
    add_curve_lines(panel, series, series.label + ", 5 %", series.low, lines);
    add_curve_lines(panel, series, series.label + ", 95 %", series.high, lines);
  }
  for (const FigureLine& drawn : panel.lines) {
    lines.push_back(figure_line(panel.title, drawn.label, drawn.vertical ? csv_cell(drawn.at) : "",
                                drawn.vertical ? evaluation::kNan : drawn.at));
  }
  for (const FigureSpan& span : panel.spans) {
    for (const double end : {span.from, span.to}) {
      lines.push_back(figure_line(panel.title, span.label, csv_cell(end), evaluation::kNan));
    }
  }
}

}  // namespace

std::string figure_csv(const Figure& figure) {
  Lines lines;
  for (const FigurePanel& panel : figure.panels) add_panel_lines(panel, lines);
  for (const PhotographRow& row : figure.photographs) {
    for (const Photograph& photograph : row.photographs) {
      for (const PhotographedReading& reading : photograph.readings) {
        lines.push_back(
            figure_line(row.label, photograph.label, csv_cell(reading.text), reading.share));
      }
    }
  }
  const LineEnds ends(figure.source.derivation);
  std::string text = "panel,series,x,y" + ends.header;
  for (const std::string& line : lines) text += line + ends.line;
  return text;
}

}  // namespace simbench::reports
