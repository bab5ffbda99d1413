#include <algorithm>
#include <string>
#include <utility>

#include "evaluation/clock_run/clock_score.h"
#include "reports/clocks/clock_report.h"

namespace simbench::reports {
namespace {

// A limit from recommendations that were made for telecommunication clocks, for orientation only.
// Its points in seconds and nanoseconds, joined by straight lines on logarithmic axes.
struct Mask {
  const char* curve;
  const char* label;
  std::vector<std::pair<double, double>> points;
};

// G.8262 (11/18), tables 1 and 3: wander generation of a synchronous Ethernet equipment clock of
// option 1 at constant temperature: MTIE 40 ns to 1 s, 40 tau^0.1 to 100 s, 25.25 tau^0.2 to
// 1000 s; TDEV 3.2 ns to 25 s, 0.64 tau^0.5 to 100 s, 6.4 ns to 1000 s. G.8273.2 (10/20), clause
// 7.1: dynamic time error of a telecom boundary clock of class A and B: MTIE 40 ns to 1000 s, TDEV
// 4 ns to 1000 s.
std::vector<Mask> masks() {
  return {{"mtie_ms", "G.8262 option 1", {{0.1, 40}, {1, 40}, {100, 63.4}, {1000, 100.5}}},
          {"mtie_ms", "G.8273.2 dTE_L", {{0.1, 40}, {1000, 40}}},
          {"tdev_ms", "G.8262 option 1", {{0.1, 3.2}, {25, 3.2}, {100, 6.4}, {1000, 6.4}}},
          {"tdev_ms", "G.8273.2 dTE_L", {{0.1, 4}, {1000, 4}}}};
}

FigureSeries curve_series(const std::string& label, int colour,
                          const std::vector<evaluation::StabilityPoint>& points) {
  FigureSeries series{.label = label, .mark = Mark::kMarkedLine, .colour = colour};
  for (const evaluation::StabilityPoint& point : points) {
    if (point.value <= 0) continue;  // of an oracle; a logarithmic axis has no place for it
    series.add(point.tau_s, point.value);
  }
  return series;
}

void add_masks(const evaluation::ClockCurve& curve, double first_tau_s, FigurePanel& panel) {
  int colour = static_cast<int>(panel.series.size());
  for (const Mask& mask : masks()) {
    if (mask.curve != std::string(curve.id)) continue;
    FigureSeries series{.label = mask.label, .mark = Mark::kLine, .colour = colour++};
    for (const auto& [tau_s, ns] : mask.points) {
      series.add(std::max(tau_s, first_tau_s), ns * 1e-6);
    }
    panel.series.push_back(std::move(series));
  }
}

}  // namespace

Figure clock_figure(const evaluation::ClockResults& results) {
  const evaluation::Results& of = results.results;
  Figure figure;
  figure.id = "clocks";
  figure.title = of.scenario + ": stability of the hosts' clocks";
  figure.caption =
      "Against the master's clock: deviations are RMS over slaves and seeds, MTIE is the largest "
      "of "
      "any. The masks of ITU-T are made for telecommunication clocks and stand for orientation.";
  figure.source = {.scenario = of.scenario,
                   .derivation = of.derivation,
                   .pipeline = of.rows.size() == 1 ? of.rows.front().pipeline : "",
                   .first_seed = of.first_seed,
                   .seeds = of.seed_count};
  for (const evaluation::ClockCurve& curve : evaluation::clock_curves()) {
    if (!curve.in_text) continue;
    FigurePanel panel{.title = curve.title, .x_label = "tau, s", .y_label = curve.axis};
    panel.log_x = panel.log_y = true;
    for (std::size_t row = 0; row < of.rows.size(); ++row) {
      panel.series.push_back(curve_series(of.rows[row].pipeline, static_cast<int>(row),
                                          results.curves[row].*curve.points));
    }
    add_masks(curve, to_seconds(evaluation::kReadingInterval), panel);
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

}  // namespace simbench::reports
