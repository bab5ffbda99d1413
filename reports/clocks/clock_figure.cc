#include <string>
#include <utility>

#include "evaluation/clock_run/clock_score.h"
#include "evaluation/stability/masks.h"
#include "reports/clocks/clock_report.h"
#include "reports/figures/stability_figure.h"

namespace simbench::reports {
namespace {

// Limits that were made for telecommunication clocks, for orientation only. G.8262 option 1 has
// those of G.813 option 1; classes A and B of G.8273.2 have one dynamic time error.
std::vector<std::pair<const char*, const evaluation::MaskLimit*>> orientation() {
  std::vector<std::pair<const char*, const evaluation::MaskLimit*>> limits;
  for (const evaluation::MaskLimit& limit : evaluation::mask_named("sec").limits) {
    limits.emplace_back("G.8262 option 1", &limit);
  }
  for (const evaluation::MaskLimit& limit : evaluation::mask_named("class_a").limits) {
    if (limit.band == evaluation::Band::kLow) limits.emplace_back("G.8273.2 dTE_L", &limit);
  }
  return limits;
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
  for (const auto& [label, limit] : orientation()) {
    if (evaluation::facts_of(limit->quantity).deviation != curve.deviation) continue;
    panel.series.push_back(limit_line(*limit, label, colour++, first_tau_s));
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
