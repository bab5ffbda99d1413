#include "sim/clock/system_clock.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "algorithms/ports/assert.h"

namespace simbench::sim {
namespace {

constexpr double kMaxRate = 0.5;
// Each pass multiplies what is wrong by the frequency error, which is far below 1e-2.
constexpr int kInversionPasses = 6;

// The instant at which the oscillator has counted `local_ns` more than at `anchor`, to about 1 ns.
TrueTime instant_of(const OscillatorModel& oscillator, TrueTime anchor, double anchor_deviation_ns,
                    double local_ns) {
  TrueTime t = anchor;
  for (int pass = 0; pass < kInversionPasses; ++pass) {
    const double ahead_ns = oscillator.deviation_ns(t) - anchor_deviation_ns;
    t = anchor + Nanoseconds(std::llround(local_ns - ahead_ns));
  }
  return t;
}

// The first instant for which `reached` holds, starting from a good guess; `reached` is monotone.
template <class Predicate>
TrueTime first_instant(TrueTime guess, Predicate reached) {
  constexpr Nanoseconds kStep(1);
  while (!reached(guess)) guess += kStep;
  while (reached(guess - kStep)) guess -= kStep;
  return guess;
}

}  // namespace

SystemClock::SystemClock(std::uint32_t host, OscillatorModel oscillator, Nanoseconds offset,
                         SteadyTime steady_epoch)
    : host_(host), oscillator_(std::move(oscillator)), steady_epoch_(steady_epoch) {
  settings_.push_back({.since = TrueTime::min(),
                       .until = TrueTime::max(),
                       .anchor = TrueTime{},
                       .anchor_deviation_ns = oscillator_.deviation_ns(TrueTime{}),
                       .base = HostTime(offset),
                       .base_part_ns = 0,
                       .frequency = 0,
                       .slew_rate = 0,
                       .slew_left_ns = 0});
}

SteadyTime SystemClock::steady(TrueTime t) const {
  if (master_ != nullptr) return master_->steady(t);
  const double ahead_ns = std::floor(oscillator_.deviation_ns(t));
  return steady_epoch_ + t.time_since_epoch() + Nanoseconds(static_cast<std::int64_t>(ahead_ns));
}

TrueTime SystemClock::when(SteadyTime at) const {
  if (master_ != nullptr) return master_->when(at);
  const auto local_ns = static_cast<double>((at - steady_epoch_).count());
  return first_instant(instant_of(oscillator_, TrueTime{}, 0, local_ns),
                       [&](TrueTime t) { return steady(t) >= at; });
}

HostTime SystemClock::read_elsewhere(TrueTime t) const {
  const auto found = std::upper_bound(
      settings_.begin(), settings_.end(), t,
      [](TrueTime instant, const Setting& setting) { return instant < setting.until; });
  current_ = static_cast<std::size_t>(found - settings_.begin());
  return read(*found, t);
}

TrueTime SystemClock::when(const Setting& setting, HostTime at) const {
  const double ahead_ns = static_cast<double>((at - setting.base).count()) - setting.base_part_ns;
  const TrueTime guess = instant_of(oscillator_, setting.anchor, setting.anchor_deviation_ns,
                                    ahead_ns / (1 + setting.rate()));
  return first_instant(guess, [&](TrueTime t) { return read(setting, t) >= at; });
}

TrueTime SystemClock::when(HostTime at, TrueTime now) const {
  if (master_ != nullptr) return master_->when(at, now);
  read(now);  // finds the setting valid now
  for (std::size_t index = current_;; ++index) {
    const Setting& setting = settings_[index];
    const TrueTime found = std::max({when(setting, at), setting.since, now});
    if (found < setting.until || index + 1 == settings_.size()) return found;
  }
}

void SystemClock::set(TrueTime at, HostTime value) {
  if (master_ != nullptr) return;
  Setting next = next_setting(at);
  next.base = value;
  next.base_part_ns = 0;
  next.slew_rate = 0;
  add(next);
}

void SystemClock::adjust_frequency(TrueTime at, double ppb) {
  if (master_ != nullptr) return;
  SIMBENCH_ASSERT(std::abs(ppb) < kMaxRate * 1e9, "a clock's rate must stay positive");
  Setting next = next_setting(at);
  next.frequency = ppb * 1e-9;
  add(next);
}

void SystemClock::slew(TrueTime at, Nanoseconds offset, double max_rate_ppb) {
  if (master_ != nullptr) return;
  SIMBENCH_ASSERT(offset.count() == 0 || (max_rate_ppb > 0 && max_rate_ppb < kMaxRate * 1e9),
                  "a slew needs a rate, and the clock's rate must stay positive");
  Setting next = next_setting(at);
  next.slew_left_ns = static_cast<double>(offset.count());
  next.slew_rate = offset.count() == 0 ? 0 : std::copysign(max_rate_ppb * 1e-9, next.slew_left_ns);
  add(next);
}

SystemClock::Setting SystemClock::next_setting(TrueTime at) {
  settle(at);
  settings_.resize(reported_);
  Setting& last = settings_.back();
  SIMBENCH_ASSERT(at >= last.since, "a clock must be adjusted in order of time");
  last.until = at;
  const Reading now = reading(last, at);
  Setting next = last;
  next.since = next.anchor = at;
  next.until = TrueTime::max();
  next.anchor_deviation_ns = oscillator_.deviation_ns(at);
  next.base = now.whole;
  next.base_part_ns = now.part_ns;
  next.slew_left_ns -= last.slew_rate * counted_ns(last, at);
  return next;
}

void SystemClock::add(const Setting& setting) {
  settings_.push_back(setting);
  current_ = settings_.size() - 1;
  if (setting.slew_rate != 0) {
    const double duration_ns = std::max(0.0, setting.slew_left_ns / setting.slew_rate);
    Setting end = setting;
    end.since = end.anchor =
        std::max(setting.since,
                 instant_of(oscillator_, setting.anchor, setting.anchor_deviation_ns, duration_ns));
    end.anchor_deviation_ns = oscillator_.deviation_ns(end.anchor);
    const Reading then = reading(setting, end.anchor);
    end.base = then.whole;
    end.base_part_ns = then.part_ns;
    end.slew_rate = end.slew_left_ns = 0;
    settings_[current_].until = end.since;
    settings_.push_back(end);
  }
  report(reported_++);
}

std::optional<TrueTime> SystemClock::settles_at() const {
  if (reported_ == settings_.size()) return std::nullopt;
  return settings_.back().since;
}

void SystemClock::settle(TrueTime now) {
  while (reported_ < settings_.size() && settings_[reported_].since <= now) report(reported_++);
}

ClockAdjustment SystemClock::present(TrueTime now) const {
  const HostTime reads = read(now);
  return {.host = host_,
          .at = steady(now),
          .before = reads,
          .after = reads,
          .rate_ppb = setting_at(now).rate() * 1e9};
}

void SystemClock::report(std::size_t index) {
  const Setting& setting = settings_[index];
  notify({.host = host_,
          .at = steady(setting.since),
          .before = read(settings_[index - 1], setting.since),
          .after = setting.base,
          .rate_ppb = setting.rate() * 1e9});
}

void SystemClock::notify(ClockAdjustment adjustment) const {
  if (observer_) observer_(adjustment);
  for (const SystemClock* follower : followers_) {
    if (!follower->observer_) continue;
    adjustment.host = follower->host_;
    follower->observer_(adjustment);
  }
}

const SystemClock::Setting& SystemClock::setting_at(TrueTime t) const {
  if (master_ != nullptr) return master_->setting_at(t);
  read(t);
  return settings_[current_];
}

void SystemClock::follow(SystemClock& master) {
  SIMBENCH_ASSERT(settings_.size() == 1, "a clock that was adjusted cannot follow another");
  SIMBENCH_ASSERT(master.master_ == nullptr && &master != this, "the master follows nobody");
  master_ = &master;
  master.followers_.push_back(this);
}

}  // namespace simbench::sim
