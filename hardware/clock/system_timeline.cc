#include "hardware/clock/system_timeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "algorithms/ports/assert.h"

namespace simbench::hardware {
namespace {

constexpr double kMaxRate = 0.5;
// 146 years: sums and differences of two such values are still representable.
constexpr Nanoseconds kLimit((std::int64_t{1} << 62) - 1);

Nanoseconds limited(Nanoseconds value) { return std::clamp(value, -kLimit, kLimit); }
HostTime limited(HostTime value) { return HostTime(limited(value.time_since_epoch())); }

void check_rate(double ppb) {
  if (std::isfinite(ppb) && std::abs(ppb) < kMaxRate * 1e9) return;
  throw ClockError(
      fmt::format("clock: found a rate of {} ppb, allowed less than {:.0f} ppb in either direction",
                  ppb, kMaxRate * 1e9));
}

// The first instant for which `reached` holds, starting from a good guess; `reached` is monotone.
template <class Predicate>
MonotonicTime first_instant(MonotonicTime guess, Predicate reached) {
  constexpr Nanoseconds kStep(1);
  while (!reached(guess)) guess += kStep;
  while (reached(guess - kStep)) guess -= kStep;
  return guess;
}

}  // namespace

SystemTimeline::SystemTimeline(std::uint32_t host, const NodeOscillator& oscillator,
                               MonotonicTime at, HostTime reads)
    : host_(host), oscillator_(oscillator) {
  settings_.push_back({.since = at, .base = limited(reads)});
}

double SystemTimeline::counted_ns(const Setting& setting, MonotonicTime at) const {
  const auto elapsed_ns = static_cast<double>((at - setting.since).count());
  return elapsed_ns + oscillator_.skew_ppm / 1e6 * elapsed_ns;
}

SystemTimeline::Reading SystemTimeline::reading(const Setting& setting, MonotonicTime at) const {
  const Nanoseconds elapsed = at - setting.since;
  const double ahead_ns = oscillator_.skew_ppm / 1e6 * static_cast<double>(elapsed.count());
  const double extra_ns =
      setting.base_part_ns + ahead_ns + setting.rate() * counted_ns(setting, at);
  const double floor_ns = std::floor(extra_ns);
  return {setting.base + elapsed + Nanoseconds(static_cast<std::int64_t>(floor_ns)),
          extra_ns - floor_ns};
}

const SystemTimeline::Setting& SystemTimeline::setting_at(MonotonicTime at) const {
  if (planned_ && at >= planned_->since) return *planned_;
  const auto later =
      std::upper_bound(settings_.begin(), settings_.end(), at,
                       [](MonotonicTime t, const Setting& setting) { return t < setting.since; });
  return later == settings_.begin() ? settings_.front() : *std::prev(later);
}

HostTime SystemTimeline::read(MonotonicTime at) const { return reading(setting_at(at), at).whole; }

MonotonicTime SystemTimeline::when(const Setting& setting, HostTime at) const {
  const HostTime wanted = limited(at);
  const Nanoseconds ahead = wanted - setting.base;
  const double pace = (1 + oscillator_.skew_ppm / 1e6) * (1 + setting.rate());
  const double counted = (static_cast<double>(ahead.count()) - setting.base_part_ns) / pace;
  constexpr double kFar = 2e18;  // 63 years
  if (counted > kFar) return MonotonicTime::max();
  if (counted < -kFar) return MonotonicTime::min();
  return first_instant(setting.since + Nanoseconds(std::llround(counted)),
                       [&](MonotonicTime t) { return reading(setting, t).whole >= wanted; });
}

MonotonicTime SystemTimeline::when(HostTime at, MonotonicTime now) const {
  const Setting& present = setting_at(now);
  const MonotonicTime found = std::max(when(present, at), now);
  if (!planned_ || found < planned_->since || &present == &*planned_) return found;
  return std::max({when(*planned_, at), planned_->since, now});
}

void SystemTimeline::set(MonotonicTime at, HostTime value) {
  Setting next = next_setting(at);
  next.base = limited(value);
  next.base_part_ns = 0;
  next.slew_rate = next.slew_left_ns = 0;
  add(next);
}

void SystemTimeline::restart(MonotonicTime at, HostTime value) {
  next_setting(at);
  add({.since = at, .base = limited(value)});
}

void SystemTimeline::adjust_frequency(MonotonicTime at, double ppb) {
  check_rate(ppb);
  Setting next = next_setting(at);
  next.frequency = ppb * 1e-9;
  add(next);
}

void SystemTimeline::slew(MonotonicTime at, Nanoseconds offset, double max_rate_ppb) {
  const bool ends = offset.count() == 0;
  if (!ends) check_rate(max_rate_ppb);
  if (!ends && max_rate_ppb <= 0) {
    throw ClockError(
        fmt::format("clock: found a slew at {} ppb, allowed a rate above 0", max_rate_ppb));
  }
  Setting next = next_setting(at);
  next.slew_left_ns = static_cast<double>(limited(offset).count());
  next.slew_rate = ends ? 0 : std::copysign(max_rate_ppb * 1e-9, next.slew_left_ns);
  add(next);
}

SystemTimeline::Setting SystemTimeline::gone_on(const Setting& setting, MonotonicTime at) const {
  const Reading then = reading(setting, at);
  Setting next = setting;
  next.since = at;
  next.base = then.whole;
  next.base_part_ns = then.part_ns;
  next.slew_left_ns -= setting.slew_rate * counted_ns(setting, at);
  return next;
}

SystemTimeline::Setting SystemTimeline::next_setting(MonotonicTime at) {
  settle(at);
  planned_.reset();
  SIMBENCH_ASSERT(at >= settings_.back().since, "a clock must be adjusted in order of time");
  return gone_on(settings_.back(), at);
}

void SystemTimeline::add(const Setting& setting) {
  begin(setting);
  if (setting.slew_rate == 0) return;
  const double counted_ns = std::max(0.0, setting.slew_left_ns / setting.slew_rate);
  const double elapsed_ns = counted_ns / (1 + oscillator_.skew_ppm / 1e6);
  constexpr double kNever = 2e18;
  if (elapsed_ns > kNever) return;
  Setting end = gone_on(setting, setting.since + Nanoseconds(std::llround(elapsed_ns)));
  end.slew_rate = end.slew_left_ns = 0;
  planned_ = end;
}

void SystemTimeline::begin(const Setting& setting) {
  const HostTime before = reading(settings_.back(), setting.since).whole;
  settings_.push_back(setting);
  if (settings_.size() > kHistory + 1) settings_.pop_front();
  if (!observer_) return;
  observer_({.host = host_,
             .at = oscillator_.steady(setting.since),
             .before = before,
             .after = setting.base,
             .rate_ppb = setting.rate() * 1e9});
}

std::optional<MonotonicTime> SystemTimeline::settles_at() const {
  if (!planned_) return std::nullopt;
  return planned_->since;
}

void SystemTimeline::settle(MonotonicTime now) {
  if (!planned_ || planned_->since > now) return;
  const Setting end = *planned_;
  planned_.reset();
  begin(end);
}

ClockAdjustment SystemTimeline::present(MonotonicTime now) const {
  const HostTime reads = read(now);
  return {.host = host_,
          .at = oscillator_.steady(now),
          .before = reads,
          .after = reads,
          .rate_ppb = setting_at(now).rate() * 1e9};
}

}  // namespace simbench::hardware
