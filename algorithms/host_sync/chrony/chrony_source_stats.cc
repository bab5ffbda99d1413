#include "algorithms/host_sync/chrony/chrony_source_stats.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "algorithms/ports/assert.h"
#include "laws/median.h"

namespace simbench {
namespace {

constexpr std::size_t kRunsRatio = 2;  // points of the runs test to points in use
constexpr std::size_t kMinRunsTest = 8;
constexpr double kRunsSignificance = 0.05;
constexpr std::size_t kTabulatedRuns = 129;  // twice 64 points, and none

// Sums of a weighted fit, about the weighted mean of x.
struct Moments {
  double weight = 0;
  double mean_x = 0;
  double mean_y = 0;
  double xx = 0;
  double xy = 0;
  double slope() const { return xy / xx; }
  double intercept() const { return mean_y - slope() * mean_x; }
};

std::vector<double> reliabilities(std::span<const double> w) {
  std::vector<double> inverse;
  inverse.reserve(w.size());
  for (const double weight : w) inverse.push_back(1 / weight);
  return inverse;
}

Moments moments(std::span<const double> x, std::span<const double> y,
                std::span<const double> reliability) {
  Moments sums;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sums.weight += reliability[i];
    sums.mean_x += x[i] * reliability[i];
    sums.mean_y += y[i] * reliability[i];
  }
  sums.mean_x /= sums.weight;
  sums.mean_y /= sums.weight;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double from_mean = x[i] - sums.mean_x;
    const double weighed = from_mean * reliability[i];
    sums.xx += from_mean * weighed;
    sums.xy += weighed * y[i];
  }
  return sums;
}

WeightedLine line_of(const Moments& sums, std::span<const double> x, std::span<const double> y,
                     std::span<const double> reliability) {
  WeightedLine line;
  line.slope = sums.slope();
  line.intercept = sums.intercept();
  double squares = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double residual = y[i] - line.intercept - line.slope * x[i];
    squares += residual * residual * reliability[i];
  }
  const auto n = static_cast<double>(x.size());
  const double unit_variance = squares / (n - 2);
  line.slope_sd = std::sqrt(unit_variance / sums.xx);
  const double lever = sums.mean_x * line.slope_sd;
  line.intercept_sd = std::sqrt(unit_variance / sums.weight + lever * lever);
  line.variance = unit_variance * n / sums.weight;
  return line;
}

int quantile_of_runs(std::size_t n) {
  // P(runs <= k) of 1 + Binomial(n - 1, 1/2), summed up to the first k where it exceeds 5 %.
  const auto trials = static_cast<double>(n - 1);
  double probability = std::exp2(-trials);
  double sum = 0;
  int runs = 1;
  while ((sum += probability) <= kRunsSignificance) {
    probability *= (trials - (runs - 1)) / runs;
    ++runs;
  }
  return runs;
}

// The number of runs of equal sign of y - intercept - slope * x; a zero is a run of its own.
int runs_of_residuals(std::span<const double> x, std::span<const double> y, double intercept,
                      double slope) {
  int runs = 0;
  double before = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double residual = y[i] - intercept - slope * x[i];
    const bool continues = (before > 0 && residual > 0) || (before < 0 && residual < 0);
    if (!continues) ++runs;
    before = residual;
  }
  return runs;
}

}  // namespace

std::optional<WeightedLine> weighted_regression(std::span<const double> x,
                                                std::span<const double> y,
                                                std::span<const double> w) {
  SIMBENCH_ASSERT(x.size() == y.size() && x.size() == w.size(), "as many x as y as w");
  if (x.size() < kChronyMinPoints) return std::nullopt;
  const std::vector<double> reliability = reliabilities(w);
  const Moments sums = moments(x, y, reliability);
  if (!(sums.xx > 0)) return std::nullopt;
  return line_of(sums, x, y, reliability);
}

std::optional<BestRegression> best_regression(std::span<const double> x, std::span<const double> y,
                                              std::span<const double> w, std::size_t extra,
                                              std::size_t min_samples) {
  SIMBENCH_ASSERT(x.size() == y.size() && x.size() == w.size() + extra, "as many x as y as w");
  const std::size_t n = w.size();
  const std::size_t fewest = std::max(min_samples, kChronyMinPoints);
  if (n < kChronyMinPoints) return std::nullopt;
  const std::vector<double> reliability = reliabilities(w);
  for (std::size_t start = 0;; ++start) {
    const std::size_t kept = n - start;
    const auto kept_x = x.last(kept);
    const auto kept_y = y.last(kept);
    const auto kept_reliability = std::span(reliability).last(kept);
    const Moments sums = moments(kept_x, kept_y, kept_reliability);
    if (!(sums.xx > 0)) return std::nullopt;
    const std::size_t tested = std::min(kept * kRunsRatio, n + extra);
    const int runs =
        runs_of_residuals(x.last(tested), y.last(tested), sums.intercept(), sums.slope());
    if (runs <= critical_runs(tested) && kept > fewest) continue;
    BestRegression best;
    best.line = line_of(sums, kept_x, kept_y, kept_reliability);
    best.start = start;
    best.runs = runs_of_residuals(kept_x, kept_y, best.line.intercept, best.line.slope);
    best.degrees_of_freedom = static_cast<int>(kept) - 2;
    return best;
  }
}

std::optional<double> second_slope(std::span<const double> a, std::span<const double> b,
                                   std::span<const double> y) {
  SIMBENCH_ASSERT(a.size() == b.size() && a.size() == y.size(), "as many a as b as y");
  if (a.size() < 4) return std::nullopt;
  const auto n = static_cast<double>(a.size());
  double mean_a = 0;
  double mean_b = 0;
  double mean_y = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    mean_a += a[i] / n;
    mean_b += b[i] / n;
    mean_y += y[i] / n;
  }
  double aa = 0;
  double ab = 0;
  double bb = 0;
  double ay = 0;
  double by = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double from_a = a[i] - mean_a;
    const double from_b = b[i] - mean_b;
    aa += from_a * from_a;
    ab += from_a * from_b;
    bb += from_b * from_b;
    ay += from_a * (y[i] - mean_y);
    by += from_b * (y[i] - mean_y);
  }
  const double determinant = aa * bb - ab * ab;
  // Rounding leaves about 1e-16 of the product.
  if (!(determinant > 1e-12 * aa * bb)) return std::nullopt;
  return (aa * by - ab * ay) / determinant;
}

int critical_runs(std::size_t n) {
  static const std::array<int, kTabulatedRuns> table_of_runs = [] {
    std::array<int, kTabulatedRuns> table{};
    for (std::size_t i = kMinRunsTest; i < table.size(); ++i) table[i] = quantile_of_runs(i);
    return table;
  }();
  return n < table_of_runs.size() ? table_of_runs[n] : quantile_of_runs(n);
}

double student_t_9995(int degrees_of_freedom) {
  SIMBENCH_ASSERT(degrees_of_freedom >= 1, "a quantile needs a degree of freedom");
  static constexpr std::array<double, 62> kQuantiles = {
      636.62, 31.599, 12.924, 8.6103, 6.8688, 5.9588, 5.4079, 5.0413, 4.7809, 4.5869, 4.437,
      4.3178, 4.2208, 4.1405, 4.0728, 4.015,  3.9651, 3.9216, 3.8834, 3.8495, 3.8193, 3.7921,
      3.7676, 3.7454, 3.7251, 3.7066, 3.6896, 3.6739, 3.6594, 3.646,  3.6335, 3.6218, 3.6109,
      3.6007, 3.5911, 3.5821, 3.5737, 3.5657, 3.5581, 3.551,  3.5442, 3.5377, 3.5316, 3.5258,
      3.5203, 3.515,  3.5099, 3.5051, 3.5004, 3.496,  3.4918, 3.4877, 3.4838, 3.48,   3.4764,
      3.4729, 3.4696, 3.4663, 3.4632, 3.4602, 3.4573, 3.4545};
  const auto index = static_cast<std::size_t>(degrees_of_freedom - 1);
  return kQuantiles[std::min(index, kQuantiles.size() - 1)];
}

namespace {

constexpr double kMedianToSd = 0.7;
constexpr double kMinSkew = 1e-12;
constexpr double kMaxSkew = 1e2;
constexpr double kMinDeviation = 1e-9;         // s
constexpr double kWorstFrequencyError = 2e-3;  // as a fraction
constexpr std::size_t kDelayTestSamples = 6;
constexpr double kEndlessDelay = std::numeric_limits<double>::infinity();

double distance(const ChronySample& sample) { return sample.delay_s / 2 + sample.dispersion_s; }

}  // namespace

bool ChronySourceStats::is_good(const ChronySample& sample) const {
  if (samples() < kDelayTestSamples || !estimate_) return true;
  const double elapsed_s = sample.at_s - estimate_->at_s;
  const double allowed_s = estimate_->sd_s * settings_.max_delay_ratio +
                           elapsed_s * (estimate_->skew + settings_.max_clock_error);
  const double increase_s = (sample.delay_s - min_delay_s()) / 2;
  if (increase_s <= allowed_s) return true;
  return std::abs(sample.offset_s - predict_s(sample.at_s)) - increase_s > allowed_s;
}

void ChronySourceStats::add(const ChronySample& sample) {
  SIMBENCH_ASSERT(std::isfinite(sample.at_s) && std::isfinite(sample.offset_s) &&
                      std::isfinite(sample.delay_s) && std::isfinite(sample.dispersion_s),
                  "a sample must be finite");
  if (samples() >= settings_.max_samples) drop_oldest(1);
  if (!samples_.empty() && sample.at_s <= samples_.back().at_s) reset();
  samples_.push_back(sample);
  min_delay_s_ = std::min(min_delay_s_, sample.delay_s);
  fill_columns();
  update_asymmetry();
  regress();
}

void ChronySourceStats::correct(double at_s, double offset_s, double frequency) {
  for (ChronySample& sample : samples_) {
    sample.offset_s -= offset_s + frequency * (sample.at_s - at_s);
  }
  if (!estimate_) return;
  estimate_->offset_s -= offset_s + frequency * (estimate_->at_s - at_s);
  estimate_->frequency -= frequency;
}

void ChronySourceStats::reset() {
  samples_.clear();
  extra_ = 0;
  min_delay_s_ = kEndlessDelay;
  estimate_.reset();
  asymmetry_ = 0;
  asymmetry_run_ = 0;
}

double ChronySourceStats::predict_s(double at_s) const {
  if (estimate_) return estimate_->offset_s + (at_s - estimate_->at_s) * estimate_->frequency;
  return samples_.empty() ? 0 : samples_.back().offset_s;
}

double ChronySourceStats::frequency_error() const {
  return estimate_ ? std::min(estimate_->skew, kWorstFrequencyError) : kWorstFrequencyError;
}

void ChronySourceStats::fill_columns() {
  const std::size_t n = samples_.size();
  columns_.time_s.resize(n);
  columns_.delay_s.resize(n);
  columns_.offset_s.resize(n);
  const double last_s = samples_.back().at_s;
  for (std::size_t i = 0; i < n; ++i) {
    columns_.time_s[i] = samples_[i].at_s - last_s;
    columns_.delay_s[i] = samples_[i].delay_s - min_delay_s_;
    columns_.offset_s[i] = samples_[i].offset_s;
  }
}

void ChronySourceStats::fill_weights() {
  std::vector<double>& values = columns_.weight;
  values.resize(samples());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = distance(samples_[extra_ + i]);
  const double least = *std::min_element(values.begin(), values.end());
  columns_.sorted = values;
  const double spread = std::min((median_in_place(columns_.sorted) - least) / kMedianToSd, least);
  const double sd = std::max(spread, settings_.precision_s);
  for (double& value : values) {
    const double factor = 1 + std::max(0.0, value - least - settings_.precision_s) / sd;
    value = factor * factor;
  }
}

void ChronySourceStats::update_asymmetry() {
  const std::optional<double> slope =
      second_slope(columns_.time_s, columns_.delay_s, columns_.offset_s);
  if (!slope || *slope * asymmetry_run_ < 0) {
    asymmetry_ = 0;
    asymmetry_run_ = 0;
    return;
  }
  if (*slope <= -kMinAsymmetry) asymmetry_run_ = std::max(asymmetry_run_ - 1, -kMaxAsymmetryRun);
  if (*slope >= kMinAsymmetry) asymmetry_run_ = std::min(asymmetry_run_ + 1, kMaxAsymmetryRun);
  if (std::abs(asymmetry_run_) < kMinAsymmetryRun) return;
  asymmetry_ = std::clamp(*slope, -kMaxAsymmetry, kMaxAsymmetry);
}

void ChronySourceStats::regress() {
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    columns_.offset_s[i] -= asymmetry_ * columns_.delay_s[i];
  }
  fill_weights();
  const auto best = best_regression(columns_.time_s, columns_.offset_s, columns_.weight, extra_,
                                    settings_.min_samples);
  if (!best) {
    estimate_.reset();
    return;
  }
  ChronyEstimate estimate;
  estimate.at_s = samples_.back().at_s;
  estimate.offset_s = best->line.intercept;
  estimate.offset_sd_s = best->line.intercept_sd;
  estimate.frequency = best->line.slope;
  estimate.skew = std::clamp(best->line.slope_sd * student_t_9995(best->degrees_of_freedom),
                             kMinSkew, kMaxSkew);
  estimate.sd_s = std::max(std::sqrt(best->line.variance), kMinDeviation);
  estimate_ = estimate;
  drop_oldest(best->start);
}

void ChronySourceStats::drop_oldest(std::size_t count) {
  extra_ += count;
  const std::size_t used = samples();
  if (extra_ <= used) return;
  samples_.erase(samples_.begin(), samples_.begin() + static_cast<std::ptrdiff_t>(extra_ - used));
  extra_ = used;
  min_delay_s_ = kEndlessDelay;
  for (const ChronySample& sample : samples_) min_delay_s_ = std::min(min_delay_s_, sample.delay_s);
}

}  // namespace simbench
