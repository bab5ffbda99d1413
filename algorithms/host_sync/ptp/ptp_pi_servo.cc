#include <algorithm>
#include <cmath>

#include "algorithms/host_sync/ptp/ptp_servo.h"

namespace simbench {
namespace {

constexpr double kProportionalExponent = -0.3;
constexpr double kIntegralExponent = 0.4;
constexpr double kProportionalMax = 0.7;
constexpr double kIntegralMax = 0.3;
constexpr double kEstimateOverIntegral = 0.016;
constexpr double kLongestEstimateS = 1000;

}  // namespace

PiServo::PiServo(Scales scales, ServoSettings settings)
    : settings_(settings),
      kp_(std::min(scales.kp * std::pow(settings.interval_s, kProportionalExponent),
                   kProportionalMax / settings.interval_s)),
      ki_(std::min(scales.ki * std::pow(settings.interval_s, kIntegralExponent),
                   kIntegralMax / settings.interval_s)) {}

ServoAnswer PiServo::sample(double offset_ns, std::int64_t local_ns, double weight) {
  if (phase_ == Phase::kRunning && settings_.step_threshold_ns > 0 &&
      std::abs(offset_ns) > settings_.step_threshold_ns) {
    phase_ = Phase::kEmpty;
  }
  if (phase_ == Phase::kEmpty) {
    first_offset_ns_ = offset_ns;
    first_local_ns_ = local_ns;
    phase_ = Phase::kOneSample;
    return {.ppb = drift_ppb_, .state = ServoState::kUnlocked};
  }
  if (phase_ == Phase::kOneSample) return first_frequency(offset_ns, local_ns);
  const double integral_ppb = ki_ * offset_ns * weight;
  const double ppb = kp_ * offset_ns * weight + drift_ppb_ + integral_ppb;
  const double limit = settings_.max_frequency_ppb;
  if (std::abs(ppb) > limit) {
    return {.ppb = std::copysign(limit, ppb), .state = ServoState::kLocked};
  }
  drift_ppb_ += integral_ppb;
  return {.ppb = ppb, .state = ServoState::kLocked};
}

ServoAnswer PiServo::first_frequency(double offset_ns, std::int64_t local_ns) {
  ServoAnswer answer{.ppb = drift_ppb_, .state = ServoState::kUnlocked};
  if (local_ns <= first_local_ns_) {
    phase_ = Phase::kEmpty;
    return answer;
  }
  const auto elapsed_ns = static_cast<double>(local_ns - first_local_ns_);
  const double needed_s = std::min(kEstimateOverIntegral / ki_, kLongestEstimateS);
  if (elapsed_ns < needed_s * 1e9) return answer;
  drift_ppb_ += (1e9 - drift_ppb_) * (offset_ns - first_offset_ns_) / elapsed_ns;
  drift_ppb_ = std::clamp(drift_ppb_, -settings_.max_frequency_ppb, settings_.max_frequency_ppb);
  const double step = is_first_update_ ? settings_.first_step_threshold_ns : 0;
  const bool is_far =
      (step > 0 && std::abs(offset_ns) > step) ||
      (settings_.step_threshold_ns > 0 && std::abs(offset_ns) > settings_.step_threshold_ns);
  is_first_update_ = false;
  phase_ = Phase::kRunning;
  return {.ppb = drift_ppb_, .state = is_far ? ServoState::kJump : ServoState::kLocked};
}

}  // namespace simbench
