#include "evaluation/stability/time_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "algorithms/ports/assert.h"
#include "evaluation/stability/compensated_sum.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

constexpr std::size_t kNeighbours = 2;  // differences on either side
constexpr double kRounding = 1e-14;     // of a time error, far less than any that is meant

double time_of(const TimeErrorSeries& series, const TimeErrorPiece& piece, std::size_t i) {
  return piece.start_s + static_cast<double>(i) * series.interval_s;
}

// How far each difference but the first and the last is from the median of its neighbours.
std::vector<double> jumps_of(std::span<const double> x) {
  std::vector<double> jumps;
  std::vector<double> near;
  for (std::size_t i = 1; i + 2 < x.size(); ++i) {
    near.clear();
    const std::size_t last = std::min(i + kNeighbours, x.size() - 2);
    for (std::size_t j = i - std::min(i, kNeighbours); j <= last; ++j) {
      if (j != i) near.push_back(x[j + 1] - x[j]);
    }
    std::sort(near.begin(), near.end());
    jumps.push_back(x[i + 1] - x[i] - quantile_of_sorted(near, 0.5));
  }
  return jumps;
}

double largest_error_of(const TimeErrorSeries& series) {
  double largest = 0;
  for (const TimeErrorPiece& piece : series.pieces) {
    for (const double x : piece.x_s) largest = std::max(largest, std::abs(x));
  }
  return largest;
}

// The distance beyond which a difference jumps.
double limit_of(const std::vector<std::vector<double>>& jumps, double largest_error) {
  std::vector<double> distances;
  for (const std::vector<double>& piece : jumps) {
    for (const double jump : piece) distances.push_back(std::abs(jump));
  }
  const double mean = mean_of(distances);
  const double scatter = kSigmasOfMedian * median(std::move(distances));
  return std::max(kStepFactor * (scatter > 0 ? scatter : mean), kRounding * largest_error);
}

std::vector<double> sorted_magnitudes(const TimeErrorSeries& series) {
  std::vector<double> magnitudes;
  for (const TimeErrorPiece& piece : series.pieces) {
    for (const double x : piece.x_s) magnitudes.push_back(std::abs(x));
  }
  std::sort(magnitudes.begin(), magnitudes.end());
  return magnitudes;
}

}  // namespace

void check_series(const TimeErrorSeries& series) {
  // Also false for NaN.
  const auto within = [](double value) { return std::abs(value) <= kLargestSeconds; };
  SIMBENCH_ASSERT(series.interval_s > 0 && within(series.interval_s),
                  "the interval of a series is a positive number");
  for (const TimeErrorPiece& piece : series.pieces) {
    SIMBENCH_ASSERT(
        within(piece.start_s) && std::all_of(piece.x_s.begin(), piece.x_s.end(), within),
        "times and time errors are finite numbers");
  }
}

std::int64_t points_in(const TimeErrorSeries& series) {
  std::size_t points = 0;
  for (const TimeErrorPiece& piece : series.pieces) points += piece.x_s.size();
  return static_cast<std::int64_t>(points);
}

std::vector<TimeErrorStep> steps_of(const TimeErrorSeries& series) {
  check_series(series);
  std::vector<std::vector<double>> jumps;
  std::size_t differences = 0;
  for (const TimeErrorPiece& piece : series.pieces) {
    jumps.push_back(jumps_of(piece.x_s));
    differences += std::max<std::size_t>(piece.x_s.size(), 1) - 1;
  }
  const bool any =
      std::any_of(jumps.begin(), jumps.end(), [](const auto& of) { return !of.empty(); });
  if (!any || differences < static_cast<std::size_t>(kFewestDifferences)) return {};
  const double limit = limit_of(jumps, largest_error_of(series));
  std::vector<TimeErrorStep> steps;
  for (std::size_t piece = 0; piece < jumps.size(); ++piece) {
    const std::vector<double>& of = jumps[piece];
    for (std::size_t i = 0; i < of.size(); ++i) {
      double jump = of[i];
      if (std::abs(jump) <= limit) continue;
      const double next = i + 1 < of.size() ? of[i + 1] : 0;
      if (next * jump < 0 && std::abs(next) > 0.5 * std::abs(jump)) {
        jump += next;
        ++i;
      }
      if (std::abs(jump) <= limit) continue;
      // Jump 0 is that of the second difference, which ends at the third point.
      steps.push_back({time_of(series, series.pieces[piece], i + 2), jump});
    }
  }
  return steps;
}

std::optional<double> remove_frequency_offset(TimeErrorSeries& series) {
  check_series(series);
  std::vector<double> times;
  std::vector<double> errors;
  for (const TimeErrorPiece& piece : series.pieces) {
    for (std::size_t i = 0; i < piece.x_s.size(); ++i) {
      times.push_back(time_of(series, piece, i));
      errors.push_back(piece.x_s[i]);
    }
  }
  if (times.size() < 2) return std::nullopt;
  const FittedLine line = fit_line(times, errors);
  if (!std::isfinite(line.slope)) return std::nullopt;
  for (TimeErrorPiece& piece : series.pieces) {
    for (std::size_t i = 0; i < piece.x_s.size(); ++i) {
      piece.x_s[i] -= line.slope * (time_of(series, piece, i) - line.mean_x);
    }
  }
  return line.slope;
}

TimeErrorSummary time_error_of(const TimeErrorSeries& series) {
  check_series(series);
  const auto count = static_cast<double>(points_in(series));
  if (count == 0) return {};
  const auto mean_over_points = [&](auto value_of) {
    CompensatedSum sum;
    for (const TimeErrorPiece& piece : series.pieces) {
      for (const double x : piece.x_s) sum.add(value_of(x));
    }
    return sum.value() / count;
  };
  const double mean = mean_over_points([](double x) { return x; });
  const double square = mean_over_points([](double x) { return x * x; });
  const double variance = mean_over_points([&](double x) { return (x - mean) * (x - mean); });
  double largest = -kLargestSeconds;
  double smallest = kLargestSeconds;
  for (const TimeErrorPiece& piece : series.pieces) {
    for (const double x : piece.x_s) {
      largest = std::max(largest, x);
      smallest = std::min(smallest, x);
    }
  }
  const std::vector<double> magnitudes = sorted_magnitudes(series);
  return {.max_te_ms = 1e3 * std::max(largest, -smallest),
          .rms_te_ms = 1e3 * std::sqrt(square),
          .constant_te_ms = 1e3 * mean,
          .dynamic_te_ms = 1e3 * std::sqrt(variance),
          .dynamic_te_p2p_ms = 1e3 * (largest - smallest),
          .p50_te_ms = 1e3 * quantile_of_sorted(magnitudes, 0.5),
          .p95_te_ms = 1e3 * quantile_of_sorted(magnitudes, 0.95),
          .p99_te_ms = 1e3 * quantile_of_sorted(magnitudes, 0.99),
          .p99_9_te_ms = 1e3 * quantile_of_sorted(magnitudes, 0.999)};
}

std::optional<double> share_within(const TimeErrorSeries& series, double limit_s) {
  check_series(series);
  const std::int64_t points = points_in(series);
  if (points == 0) return std::nullopt;
  std::int64_t within = 0;
  for (const TimeErrorPiece& piece : series.pieces) {
    within += std::count_if(piece.x_s.begin(), piece.x_s.end(),
                            [&](double x) { return std::abs(x) <= limit_s; });
  }
  return static_cast<double>(within) / static_cast<double>(points);
}

}  // namespace simbench::evaluation
