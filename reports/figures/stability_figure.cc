#include "reports/figures/stability_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>

#include "evaluation/statistics/statistics.h"
#include "recording/counted.h"
#include "reports/figures/figure_parts.h"
#include "reports/text/time_text.h"

namespace simbench::reports {
namespace {

// A power of tau is straight on these axes; a sum is not.
constexpr int kStepsOfACurvedLimit = 20;
constexpr std::size_t kMostPointsOfAClock = 4000;
constexpr std::size_t kMostSteps = 8;  // more cannot be told apart

FigureSeries clock_line(const StabilityFinding& finding, const evaluation::ClockCurve& curve,
                        int colour) {
  const bool has_interval = curve.deviation != evaluation::Deviation::kMtie;
  FigureSeries series{.label = log_name(finding.log), .mark = Mark::kMarkedLine, .colour = colour};
  for (const evaluation::StabilityPoint& point : finding.log.stability.*curve.points) {
    if (point.value <= 0) continue;  // a logarithmic axis has no place for it
    if (!has_interval) {
      series.add(point.tau_s, point.value);
    } else if (point.certainty) {
      series.add(point.tau_s, point.value, point.certainty->low, point.certainty->high);
    } else {
      series.add(point.tau_s, point.value, point.value, point.value);
    }
  }
  return series;
}

void add_limits(const std::vector<evaluation::ClockMask>& masks,
                const evaluation::ClockCurve& curve, double first_tau_s, FigurePanel& panel) {
  int colour = static_cast<int>(panel.series.size());
  for (const evaluation::ClockMask& mask : masks) {
    for (const evaluation::MaskLimit& limit : mask.limits) {
      const evaluation::QuantityFacts& facts = evaluation::facts_of(limit.quantity);
      if (!facts.has_tau() || facts.deviation != curve.deviation) continue;
      FigureSeries line = limit_line(limit, mask.title + " " + limit.label, colour++, first_tau_s);
      if (line.x.size() == 1) line.mark = Mark::kPoints;
      panel.series.push_back(std::move(line));
    }
  }
}

double first_tau(const std::vector<StabilityFinding>& findings) {
  double first_s = findings.empty() ? 1 : findings.front().log.stability.interval_s;
  for (const StabilityFinding& finding : findings) {
    first_s = std::min(first_s, finding.log.stability.interval_s);
  }
  return first_s;
}

// The points of a clock in the unit that fits, with a gap between its pieces.
FigureSeries time_error_line(const evaluation::Stability& stability, const ShownUnit& unit) {
  FigureSeries line = series("time error", Mark::kLine, 0);
  const double per_s = 1e3 * unit.per_ms;
  for (const evaluation::TimeErrorPiece& piece : stability.series.pieces) {
    if (!line.x.empty()) line.add(piece.start_s - stability.interval_s / 2, evaluation::kNan);
    double at_s = piece.start_s;
    for (const double x_s : piece.x_s) {
      line.add(at_s, per_s * x_s);
      at_s += stability.interval_s;
    }
  }
  return thinned(std::move(line), kMostPointsOfAClock);
}

void add_largest_limits(const std::vector<evaluation::ClockMask>& masks, const ShownUnit& unit,
                        FigurePanel& panel) {
  for (const evaluation::ClockMask& mask : masks) {
    for (const evaluation::MaskLimit& limit : mask.limits) {
      const bool is_of_it = limit.quantity == evaluation::LimitedQuantity::kMaxTe &&
                            limit.band == evaluation::Band::kAll;
      if (!is_of_it) continue;
      const double at = unit.per_ms * limit.segments.front().base;
      for (const double side : {at, -at}) {
        panel.lines.push_back({.label = mask.title + " " + limit.label, .at = side});
      }
    }
  }
}

std::vector<evaluation::TimeErrorStep> largest_steps(const evaluation::Stability& stability) {
  std::vector<evaluation::TimeErrorStep> steps = stability.steps;
  std::ranges::stable_sort(steps, std::greater<>(),
                           [](const auto& step) { return std::abs(step.step_s); });
  steps.resize(std::min(steps.size(), kMostSteps));
  return steps;
}

FigurePanel time_error_panel(const StabilityFinding& finding,
                             const std::vector<evaluation::ClockMask>& masks) {
  const evaluation::Stability& stability = finding.log.stability;
  const ShownUnit& unit = time_unit_of(stability.time_error.max_te_ms);
  FigurePanel made = panel(log_name(finding.log), "time since the first point (s)",
                           fmt::format("time error ({})", unit.name));
  made.series.push_back(time_error_line(stability, unit));
  for (const evaluation::TimeErrorStep& step : largest_steps(stability)) {
    made.lines.push_back(
        {.label = "step of " + time_text(1e3 * step.step_s), .vertical = true, .at = step.at_s});
  }
  add_largest_limits(masks, unit, made);
  return made;
}

}  // namespace

FigureSeries limit_line(const evaluation::MaskLimit& limit, std::string label, int colour,
                        double first_tau_s) {
  FigureSeries line{.label = std::move(label), .mark = Mark::kLine, .colour = colour};
  for (const evaluation::MaskSegment& segment : limit.segments) {
    if (segment.to_s < first_tau_s) continue;
    const double from_s = std::max(segment.from_s, first_tau_s);
    const int steps = from_s == segment.to_s                     ? 0
                      : segment.base != 0 && segment.factor != 0 ? kStepsOfACurvedLimit
                                                                 : 1;
    for (int i = 0; i <= steps; ++i) {
      const double tau_s =
          steps == 0 ? from_s
                     : from_s * std::pow(segment.to_s / from_s, static_cast<double>(i) / steps);
      line.add(tau_s, segment.base + segment.factor * std::pow(tau_s, segment.exponent));
    }
  }
  return line;
}

Figure stability_figure(const std::vector<StabilityFinding>& findings,
                        const std::vector<evaluation::ClockMask>& masks) {
  Figure figure;
  figure.id = "stability";
  figure.title = "stability of " + counted(findings.size(), "measured clock");
  figure.caption =
      "With 95 % confidence intervals under the power-law noise at each tau; MTIE has none. The "
      "curves are not filtered; limits of dTE_L are of the time error below 0.1 Hz.";
  for (const evaluation::ClockCurve& curve : evaluation::clock_curves()) {
    if (!curve.in_text) continue;
    FigurePanel panel{.title = curve.title, .x_label = "tau, s", .y_label = curve.axis};
    panel.log_x = panel.log_y = true;
    for (const StabilityFinding& finding : findings) {
      panel.series.push_back(clock_line(finding, curve, static_cast<int>(panel.series.size())));
    }
    add_limits(masks, curve, first_tau(findings), panel);
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

Figure time_error_figure(const std::vector<StabilityFinding>& findings,
                         const std::vector<evaluation::ClockMask>& masks) {
  Figure figure;
  figure.id = "time_error";
  figure.title = "time error of " + counted(findings.size(), "measured clock");
  for (const StabilityFinding& finding : findings) {
    if (finding.log.stability.series.pieces.empty()) continue;
    figure.panels.push_back(time_error_panel(finding, masks));
  }
  if (figure.panels.empty()) {
    return absent(std::move(figure), "Summaries (rms, max) have no points to draw.");
  }
  figure.caption =
      "The clock minus its reference, at the points that the deviations are of; a gap is a gap of "
      "the log; dashed are the largest steps and limits. Long logs are thinned without hiding an "
      "extreme.";
  return figure;
}

}  // namespace simbench::reports
