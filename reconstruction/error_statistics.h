// The distribution of many distances in little memory: mean, standard deviation and quantiles; and
// the errors of the frame sets of a seed, added up.
//
// Mean and standard deviation are exact; quantiles come from a histogram of 0.1 mm bins up to 10 m
// (farther distances count as 10 m) and are within half a bin. 0.8 MB, however many distances.
//
//   ErrorStatistics errors;
//   errors.add(0.012);                     // metres
//   errors.summary().mean_cm;              // 1.2
//
//   SeedTally tally;
//   tally.add(set, reconstructed, errors_of_the_set);   // each set
//   row.seeds.push_back(tally.finish(seed, gathered));
#pragma once

#include <cstdint>
#include <vector>

#include "evaluation/run/exposure_sets.h"
#include "reconstruction/results.h"

namespace simbench::reconstruction {

class ErrorStatistics {
 public:
  ErrorStatistics() : bins_(kBins) {}

  void add(double distance_m);  // finite, not negative
  void merge(const ErrorStatistics& other);
  // Everything NaN where nothing was added. The standard deviation is that of the population.
  ErrorSummary summary() const;

 private:
  static constexpr std::size_t kBins = 100'000;
  static constexpr double kBinsPerMetre = 10'000;

  double quantile_m(double p) const;

  std::int64_t count_ = 0;
  double sum_ = 0;
  double sum_of_squares_ = 0;
  std::vector<std::int64_t> bins_;
};

// Adds up the frame sets of one pipeline at one seed.
class SeedTally {
 public:
  void add(const evaluation::ExposureSet& set, bool reconstructed, const ErrorStatistics& errors);
  SeedReprojection finish(std::uint64_t seed, bool gathered) const;

 private:
  ErrorStatistics errors_;
  SeedReprojection counts_;
  double spread_ms_ = 0;
};

}  // namespace simbench::reconstruction
