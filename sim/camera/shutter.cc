#include "sim/camera/shutter.h"

#include <algorithm>
#include <cmath>

namespace simbench::sim {

Shutter::Shutter(const ShutterSettings& settings, TrueTime start)
    : settings_(settings), start_(start), last_pulse_(start), ignore_until_(start) {
  if (settings.mode == ShutterMode::kFreeRunning) next_timer_ = start;
  if (settings.mode == ShutterMode::kSlave) {
    next_timer_ = start + periods(settings.free_run_after_periods);
  }
  free_run_origin_ = next_timer_;
}

Nanoseconds Shutter::periods(double count) const {
  return from_ns(count * settings_.mode_period_ns);
}

std::int64_t Shutter::periods_of_exposure() const {
  const double of_exposure =
      static_cast<double>(settings_.exposure.count()) / settings_.mode_period_ns;
  return std::max<std::int64_t>(static_cast<std::int64_t>(std::ceil(of_exposure)), 1);
}

Exposure Shutter::end_aligned(TrueTime period_start, std::int64_t pulse) const {
  const TrueTime end = period_start + settings_.trigger_to_exposure + periods(1.0);
  return {pulse, end - settings_.exposure - settings_.readout, end};
}

std::optional<Exposure> Shutter::on_pulse(TrueTime at, std::int64_t pulse) {
  if (settings_.mode == ShutterMode::kFreeRunning || at < start_) return std::nullopt;
  // An ignored pulse still ends free running, so that the shutter is ready for the next one.
  last_pulse_ = at;
  if (at < ignore_until_) return std::nullopt;
  const double unguarded = 1.0 - settings_.guard_fraction;
  if (settings_.mode == ShutterMode::kSlave) {
    ignore_until_ = at + std::max(periods(unguarded), settings_.exposure);
    return end_aligned(at, pulse);
  }
  const TrueTime start = at + settings_.trigger_to_exposure;
  const TrueTime end = start + settings_.exposure + settings_.readout;
  const double ignored_periods = settings_.mode == ShutterMode::kGenlock ? 2.0 : 1.0;
  ignore_until_ = std::max(at + periods(ignored_periods * unguarded), end);
  return Exposure{pulse, start, end};
}

std::optional<Exposure> Shutter::on_timer(TrueTime now) {
  if (settings_.mode == ShutterMode::kSlave) {
    const TrueTime runs_free_from = last_pulse_ + periods(settings_.free_run_after_periods);
    if (now < runs_free_from) {
      next_timer_ = runs_free_from;
      free_run_origin_ = runs_free_from;
      free_run_frames_ = 0;
      return std::nullopt;
    }
    ignore_until_ = now + std::max(periods(1.0 - settings_.guard_fraction), settings_.exposure);
  }
  // Counted from the origin, so that rounding to nanoseconds does not add up to a rate error.
  free_run_frames_ += periods_of_exposure();
  next_timer_ = free_run_origin_ + periods(static_cast<double>(free_run_frames_));
  return end_aligned(now, kNoPulse);
}

}  // namespace simbench::sim
