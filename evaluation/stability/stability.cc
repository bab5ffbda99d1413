#include "evaluation/stability/stability.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "algorithms/ports/assert.h"
#include "evaluation/stability/compensated_sum.h"
#include "evaluation/stability/confidence.h"

namespace simbench::evaluation {
namespace {

// The terms of all pieces.
struct Pooled {
  double sum = 0;  // of squares; of MTIE the largest range
  std::int64_t terms = 0;
};

// The inner differences of close numbers are exact, whatever their common offset.
double second_difference(const double* x, std::size_t m) {
  return (x[2 * m] - x[m]) - (x[m] - x[0]);
}
double third_difference(const double* x, std::size_t m) {
  return second_difference(x + m, m) - second_difference(x, m);
}

template <class Difference>
void add_squares(std::span<const double> x, std::size_t reach, std::size_t stride,
                 Difference difference, Pooled& pooled) {
  for (std::size_t i = 0; i + reach < x.size(); i += stride) {
    const double term = difference(x.data() + i);
    pooled.sum += term * term;
    ++pooled.terms;
  }
}

// Squares of the means over m second differences.
void add_modified(std::span<const double> x, std::size_t m, Pooled& pooled) {
  if (x.size() < 3 * m) return;
  CompensatedSum window;
  for (std::size_t i = 0; i < m; ++i) window.add(second_difference(x.data() + i, m));
  for (std::size_t first = 0;; ++first) {
    const double mean = window.value() / static_cast<double>(m);
    pooled.sum += mean * mean;
    ++pooled.terms;
    if (first + 3 * m == x.size()) return;
    window.add(second_difference(x.data() + first + m, m));
    window.add(-second_difference(x.data() + first, m));
  }
}

// Largest and smallest of every window of m + 1 points, for a growing m.
class Windows {
 public:
  explicit Windows(std::span<const double> x) : largest_(x.begin(), x.end()), smallest_(largest_) {}

  // Less than the number of points, and not less than before.
  void widen_to(std::size_t m) {
    while (m_ < m) {
      // Two windows that touch or overlap make a wider one.
      const std::size_t shift = std::min(std::max<std::size_t>(m_, 1), m - m_);
      const std::size_t left = largest_.size() - shift;
      for (std::size_t i = 0; i < left; ++i) {
        largest_[i] = std::max(largest_[i], largest_[i + shift]);
        smallest_[i] = std::min(smallest_[i], smallest_[i + shift]);
      }
      largest_.resize(left);
      smallest_.resize(left);
      m_ += shift;
    }
  }
  void add_to(Pooled& pooled) const {
    for (std::size_t i = 0; i < largest_.size(); ++i) {
      pooled.sum = std::max(pooled.sum, largest_[i] - smallest_[i]);
    }
    pooled.terms += static_cast<std::int64_t>(largest_.size());
  }

 private:
  std::vector<double> largest_;
  std::vector<double> smallest_;
  std::size_t m_ = 0;
};

void add_piece(std::span<const double> x, Deviation deviation, std::size_t m, Pooled& pooled) {
  const auto second = [m](const double* at) { return second_difference(at, m); };
  const auto third = [m](const double* at) { return third_difference(at, m); };
  switch (deviation) {
    case Deviation::kAdev:
      return add_squares(x, 2 * m, 1, second, pooled);
    case Deviation::kAdevPlain:
      return add_squares(x, 2 * m, m, second, pooled);
    case Deviation::kMdev:
    case Deviation::kTdev:
      return add_modified(x, m, pooled);
    case Deviation::kHdev:
      return add_squares(x, 3 * m, 1, third, pooled);
    case Deviation::kHdevPlain:
      return add_squares(x, 3 * m, m, third, pooled);
    case Deviation::kMtie:
      if (x.size() <= m) return;
      Windows windows(x);
      windows.widen_to(m);
      return windows.add_to(pooled);
  }
}

std::optional<StabilityPoint> point_of(const Pooled& pooled, Deviation deviation, double tau_s) {
  if (pooled.terms == 0) return std::nullopt;
  StabilityPoint point{.tau_s = tau_s, .value = pooled.sum, .terms = pooled.terms};
  if (deviation == Deviation::kMtie) return point;
  const double mean = pooled.sum / static_cast<double>(pooled.terms);
  const bool hadamard = deviation == Deviation::kHdev || deviation == Deviation::kHdevPlain;
  point.value = std::sqrt(mean / (hadamard ? 6 : 2)) / tau_s;
  if (deviation == Deviation::kTdev) point.value *= tau_s / std::sqrt(3.0);
  return point;
}

std::size_t longest_of(const TimeErrorSeries& series) {
  std::size_t longest = 0;
  for (const TimeErrorPiece& piece : series.pieces) longest = std::max(longest, piece.x_s.size());
  return longest;
}

// A piece's windows grow from octave to octave.
std::vector<StabilityPoint> mtie_over_octaves(const TimeErrorSeries& series) {
  std::vector<Pooled> octaves;
  for (const TimeErrorPiece& piece : series.pieces) {
    Windows windows(piece.x_s);
    std::size_t octave = 0;
    for (std::size_t m = 1; m < piece.x_s.size(); m *= 2, ++octave) {
      if (octave == octaves.size()) octaves.emplace_back();
      windows.widen_to(m);
      windows.add_to(octaves[octave]);
    }
  }
  std::vector<StabilityPoint> points;
  double tau_s = series.interval_s;
  for (const Pooled& pooled : octaves) {
    points.push_back(*point_of(pooled, Deviation::kMtie, tau_s));
    tau_s *= 2;
  }
  return points;
}

std::vector<StabilityPoint> in_ms(std::vector<StabilityPoint> points) {
  for (StabilityPoint& point : points) point.value *= 1e3;
  return points;
}

void add_certainty(const TimeErrorSeries& series, StabilityCurves& curves) {
  // No deviation reaches farther than ADEV.
  const std::vector<std::optional<NoiseType>> noises =
      noise_types_over_octaves(series, curves.adev.size());
  for (const ClockCurve& curve : clock_curves()) {
    if (curve.deviation == Deviation::kMtie) continue;
    std::int64_t m = 1;
    std::size_t octave = 0;
    for (StabilityPoint& point : curves.*curve.points) {
      const std::optional<NoiseType> noise = noises[octave++];
      if (noise && point.value > 0) {
        const double degrees = degrees_of_freedom(series, curve.deviation, m, *noise);
        const Interval interval = deviation_interval(point.value, degrees);
        point.certainty = {.low = interval.low,
                           .high = interval.high,
                           .noise = *noise,
                           .reliable = degrees >= kFewestDegrees};
      }
      m *= 2;
    }
  }
}

}  // namespace

std::optional<StabilityPoint> deviation_at(const TimeErrorSeries& series, Deviation deviation,
                                           std::int64_t m) {
  SIMBENCH_ASSERT(m >= 1, "an averaging time is at least one interval");
  check_series(series);
  if (static_cast<std::uint64_t>(m) > longest_of(series)) return std::nullopt;
  Pooled pooled;
  for (const TimeErrorPiece& piece : series.pieces) {
    add_piece(piece.x_s, deviation, static_cast<std::size_t>(m), pooled);
  }
  return point_of(pooled, deviation, static_cast<double>(m) * series.interval_s);
}

std::vector<StabilityPoint> deviation_over_octaves(const TimeErrorSeries& series,
                                                   Deviation deviation) {
  check_series(series);
  if (deviation == Deviation::kMtie) return mtie_over_octaves(series);
  std::vector<StabilityPoint> points;
  for (std::int64_t m = 1;; m *= 2) {
    const std::optional<StabilityPoint> point = deviation_at(series, deviation, m);
    if (!point) return points;
    points.push_back(*point);
  }
}

StabilityCurves stability_curves(const TimeErrorSeries& series) {
  StabilityCurves curves{.adev = deviation_over_octaves(series, Deviation::kAdev),
                         .mdev = deviation_over_octaves(series, Deviation::kMdev),
                         .hdev = deviation_over_octaves(series, Deviation::kHdev),
                         .mtie_ms = in_ms(deviation_over_octaves(series, Deviation::kMtie))};
  curves.tdev_ms = curves.mdev;
  for (StabilityPoint& point : curves.tdev_ms) point.value *= 1e3 * point.tau_s / std::sqrt(3.0);
  return curves;
}

Stability stability_of(TimeErrorSeries series) {
  Stability stability;
  static_cast<StabilityCurves&>(stability) = stability_curves(series);
  add_certainty(series, stability);
  stability.interval_s = series.interval_s;
  stability.points = points_in(series);
  for (const TimeErrorPiece& piece : series.pieces) stability.pieces += piece.x_s.empty() ? 0 : 1;
  stability.time_error = time_error_of(series);
  stability.steps = steps_of(series);
  stability.series = std::move(series);
  return stability;
}

}  // namespace simbench::evaluation
