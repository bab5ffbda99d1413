// What chrony estimates of its server: the last samples, and the line through them.
//
// Source: docs/reference/host_sync.md section 1 (chrony, sourcestats.c, regress.c); the quantile of
// the runs test is computed, not copied.
//
//   ChronySourceStats stats({});
//   if (stats.is_good(sample)) stats.add(sample);
//   if (stats.estimate()) stats.correct(now_s, stats.predict_s(now_s), 0);
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace simbench {

// The line fit: weighted least squares that drops old points until the residuals look random.
//
// Runs test: residuals of equal sign in a row are a run. A line that does not fit, because the
// clock's rate has changed, has few runs. For n independent signs the number of runs is 1 +
// Binomial(n - 1, 1/2); a fit with no more runs than its 5 % quantile is rejected, the oldest point
// is dropped and the fit repeated, until it passes or `min_samples` (at least 3) points are left.
// Fewer than 8 residuals are not tested.
//
// Weights act like variances: a large w makes a point count less; all must be > 0. x must not all
// be equal; times are usually given relative to the last, so the intercept is the present value.
//
// Complexity: a fit O(n), the whole O(n^2); n is at most 64 in use. The results are finite for
// finite input.
//
//   const auto fit = best_regression(x, y, w, extra, 3);  // x, y: `extra` older points first
//   if (fit) now_s = fit->line.intercept;
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

// The number of runs at or below which n residuals are rejected; 0 for n < 8.
int critical_runs(std::size_t n);

// Quantile 99.95 % of Student's t distribution; 62 degrees of freedom and more as 62.
double student_t_9995(int degrees_of_freedom);

// An offset (server minus client), a round trip delay and a dispersion at a steady time.
struct ChronySample {
  double at_s = 0;
  double offset_s = 0;
  double delay_s = 0;
  double dispersion_s = 0;
};

struct ChronyStatsSettings {
  std::size_t min_samples = 6;  // that the runs test leaves
  std::size_t max_samples = 64;
  double precision_s = 1e-7;
  double max_delay_ratio = 10;    // maxdelaydevratio
  double max_clock_error = 1e-6;  // maxclockerror, as a fraction
};

struct ChronyEstimate {
  double at_s = 0;      // of the last sample
  double offset_s = 0;  // then
  double offset_sd_s = 0;
  double frequency = 0;  // of the offset: by which the client's clock is slow, as a fraction
  double skew = 0;       // bound of the frequency's error
  double sd_s = 0;       // of the samples
};

// The client's clock is taken as if every correction had taken effect at once and had always been
// there: correct() reports one and moves all samples with it.
//
//  - Weights: distance = delay/2 + dispersion; sd = (median - minimum)/0.7, from the precision to
//    the minimum; w = (1 + max(0, distance - minimum - precision)/sd)^2, like a variance.
//  - Line: best_regression() over at most 64 samples; the dropped ones still serve its runs test.
//    Skew: 99.95 % bound of the slope's error.
//  - Asymmetry: offset regressed on time and delay, over all samples, the dropped ones too. A slope
//    on the delay of 0.45 or more (all of the extra delay in one direction is 0.5) adds one to a
//    count, up to 1000; a smaller one of the same sign leaves it, another sign begins anew. From a
//    count of ten on it is corrected: offset - slope * (delay - minimum delay), the slope being at
//    most 0.5. The minimum delay is that of all samples, the dropped ones too.
//
// Complexity: O(n^2) a sample in the worst case, O(n) when no sample is dropped; n <= 64.
// Degenerate: fewer than three samples, or all at one time, have no estimate.
class ChronySourceStats {
 public:
  static constexpr double kMinAsymmetry = 0.45;
  static constexpr double kMaxAsymmetry = 0.5;
  static constexpr int kMinAsymmetryRun = 10;
  static constexpr int kMaxAsymmetryRun = 1000;

  explicit ChronySourceStats(const ChronyStatsSettings& settings) : settings_(settings) {}

  // With six samples or more: whether half the sample's delay above the minimum is within
  // max_delay_ratio times the samples' sd and what the clock may have changed by (skew and
  // max_clock_error since the last sample), or its offset differs by more than that delay explains:
  // a change of the clock.
  bool is_good(const ChronySample& sample) const;

  // Samples must be finite; one that is not later than the last restarts the collection.
  void add(const ChronySample& sample);

  // The client's clock was advanced by `offset_s` and its rate by `frequency` at `at_s`.
  void correct(double at_s, double offset_s, double frequency);

  void reset();

  const std::optional<ChronyEstimate>& estimate() const { return estimate_; }
  // The estimated offset at a time; without an estimate that of the last sample, or 0.
  double predict_s(double at_s) const;
  // The least delay of the samples, the dropped ones too; infinite without any.
  double min_delay_s() const { return min_delay_s_; }
  // Bound of the frequency's error, as a fraction; at most 0.2 %, which it is without an estimate.
  double frequency_error() const;
  std::size_t samples() const { return samples_.size() - extra_; }
  double asymmetry() const { return asymmetry_; }

 private:
  // The samples in columns, as far as a fit needs them; allocated once.
  struct Columns {
    std::vector<double> time_s;   // since the last sample
    std::vector<double> delay_s;  // above the least
    std::vector<double> offset_s;
    std::vector<double> weight;
    std::vector<double> sorted;
  };

  void fill_columns();
  void fill_weights();
  void update_asymmetry();
  void regress();
  void drop_oldest(std::size_t count);

  ChronyStatsSettings settings_;
  std::vector<ChronySample> samples_;  // in order of time; the first `extra_` not in use
  std::size_t extra_ = 0;
  double min_delay_s_ = std::numeric_limits<double>::infinity();
  Columns columns_;
  std::optional<ChronyEstimate> estimate_;
  double asymmetry_ = 0;
  int asymmetry_run_ = 0;
};

}  // namespace simbench
