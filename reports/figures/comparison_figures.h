// The figures of a comparison: of each compared pipeline the distributions of A and B side by side,
// and the difference of every pair of seeds with its mean and interval. A panel for each metric of
// which both have values; the pipelines are alternatives of one figure.
//
//   const std::vector<Figure> figures = comparison_figures({});
#pragma once

#include <string>
#include <vector>

#include "reports/comparison/comparison.h"
#include "reports/figures/figure.h"

namespace simbench::reports {

inline constexpr const char* kComparedDistributions = "compared_distributions";
inline constexpr const char* kPairedDifferences = "paired_differences";

// Figures of one id stand together, in the order of the comparison.
std::vector<Figure> comparison_figures(const Comparison& comparison);

}  // namespace simbench::reports
