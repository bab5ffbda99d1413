#include "reports/reconstruction/reconstruction_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/statistics/statistics.h"
#include "reports/reconstruction/reconstruction_document.h"

namespace simbench::reports {
namespace {

using reconstruction::CurvePoint;
using reconstruction::ReconstructionResults;

constexpr const char* kErrorAxis = "median mean error, cm";

std::vector<FigureLine> published_lines(const ReconstructionResults& results) {
  std::vector<FigureLine> lines;
  for (const reconstruction::ReprojectionRow& row : results.rows) {
    if (!row.published) continue;
    lines.push_back(
        {.label = fmt::format("published {}: {}", row.pipeline, cm_text(row.published->mean_cm)),
         .at = row.published->mean_cm});
  }
  return lines;
}

FigurePanel desync_panel(const ReconstructionResults& results) {
  FigurePanel panel{.title = "Reprojection error over desynchronisation",
                    .x_label = "desynchronisation of the hosts, ms",
                    .y_label = kErrorAxis,
                    .lines = published_lines(results)};
  for (const CurvePoint& point : results.curve) {
    const std::string label = speed_text(point.speed_m_per_s, point.speed_factor);
    if (panel.series.empty() || panel.series.back().label != label) {
      const int colour = static_cast<int>(panel.series.size());
      panel.series.push_back(
          {.label = label, .mark = Mark::kLine, .x = {}, .y = {}, .colour = colour});
    }
    panel.series.back().x.push_back(point.desync_ms);
    panel.series.back().y.push_back(evaluation::median(point.mean_cm));
  }
  return panel;
}

FigurePanel speed_panel(const reconstruction::SpeedNeeded& needed) {
  const bool walks = std::any_of(needed.points.begin(), needed.points.end(),
                                 [](const CurvePoint& point) { return point.speed_m_per_s > 0; });
  FigurePanel panel{
      .title = fmt::format("Reprojection error of {} ({} ms) over the subject's speed",
                           needed.pipeline, ms_text(needed.desync_ms)),
      .x_label = walks ? "walking speed, m/s" : "factor on the stated speed",
      .y_label = kErrorAxis,
      .lines = {{.label = fmt::format("published: {}", cm_text(needed.published_mean_cm)),
                 .at = needed.published_mean_cm}}};
  FigureSeries series{.label = needed.pipeline, .mark = Mark::kLine, .x = {}, .y = {}};
  for (const CurvePoint& point : needed.points) {
    series.x.push_back(walks ? point.speed_m_per_s : point.speed_factor);
    series.y.push_back(evaluation::median(point.mean_cm));
  }
  panel.series.push_back(std::move(series));
  return panel;
}

}  // namespace

Figure reconstruction_figure(const ReconstructionResults& results) {
  Figure figure;
  figure.id = "reconstruction";
  figure.title = fmt::format("{}: what desynchronisation costs", results.scenario.name);
  figure.caption = fmt::format(
      "Over desynchronisation: all hosts off by a known amount, exposures of a host's cameras "
      "coincide, the hosts are spread over it. Over speed: the exposures that the pipeline has. "
      "Medians over {} {}.",
      results.seeds, results.seeds == 1 ? "seed" : "seeds");
  if (!results.curve.empty()) figure.panels.push_back(desync_panel(results));
  if (results.speed_needed && !results.speed_needed->points.empty()) {
    figure.panels.push_back(speed_panel(*results.speed_needed));
  }
  if (figure.panels.empty()) figure.absent = "the curve was not asked for";
  return figure;
}

}  // namespace simbench::reports
