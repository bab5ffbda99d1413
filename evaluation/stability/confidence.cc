#include "evaluation/stability/confidence.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <map>

#include "algorithms/ports/assert.h"
#include "evaluation/statistics/in_double.h"

namespace simbench::evaluation {
namespace {

// How a deviation is made of the phase.
struct Estimator {
  unsigned order = 2;  // of its differences
  bool modified = false;
  bool overlapping = true;
};

Estimator estimator_of(Deviation deviation) {
  SIMBENCH_ASSERT(deviation != Deviation::kMtie, "MTIE has no degrees of freedom");
  return {.order = deviation == Deviation::kHdev || deviation == Deviation::kHdevPlain ? 3U : 2U,
          .modified = deviation == Deviation::kMdev || deviation == Deviation::kTdev,
          .overlapping = deviation != Deviation::kAdevPlain && deviation != Deviation::kHdevPlain};
}

// The terms of a piece; 0 or less: none.
std::int64_t terms_of(const Estimator& estimator, std::int64_t points, std::int64_t m) {
  const std::int64_t reach = static_cast<std::int64_t>(estimator.order) * m;
  if (estimator.modified) return points - reach - m + 1;
  return estimator.overlapping ? points - reach : (points - 1 - reach + m) / m;
}

double binomial(unsigned n, unsigned k) {
  return boost::math::binomial_coefficient<double>(n, k, InDouble());
}

// The correlation of the terms of one estimator under one noise, up to a factor, over lags in units
// of tau. The names are those of the paper.
class TermCorrelation {
 public:
  // `filter`: samples that a term averages over tau, 1 for a modified variance; 0: their limit.
  TermCorrelation(NoiseType noise, unsigned order, double filter)
      : alpha_(static_cast<int>(noise)), order_(order), filter_(filter) {}

  double sz(double t) const {
    double sum = 0;
    const auto order = static_cast<int>(order_);
    for (int k = -order; k <= order; ++k) {
      const auto distance = static_cast<unsigned>(std::abs(k));
      const double weight = binomial(2 * order_, order_ - distance);
      sum += (distance % 2 == 0 ? weight : -weight) * sx(t + k);
    }
    return sum;
  }

 private:
  // The generalised autocovariance of the phase, of continuous time.
  static double sw(double t, int alpha) {
    t = std::abs(t);
    if (t == 0) return 0;
    switch (alpha) {
      case 2:
        return -t;
      case 1:
        return t * t * std::log(t);
      case 0:
        return t * t * t;
      case -1:
        return -t * t * t * t * std::log(t);
      default:
        return -t * t * t * t * t;
    }
  }
  double sx(double t) const {
    if (filter_ == 0) return sw(t, alpha_ + 2);
    const double step = 1 / filter_;
    return filter_ * filter_ * (2 * sw(t, alpha_) - sw(t - step, alpha_) - sw(t + step, alpha_));
  }

  int alpha_;
  unsigned order_;
  double filter_;
};

// White phase: only terms that share a point are correlated.
double white_phase_degrees(unsigned order, double terms, double length) {
  const double middle = binomial(2 * order, order);
  double sum = 1;
  for (unsigned k = 1; k <= order && k < length; ++k) {
    const double share = binomial(2 * order, order - k) / middle;
    sum += 2 * (1 - k / length) * share * share;
  }
  return terms / sum;
}

}  // namespace

double degrees_of_freedom(std::int64_t points, Deviation deviation, std::int64_t m,
                          NoiseType noise) {
  SIMBENCH_ASSERT(m >= 1, "an averaging time is at least one interval");
  const Estimator estimator = estimator_of(deviation);
  const auto terms = static_cast<double>(terms_of(estimator, points, m));
  SIMBENCH_ASSERT(terms >= 1, "a deviation without a term has no degrees of freedom");
  const auto factor = static_cast<double>(m);
  const double per_tau = estimator.overlapping ? factor : 1;
  if (noise == NoiseType::kWhitePm && !estimator.modified) {
    return white_phase_degrees(estimator.order, terms, terms / per_tau);
  }
  const double reach = estimator.order + 1;  // in tau; terms farther apart are hardly correlated
  const double lags = std::min(terms, reach * per_tau);
  const double scale = std::min(1.0, kMostLags / lags);
  double filter = 1;
  double filter_of_all = 1;  // of the variance itself, which under flicker phase keeps ln m
  if (!estimator.modified) {
    const bool limit = static_cast<int>(noise) <= 0 && factor * reach > kMostLags;
    filter = limit ? 0 : factor * scale;
    filter_of_all = limit ? 0 : factor;
  }
  const TermCorrelation correlation(noise, estimator.order, filter);
  const double scaled_terms = terms * scale;
  const auto steps = static_cast<int>(std::lround(lags * scale));
  const auto squared = [&](double step) {
    const double value = correlation.sz(step / (per_tau * scale));
    return value * value;
  };
  double sum = squared(0) + (1 - steps / scaled_terms) * squared(steps);
  for (int step = 1; step < steps; ++step) sum += 2 * (1 - step / scaled_terms) * squared(step);
  const double variance = TermCorrelation(noise, estimator.order, filter_of_all).sz(0);
  return scaled_terms * variance * variance / sum;
}

double degrees_of_freedom(const TimeErrorSeries& series, Deviation deviation, std::int64_t m,
                          NoiseType noise) {
  const Estimator estimator = estimator_of(deviation);
  std::map<std::int64_t, double> pieces_of_length;
  for (const TimeErrorPiece& piece : series.pieces) {
    const auto points = static_cast<std::int64_t>(piece.x_s.size());
    if (terms_of(estimator, points, m) >= 1) pieces_of_length[points] += 1;
  }
  SIMBENCH_ASSERT(!pieces_of_length.empty(),
                  "a deviation without a term has no degrees of freedom");
  double all_terms = 0;
  double variance = 0;
  for (const auto& [points, pieces] : pieces_of_length) {
    const auto terms = static_cast<double>(terms_of(estimator, points, m));
    all_terms += pieces * terms;
    variance += pieces * terms * terms / degrees_of_freedom(points, deviation, m, noise);
  }
  return all_terms * all_terms / variance;
}

Interval deviation_interval(double deviation, double degrees, double confidence) {
  const boost::math::chi_squared_distribution<double, InDouble> distribution(degrees);
  const double tail = (1 - confidence) / 2;
  return {deviation * std::sqrt(degrees / quantile(complement(distribution, tail))),
          deviation * std::sqrt(degrees / quantile(distribution, tail))};
}

}  // namespace simbench::evaluation
