// The line fit of chrony: weighted least squares that drops old points until the residuals look
// random.
//
// Runs test: residuals of equal sign in a row are a run. A line that does not fit, because the
// clock's rate has changed, has few runs. Of n independent signs the number of runs is 1 +
// Binomial(n - 1, 1/2); a fit with no more runs than the 5 % quantile of that is rejected, the
// oldest point dropped, and the fit repeated, until it passes or `min_samples` (at least 3) points
// are left. Fewer than 8 residuals are not tested.
//
// Weights act like variances: a large w makes a point count less; all must be > 0. x must not all
// be equal; times are usually given relative to the last, so the intercept is the present value.
//
// Complexity: a fit O(n), the whole O(n^2); n is at most 64 in use. The results are finite for
// finite input.
//
// Source: docs/reference/host_sync.md section 1 (chrony, regress.c); the quantile is computed, not
// copied.
//
//   const auto fit = best_regression(x, y, w, extra, 3);  // x, y: `extra` older points first
//   if (fit) now_s = fit->line.intercept;
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_REGRESSION_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_REGRESSION_H_

#include <cstddef>
#include <optional>
#include <span>

namespace simbench {

inline constexpr std::size_t kChronyMinPoints = 3;

struct WeightedLine {
  double intercept = 0;
  double slope = 0;
  double variance = 0;  // of a point of average weight
  double intercept_sd = 0;
  double slope_sd = 0;
};

// Weighted least squares over all points. Needs three; fewer, or all at one x, give nothing.
std::optional<WeightedLine> weighted_regression(std::span<const double> x,
                                                std::span<const double> y,
                                                std::span<const double> w);

struct BestRegression {
  WeightedLine line;
  std::size_t start = 0;  // points dropped
  int runs = 0;           // of the residuals of the points kept
  int degrees_of_freedom = 0;
};

// x and y hold `extra` older points before the w.size() points in use; the older ones only serve
// the runs test, up to twice the points in use. Nothing for fewer than three points in use.
std::optional<BestRegression> best_regression(std::span<const double> x, std::span<const double> y,
                                              std::span<const double> w, std::size_t extra,
                                              std::size_t min_samples);

// Slope of y on `b` in y = c0 + c1 a + c2 b + noise; nothing for fewer than 4 points or if a and b
// do not determine it.
std::optional<double> second_slope(std::span<const double> a, std::span<const double> b,
                                   std::span<const double> y);

// The number of runs of equal sign of y - intercept - slope * x; a zero is a run of its own.
int runs_of_residuals(std::span<const double> x, std::span<const double> y, double intercept,
                      double slope);

// Mean of the middle two if their number is even. Must not be empty.
double median(std::span<const double> values);

// The number of runs at or below which n residuals are rejected; 0 for n < 8.
int critical_runs(std::size_t n);

// Quantile 99.95 % of Student's t distribution; 62 degrees of freedom and more as 62.
double student_t_9995(int degrees_of_freedom);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_REGRESSION_H_
