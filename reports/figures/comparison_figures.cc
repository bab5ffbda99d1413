#include "reports/figures/comparison_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "recording/counted.h"
#include "reports/figures/figure_parts.h"
#include "reports/text/metric_text.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::Metric;
using evaluation::PairedComparison;

constexpr int kColourOfA = 0;
constexpr int kColourOfB = 1;

// "AMD (ms)", "recall (%)", "wrong locks".
std::string metric_axis(const std::string& what, const Metric& metric) {
  const std::string unit = metric.is_share() ? "%" : metric.unit;
  return unit.empty() ? what : fmt::format("{} ({})", what, unit);
}

std::vector<double> shown_values(const Metric& metric, std::vector<double> values) {
  for (double& value : values) value = shown_value(metric, value);
  return values;
}

// "A: monday", or the pipeline where two of one archive are compared.
std::string side_label(const char* side, const std::string& pipeline, const std::string& archive,
                       bool is_of_pipelines) {
  return fmt::format("{}: {}", side, is_of_pipelines ? pipeline : archive);
}

std::optional<FigurePanel> both_distributions(const Comparison& comparison,
                                              const ComparedPipeline& pipeline,
                                              std::size_t metric) {
  const Metric& judged = *comparison.judged[metric];
  const ComparedValues& values = pipeline.values[metric];
  const bool is_of_pipelines = pipeline.pipeline_a != pipeline.pipeline_b;
  FigurePanel made =
      panel(capitalised(judged.title), "share of seeds (%)", metric_axis(judged.title, judged));
  auto a = quantile_curve(
      shown_values(judged, values.a),
      side_label("A", pipeline.pipeline_a, comparison.archive_a, is_of_pipelines), kColourOfA);
  auto b = quantile_curve(
      shown_values(judged, values.b),
      side_label("B", pipeline.pipeline_b, comparison.archive_b, is_of_pipelines), kColourOfB);
  if (!a || !b) return std::nullopt;
  made.series = {std::move(*a), std::move(*b)};
  choose_scale(made);
  return made;
}

void add_level(std::string label, double at, int colour, FigurePanel& panel) {
  if (std::isfinite(at)) {
    panel.lines.push_back({.label = std::move(label), .at = at, .colour = colour});
  }
}

std::optional<FigurePanel> seed_differences(const Comparison& comparison,
                                            const ComparedPipeline& pipeline, std::size_t metric) {
  const Metric& judged = *comparison.judged[metric];
  const PairedComparison& found = pipeline.metrics[metric];
  if (found.pairs == 0) return std::nullopt;
  FigurePanel made =
      panel(fmt::format("{}: {}", capitalised(judged.title),
                        verdict_text(found, comparison.smallest_effect)),
            comparison.by_index ? "seed of A" : "seed", metric_axis("B - A", judged));
  FigureSeries points = series("B - A of a pair", Mark::kPoints, kColourOfB);
  const ComparedValues& values = pipeline.values[metric];
  for (std::size_t i = 0; i < values.a.size(); ++i) {
    points.add(static_cast<double>(comparison.first_seed_a + i),
               shown_value(judged, values.b[i] - values.a[i]));
  }
  made.series.push_back(thinned(std::move(points), kMostPoints));
  const auto shown = [&judged](double value) { return shown_value(judged, value); };
  add_level("no difference", 0, -1, made);
  add_level(fmt::format("mean {}", difference_text(judged, found.difference.value)),
            shown(found.difference.value), kColourOfB, made);
  // All of these are one line where the values are equal.
  if (found.difference.low == found.difference.high) return made;
  add_level("interval", shown(found.difference.low), kColourOfB, made);
  add_level("interval", shown(found.difference.high), kColourOfB, made);
  return made;
}

using MakesPanel = std::optional<FigurePanel> (*)(const Comparison&, const ComparedPipeline&,
                                                  std::size_t);

Figure figure_of(const Comparison& comparison, const ComparedPipeline& pipeline, const char* id,
                 const char* title, std::string caption, MakesPanel make) {
  Figure figure;
  figure.id = id;
  figure.title = title;
  figure.pipeline = pair_name(comparison, pipeline);
  for (std::size_t metric = 0; metric < comparison.judged.size(); ++metric) {
    if (auto made = make(comparison, pipeline, metric)) figure.panels.push_back(std::move(*made));
  }
  if (figure.panels.empty()) return absent(std::move(figure), "No pair has values of a metric.");
  figure.caption = std::move(caption);
  if (std::ranges::any_of(figure.panels, &FigurePanel::log_y)) figure.caption += kLogNote;
  return figure;
}

}  // namespace

std::vector<Figure> comparison_figures(const Comparison& comparison) {
  std::vector<Figure> figures;
  figures.reserve(2 * comparison.pipelines.size());
  for (const ComparedPipeline& pipeline : comparison.pipelines) {
    figures.push_back(
        figure_of(comparison, pipeline, kComparedDistributions, "Distributions of A and B",
                  fmt::format("Scores of {} of seeds in ascending order: 50 % is the median.",
                              counted(comparison.seed_count, "pair")),
                  both_distributions));
  }
  for (const ComparedPipeline& pipeline : comparison.pipelines) {
    figures.push_back(figure_of(
        comparison, pipeline, kPairedDifferences, "B - A, seed by seed",
        "A point is a pair of runs in one world, so what their worlds have in common cancels. "
        "Dashed: their mean with its interval at the level that Holm's correction leaves to it "
        "(without one, there are too few pairs for a verdict), and no difference.",
        seed_differences));
  }
  return figures;
}

}  // namespace simbench::reports
