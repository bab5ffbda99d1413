// Published figures of any metric, each beside the seeds of its pipeline's row.
//
// A value is inside or outside the seeds as a published AMD is (Placement). A bound, such as "below
// 250 us", holds if at least 95 % of the seeds keep it and fails if less than 5 % do, as far as the
// seeds can tell: by the whole interval of the share of the seeds that keep it. Where this lies
// between 5 and 95 %, the bound is inside: many seeds keep it, and many do not. Where it contains
// one of the limits, the seeds are too few. That all seeds keep it takes kFewestOutside of them to
// show.
//
//   const scenarios::PublishedFigure claim{
//       .pipeline = "libsoftwaresync", .metric = "exposure_spread_median_ms", .at_most = 0.25};
//   if (compare_figure(claim, row).verdict == FigureVerdict::kFails) use(claim.number());
//
// Source: docs/design.md section 8.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "evaluation/statistics/statistics.h"
#include "scenarios/scenario.h"

namespace simbench::evaluation {

struct Row;

enum class FigureVerdict : std::uint8_t {
  kInside,
  kOutside,  // of a value
  kHolds,    // of a bound
  kFails,
  kTooFewSeeds,
};

// "inside", "outside", "holds", "fails"; "" if the seeds are too few to tell.
std::string_view verdict_word(FigureVerdict verdict);

// The verdict on a bound by the seeds that keep it, or on a claim by those in which it holds.
FigureVerdict verdict_of_bound(const Percentile& kept);

struct FigureComparison {
  scenarios::PublishedFigure figure;
  Percentile percentile;  // of the published number among the seeds
  Percentile kept;        // the seeds that keep a bound; NaN of a value
  FigureVerdict verdict = FigureVerdict::kTooFewSeeds;
};

// One figure, whose metric must be a series of captures. Without a seed that has a value of the
// metric the percentages are NaN. Linear in the seeds.
FigureComparison compare_figure(const scenarios::PublishedFigure& figure, const Row& row);

// Those whose pipelines have rows, in their order.
std::vector<FigureComparison> compare_figures(std::span<const scenarios::PublishedFigure> figures,
                                              std::span<const Row> rows);

}  // namespace simbench::evaluation
