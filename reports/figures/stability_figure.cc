#include "reports/figures/stability_figure.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "recording/counted.h"

namespace simbench::reports {
namespace {

// A power of tau is straight on these axes; a sum is not.
constexpr int kStepsOfACurvedLimit = 20;

FigureSeries clock_line(const StabilityFinding& finding, const evaluation::ClockCurve& curve,
                        int colour) {
  const bool has_interval = curve.deviation != evaluation::Deviation::kMtie;
  FigureSeries series{.label = finding.log.file, .mark = Mark::kMarkedLine, .colour = colour};
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
      "Shaded: 95 % confidence intervals under the power-law noise at each tau; MTIE has none. The "
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

}  // namespace simbench::reports
