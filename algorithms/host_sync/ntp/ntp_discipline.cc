#include "algorithms/host_sync/ntp/ntp_discipline.h"

#include <algorithm>
#include <cmath>

#include "algorithms/ports/assert.h"

namespace simbench {
namespace {

double seconds_of_poll(int exponent) { return std::ldexp(1.0, exponent); }

double within_limit(double frequency) {
  return std::clamp(frequency, -NtpDiscipline::kMaxFrequency, NtpDiscipline::kMaxFrequency);
}

}  // namespace

NtpDiscipline::NtpDiscipline(const NtpDisciplineSettings& settings)
    : settings_(settings),
      state_(settings.frequency ? NtpState::kFset : NtpState::kNset),
      frequency_(within_limit(settings.frequency.value_or(0))),
      poll_(settings.poll_min),
      jitter_s_(settings.precision_s) {}

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
      break;
    case NtpState::kSync:
    case NtpState::kSpik:
      if (is_starting(at_s)) break;
      if (poll_ >= kAllanPoll) {
        frequency_ += (offset_s - residual_s(at_s)) * kFllGain / std::max(poll_interval_s(), mu_s);
      }
      const double loop_s = 4 * time_constant_s();
      frequency_ += offset_s * std::min(mu_s, seconds_of_poll(kAllanPoll)) / (loop_s * loop_s);
      break;
  }
  frequency_ = within_limit(frequency_);
  lock(NtpState::kSync, offset_s, at_s);
  if (!is_starting(at_s)) adapt_poll(offset_s);
  return NtpAction::kAdjust;
}

NtpAction NtpDiscipline::step(double at_s) {
  poll_ = settings_.poll_min;
  poll_counter_ = 0;
  jitter_s_ = settings_.precision_s;
  // Without a frequency it is measured next, with the phase where the step has put it.
  lock(state_ == NtpState::kNset ? NtpState::kFreq : NtpState::kSync, 0, at_s);
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

double NtpDiscipline::decay(double from_s, double to_s) const {
  const double clamped_s = std::max(std::min(to_s, clamp_end_s_.value_or(from_s)) - from_s, 0.0);
  return clamped_s / kClampTime + (to_s - from_s - clamped_s) / time_constant_s();
}

double NtpDiscipline::residual_s(double at_s) const {
  return state_ == NtpState::kSync ? offset_s_ * std::exp(-decay(at_s_, at_s)) : 0;
}

double NtpDiscipline::phase_rate(double at_s) const {
  const double part = -std::expm1(-decay(at_s, at_s + poll_interval_s()));
  const double rate = residual_s(at_s) * part / poll_interval_s();
  const double limit = kMaxFrequency - std::abs(frequency_);
  return std::clamp(rate, -limit, limit);
}

}  // namespace simbench
