// What chrony knows about its server: the last samples, and the line through them.
//
// A sample is an offset (server minus client), a round trip delay and a dispersion, in seconds, at
// a steady time. The client's clock is meant as if every correction had taken effect at once and
// had always been there: correct() tells of one, and moves all samples with it.
//
//  - Weights: distance = delay/2 + dispersion; sd = (median - minimum)/0.7, from the precision to
//    the minimum; w = (1 + max(0, distance - minimum - precision)/sd)^2, like a variance.
//  - Line: best_regression() (chrony_regression.h) over at most 64 samples; what the runs test
//    drops stays for the runs test. Skew: 99.95 % bound of the slope's error.
//  - Asymmetry: offset regressed on time and delay. A slope on the delay of 0.45 or more (all of
//    the extra delay in one direction is 0.5) for ten samples in a row is corrected:
//    offset - slope * (delay - minimum delay), the slope being at most 0.5.
//
// Complexity: O(n^2) a sample in the worst case, O(n) when no sample is dropped; n <= 64.
// Degenerate: fewer than three samples, or all at one time, have no estimate.
//
// Source: docs/reference/host_sync.md section 1 (chrony, sourcestats.c).
//
//   ChronySourceStats stats({});
//   if (stats.is_good(sample)) stats.add(sample);
//   if (stats.estimate()) stats.correct(now_s, stats.predict_s(now_s), 0);
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_SOURCE_STATS_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_SOURCE_STATS_H_

#include <cstddef>
#include <optional>
#include <vector>

namespace simbench {

struct ChronySample {
  double at_s = 0;
  double offset_s = 0;
  double delay_s = 0;
  double dispersion_s = 0;
};

struct ChronyStatsSettings {
  std::size_t min_samples = 6;  // the runs test leaves so many
  std::size_t max_samples = 64;
  double precision_s = 1e-7;
  double max_delay_ratio = 10;  // maxdelaydevratio
};

struct ChronyEstimate {
  double at_s = 0;      // of the last sample
  double offset_s = 0;  // then
  double offset_sd_s = 0;
  double frequency = 0;  // of the offset: what the client's clock lacks, as a fraction
  double skew = 0;       // bound of the frequency's error
  double sd_s = 0;       // of the samples
};

class ChronySourceStats {
 public:
  static constexpr double kMinAsymmetry = 0.45;
  static constexpr double kMaxAsymmetry = 0.5;
  static constexpr int kAsymmetryRun = 10;

  explicit ChronySourceStats(const ChronyStatsSettings& settings) : settings_(settings) {}

  // Whether the sample's delay, above the minimum, is within max_delay_ratio of the samples' sd, or
  // its offset is off by more than that delay explains: a change of the clock.
  bool is_good(const ChronySample& sample) const;

  // Samples must be finite; one that is not later than the last restarts the collection.
  void add(const ChronySample& sample);

  // The client's clock was advanced by `offset_s` and its rate by `frequency` at `at_s`.
  void correct(double at_s, double offset_s, double frequency);

  void reset();

  const std::optional<ChronyEstimate>& estimate() const { return estimate_; }
  // The offset that the estimate says for a time; 0 without one.
  double predict_s(double at_s) const;
  std::size_t samples() const { return samples_.size() - extra_; }
  double asymmetry() const { return asymmetry_; }

 private:
  double min_delay_s() const;
  std::vector<double> weights() const;
  void update_asymmetry();
  void regress();
  void drop_oldest(std::size_t count);

  ChronyStatsSettings settings_;
  std::vector<ChronySample> samples_;  // in order of time; the first `extra_` not in use
  std::size_t extra_ = 0;
  std::optional<ChronyEstimate> estimate_;
  double asymmetry_ = 0;
  int asymmetry_run_ = 0;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_CHRONY_CHRONY_SOURCE_STATS_H_
