#include "algorithms/host_sync/ntp/ntp_clock_filter.h"

#include <algorithm>
#include <cmath>

#include "algorithms/ports/assert.h"

namespace simbench {
namespace {

bool is_missing(const NtpSample& stage) {
  return stage.dispersion_s >= NtpClockFilter::kMaxDispersion;
}

double preference(const NtpSample& stage, double now_s) {
  if (is_missing(stage)) return NtpClockFilter::kMaxDispersion;
  const bool is_old = now_s - stage.at_s > NtpClockFilter::kAllanIntercept;
  return is_old ? stage.delay_s + stage.dispersion_s : stage.delay_s;
}

}  // namespace

std::optional<NtpSample> NtpClockFilter::add(const NtpSample& sample, double poll_interval_s,
                                             bool is_starting) {
  SIMBENCH_ASSERT(std::isfinite(sample.offset_s) && std::isfinite(sample.delay_s) &&
                      std::isfinite(sample.dispersion_s) && std::isfinite(sample.at_s),
                  "a sample must be finite");
  NtpSample floored = sample;
  floored.delay_s = std::max(sample.delay_s, precision_s_);
  floored.dispersion_s = std::clamp(sample.dispersion_s, 0.0, kMaxDispersion);
  shift_in(floored);
  const auto by_preference = is_starting ? stages_ : ordered(sample.at_s);
  const double jitter_before_s = jitter_s_;
  const bool was_settled = dispersion_s_ < kMaxDistance;
  update_statistics(by_preference);
  const NtpSample& best = by_preference.front();
  if (is_missing(best)) return std::nullopt;
  if (last_used_) {
    if (best.at_s <= last_used_->at_s) return std::nullopt;
    const bool is_soon = best.at_s - last_used_->at_s < 2 * poll_interval_s;
    const double change_s = std::abs(best.offset_s - last_used_->offset_s);
    if (was_settled && is_soon && change_s > kPopcornGate * jitter_before_s) return std::nullopt;
  }
  last_used_ = best;
  return best;
}

void NtpClockFilter::add_missing(double at_s) {
  shift_in({0, kMaxDispersion, kMaxDispersion, at_s});
  update_statistics(ordered(at_s));
}

void NtpClockFilter::reset() {
  stages_.fill({0, kMaxDispersion, kMaxDispersion, newest_s_});
  last_used_.reset();
  jitter_s_ = precision_s_;
  dispersion_s_ = kMaxDispersion;
  best_delay_s_ = kMaxDispersion;
}

double NtpClockFilter::distance_s() const { return best_delay_s_ / 2 + dispersion_s_ + jitter_s_; }

void NtpClockFilter::shift_in(const NtpSample& stage) {
  const double grown_s = kDispersionGrowth * std::max(stage.at_s - newest_s_, 0.0);
  for (NtpSample& each : stages_) {
    each.dispersion_s = std::min(each.dispersion_s + grown_s, kMaxDispersion);
  }
  std::rotate(stages_.begin(), stages_.end() - 1, stages_.end());
  stages_.front() = stage;
  newest_s_ = stage.at_s;
}

std::array<NtpSample, NtpClockFilter::kStages> NtpClockFilter::ordered(double now_s) const {
  auto sorted = stages_;
  // Newest first among equals.
  std::stable_sort(sorted.begin(), sorted.end(), [now_s](const NtpSample& a, const NtpSample& b) {
    return preference(a, now_s) < preference(b, now_s);
  });
  return sorted;
}

void NtpClockFilter::update_statistics(const std::array<NtpSample, kStages>& by_delay) {
  dispersion_s_ = 0;
  double squares = 0;
  int others = 0;
  double weight = 0.5;
  for (const NtpSample& stage : by_delay) {
    dispersion_s_ += stage.dispersion_s * weight;
    weight /= 2;
    if (is_missing(stage)) continue;
    const double difference_s = stage.offset_s - by_delay.front().offset_s;
    squares += difference_s * difference_s;
    ++others;
  }
  --others;  // the best itself
  jitter_s_ = others > 0 ? std::max(std::sqrt(squares / others), precision_s_) : precision_s_;
  best_delay_s_ = by_delay.front().delay_s;
}

}  // namespace simbench
