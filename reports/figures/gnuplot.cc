#include "reports/figures/gnuplot.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <limits>
#include <map>
#include <string_view>
#include <system_error>
#include <vector>

#include "recording/temporary_folder.h"
#include "recording/text_fields.h"
#include "reports/text/escaped_text.h"
#include "reports/text/output_file.h"
#include "reports/text/plain_text.h"

extern char** environ;

namespace simbench::reports {
namespace {

using SpanColours = std::map<std::string, const char*>;
namespace fs = std::filesystem;

constexpr int kRowHeight = 130;
constexpr std::size_t kReadingsInPhotograph = 3;  // more lines do not fit a photograph
constexpr double kFaintest = 0.35;                // brightness of a reading without a share

// A single quote is doubled; a line of gnuplot ends with its line.
std::string in_quotes(std::string_view text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') out += '\'';
    out += c == '\n' || c == '\r' ? ' ' : c;
  }
  return out + '\'';
}

// Text of the picture.
std::string picture_text(std::string_view text) { return in_quotes(printable_lines(text)); }

std::string label(const std::string& text, double x, double y, const std::string& look) {
  return fmt::format("set label {} at {},{} {}\n", picture_text(text), x, y, look);
}

// White text on black, the fainter the smaller its share.
std::string shade(double share) {
  const auto level = static_cast<int>(
      std::lround(255 * (kFaintest + (1 - kFaintest) * std::clamp(share, 0., 1.))));
  return fmt::format("#{0:02X}{0:02X}{0:02X}", level);
}

// Column `x` from the left, row `y` from the bottom, each one unit large.
std::string photograph_script(const Photograph& photograph, double x, double y) {
  std::string script =
      fmt::format("set object rect from {},{} to {},{} fc rgb '#14181D' fs solid noborder\n",
                  x + 0.03, y + 0.18, x + 0.97, y + 0.84);
  const std::size_t shown = std::min(photograph.readings.size(), kReadingsInPhotograph);
  for (std::size_t i = 0; i < shown; ++i) {
    const PhotographedReading& reading = photograph.readings[i];
    const double line =
        y + 0.51 + 0.2 * (static_cast<double>(shown - 1) / 2 - static_cast<double>(i));
    script +=
        label(reading.text, x + 0.5, line,
              fmt::format("center front font 'monospace,13' tc rgb '{}'", shade(reading.share)));
    if (photograph.readings.size() == 1) continue;
    script += label(fmt::format("{:.0f} %", 100 * reading.share), x + 0.95, line,
                    "right front font ',7' tc rgb '#9AA4AE'");
  }
  if (shown < photograph.readings.size()) {
    script += label(fmt::format("and {} more", photograph.readings.size() - shown), x + 0.5,
                    y + 0.22, "center front font ',7' tc rgb '#9AA4AE'");
  }
  return script + label(photograph.label, x + 0.5, y + 0.09, "center font ',9' tc rgb '#333333'");
}

int photographs_height(const Figure& figure) {
  return kRowHeight * static_cast<int>(figure.photographs.size());
}

constexpr int kSourceHeight = 14;            // of a line below the title
constexpr std::size_t kSourceLetters = 150;  // in such a line

// Below the title: the source of the numbers, in as many lines as it takes.
std::vector<std::string> lines_of_source(const FigureSource& source) {
  std::vector<std::string> lines;
  for (const std::string& text : source_lines(source)) {
    const std::vector<std::string> more = words_in_lines(text, kSourceLetters);
    lines.insert(lines.end(), more.begin(), more.end());
  }
  return lines;
}

int head_height(const Figure& figure) {
  constexpr int kTitleHeight = 40;
  return kTitleHeight + kSourceHeight * static_cast<int>(lines_of_source(figure.source).size());
}

// Title and source at the top of a picture of that height.
std::string head_script(const Figure& figure, int height) {
  const std::string title = figure.paper.empty()
                                ? figure.title
                                : fmt::format("{} ({} of the paper)", figure.title, figure.paper);
  constexpr int kTitleMiddle = 16;
  int y = kTitleMiddle;
  const auto line = [&y, height](const std::string& text, const std::string& look) {
    const double place = 1 - static_cast<double>(y) / height;
    y += kSourceHeight;
    return fmt::format("set label {} at screen 0.5, screen {:.4f} center {}\n", picture_text(text),
                       place, look);
  };
  std::string script = line(title, "font ',14'");
  y += 4;
  for (const std::string& text : lines_of_source(figure.source)) {
    script += line(text, "font ',9' tc rgb '#444444'");
  }
  return script;
}

std::string photographs_script(const Figure& figure, int height) {
  std::size_t columns = 1;
  for (const PhotographRow& row : figure.photographs) {
    columns = std::max(columns, row.photographs.size());
  }
  std::string script = fmt::format(
      "unset border\nunset tics\nunset key\nset lmargin 1\nset rmargin 1\nset bmargin 0\n"
      "set tmargin at screen {:.4f}\nset xrange [0:{}]\nset yrange [0:{}]\n",
      1 - static_cast<double>(head_height(figure)) / height, columns, figure.photographs.size());
  for (std::size_t i = 0; i < figure.photographs.size(); ++i) {
    const PhotographRow& row = figure.photographs[i];
    const auto y = static_cast<double>(figure.photographs.size() - 1 - i);
    script += label(row.label, 0.03, y + 0.92, "left font ',11'");
    for (std::size_t camera = 0; camera < row.photographs.size(); ++camera) {
      script += photograph_script(row.photographs[camera], static_cast<double>(camera), y);
    }
  }
  return script + "plot NaN notitle\nset output\n";
}

constexpr std::array<const char*, 8> kColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                 "#E69F00", "#56B4E9", "#000000", "#8C6D31"};
constexpr std::array<const char*, 3> kSpanColours = {"#E8E8E8", "#D6E6F2", "#FBEBD3"};
constexpr std::array<int, 4> kPointTypes = {7, 5, 9, 13};

constexpr int kWidth = 900;  // points of the picture; a PDF has 100 of them to the inch
constexpr int kPanelHeight = 230;
constexpr int kAxisHeight = 105;  // of a panel: its title and x axis
constexpr int kEntryHeight = 15;  // of a legend
constexpr double kPointsPerInch = 100;
constexpr double kFewTics = 12;  // of whole numbers, none between them

std::string datablock(std::size_t number, const FigureSeries& series) {
  std::string text = fmt::format("$data{} << END\n", number);
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (std::isfinite(series.x[i]) && std::isfinite(series.y[i])) {
      fmt::format_to(std::back_inserter(text), "{} {}", series.x[i], series.y[i]);
      if (!series.low.empty()) {
        fmt::format_to(std::back_inserter(text), " {} {}", series.low[i], series.high[i]);
      }
      text += '\n';
    } else {
      text += '\n';  // breaks the line
    }
  }
  return text + "END\n";
}

// The common part of the labels of the series of one colour.
std::string common_label(const std::string& a, const std::string& b) {
  if (a == b || b.starts_with(a + ",")) return a;
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

std::size_t number_of(const FigureSeries& series) {
  return static_cast<std::size_t>(std::max(series.colour, 0));
}

std::string colour_of(std::size_t number) { return kColours.at(number % kColours.size()); }

// A bar's place beside those of the other series, and its width.
std::string bar_columns(const FigurePanel& panel, const FigureSeries& bar) {
  constexpr double kGroupWidth = 0.7;  // of the room of a category
  std::size_t bars = 0;
  std::size_t place = 0;
  for (const FigureSeries& series : panel.series) {
    if (&series == &bar) place = bars;
    if (series.mark == Mark::kBars) ++bars;
  }
  const double width = kGroupWidth / static_cast<double>(bars);
  const double shift = (static_cast<double>(place) + 0.5) * width - kGroupWidth / 2;
  return fmt::format("($1+({:.4g})):2:({:.4g})", shift, width);
}

// The columns of the data, and how they are drawn.
std::string series_style(const FigurePanel& panel, const FigureSeries& series) {
  const std::string colour = colour_of(number_of(series));
  const std::size_t turn = number_of(series) / kColours.size();
  const std::size_t dash = turn % 5 + 1;
  const int point = kPointTypes.at(turn % kPointTypes.size());
  switch (series.mark) {
    case Mark::kPoints:
      if (!series.low.empty()) {
        return fmt::format("1:2:3:4 with yerrorbars pt {} ps 0.6 lw 1.4 lc rgb '{}'", point,
                           colour);
      }
      return fmt::format("1:2 with points pt {} ps {} lc rgb '{}'", point,
                         panel.categories.empty() ? 0.4 : 0.6, colour);
    case Mark::kLine:
      return fmt::format("1:2 with lines lw 1.4 dt {} lc rgb '{}'", dash, colour);
    case Mark::kMarkedLine:
      return fmt::format("1:2 with linespoints pt {} ps 0.5 lw 1.4 dt {} lc rgb '{}'", point, dash,
                         colour);
    case Mark::kSteps:
      return fmt::format("1:2 with steps lw 1.4 dt {} lc rgb '{}'", dash, colour);
    case Mark::kBars:
      return fmt::format("{} with boxes lc rgb '{}' fs solid 0.75 noborder",
                         bar_columns(panel, series), colour);
  }
  return "";
}

// Colours by the label of a shaded stretch, for all panels of a figure.
SpanColours span_colours(const Figure& figure) {
  SpanColours colours;
  for (const FigurePanel& panel : figure.panels) {
    for (const FigureSpan& span : panel.spans) {
      colours.emplace(span.label, kSpanColours.at(colours.size() % kSpanColours.size()));
    }
  }
  return colours;
}

// Shaded stretches, behind the data and in the legend.
std::string spans(const FigurePanel& panel, const SpanColours& colours,
                  std::vector<std::string>& plots) {
  std::string text;
  for (const FigureSpan& span : panel.spans) {
    const char* colour = colours.at(span.label);
    fmt::format_to(std::back_inserter(text),
                   "set object rect from {}, graph 0 to {}, graph 1 behind fc rgb '{}' fs solid "
                   "noborder\n",
                   span.from, span.to, colour);
    plots.push_back(fmt::format("keyentry with boxes fs solid noborder lc rgb '{}' title {}",
                                colour, picture_text(span.label)));
  }
  return text;
}

std::string line_colour(const FigureLine& line) {
  return line.colour < 0 ? "#555555" : colour_of(static_cast<std::size_t>(line.colour));
}

std::string lines(const FigurePanel& panel, std::vector<std::string>& plots) {
  std::string text;
  for (const FigureLine& line : panel.lines) {
    const std::string look = fmt::format("lw 1.2 dt 3 lc rgb '{}'", line_colour(line));
    const std::string ends =
        line.vertical ? fmt::format("from {0}, graph 0 to {0}, graph 1", line.at)
                      : fmt::format("from graph 0, first {0} to graph 1, first {0}", line.at);
    fmt::format_to(std::back_inserter(text), "set arrow {} nohead {}\n", ends, look);
    plots.push_back(fmt::format("keyentry with lines {} title {}", look, picture_text(line.label)));
  }
  return text;
}

// The smallest and the largest value within an axis.
struct Range {
  double least = std::numeric_limits<double>::infinity();
  double greatest = -std::numeric_limits<double>::infinity();

  void cover(double value) {
    if (!std::isfinite(value)) return;
    least = std::min(least, value);
    greatest = std::max(greatest, value);
  }
  bool empty() const { return least > greatest; }
};

std::string x_range(const FigurePanel& panel) {
  Range range;
  bool all_whole = true;
  for (const FigureSeries& series : panel.series) {
    for (const double x : series.x) {
      if (panel.log_x && x <= 0) continue;
      range.cover(x);
      all_whole = all_whole && x == std::round(x);
    }
  }
  for (const FigureSpan& span : panel.spans) {
    range.cover(span.from);
    range.cover(span.to);
  }
  if (range.empty()) return panel.log_x ? "set xrange [0.1:1]\n" : "set xrange [0:1]\n";
  if (panel.log_x) {
    return fmt::format("set xrange [{}:{}]\nset xtics norotate autofreq\n", range.least / 1.3,
                       range.greatest * 1.3);
  }
  const double room = std::max((range.greatest - range.least) * 0.01, 1e-6);
  return fmt::format("set xrange [{}:{}]\nset xtics norotate {}\n", range.least - room,
                     range.greatest + room,
                     all_whole && range.greatest - range.least < kFewTics ? "1" : "autofreq");
}

std::string y_range(const FigurePanel& panel) {
  Range range;
  const auto cover = [&](double y) {
    if (!panel.log_y || y > 0) range.cover(y);
  };
  for (const FigureSeries& series : panel.series) {
    for (const std::vector<double>* values : {&series.y, &series.low, &series.high}) {
      for (const double y : *values) cover(y);
    }
    if (series.mark == Mark::kBars) cover(0);
  }
  for (const FigureLine& line : panel.lines) {
    if (!line.vertical) cover(line.at);
  }
  if (range.empty()) return panel.log_y ? "set yrange [0.1:1]\n" : "set yrange [0:1]\n";
  if (panel.log_y) {
    return fmt::format("set yrange [{}:{}]\n", range.least / 1.3, range.greatest * 1.3);
  }
  // A constant gets a range that does not magnify its last digits.
  const double room =
      std::max({(range.greatest - range.least) * 0.06, std::abs(range.greatest) * 1e-4, 1e-6});
  return fmt::format("set yrange [{}:{}]\n", range.least - room, range.greatest + room);
}

std::string categories(const FigurePanel& panel) {
  if (panel.categories.empty()) return "";
  std::string tics;
  for (std::size_t i = 0; i < panel.categories.size(); ++i) {
    fmt::format_to(std::back_inserter(tics), "{}{} {}", i == 0 ? "" : ", ",
                   picture_text(panel.categories[i]), i);
  }
  return fmt::format("set xtics ({}) rotate by -20\nset xrange [-0.6:{}]\nset xzeroaxis lt -1\n",
                     tics, static_cast<double>(panel.categories.size()) - 0.4);
}

bool has_legend(const FigurePanel& panel) {
  return panel.series.size() > 1 || !panel.lines.empty() || !panel.spans.empty();
}

std::string panel_script(const FigurePanel& panel, const SpanColours& colours,
                         std::size_t& datablocks) {
  std::string script = "unset object\nunset arrow\n";
  fmt::format_to(
      std::back_inserter(script),
      "set title {} offset 0,-0.5\nset xlabel {} offset 0,0.8\nset ylabel {} offset 1,0\n",
      picture_text(panel.title), picture_text(panel.x_label), picture_text(panel.y_label));
  script += panel.log_x ? "set logscale x\n" : "unset logscale x\n";
  script += panel.log_y ? "set logscale y\n" : "unset logscale y\n";
  script += x_range(panel) + y_range(panel) + categories(panel);
  std::map<int, std::string> legend = legend_of(panel);
  std::vector<std::string> plots;
  for (const FigureSeries& series : panel.series) {
    script += datablock(datablocks, series);
    const auto entry = legend.extract(series.colour);  // titles its first series alone
    const std::string title =
        entry.empty() || !has_legend(panel) ? "notitle" : "title " + picture_text(entry.mapped());
    if (series.mark == Mark::kMarkedLine && !series.low.empty()) {
      plots.push_back(fmt::format(
          "$data{} using 1:3:4 with filledcurves fs transparent solid 0.15 noborder lc rgb '{}' "
          "notitle",
          datablocks, colour_of(number_of(series))));
    }
    plots.push_back(
        fmt::format("$data{} using {} {}", datablocks, series_style(panel, series), title));
    ++datablocks;
  }
  if (plots.empty()) plots.emplace_back("NaN notitle");
  script += lines(panel, plots);
  script += spans(panel, colours, plots);
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

// All panels have one height, with room for the longest legend.
int panels_height(const Figure& figure) {
  std::size_t entries = 0;
  for (const FigurePanel& panel : figure.panels) {
    entries = std::max(entries, legend_of(panel).size() + panel.lines.size() + panel.spans.size());
  }
  const int panel = std::max(kPanelHeight, kAxisHeight + kEntryHeight * static_cast<int>(entries));
  return panel * static_cast<int>(figure.panels.size());
}

// For all panels, so that their axes stand below each other.
bool has_legends(const Figure& figure) {
  return std::any_of(figure.panels.begin(), figure.panels.end(), has_legend);
}

constexpr const char* kAbsent =
    "SVG and PDF are drawn by gnuplot, which is not installed; run `apt-get install gnuplot-nox`, "
    "or name a .csv file";

// Runs gnuplot on a script, with its output in `log`. Returns its exit status.
int run_gnuplot(const fs::path& script, const fs::path& log) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, S_IRUSR | S_IWUSR);
  posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
  std::string program = "gnuplot";
  std::string argument = script.string();
  std::array<char*, 3> arguments = {program.data(), argument.data(), nullptr};
  pid_t child = 0;
  const int failed =
      posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed == ENOENT) throw OutputError(kAbsent);
  if (failed != 0) throw OutputError(fmt::format("gnuplot: {}", std::strerror(failed)));
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw OutputError(fmt::format("gnuplot: {}", std::strerror(errno)));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

std::string gnuplot_script(const Figure& figure, PlotFormat format, const std::string& output) {
  const bool is_photographs = figure.panels.empty();
  const int head = head_height(figure);
  const int height = head + (is_photographs ? photographs_height(figure) : panels_height(figure));
  std::string script = "set encoding utf8\n" + terminal(format, height);
  fmt::format_to(std::back_inserter(script), "set output {}\n", in_quotes(output));
  script += head_script(figure, height);
  if (is_photographs) return script + photographs_script(figure, height);
  script +=
      "set key at screen 0.72, graph 1 left top vertical maxrows 99 Left reverse samplen 1.5 "
      "font ',10'\n"
      "set pointintervalbox 0\nset border 3\nset tics nomirror out scale 0.5\nset grid ytics lc "
      "rgb '#DDDDDD' lt 1\n"
      "set xtics offset 0,0.3\n";
  fmt::format_to(std::back_inserter(script),
                 "set lmargin at screen 0.115\nset rmargin at screen {}\n",
                 has_legends(figure) ? 0.7 : 0.97);
  script += "set multiplot\n";
  std::size_t datablocks = 0;
  const SpanColours colours = span_colours(figure);
  const double share = (1 - static_cast<double>(head) / height) /  // of the picture, for a panel
                       static_cast<double>(figure.panels.size());
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    fmt::format_to(std::back_inserter(script), "set size 1,{:.6f}\nset origin 0,{:.6f}\n", share,
                   share * static_cast<double>(figure.panels.size() - 1 - i));
    script += panel_script(figure.panels[i], colours, datablocks) + "unset label\n";
  }
  return script + "unset multiplot\nset output\n";
}

namespace {

// The SVG with the figure's own title and source, where gnuplot names all alike.
std::string own_titled(const std::string& svg, const Figure& figure) {
  constexpr std::string_view kEnd = "</desc>";
  const std::size_t begin = svg.find("<title>");
  const std::size_t end = svg.find(kEnd);
  if (begin == std::string::npos || end == std::string::npos || end < begin) return svg;
  return svg.substr(0, begin) +
         fmt::format(
             "<title>{}</title>\n<desc>{}</desc>", html_escaped(figure.title),
             html_escaped(fmt::format("{}", fmt::join(source_lines(figure.source), "; ")))) +
         svg.substr(end + kEnd.size());
}

}  // namespace

void draw(const Figure& figure, PlotFormat format, const fs::path& output) {
  OutputFile picture(output.string());
  const OutputFile script(picture.path().string() + ".gnuplot");
  const OutputFile log(picture.path().string() + ".log");
  script.write(gnuplot_script(figure, format, picture.path().string()));
  const int status = run_gnuplot(script.path(), log.path());
  std::error_code error;
  const bool drawn = status == 0 && fs::file_size(picture.path(), error) > 0 && !error;
  if (!drawn) {
    throw OutputError(fmt::format("{}: gnuplot failed (status {}): {}", output.string(), status,
                                  content_of(log.path()).value_or("")));
  }
  if (format == PlotFormat::kSvg) {
    picture.write(own_titled(content_of(picture.path()).value_or(""), figure));
  }
  picture.publish();
}

std::string drawn_svg(const Figure& figure) {
  const HeldInterrupt held;  // until the folder is gone
  const TemporaryFolder folder;
  const std::string picture = folder.file(figure.id + ".svg");
  draw(figure, PlotFormat::kSvg, picture);
  return content_of(picture).value_or("");
}

}  // namespace simbench::reports
