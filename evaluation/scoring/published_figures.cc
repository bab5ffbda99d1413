#include "evaluation/scoring/published_figures.h"

#include "evaluation/scoring/metrics.h"
#include "evaluation/scoring/results.h"

namespace simbench::evaluation {
namespace {

FigureVerdict verdict_of_value(const Percentile& percentile) {
  switch (placement_of(percentile)) {
    case Placement::kInside:
      return FigureVerdict::kInside;
    case Placement::kOutside:
      return FigureVerdict::kOutside;
    case Placement::kTooFewSeeds:
      break;
  }
  return FigureVerdict::kTooFewSeeds;
}

}  // namespace

FigureVerdict verdict_of_bound(const Percentile& kept) {
  constexpr double kFew = 5;
  constexpr double kNearlyAll = 95;
  if (kept.low >= kNearlyAll) return FigureVerdict::kHolds;
  if (kept.high < kFew) return FigureVerdict::kFails;
  if (kept.low >= kFew && kept.high < kNearlyAll) return FigureVerdict::kInside;
  return FigureVerdict::kTooFewSeeds;
}

std::string_view verdict_word(FigureVerdict verdict) {
  switch (verdict) {
    case FigureVerdict::kInside:
      return "inside";
    case FigureVerdict::kOutside:
      return "outside";
    case FigureVerdict::kHolds:
      return "holds";
    case FigureVerdict::kFails:
      return "fails";
    case FigureVerdict::kTooFewSeeds:
      break;
  }
  return "";
}

FigureComparison compare_figure(const scenarios::PublishedFigure& figure, const Row& row) {
  const std::vector<double>& values = metric(figure.metric).series(row).values;
  FigureComparison comparison{.figure = figure,
                              .percentile = percentile_of(figure.number(), values),
                              .kept = {kNan, kNan, kNan}};
  if (figure.value) {
    comparison.verdict = verdict_of_value(comparison.percentile);
    return comparison;
  }
  comparison.kept = figure.at_most ? percent_at_most(*figure.at_most, values)
                                   : percent_at_least(figure.number(), values);
  comparison.verdict = verdict_of_bound(comparison.kept);
  return comparison;
}

std::vector<FigureComparison> compare_figures(std::span<const scenarios::PublishedFigure> figures,
                                              std::span<const Row> rows) {
  std::vector<FigureComparison> comparisons;
  for (const scenarios::PublishedFigure& figure : figures) {
    const Row* const row = find_row(rows, figure.pipeline);
    if (row != nullptr) comparisons.push_back(compare_figure(figure, *row));
  }
  return comparisons;
}

}  // namespace simbench::evaluation
