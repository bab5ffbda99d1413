#include "reports/figures/gnuplot_photographs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <string_view>

namespace simbench::reports {
namespace {

constexpr int kRowHeight = 130;
constexpr std::size_t kReadingsInPhotograph = 3;  // more lines do not fit a photograph
constexpr double kFaintest = 0.35;                // brightness of a reading of no share

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '\'' ? "''" : std::string(1, c);
  return out;
}

std::string label(const std::string& text, double x, double y, const std::string& look) {
  return fmt::format("set label '{}' at {},{} {}\n", escaped(text), x, y, look);
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

}  // namespace

int photographs_height(const Figure& figure) {
  return kRowHeight * static_cast<int>(figure.photographs.size());
}

std::string photographs_script(const Figure& figure, const std::string& title) {
  std::size_t columns = 1;
  for (const PhotographRow& row : figure.photographs) {
    columns = std::max(columns, row.photographs.size());
  }
  std::string script = fmt::format(
      "unset border\nunset tics\nunset key\nset lmargin 1\nset rmargin 1\nset bmargin 0\n"
      "set title {} font ',14'\nset xrange [0:{}]\nset yrange [0:{}]\n",
      title, columns, figure.photographs.size());
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

}  // namespace simbench::reports
