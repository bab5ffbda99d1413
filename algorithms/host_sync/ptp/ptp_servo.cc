#include "algorithms/host_sync/ptp/ptp_servo.h"

#include <algorithm>
#include <cmath>

namespace simbench {
namespace {

constexpr double kEstimateOverIntegral = 0.016;
constexpr double kLongestEstimateS = 1000;
// A sample that comes a little early is late enough.
constexpr double kEstimateMargin = 1.001;

}  // namespace

PiServo::PiServo(PiScales scales, ServoSettings settings)
    : settings_(settings),
      kp_(std::min(scales.kp * std::pow(settings.interval_s, scales.kp_exponent),
                   scales.kp_limit / settings.interval_s)),
      ki_(std::min(scales.ki * std::pow(settings.interval_s, scales.ki_exponent),
                   scales.ki_limit / settings.interval_s)) {}

double PiServo::first_frequency_s() const {
  return std::min(kEstimateOverIntegral / ki_, kLongestEstimateS);
}

ServoAnswer PiServo::sample(double offset_ns, std::int64_t local_ns, double weight) {
  if (phase_ == Phase::kRunning && settings_.step_threshold_ns > 0 &&
      std::abs(offset_ns) > settings_.step_threshold_ns) {
    phase_ = Phase::kEmpty;
    return {.ppb = drift_ppb_, .state = ServoState::kUnlocked};
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

void PiServo::forget() {
  phase_ = Phase::kEmpty;
  drift_ppb_ = 0;
}

ServoAnswer PiServo::first_frequency(double offset_ns, std::int64_t local_ns) {
  ServoAnswer answer{.ppb = drift_ppb_, .state = ServoState::kUnlocked};
  if (local_ns <= first_local_ns_) {
    phase_ = Phase::kEmpty;
    return answer;
  }
  const auto elapsed_ns = static_cast<double>(local_ns - first_local_ns_);
  if (elapsed_ns * kEstimateMargin < first_frequency_s() * 1e9) return answer;
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

namespace {

constexpr double kErrorSmoothing = 0.02;
constexpr int kErrorUpdates = 10;
constexpr double kErrorMargin = 1.05;
// Windows up to 2^4 samples are corrected within one interval.
constexpr int kWindowOfOneInterval = 4;

}  // namespace

void LinearRegressionServo::restart() {
  points_.clear();
  fits_ = {};
  window_ = 0;
  has_local_ = false;
}

// Moves the point at which the fits are evaluated, as both clocks have advanced by these.
void LinearRegressionServo::move(std::int64_t oscillator_ns, std::int64_t local_ns) {
  now_.oscillator_ns += oscillator_ns;
  now_.reference_ns += local_ns;
  for (Fit& fit : fits_) {
    fit.intercept_ns +=
        static_cast<double>(oscillator_ns) * fit.slope - static_cast<double>(local_ns);
  }
}

void LinearRegressionServo::advance_to(std::int64_t local_ns) {
  if (has_local_) {
    const std::int64_t local = local_ns - last_local_ns_;
    const double ratio = 1 + frequency_ppb_ / 1e9;
    const double oscillator = static_cast<double>(local) / ratio + oscillator_part_ns_;
    const double whole = std::floor(oscillator);
    oscillator_part_ns_ = oscillator - whole;
    move(static_cast<std::int64_t>(whole), local);
  }
  has_local_ = true;
  last_local_ns_ = local_ns;
}

void LinearRegressionServo::fit_all() {
  double x_sum = 0;
  double y_sum = 0;
  double xy_sum = 0;
  double xx_sum = 0;
  double w_sum = 0;
  std::size_t taken = 0;
  const auto newest_ns = static_cast<double>(points_.front().reference_ns - now_.reference_ns);
  for (int window = kSmallest; window <= kLargest; ++window) {
    const std::size_t count = std::size_t{1} << window;
    if (count > points_.size()) break;
    Fit& result = fit(window);
    if (result.slope != 0) {
      const double error_ns = std::abs(result.intercept_ns - newest_ns);
      if (result.errors < kErrorUpdates) {
        result.error_ns = (result.error_ns * result.errors + error_ns) / (result.errors + 1);
        ++result.errors;
      } else {
        result.error_ns += kErrorSmoothing * (error_ns - result.error_ns);
      }
    }
    for (; taken < count; ++taken) {
      const Point& point = points_[taken];
      const auto x = static_cast<double>(point.oscillator_ns - now_.oscillator_ns);
      const auto y = static_cast<double>(point.reference_ns - now_.reference_ns);
      x_sum += x * point.weight;
      y_sum += y * point.weight;
      xy_sum += x * y * point.weight;
      xx_sum += x * x * point.weight;
      w_sum += point.weight;
    }
    result.slope = (xy_sum - x_sum * y_sum / w_sum) / (xx_sum - x_sum * x_sum / w_sum);
    result.intercept_ns = (y_sum - result.slope * x_sum) / w_sum;
  }
}

void LinearRegressionServo::choose_window() {
  int chosen = 0;
  double error_ns = 0;
  for (int window = kSmallest; window <= kLargest; ++window) {
    const Fit& candidate = fit(window);
    const bool is_only = chosen == 0 && candidate.slope != 0;
    const bool is_better =
        candidate.errors >= kErrorUpdates && error_ns * kErrorMargin > candidate.error_ns;
    if (!is_only && !is_better) continue;
    chosen = window;
    error_ns = candidate.error_ns;
  }
  window_ = chosen;
}

ServoAnswer LinearRegressionServo::sample(double offset_ns, std::int64_t local_ns, double weight) {
  // A clock that stood still or went back fits no line.
  if (has_local_ && local_ns <= last_local_ns_) restart();
  advance_to(local_ns);
  points_.push_front({.oscillator_ns = now_.oscillator_ns,
                      .reference_ns = now_.reference_ns - std::llround(offset_ns),
                      .weight = weight});
  if (points_.size() > (std::size_t{1} << kLargest)) points_.pop_back();
  fit_all();
  choose_window();
  if (window_ == 0) return {.ppb = -frequency_ppb_, .state = ServoState::kUnlocked};
  Fit& chosen = fit(window_);
  const double residual_ns = std::abs(chosen.intercept_ns);
  const double first_step_ns = is_first_update_ ? settings_.first_step_threshold_ns : 0;
  const bool is_far =
      (first_step_ns > 0 && residual_ns > first_step_ns) ||
      (settings_.step_threshold_ns > 0 && residual_ns > settings_.step_threshold_ns);
  is_first_update_ = false;
  if (is_far) {
    const std::int64_t step_ns = -std::llround(offset_ns);
    move(0, step_ns);
    last_local_ns_ += step_ns;
  }
  const int intervals = window_ <= kWindowOfOneInterval ? 1 : window_ / 2;
  frequency_ppb_ = 1e9 * (chosen.slope - 1);
  frequency_ppb_ += chosen.intercept_ns / settings_.interval_s / intervals;
  frequency_ppb_ =
      std::clamp(frequency_ppb_, -settings_.max_frequency_ppb, settings_.max_frequency_ppb);
  rate_ratio_ = chosen.slope / (1 + frequency_ppb_ / 1e9);
  return {.ppb = -frequency_ppb_, .state = is_far ? ServoState::kJump : ServoState::kLocked};
}

void ServoSettings::bind_first_step(ParameterBinder& parameters, const char* source) {
  parameters.scaled("first_step_threshold_us", first_step_threshold_ns, 1e3, 0, 1e12,
                    "the first correction is a step above this; 0: never", source);
}

void ServoSettings::bind_max_frequency(ParameterBinder& parameters, const char* source) {
  parameters.scaled("max_frequency_ppm", max_frequency_ppb, 1e3, 1, 9e5,
                    "largest correction of a frequency, and no more than the clock takes: the "
                    "system clock 10 %, a card what its driver states",
                    source);
}

}  // namespace simbench
