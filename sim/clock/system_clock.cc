#include "sim/clock/system_clock.h"

#include "algorithms/ports/assert.h"

namespace simbench::sim {
namespace {

// More adjustments than there are in the longest way of a frame or a message, for which alone a
// clock's past is read; a service of years makes millions.
constexpr std::size_t kSettingsKept = 1 << 18;

}  // namespace

SystemClock::SystemClock(std::uint32_t host, OscillatorModel oscillator, Nanoseconds offset,
                         SteadyTime steady_epoch)
    : own_(host, {steady_epoch, std::move(oscillator)}, TrueTime{}, HostTime(offset),
           kSettingsKept),
      host_(host) {
  own_.observe([this](const ClockAdjustment& adjustment) { notify(adjustment); });
}

TrueTime SystemClock::when(SteadyTime at) const {
  const HostOscillator& oscillator = clock_->oscillator();
  return clocks::when_steady(oscillator, TrueTime{}, oscillator.steady_epoch, at,
                             oscillator.last_deviation_ns);
}

TrueTime SystemClock::when(HostTime at, TrueTime now) const { return clock_->when(at, now); }

void SystemClock::set(TrueTime at, HostTime value) {
  if (!is_follower()) own_.set(at, value);
}

void SystemClock::adjust_frequency(TrueTime at, double ppb) {
  if (is_follower()) return;
  own_.adjust_frequency(at, ppb + smear_ppb_);
  frequency_ppb_ = ppb;
}

void SystemClock::slew(TrueTime at, Nanoseconds offset, double max_rate_ppb) {
  if (!is_follower()) own_.slew(at, offset, max_rate_ppb);
}

void SystemClock::leap(TrueTime at, Nanoseconds offset) {
  if (!is_follower()) own_.leap(at, offset);
}

void SystemClock::smear(TrueTime at, double ppb) {
  if (is_follower()) return;
  smear_ppb_ = ppb;
  own_.adjust_frequency(at, frequency_ppb_ + smear_ppb_);
}

ClockAdjustment SystemClock::present(TrueTime now) const {
  ClockAdjustment present = clock_->present(now);
  present.host = host_;
  return present;
}

void SystemClock::notify(ClockAdjustment adjustment) {
  is_adjusted_ = true;
  if (observer_) observer_(adjustment);
  for (const SystemClock* follower : followers_) {
    if (!follower->observer_) continue;
    adjustment.host = follower->host_;
    follower->observer_(adjustment);
  }
}

void SystemClock::follow(SystemClock& master) {
  SIMBENCH_ASSERT(!is_adjusted_, "a clock that was adjusted cannot follow another");
  SIMBENCH_ASSERT(!master.is_follower() && &master != this, "the master follows nobody");
  clock_ = &master.own_;
  master.followers_.push_back(this);
}

void read_errors(std::span<SystemClock* const> clocks, TrueTime t, std::span<Nanoseconds> errors) {
  const HostTime master = clocks.front()->read(t);
  for (std::size_t host = 0; host < clocks.size(); ++host) {
    errors[host] = clocks[host]->read(t) - master;
  }
}

}  // namespace simbench::sim
