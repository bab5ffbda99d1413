#include "algorithms/host_sync/chrony/chrony_robust_regression.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "algorithms/host_sync/chrony/chrony_regression.h"
#include "algorithms/ports/assert.h"

namespace simbench {
namespace {

constexpr double kMaxBracket = 100;

// The sum whose sign says on which side of the solution `slope` lies, and the intercept to it.
struct Deviation {
  double intercept = 0;
  double sum = 0;
};

Deviation absolute_deviation(std::span<const double> x, std::span<const double> y, double slope) {
  std::vector<double> rest(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) rest[i] = y[i] - slope * x[i];
  Deviation result;
  result.intercept = median(rest);
  for (std::size_t i = 0; i < x.size(); ++i) {
    // With an odd number of points the median's own residual is 0 but for rounding, and counts to
    // the side that rounding puts it on, as in the original: so the search ends where its does.
    const double residual = y[i] - result.intercept - slope * x[i];
    if (residual > 0) result.sum += x[i];
    if (residual < 0) result.sum -= x[i];
  }
  return result;
}

struct Line {
  double intercept;
  double slope;
};

// Where the search begins.
struct Guess {
  double slope = 0;
  double spread = 0;
  double xx = 0;
};

Guess least_squares(std::span<const double> x, std::span<const double> y) {
  const auto n = static_cast<double>(x.size());
  double mean_x = 0;
  double mean_y = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i];
    mean_y += y[i];
  }
  mean_x /= n;
  mean_y /= n;
  Guess guess;
  double xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    guess.xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (y[i] - mean_y) * (x[i] - mean_x);
  }
  guess.slope = xy / guess.xx;
  const double intercept = mean_y - guess.slope * mean_x;
  double squares = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double residual = y[i] - intercept - guess.slope * x[i];
    squares += residual * residual;
  }
  guess.spread = std::sqrt(squares * n / guess.xx);
  return guess;
}

std::optional<Line> least_absolute(std::span<const double> x, std::span<const double> y,
                                   double tolerance) {
  const Guess guess = least_squares(x, y);
  if (!(guess.xx > 0)) return std::nullopt;
  // Twice the slope's spread to either side, doubled until the solution is inside.
  double reach = std::max(guess.spread, tolerance);
  double low = 0;
  double high = 0;
  double low_sum = 0;
  do {
    reach *= 2;
    if (reach > kMaxBracket) return std::nullopt;
    low = guess.slope - reach;
    high = guess.slope + reach;
    low_sum = absolute_deviation(x, y, low).sum;
  } while (low_sum * absolute_deviation(x, y, high).sum >= 0);
  while (true) {
    const double middle = 0.5 * (low + high);
    const Deviation at = absolute_deviation(x, y, middle);
    if (at.sum == 0 || !(low < middle && middle < high)) return Line{at.intercept, middle};
    (at.sum * low_sum > 0 ? low : high) = middle;
    if (high - low <= tolerance) return Line{at.intercept, middle};
  }
}

}  // namespace

std::optional<RobustRegression> robust_regression(std::span<const double> x,
                                                  std::span<const double> y, double tolerance) {
  SIMBENCH_ASSERT(x.size() == y.size() && tolerance > 0, "as many x as y");
  if (x.size() < 2) return std::nullopt;
  if (x.size() == 2) {
    if (x[0] == x[1]) return std::nullopt;
    const double slope = (y[1] - y[0]) / (x[1] - x[0]);
    return RobustRegression{y[0] - slope * x[0], slope, 0, 0};
  }
  RobustRegression result;
  for (;; ++result.start) {
    const auto kept_x = x.subspan(result.start);
    const auto kept_y = y.subspan(result.start);
    const std::optional<Line> line = least_absolute(kept_x, kept_y, tolerance);
    if (!line) return std::nullopt;
    result.intercept = line->intercept;
    result.slope = line->slope;
    if (kept_x.size() == kChronyMinPoints) return result;
    result.runs = runs_of_residuals(kept_x, kept_y, line->intercept, line->slope);
    if (result.runs > critical_runs(kept_x.size())) return result;
  }
}

}  // namespace simbench
