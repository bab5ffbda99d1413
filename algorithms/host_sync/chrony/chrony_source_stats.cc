#include "algorithms/host_sync/chrony/chrony_source_stats.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "algorithms/host_sync/chrony/chrony_regression.h"
#include "algorithms/ports/assert.h"

namespace simbench {
namespace {

constexpr double kMedianToSd = 0.7;
constexpr double kMinSkew = 1e-12;
constexpr double kMaxSkew = 1e2;

double distance(const ChronySample& sample) { return sample.delay_s / 2 + sample.dispersion_s; }

}  // namespace

bool ChronySourceStats::is_good(const ChronySample& sample) const {
  if (samples() < kChronyMinPoints || !estimate_) return true;
  const double elapsed_s = std::max(sample.at_s - estimate_->at_s, 0.0);
  const double allowed_s =
      estimate_->sd_s * settings_.max_delay_ratio + elapsed_s * estimate_->skew;
  const double increase_s = (sample.delay_s - min_delay_s()) / 2;
  if (increase_s < allowed_s) return true;
  return std::abs(sample.offset_s - predict_s(sample.at_s)) - increase_s > allowed_s;
}

void ChronySourceStats::add(const ChronySample& sample) {
  SIMBENCH_ASSERT(std::isfinite(sample.at_s) && std::isfinite(sample.offset_s) &&
                      std::isfinite(sample.delay_s) && std::isfinite(sample.dispersion_s),
                  "a sample must be finite");
  if (!samples_.empty() && sample.at_s <= samples_.back().at_s) reset();
  samples_.push_back(sample);
  if (samples() > settings_.max_samples) drop_oldest(1);
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
  estimate_.reset();
  asymmetry_ = 0;
  asymmetry_run_ = 0;
}

double ChronySourceStats::predict_s(double at_s) const {
  return estimate_ ? estimate_->offset_s + (at_s - estimate_->at_s) * estimate_->frequency : 0;
}

double ChronySourceStats::min_delay_s() const {
  const auto used = std::span(samples_).subspan(extra_);
  return std::min_element(used.begin(), used.end(),
                          [](const auto& a, const auto& b) { return a.delay_s < b.delay_s; })
      ->delay_s;
}

std::vector<double> ChronySourceStats::weights() const {
  std::vector<double> values;
  for (const ChronySample& sample : std::span(samples_).subspan(extra_)) {
    values.push_back(distance(sample));
  }
  const double least = *std::min_element(values.begin(), values.end());
  const double spread = std::min((median(values) - least) / kMedianToSd, least);
  const double sd = std::max(spread, settings_.precision_s);
  for (double& value : values) {
    const double factor = 1 + std::max(0.0, value - least - settings_.precision_s) / sd;
    value = factor * factor;
  }
  return values;
}

void ChronySourceStats::update_asymmetry() {
  std::vector<double> time;
  std::vector<double> delay;
  std::vector<double> offset;
  for (const ChronySample& sample : std::span(samples_).subspan(extra_)) {
    time.push_back(sample.at_s - samples_.back().at_s);
    delay.push_back(sample.delay_s);
    offset.push_back(sample.offset_s);
  }
  const double slope = second_slope(time, delay, offset).value_or(0);
  asymmetry_run_ = std::abs(slope) >= kMinAsymmetry ? asymmetry_run_ + 1 : 0;
  asymmetry_ =
      asymmetry_run_ > kAsymmetryRun ? std::clamp(slope, -kMaxAsymmetry, kMaxAsymmetry) : 0;
}

void ChronySourceStats::regress() {
  const double last_s = samples_.back().at_s;
  const double least_s = min_delay_s();
  std::vector<double> time;
  std::vector<double> offset;
  for (const ChronySample& sample : samples_) {
    time.push_back(sample.at_s - last_s);
    offset.push_back(sample.offset_s - asymmetry_ * (sample.delay_s - least_s));
  }
  const auto best = best_regression(time, offset, weights(), extra_, settings_.min_samples);
  if (!best) {
    estimate_.reset();
    return;
  }
  ChronyEstimate estimate;
  estimate.at_s = last_s;
  estimate.offset_s = best->line.intercept;
  estimate.offset_sd_s = best->line.intercept_sd;
  estimate.frequency = best->line.slope;
  estimate.skew = std::clamp(best->line.slope_sd * student_t_9995(best->degrees_of_freedom),
                             kMinSkew, kMaxSkew);
  estimate.sd_s = std::max(std::sqrt(best->line.variance), settings_.precision_s);
  estimate_ = estimate;
  drop_oldest(best->start);
}

void ChronySourceStats::drop_oldest(std::size_t count) {
  extra_ += count;
  const std::size_t used = samples();
  if (extra_ <= used) return;
  samples_.erase(samples_.begin(), samples_.begin() + static_cast<std::ptrdiff_t>(extra_ - used));
  extra_ = used;
}

}  // namespace simbench
