#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <map>
#include <string_view>
#include <vector>

#include "reports/figures/gnuplot.h"
#include "reports/figures/gnuplot_photographs.h"

namespace simbench::reports {
namespace {

constexpr std::array<const char*, 8> kColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                 "#E69F00", "#56B4E9", "#000000", "#8C6D31"};
constexpr std::array<const char*, 3> kSpanColours = {"#E8E8E8", "#D6E6F2", "#FBEBD3"};
constexpr std::array<int, 4> kPointTypes = {7, 5, 9, 13};

constexpr int kWidth = 900;  // points of the picture; a PDF has 100 of them to the inch
constexpr int kPanelHeight = 250;
constexpr int kTitleHeight = 40;
constexpr double kPointsPerInch = 100;

// A single quote is doubled; a line of gnuplot ends with its line.
std::string in_quotes(std::string_view text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') out += '\'';
    out += c == '\n' || c == '\r' ? ' ' : c;
  }
  return out + '\'';
}

std::string datablock(std::size_t number, const FigureSeries& series) {
  std::string text = fmt::format("$data{} << END\n", number);
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (std::isfinite(series.x[i]) && std::isfinite(series.y[i])) {
      fmt::format_to(std::back_inserter(text), "{} {}\n", series.x[i], series.y[i]);
    } else {
      text += '\n';  // breaks the line
    }
  }
  return text + "END\n";
}

// What the labels of the series of one colour have in common.
std::string common_label(const std::string& a, const std::string& b) {
  if (a == b) return a;
  const auto differ = std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first;
  const std::string common(a.begin(), differ);
  const std::size_t comma = common.rfind(',');
  return comma == std::string::npos ? a + ", ..." : common.substr(0, comma);
}

std::map<int, std::string> legend_of(const FigurePanel& panel) {
  std::map<int, std::string> legend;
  for (const FigureSeries& series : panel.series) {
    const auto [entry, added] = legend.emplace(series.colour, series.label);
    if (!added) entry->second = common_label(entry->second, series.label);
  }
  return legend;
}

std::string style(const FigureSeries& series) {
  const auto number = static_cast<std::size_t>(std::max(series.colour, 0));
  const char* colour = kColours.at(number % kColours.size());
  const std::size_t turn = number / kColours.size();
  const std::size_t dash = turn % 5 + 1;
  switch (series.mark) {
    case Mark::kPoints:
      return fmt::format("with points pt {} ps 0.4 lc rgb '{}'",
                         kPointTypes.at(turn % kPointTypes.size()), colour);
    case Mark::kLine:
      return fmt::format("with lines lw 1.4 dt {} lc rgb '{}'", dash, colour);
    case Mark::kSteps:
      return fmt::format("with steps lw 1.4 dt {} lc rgb '{}'", dash, colour);
    case Mark::kBars:
      return fmt::format("with boxes lc rgb '{}' fs solid 0.75 noborder", colour);
  }
  return "";
}

// Shaded stretches lie behind the data, and stand in the legend.
std::string spans(const FigurePanel& panel, std::vector<std::string>& plots) {
  std::string text;
  for (std::size_t i = 0; i < panel.spans.size(); ++i) {
    const FigureSpan& span = panel.spans[i];
    const char* colour = kSpanColours.at(i % kSpanColours.size());
    fmt::format_to(std::back_inserter(text),
                   "set object rect from {}, graph 0 to {}, graph 1 behind fc rgb '{}' fs solid "
                   "noborder\n",
                   span.from, span.to, colour);
    plots.push_back(fmt::format("keyentry with boxes fs solid noborder lc rgb '{}' title {}",
                                colour, in_quotes(span.label)));
  }
  return text;
}

std::string lines(const FigurePanel& panel, std::vector<std::string>& plots) {
  std::string text;
  for (std::size_t i = 0; i < panel.lines.size(); ++i) {
    const FigureLine& line = panel.lines[i];
    const std::string look = fmt::format("lw 1.2 dt {} lc rgb '#555555'", 2 + i % 4);
    const std::string ends =
        line.vertical ? fmt::format("from {0}, graph 0 to {0}, graph 1", line.at)
                      : fmt::format("from graph 0, first {0} to graph 1, first {0}", line.at);
    fmt::format_to(std::back_inserter(text), "set arrow {} nohead {}\n", ends, look);
    plots.push_back(fmt::format("keyentry with lines {} title {}", look, in_quotes(line.label)));
  }
  return text;
}

// The lines and points of all series lie within the axes; so do the lines across the panel.
std::string ranges(const FigurePanel& panel) {
  double least = std::numeric_limits<double>::infinity();
  double greatest = -least;
  const auto cover = [&](double y) {
    if (!std::isfinite(y) || (panel.log_y && y <= 0)) return;
    least = std::min(least, y);
    greatest = std::max(greatest, y);
  };
  for (const FigureSeries& series : panel.series) {
    for (const double y : series.y) cover(y);
    if (series.mark == Mark::kBars) cover(0);
  }
  for (const FigureLine& line : panel.lines) {
    if (!line.vertical) cover(line.at);
  }
  if (least > greatest) return panel.log_y ? "set yrange [0.1:1]\n" : "set yrange [0:1]\n";
  if (panel.log_y) return fmt::format("set yrange [{}:{}]\n", least / 1.3, greatest * 1.3);
  // A constant gets a range in which its last digits would not be drawn as a mountain.
  const double room = std::max({(greatest - least) * 0.06, std::abs(greatest) * 1e-6, 1e-6});
  return fmt::format("set yrange [{}:{}]\n", least - room, greatest + room);
}

std::string categories(const FigurePanel& panel) {
  if (panel.categories.empty()) return "";
  std::string tics;
  for (std::size_t i = 0; i < panel.categories.size(); ++i) {
    fmt::format_to(std::back_inserter(tics), "{}{} {}", i == 0 ? "" : ", ",
                   in_quotes(panel.categories[i]), i);
  }
  return fmt::format(
      "set xtics ({}) rotate by -20\nset xrange [-0.6:{}]\nset boxwidth 0.7\nset xzeroaxis lt -1\n",
      tics, static_cast<double>(panel.categories.size()) - 0.4);
}

std::string panel_script(const FigurePanel& panel, std::size_t& datablocks) {
  std::string script = "unset object\nunset arrow\nset autoscale x\nset xtics norotate autofreq\n";
  fmt::format_to(std::back_inserter(script), "set title {}\nset xlabel {}\nset ylabel {}\n",
                 in_quotes(panel.title), in_quotes(panel.x_label), in_quotes(panel.y_label));
  script += panel.log_y ? "set logscale y\n" : "unset logscale y\n";
  script += ranges(panel) + categories(panel);
  std::map<int, std::string> legend = legend_of(panel);
  const bool has_legend = panel.series.size() > 1 || !panel.lines.empty() || !panel.spans.empty();
  std::vector<std::string> plots;
  for (const FigureSeries& series : panel.series) {
    script += datablock(datablocks, series);
    const auto entry = legend.extract(series.colour);  // titles its first series alone
    const std::string title =
        entry.empty() || !has_legend ? "notitle" : "title " + in_quotes(entry.mapped());
    plots.push_back(fmt::format("$data{} using 1:2 {} {}", datablocks, style(series), title));
    ++datablocks;
  }
  if (plots.empty()) plots.emplace_back("NaN notitle");
  script += lines(panel, plots);
  script += spans(panel, plots);
  return script + fmt::format("plot {}\n", fmt::join(plots, ", \\\n     "));
}

std::string terminal(PlotFormat format, int height) {
  if (format == PlotFormat::kSvg) {
    return fmt::format(
        "set terminal svg noenhanced size {},{} font 'Helvetica,Arial,sans-serif,12' "
        "background '#ffffff'\n",
        kWidth, height);
  }
  return fmt::format("set terminal pdfcairo noenhanced size {}in,{}in font 'Helvetica,9'\n",
                     kWidth / kPointsPerInch, height / kPointsPerInch);
}

}  // namespace

std::string gnuplot_script(const Figure& figure, PlotFormat format, const std::string& output) {
  const bool is_photographs = figure.panels.empty();
  const int height =
      kTitleHeight + (is_photographs ? photographs_height(figure)
                                     : kPanelHeight * static_cast<int>(figure.panels.size()));
  std::string script = "set encoding utf8\n" + terminal(format, height);
  fmt::format_to(std::back_inserter(script), "set output {}\n", in_quotes(output));
  const std::string title = figure.paper.empty()
                                ? figure.title
                                : fmt::format("{} ({} of the paper)", figure.title, figure.paper);
  if (is_photographs) return script + photographs_script(figure, in_quotes(title));
  script +=
      "set key outside right top Left reverse samplen 1.5 spacing 1.1\n"
      "set border 3\nset tics nomirror out\nset grid ytics lc rgb '#DDDDDD' lt 1\n";
  fmt::format_to(std::back_inserter(script), "set multiplot layout {},1 title {} font ',14'\n",
                 figure.panels.size(), in_quotes(title));
  std::size_t datablocks = 0;
  for (const FigurePanel& panel : figure.panels) script += panel_script(panel, datablocks);
  return script + "unset multiplot\nset output\n";
}

}  // namespace simbench::reports
