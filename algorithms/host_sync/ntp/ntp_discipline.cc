#include "algorithms/host_sync/ntp/ntp_discipline.h"

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
  update_statistics(by_preference);
  const NtpSample& best = by_preference.front();
  if (is_missing(best)) return std::nullopt;
  const double change_s = std::abs(best.offset_s - best_offset_s_.value_or(best.offset_s));
  best_offset_s_ = best.offset_s;
  if (last_used_at_s_) {
    const double passed_s = best.at_s - *last_used_at_s_;
    const bool is_spike = change_s > kPopcornGate * jitter_s_ && passed_s < 2 * poll_interval_s &&
                          dispersion_s_ < kMaxDistance && best.dispersion_s < kMaxDistance;
    if (passed_s <= 0 || is_spike) return std::nullopt;
  }
  last_used_at_s_ = best.at_s;
  return best;
}

void NtpClockFilter::add_missing(double at_s) {
  shift_in({0, kMaxDispersion, kMaxDispersion, at_s});
  update_statistics(ordered(at_s));
}

void NtpClockFilter::reset() {
  stages_.fill({0, kMaxDispersion, kMaxDispersion, newest_s_});
  last_used_at_s_.reset();
  best_offset_s_.reset();
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

namespace {

double seconds_of_poll(int exponent) { return std::ldexp(1.0, exponent); }

// ntpd leaves the kernel's loop alone where an offset may be too large for it.
bool uses_kernel(const NtpDisciplineSettings& settings) {
  return settings.loop == NtpLoop::kKernel && settings.step_s > 0 &&
         settings.step_s <= NtpDiscipline::kKernelStep;
}

double within_limit(double frequency) {
  return std::clamp(frequency, -NtpDiscipline::kMaxFrequency, NtpDiscipline::kMaxFrequency);
}

}  // namespace

NtpDiscipline::NtpDiscipline(const NtpDisciplineSettings& settings)
    : settings_(settings),
      state_(settings.frequency ? NtpState::kFset : NtpState::kNset),
      frequency_(within_limit(settings.frequency.value_or(0))),
      poll_(settings.poll_min),
      jitter_s_(settings.precision_s) {
  if (uses_kernel(settings)) kernel_.emplace(0);
  if (kernel_) kernel_->set_frequency(frequency_);
}

NtpAction NtpDiscipline::update(double offset_s, double at_s) {
  SIMBENCH_ASSERT(std::isfinite(offset_s) && std::isfinite(at_s), "an offset must be finite");
  const double size_s = std::abs(offset_s);
  if (settings_.panic_s > 0 && size_s > settings_.panic_s) return NtpAction::kPanic;
  const bool is_large = settings_.step_s > 0 && size_s > settings_.step_s;
  return is_large ? update_large(offset_s, at_s) : update_small(offset_s, at_s);
}

NtpAction NtpDiscipline::update_large(double offset_s, double at_s) {
  const bool is_waiting = at_s - at_s_ < settings_.step_out_s;
  switch (state_) {
    case NtpState::kSync:
      state_ = NtpState::kSpik;
      return NtpAction::kIgnore;
    case NtpState::kSpik:
      return is_waiting ? NtpAction::kIgnore : step(at_s);
    case NtpState::kFreq:
      if (is_waiting) return NtpAction::kIgnore;
      measure_frequency(offset_s, at_s);
      return step(at_s);
    case NtpState::kNset:
    case NtpState::kFset:
      break;
  }
  return step(at_s);
}

NtpAction NtpDiscipline::update_small(double offset_s, double at_s) {
  const double floored_s = std::max(std::abs(offset_s - offset_s_), settings_.precision_s);
  jitter_s_ =
      std::sqrt(jitter_s_ * jitter_s_ + (floored_s * floored_s - jitter_s_ * jitter_s_) / kAverage);
  const double mu_s = at_s - at_s_;
  switch (state_) {
    case NtpState::kNset:
      lock(NtpState::kFreq, 0, at_s);
      return NtpAction::kSlew;
    case NtpState::kFreq:
      if (mu_s < settings_.step_out_s) return NtpAction::kIgnore;
      measure_frequency(offset_s, at_s);
      break;
    case NtpState::kFset:
    case NtpState::kSync:
    case NtpState::kSpik:
      break;
  }
  if (!kernel_ && !is_starting(at_s)) update_frequency(offset_s, at_s);
  lock(NtpState::kSync, offset_s, at_s);
  if (std::abs(offset_s) < kClampFloor) clamp_end_s_ = std::min(*clamp_end_s_, at_s);
  if (is_kernel_in_force(at_s)) {
    kernel_->update(offset_s, poll_, at_s);
    frequency_ = kernel_->frequency();
  }
  if (!is_starting(at_s)) adapt_poll(offset_s);
  return NtpAction::kAdjust;
}

void NtpDiscipline::update_frequency(double offset_s, double at_s) {
  const double mu_s = at_s - at_s_;
  if (poll_ >= kAllanPoll) {
    frequency_ += (offset_s - residual_s(at_s)) * kFllGain / std::max(poll_interval_s(), mu_s);
  }
  const double loop_s = 4 * kPllGain * poll_interval_s();
  frequency_ += offset_s * std::min(mu_s, seconds_of_poll(kAllanPoll)) / (loop_s * loop_s);
  frequency_ = within_limit(frequency_);
}

NtpAction NtpDiscipline::step(double at_s) {
  poll_ = settings_.poll_min;
  poll_counter_ = 0;
  jitter_s_ = settings_.precision_s;
  // Without a frequency it is measured next, with the phase where the step has put it.
  lock(state_ == NtpState::kNset ? NtpState::kFreq : NtpState::kSync, 0, at_s);
  if (is_kernel_in_force(at_s)) kernel_->update(0, poll_, at_s);
  return NtpAction::kStep;
}

void NtpDiscipline::lock(NtpState state, double offset_s, double at_s) {
  state_ = state;
  offset_s_ = offset_s;
  at_s_ = at_s;
  if (state == NtpState::kSync && !clamp_end_s_) clamp_end_s_ = at_s + settings_.step_out_s;
}

void NtpDiscipline::measure_frequency(double offset_s, double at_s) {
  frequency_ = within_limit(frequency_ + (offset_s - offset_s_) / (at_s - at_s_));
  if (kernel_) kernel_->set_frequency(frequency_);
}

void NtpDiscipline::adapt_poll(double offset_s) {
  if (std::abs(offset_s) < kPollGate * jitter_s_) {
    poll_counter_ += poll_;
    if (poll_counter_ > kPollLimit) move_poll(1);
  } else {
    poll_counter_ -= 2 * poll_;
    if (poll_counter_ < -kPollLimit) move_poll(-1);
  }
}

void NtpDiscipline::move_poll(int by) {
  const int moved = std::clamp(poll_ + by, settings_.poll_min, settings_.poll_max);
  poll_counter_ = moved == poll_ ? by * kPollLimit : 0;
  poll_ = moved;
}

double NtpDiscipline::poll_interval_s() const { return seconds_of_poll(poll_); }

double NtpDiscipline::time_constant_s() const {
  return kernel_ ? kernel_->time_constant_s() : kPllGain * poll_interval_s();
}

double NtpDiscipline::decay(double from_s, double to_s) const {
  const double clamped_s = std::max(std::min(to_s, clamp_end_s_.value_or(from_s)) - from_s, 0.0);
  // The kernel has not been told the offset of a clamp that ran out.
  const double looped = kernel_ ? 0 : (to_s - from_s - clamped_s) / time_constant_s();
  return clamped_s / kClampTime + looped;
}

double NtpDiscipline::residual_s(double at_s) const {
  if (is_kernel_in_force(at_s)) return kernel_->residual_s(at_s);
  return state_ == NtpState::kSync ? offset_s_ * std::exp(-decay(at_s_, at_s)) : 0;
}

double NtpDiscipline::phase_rate(double at_s) const {
  const double interval_s = poll_interval_s();
  if (is_kernel_in_force(at_s)) {
    return (kernel_->residual_s(at_s) - kernel_->residual_s(at_s + interval_s)) / interval_s;
  }
  const double part = -std::expm1(-decay(at_s, at_s + interval_s));
  const double rate = residual_s(at_s) * part / interval_s;
  const double limit = kMaxFrequency - std::abs(frequency_);
  return std::clamp(rate, -limit, limit);
}

}  // namespace simbench
