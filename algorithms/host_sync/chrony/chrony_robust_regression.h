// chrony's robust line fit: least absolute deviations, with the runs test of chrony_regression.h.
//
// The sum of x * sign(residual) falls with the slope, the intercept being the median of y - slope *
// x; its zero is bisected. Outliers count no more than any other point on their side. It is the fit
// for points without weights, such as times entered by hand.
//
// Complexity: O(n log(spread / tolerance)) a fit, O(n^2) with the runs test.
// Source: docs/reference/host_sync.md section 1 (chrony, regress.c).
//
//   const auto fit = robust_regression(x, y, 1e-12);
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_ROBUST_REGRESSION_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_ROBUST_REGRESSION_H_

#include <cstddef>
#include <optional>
#include <span>

namespace simbench {

struct RobustRegression {
  double intercept = 0;
  double slope = 0;
  std::size_t start = 0;
  int runs = 0;
};

// Least absolute deviations: the slope is bisected to `tolerance`, the intercept is the median of
// what is left. Two points give the line through them. Nothing for fewer, for points all at one x,
// or if no slope within 100 of the least squares one is a solution.
std::optional<RobustRegression> robust_regression(std::span<const double> x,
                                                  std::span<const double> y, double tolerance);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_ROBUST_REGRESSION_H_
