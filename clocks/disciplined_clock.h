// A system clock that is set, slewed and given rates, over an oscillator: the same one in the
// simulated and in the real world.
//
// The clock reads setting + (1 + rate) * (what the oscillator has counted since the setting). A
// step, a change of rate, a slew and the planned end of that slew each begin a setting, which is
// valid until the next one. The clock can thus be read at any instant: under the setting of that
// instant if it is among the last `history`, else under the oldest one kept.
//
// Contract
//  - Adjustments come in order of time.
//  - A slew ends by itself; a step or another slew before its end leaves the rest of it undone, a
//    change of rate does not.
//  - The observer is notified of each adjustment in order of time, also of the end of a slew, in
//    time if settle() is called at settles_at(), each time there is one. The end of a slew that
//    takes more than a day depends on the oscillator's far future: it is planned when it is near,
//    and until then settles_at() is an instant at which to look again.
//  - Errors: ClockError for a rate that is not finite or not below 0.5, and for a slew without a
//    positive rate; the clock is then as it was.
//  - Used by one thread.
//
// Precision: a setting keeps its part of a nanosecond, so that a rate of 1e-9 survives hours and
// any number of adjustments; readings are rounded down to 1 ns. Values and offsets beyond 146 years
// are cut to that; what is further than 63 years away is never.
//
// The rate is a sum of parts (Setting::rate): the frequency that stays, and a slew that ends. What
// disciplines a clock by a loop of its own, as the Linux kernel's PLL and FLL do, gives it a
// frequency for each of its seconds (sim/programs/kernel_clock.h).
//
// Complexity: reading the present O(1), some nanoseconds; the past O(log n) of n adjustments.
// Source: docs/design.md sections 4, 5 and 7; docs/reference/calibration.md section 2 ("Host
// clock").
//
//   DisciplinedClock<hardware::NodeOscillator> clock(3, oscillator, now, os_time, 64);
//   clock.slew(now, from_ms(2), 500'000);  // 2 ms at 500 ppm: takes 4 s
//   HostTime reading = clock.read(kernel_stamp);
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "algorithms/ports/assert.h"
#include "algorithms/ports/clock_adjustment.h"
#include "clocks/prefetch.h"

namespace simbench::clocks {

// An adjustment that a clock refuses; one line for the user.
class ClockError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// An oscillator and the instants at which it is looked at: true time in the simulated world, the
// kernel's monotonic time in the real one.
template <class T>
concept Oscillator = requires(const T& oscillator, typename T::Instant at) {
  // What it has counted since some zero, minus the time that has passed, in ns.
  { oscillator.deviation_ns(at) } -> std::convertible_to<double>;
  // What the steady clock reads that counts it.
  { oscillator.steady(at) } -> std::same_as<SteadyTime>;
};

// Counts and readings further away than this are never reached: 63 years.
inline constexpr double kNeverNs = 2e18;
// The end of a slew that is further away is planned later: a day.
inline constexpr double kFarEndNs = 8.64e13;

// The instant at which the oscillator has counted `local_ns` more than at `anchor`, to about 1 ns.
// `guess_ns`: how much more than the time that has passed, about; a good one saves looks.
template <Oscillator O>
typename O::Instant instant_after(const O& oscillator, typename O::Instant anchor,
                                  double anchor_deviation_ns, double local_ns,
                                  double guess_ns = 0) {
  // Each pass multiplies what is wrong by the frequency error, which is far below 1e-2. The first
  // guess needs no look at the anchor, which an oscillator may find far from where it is used.
  constexpr int kPasses = 5;
  typename O::Instant t = anchor + from_ns(local_ns - guess_ns);
  for (int pass = 0; pass < kPasses; ++pass) {
    const double ahead_ns = oscillator.deviation_ns(t) - anchor_deviation_ns;
    const typename O::Instant before = std::exchange(t, anchor + from_ns(local_ns - ahead_ns));
    if (t == before) break;
  }
  return t;
}

// The first instant for which `reached` holds, starting from a guess; `reached` is monotone. A good
// guess costs two looks, a bad one the logarithm of its error. If nothing near kNeverNs differs
// from the guess, that end is the answer.
template <class Instant, class Predicate>
Instant first_instant(Instant guess, Predicate reached) {
  constexpr Nanoseconds kFarthest(std::int64_t{1} << 60);
  Nanoseconds step(1);
  Instant before = guess;
  Instant after = guess;
  if (reached(guess)) {
    for (before -= step; reached(before) && step < kFarthest; before -= step) {
      after = before;
      step *= 2;
    }
  } else {
    for (after += step; !reached(after) && step < kFarthest; after += step) {
      before = after;
      step *= 2;
    }
  }
  while (after - before > Nanoseconds(1)) {
    const Instant middle = before + (after - before) / 2;
    (reached(middle) ? after : before) = middle;
  }
  return after;
}

// The first instant at which the steady clock, which read `zero_reading` at `zero`, reads `at` or
// more. The oscillator's deviation counts from `zero`; `guess_ns` is about what it is then.
template <Oscillator O>
typename O::Instant when_steady(const O& oscillator, typename O::Instant zero,
                                SteadyTime zero_reading, SteadyTime at, double guess_ns = 0) {
  using Instant = typename O::Instant;
  const double about_ns =
      static_cast<double>(nanoseconds_of(at)) - static_cast<double>(nanoseconds_of(zero_reading));
  if (about_ns > kNeverNs) return Instant::max();
  if (about_ns < -kNeverNs) return Instant::min();
  const auto local_ns = static_cast<double>((at - zero_reading).count());
  return first_instant(instant_after(oscillator, zero, 0, local_ns, guess_ns),
                       [&](Instant t) { return oscillator.steady(t) >= at; });
}

// Throw ClockError for what is no clock's rate, or no slew's.
void check_rate(double ppb);
void check_slew_rate(double ppb);

template <Oscillator O>
class DisciplinedClock {
 public:
  using Instant = typename O::Instant;
  using Observer = std::function<void(const ClockAdjustment&)>;
  static constexpr std::size_t kWholeHistory = std::numeric_limits<std::size_t>::max() - 1;

  // Reads `reads` at `at`, at rate 0. `host` is the number under which adjustments are reported.
  DisciplinedClock(std::uint32_t host, O oscillator, Instant at, HostTime reads,
                   std::size_t history = kWholeHistory)
      : oscillator_(std::move(oscillator)), host_(host), history_(history) {
    settings_.push_back({.since = Instant::min(),
                         .until = Instant::max(),
                         .anchor = at,
                         .anchor_deviation_ns = oscillator_.deviation_ns(at),
                         .base = limited(reads)});
  }

  const O& oscillator() const { return oscillator_; }

  // In place: a world reads its clocks several times a frame.
  [[gnu::always_inline]] HostTime read(Instant t) const {
    return read(t, oscillator_.deviation_ns(t));
  }
  // The same where the oscillator's deviation at `t` is known already.
  [[gnu::always_inline]] HostTime read(Instant t, double deviation_ns) const {
    return reading(setting_at(t), t, deviation_ns).whole;
  }
  // Prepares a reading at about the time of the last one (clocks/prefetch.h); the second once the
  // first has had time.
  void prefetch() const { clocks::prefetch(this, 128); }
  void prefetch_setting() const { clocks::prefetch(&settings_[current_], sizeof(Setting)); }
  // The reading minus `from`, with its part of a nanosecond.
  double read_since_ns(Instant t, HostTime from) const {
    const Reading then = reading(setting_at(t), t);
    return static_cast<double>((then.whole - from).count()) + then.part_ns;
  }
  // The first instant, not before `now`, at which the clock reads `at` or more without a further
  // adjustment.
  Instant when(HostTime at, Instant now) const;

  void set(Instant at, HostTime value);
  // The same, at rate 0.
  void restart(Instant at, HostTime value);
  // Adds `offset` at once and leaves an unfinished slew as it is, as the kernel takes a leap
  // second.
  void leap(Instant at, Nanoseconds offset);
  // Rate against the oscillator, replacing the one before. |ppb| < 5e8.
  void adjust_frequency(Instant at, double ppb);
  // Adds `offset` gradually by a rate of +-max_rate_ppb, which is > 0 and < 5e8. An offset of 0
  // ends an unfinished slew, whatever the rate.
  void slew(Instant at, Nanoseconds offset, double max_rate_ppb);

  // When settle() is due: the planned end of a slew, if there is one that was not yet reported.
  std::optional<Instant> settles_at() const;
  // Reports the end of a slew that was reached at or before `now`.
  void settle(Instant now);

  // The setting valid at `now`, as an adjustment that changes nothing.
  ClockAdjustment present(Instant now) const;
  // From now on notifies `observer`, in place of the one before.
  void observe(Observer observer) { observer_ = std::move(observer); }

 private:
  struct Setting {
    Instant since;   // valid from here (the first one: from the beginning of time)
    Instant until;   // to before here
    Instant anchor;  // where the clock read base + base_part_ns
    double anchor_deviation_ns = 0;
    HostTime base;
    double base_part_ns = 0;  // in [0, 1)
    double frequency = 0;     // rate that stays, as a fraction
    double slew_rate = 0;     // rate that ends with the slew
    double slew_left_ns = 0;  // at the anchor
    double rate() const { return frequency + slew_rate; }
  };
  // A reading with its part of a nanosecond, which a change of rate must not lose.
  struct Reading {
    HostTime whole;
    double part_ns = 0;
  };

  static Nanoseconds limited(Nanoseconds value) {
    // Sums and differences of two such values are still representable.
    constexpr Nanoseconds kLimit((std::int64_t{1} << 62) - 1);
    return std::clamp(value, -kLimit, kLimit);
  }
  static HostTime limited(HostTime value) { return HostTime(limited(value.time_since_epoch())); }

  // What the oscillator has counted since the setting's anchor.
  static double counted_ns(const Setting& setting, Instant t, double deviation_ns) {
    return static_cast<double>((t - setting.anchor).count()) +
           (deviation_ns - setting.anchor_deviation_ns);
  }
  Reading reading(const Setting& setting, Instant t) const {
    return reading(setting, t, oscillator_.deviation_ns(t));
  }
  static Reading reading(const Setting& setting, Instant t, double deviation_ns) {
    const Nanoseconds elapsed = t - setting.anchor;
    const double ahead_ns = deviation_ns - setting.anchor_deviation_ns;
    const double local_ns = static_cast<double>(elapsed.count()) + ahead_ns;
    const double extra_ns = setting.base_part_ns + ahead_ns + setting.rate() * local_ns;
    const Nanoseconds whole = from_ns_down(extra_ns);
    return {setting.base + elapsed + whole, extra_ns - static_cast<double>(whole.count())};
  }
  const Setting& setting_at(Instant t) const {
    const Setting& current = settings_[current_];
    return t >= current.since && t < current.until ? current : find_setting(t);
  }
  // Remembers where it found it.
  const Setting& find_setting(Instant t) const;
  // The first instant at which this setting, were it valid for ever, reads `at` or more.
  Instant when(const Setting& setting, HostTime at) const;

  // The setting as it goes on from `at`.
  Setting continued(const Setting& setting, Instant at) const;
  // Ends the present setting at `at`, drops what was planned after it, and returns the next one,
  // which goes on in the same way.
  Setting next_setting(Instant at);
  // Adds it and, if it slews, the planned end of that; reports it.
  void add(const Setting& setting);
  // Plans the end of the last setting's slew, as far as it can be told at `now`.
  void plan_end(Instant now);
  void report_next();

  // What each reading needs comes first, together in the cache.
  std::vector<Setting> settings_;
  mutable std::size_t current_ = 0;  // where the last reading was found
  O oscillator_;
  std::uint32_t host_;
  std::size_t history_;
  std::size_t reported_ = 1;           // settings whose begin was reported
  std::optional<Instant> look_again_;  // when the end of the last one's slew is planned
  Observer observer_;
};

template <Oscillator O>
auto DisciplinedClock<O>::find_setting(Instant t) const -> const Setting& {
  const auto found = std::upper_bound(
      settings_.begin(), settings_.end(), t,
      [](Instant instant, const Setting& setting) { return instant < setting.until; });
  current_ = static_cast<std::size_t>(std::min(found, settings_.end() - 1) - settings_.begin());
  return settings_[current_];
}

template <Oscillator O>
auto DisciplinedClock<O>::when(const Setting& setting, HostTime at) const -> Instant {
  const HostTime wanted = limited(at);
  const double ahead_ns =
      static_cast<double>((wanted - setting.base).count()) - setting.base_part_ns;
  const double local_ns = ahead_ns / (1 + setting.rate());
  if (local_ns > kNeverNs) return Instant::max();
  if (local_ns < -kNeverNs) return Instant::min();
  const Instant guess =
      instant_after(oscillator_, setting.anchor, setting.anchor_deviation_ns, local_ns);
  return first_instant(guess, [&](Instant t) { return reading(setting, t).whole >= wanted; });
}

template <Oscillator O>
auto DisciplinedClock<O>::when(HostTime at, Instant now) const -> Instant {
  setting_at(now);
  for (std::size_t index = current_;; ++index) {
    const Setting& setting = settings_[index];
    const Instant found = std::max({when(setting, at), setting.since, now});
    if (found < setting.until || index + 1 == settings_.size()) return found;
  }
}

template <Oscillator O>
void DisciplinedClock<O>::set(Instant at, HostTime value) {
  Setting next = next_setting(at);
  next.base = limited(value);
  next.base_part_ns = next.slew_rate = next.slew_left_ns = 0;
  add(next);
}

template <Oscillator O>
void DisciplinedClock<O>::restart(Instant at, HostTime value) {
  Setting next = next_setting(at);
  next.base = limited(value);
  next.base_part_ns = next.frequency = next.slew_rate = next.slew_left_ns = 0;
  add(next);
}

template <Oscillator O>
void DisciplinedClock<O>::leap(Instant at, Nanoseconds offset) {
  Setting next = next_setting(at);
  next.base = limited(next.base + limited(offset));
  add(next);
}

template <Oscillator O>
void DisciplinedClock<O>::adjust_frequency(Instant at, double ppb) {
  check_rate(ppb);
  Setting next = next_setting(at);
  next.frequency = ppb * 1e-9;
  add(next);
}

template <Oscillator O>
void DisciplinedClock<O>::slew(Instant at, Nanoseconds offset, double max_rate_ppb) {
  const bool ends = offset.count() == 0;
  if (!ends) check_slew_rate(max_rate_ppb);
  Setting next = next_setting(at);
  next.slew_left_ns = static_cast<double>(limited(offset).count());
  next.slew_rate = ends ? 0 : std::copysign(max_rate_ppb * 1e-9, next.slew_left_ns);
  add(next);
}

template <Oscillator O>
auto DisciplinedClock<O>::continued(const Setting& setting, Instant at) const -> Setting {
  const double deviation_ns = oscillator_.deviation_ns(at);
  const Reading then = reading(setting, at, deviation_ns);
  Setting next = setting;
  next.since = next.anchor = at;
  next.until = Instant::max();
  next.anchor_deviation_ns = deviation_ns;
  next.base = then.whole;
  next.base_part_ns = then.part_ns;
  next.slew_left_ns -= setting.slew_rate * counted_ns(setting, at, deviation_ns);
  return next;
}

template <Oscillator O>
auto DisciplinedClock<O>::next_setting(Instant at) -> Setting {
  settle(at);
  settings_.resize(reported_);
  Setting& last = settings_.back();
  SIMBENCH_ASSERT(at >= last.since, "a clock must be adjusted in order of time");
  last.until = at;
  return continued(last, at);
}

template <Oscillator O>
void DisciplinedClock<O>::add(const Setting& setting) {
  settings_.push_back(setting);
  current_ = settings_.size() - 1;
  plan_end(setting.since);
  report_next();
}

template <Oscillator O>
void DisciplinedClock<O>::plan_end(Instant now) {
  look_again_.reset();
  const Setting setting = settings_.back();
  if (setting.slew_rate == 0) return;
  const double duration_ns = std::max(0.0, setting.slew_left_ns / setting.slew_rate);
  if (duration_ns > kNeverNs) return;
  const double left_ns = duration_ns - counted_ns(setting, now, oscillator_.deviation_ns(now));
  if (left_ns > kFarEndNs) {
    look_again_ = now + from_ns(left_ns / 2);
    return;
  }
  const Instant at =
      instant_after(oscillator_, setting.anchor, setting.anchor_deviation_ns, duration_ns);
  Setting end = continued(setting, std::max(setting.since, at));
  end.slew_rate = end.slew_left_ns = 0;
  settings_.back().until = end.since;
  settings_.push_back(end);
}

template <Oscillator O>
std::optional<typename O::Instant> DisciplinedClock<O>::settles_at() const {
  if (reported_ == settings_.size()) return look_again_;
  return settings_.back().since;
}

template <Oscillator O>
void DisciplinedClock<O>::settle(Instant now) {
  if (look_again_ && *look_again_ <= now) plan_end(now);
  while (reported_ < settings_.size() && settings_[reported_].since <= now) report_next();
}

template <Oscillator O>
void DisciplinedClock<O>::report_next() {
  const Setting setting = settings_[reported_];
  const HostTime before = reading(settings_[reported_ - 1], setting.since).whole;
  ++reported_;
  // Many at a time where there are many.
  const std::size_t old = reported_ > history_ + 1 ? reported_ - history_ - 1 : 0;
  if (old > history_ / 128) {
    settings_.erase(settings_.begin(), settings_.begin() + static_cast<std::ptrdiff_t>(old));
    reported_ -= old;
    current_ -= std::min(current_, old);
  }
  if (!observer_) return;
  observer_({.host = host_,
             .at = oscillator_.steady(setting.since),
             .before = before,
             .after = setting.base,
             .rate_ppb = setting.rate() * 1e9});
}

template <Oscillator O>
ClockAdjustment DisciplinedClock<O>::present(Instant now) const {
  const HostTime reads = read(now);
  return {.host = host_,
          .at = oscillator_.steady(now),
          .before = reads,
          .after = reads,
          .rate_ppb = setting_at(now).rate() * 1e9};
}

}  // namespace simbench::clocks
