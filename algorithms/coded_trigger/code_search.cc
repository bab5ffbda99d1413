#include "algorithms/coded_trigger/code_search.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "laws/saturate.h"

namespace simbench {
namespace {

// Standard deviations that count as possible.
constexpr double kWidth = 8;
// Sums over slots further from zero lose digits.
constexpr std::int64_t kMostSlots = 100'000;
// Another place must leave so much more, in squares of what may pass for a pulse.
constexpr double kWrongFramesBehind = 1.25;
// A longer gap begins anew: the rate of the camera's clock is not known yet.
constexpr std::int64_t kLongestSearchGap = 32;

const char* const kCodeSource = "docs/coded_trigger.md section 4";

}  // namespace

void CodeDecoderSettings::bind(ParameterBinder& parameters) {
  parameters.number("noise_us", noise.noise_us, 0.1, 1e4,
                    "noise of a sensor stamp against its pulse, standard deviation",
                    "trigger jitter below 10 us (librealsense #14957), stamps of 1 us");
  parameters.number("rate_error_ppm", noise.rate_error_ppm, 0.1, 1000,
                    "rate of a camera's clock against the trigger's, standard deviation",
                    "75 ppm typical (realsense-ros #639)");
  parameters.number("lost_share", noise.lost_share, 1e-4, 0.5,
                    "of frames, in codes that leave pulses out", kCodeSource);
  parameters.number("error_probability", error_probability, 1e-15, 0.1,
                    "that a camera takes a wrong place in the code for its own", kCodeSource);
}

double smallest_step_us(const TriggerCode& code) {
  const std::set<std::int32_t> shifts(code.shifts_ns().begin(), code.shifts_ns().end());
  double step_us = 0;
  for (auto next = shifts.begin(), last = next++; next != shifts.end(); last = next++) {
    const double us = static_cast<double>(std::int64_t{*next} - *last) * 1e-3;
    step_us = step_us == 0 ? us : std::min(step_us, us);
  }
  return step_us;
}

double most_noise_us(const TriggerCode& code, const CodeDecoderSettings& settings) {
  constexpr double kStepsPerNoise = 6;
  const double step_us = smallest_step_us(code);
  return step_us > 0 ? step_us / kStepsPerNoise : kWidth * settings.noise.noise_us;
}

CodeSearch::CodeSearch(std::shared_ptr<const CodedPulses> pulses,
                       const CodeDecoderSettings& settings)
    : pulses_(std::move(pulses)),
      error_probability_(settings.error_probability),
      least_evidence_nats_(
          std::log(static_cast<double>(pulses_->code.length()) / settings.error_probability)),
      most_noise_us_(most_noise_us(pulses_->code, settings)),
      most_step_us_(to_ns(pulses_->code.range()) * 1e-3 + kWidth * settings.noise.noise_us),
      most_rate_us_(kWidth * settings.noise.rate_error_ppm * 1e-6 * to_ns(pulses_->code.period()) *
                    1e-3),
      correlator_(pulses_->code, settings.noise) {
  // Codes that only leave pulses out have no shifts that a wrong stamp could be taken for.
  const bool has_shifts = smallest_step_us(pulses_->code) > 0;
  if (has_shifts) least_squares_behind_ = kWrongFramesBehind * most_step_us_ * most_step_us_;
  points_.reserve(kMostHeld);
}

void CodeSearch::clear() {
  points_.clear();
  if (correlator_.points() > 0) correlator_.clear();
}

std::uint32_t CodeSearch::begin_anew(std::int64_t at_ns) {
  const auto given_up = static_cast<std::uint32_t>(points_.size());
  clear();
  points_.push_back({});
  newest_at_ns_ = at_ns;
  return given_up;
}

void CodeSearch::give_up_oldest() {
  const Point oldest = points_.front();
  points_.erase(points_.begin());
  correlator_.remove(oldest.slot, oldest.residual_us);
  for (std::int64_t slot = oldest.slot + 1; slot < points_.front().slot; ++slot) {
    correlator_.remove_absent(slot);
  }
}

bool CodeSearch::is_like_a_pulse(std::int64_t slots, double step_us) const {
  if (slots < 1 || slots > kLongestSearchGap) return false;
  return std::abs(step_us) <= most_step_us_ + most_rate_us_ * static_cast<double>(slots);
}

bool CodeSearch::is_sure() const {
  // sqrt(2 pi e)
  constexpr double kWidthOfNoise = 4.132731354122493;
  const double gain_nats = std::log(2 * most_step_us_ / (kWidthOfNoise * verdict_.noise_us));
  return verdict_.error_probability <= error_probability_ &&
         verdict_.squares_behind >= least_squares_behind_ &&
         static_cast<double>(points_.size() - 2) * gain_nats >= least_evidence_nats_;
}

// What the correlator does not have yet.
void CodeSearch::correlate() {
  for (std::size_t i = correlator_.points(); i < points_.size(); ++i) {
    for (std::int64_t slot = i > 0 ? points_[i - 1].slot + 1 : points_[i].slot;
         slot < points_[i].slot; ++slot) {
      correlator_.add_absent(slot);
    }
    correlator_.add(points_[i].slot, points_[i].residual_us);
  }
}

CodeSearch::Outcome CodeSearch::add(std::int64_t at_ns) {
  if (points_.empty()) return {begin_anew(at_ns)};
  const std::int64_t period_ns = pulses_->code.period().count();
  const std::int64_t elapsed_ns = at_ns - newest_at_ns_;
  const std::int64_t slots =
      saturate_round(static_cast<double>(elapsed_ns) / static_cast<double>(period_ns));
  const double step_us = static_cast<double>(Int128{elapsed_ns} - Int128{slots} * period_ns) * 1e-3;
  const Point last = points_.back();
  if (!is_like_a_pulse(slots, step_us) || last.slot > kMostSlots) return {begin_anew(at_ns)};
  points_.push_back({.slot = last.slot + slots, .residual_us = last.residual_us + step_us});
  newest_at_ns_ = at_ns;
  if (points_.size() < kFirstLook) return {};
  correlate();
  Outcome outcome;
  for (verdict_ = correlator_.judge(); verdict_.noise_us > most_noise_us_;
       verdict_ = correlator_.judge()) {
    give_up_oldest();
    ++outcome.given_up;
    if (points_.size() < kFirstLook) return outcome;
  }
  outcome.is_found = is_sure();
  if (!outcome.is_found && points_.size() == kMostHeld) {
    give_up_oldest();
    ++outcome.given_up;
  }
  return outcome;
}

}  // namespace simbench
