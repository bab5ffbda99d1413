#include "reconstruction/error_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "algorithms/ports/assert.h"

namespace simbench::reconstruction {

void ErrorStatistics::add(double distance_m) {
  SIMBENCH_ASSERT(std::isfinite(distance_m) && distance_m >= 0, "a distance");
  ++count_;
  sum_ += distance_m;
  sum_of_squares_ += distance_m * distance_m;
  const double bin = std::min(distance_m * kBinsPerMetre, static_cast<double>(kBins - 1));
  ++bins_[static_cast<std::size_t>(bin)];
}

void ErrorStatistics::merge(const ErrorStatistics& other) {
  count_ += other.count_;
  sum_ += other.sum_;
  sum_of_squares_ += other.sum_of_squares_;
  for (std::size_t bin = 0; bin < kBins; ++bin) bins_[bin] += other.bins_[bin];
}

double ErrorStatistics::quantile_m(double p) const {
  const double rank = p * static_cast<double>(count_);
  double below = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const auto here = static_cast<double>(bins_[bin]);
    if (here > 0 && below + here >= rank) {
      const double share = std::clamp((rank - below) / here, 0.0, 1.0);
      return (static_cast<double>(bin) + share) / kBinsPerMetre;
    }
    below += here;
  }
  return static_cast<double>(kBins) / kBinsPerMetre;
}

ErrorSummary ErrorStatistics::summary() const {
  if (count_ == 0) return {};
  constexpr double kCmPerMetre = 100;
  const auto n = static_cast<double>(count_);
  const double mean = sum_ / n;
  const double variance = std::max(0.0, sum_of_squares_ / n - mean * mean);
  return {.mean_cm = mean * kCmPerMetre,
          .std_cm = std::sqrt(variance) * kCmPerMetre,
          .median_cm = quantile_m(0.5) * kCmPerMetre,
          .p95_cm = quantile_m(0.95) * kCmPerMetre,
          .count = count_};
}

void SeedTally::add(const evaluation::ExposureSet& set, bool reconstructed,
                    const ErrorStatistics& errors) {
  ++(reconstructed ? counts_.sets : counts_.failed_sets);
  for (const auto& exposure : set.cameras) counts_.missing_frames += exposure ? 0 : 1;
  spread_ms_ += set.spread_ms();
  errors_.merge(errors);
}

SeedReprojection SeedTally::finish(std::uint64_t seed, bool gathered) const {
  SeedReprojection result = counts_;
  result.seed = seed;
  result.errors = errors_.summary();
  result.gathered = gathered;
  if (const std::int64_t all = result.sets + result.failed_sets; all > 0) {
    result.desync_ms = spread_ms_ / static_cast<double>(all);
  }
  return result;
}

}  // namespace simbench::reconstruction
