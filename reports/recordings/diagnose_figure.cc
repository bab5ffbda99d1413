#include "reports/recordings/diagnose_figure.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "evaluation/statistics/statistics.h"
#include "reports/figures/figure_parts.h"

namespace simbench::reports {
namespace {

using evaluation::CameraDiagnosis;
using evaluation::Diagnosis;
using evaluation::GroupVerdict;

constexpr std::size_t kMostCameras = 24;    // more cannot be told apart
constexpr std::size_t kFramesOfZero = 50;   // whose median is 0
constexpr std::size_t kMostBlocks = 80;     // whose medians a curve has
constexpr std::size_t kMostSlipLines = 12;  // of all cameras

bool has_place(const CameraDiagnosis& camera) {
  return camera.standing.follows != evaluation::Follows::kOtherRate &&
         camera.facts.arrivals_ms.size() > 1;
}

// The width of the curve, its drift taken out.
double jitter_ms(const CameraDiagnosis& camera, const FigureSeries& phases) {
  const double moves = camera.standing.moves_ms_per_minute;
  std::vector<double> level;
  level.reserve(phases.y.size());
  for (std::size_t i = 0; i < phases.y.size(); ++i) {
    level.push_back(phases.y[i] - (std::isnan(moves) ? 0 : moves * phases.x[i] / 60));
  }
  const evaluation::Series series = evaluation::make_series(std::move(level));
  return series.p95 - series.p05;
}

void add_slips(const CameraDiagnosis& camera, int colour, FigurePanel& panel) {
  for (const evaluation::StampJump& jump : camera.facts.jumps) {
    if (panel.lines.size() == kMostSlipLines) return;
    panel.lines.push_back(
        {.label = camera.camera + (jump.periods != 0 ? " slips" : ": a clock is set"),
         .vertical = true,
         .at = jump.at_s,
         .colour = colour});
  }
}

std::vector<FigurePanel> panels_of(const Diagnosis& diagnosis, const GroupVerdict& group) {
  FigurePanel phases = panel(group.stream + ": how the phase moves", "s after its first frame",
                             "arrival less the common period (ms)");
  FigurePanel widths =
      panel(group.stream + ": jitter of the arrivals", "", "from 5 to 95 %, drift taken out (ms)");
  FigureSeries bars = series("jitter", Mark::kBars, 0);
  for (const CameraDiagnosis& camera : diagnosis.cameras) {
    if (camera.stream != group.stream || phases.series.size() == kMostCameras) continue;
    FigureSeries curve = phase_series(camera, group.period_ms);
    if (curve.x.empty()) continue;
    curve.colour = static_cast<int>(phases.series.size());
    bars.x.push_back(static_cast<double>(widths.categories.size()));
    bars.y.push_back(jitter_ms(camera, curve));
    widths.categories.push_back(camera.camera);
    add_slips(camera, curve.colour, phases);
    phases.series.push_back(block_medians(curve));
  }
  if (phases.series.empty()) return {};
  widths.series = {std::move(bars)};
  return {std::move(phases), std::move(widths)};
}

}  // namespace

FigureSeries block_medians(const FigureSeries& curve) {
  FigureSeries medians{
      .label = curve.label, .mark = curve.mark, .x = {}, .y = {}, .colour = curve.colour};
  const std::size_t size = (curve.x.size() + kMostBlocks - 1) / kMostBlocks;
  for (std::size_t from = 0; from < curve.x.size(); from += size) {
    const auto begin = static_cast<std::ptrdiff_t>(from);
    const auto end = static_cast<std::ptrdiff_t>(std::min(from + size, curve.x.size()));
    medians.x.push_back(evaluation::median({curve.x.begin() + begin, curve.x.begin() + end}));
    medians.y.push_back(evaluation::median({curve.y.begin() + begin, curve.y.begin() + end}));
  }
  return medians;
}

FigureSeries phase_series(const CameraDiagnosis& camera, double period_ms) {
  FigureSeries curve = series(camera.camera, Mark::kLine, 0);
  if (!has_place(camera) || !(period_ms > 0)) return curve;
  const evaluation::StreamFacts& facts = camera.facts;
  const double own_ms = period_ms * camera.standing.period_multiple;
  for (std::size_t i = 0; i < facts.arrivals_ms.size(); ++i) {
    const double since_ms = facts.arrivals_ms[i] - facts.arrivals_ms.front();
    curve.x.push_back(since_ms / 1000);
    curve.y.push_back(since_ms -
                      static_cast<double>(facts.periods[i] - facts.periods.front()) * own_ms);
  }
  const auto first = static_cast<std::ptrdiff_t>(std::min(curve.y.size(), kFramesOfZero));
  const double zero_ms = evaluation::median({curve.y.begin(), curve.y.begin() + first});
  for (double& y : curve.y) y -= zero_ms;
  return curve;
}

Figure diagnose_figure(const Diagnosis& diagnosis) {
  Figure figure;
  figure.id = "phases";
  figure.title = "Who keeps the common beat";
  for (const GroupVerdict& group : diagnosis.groups) {
    for (FigurePanel& made : panels_of(diagnosis, group)) figure.panels.push_back(std::move(made));
  }
  if (figure.panels.empty()) {
    return absent(std::move(figure), "No stream has a frame period that is known well enough.");
  }
  figure.caption =
      "Arrivals in the host's time less whole common frame periods, from 0 on, as medians of short "
      "stretches. A camera on the "
      "trigger stays level; one that runs free, or whose host's clock drifts, leaves along a line. "
      "Where stamps slip, a line stands, and the arrivals are shown without the slip.";
  return figure;
}

}  // namespace simbench::reports
