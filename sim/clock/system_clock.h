// A host's clocks: its steady clock, which is its oscillator, and its system clock on top of that.
//
// The system clock reads setting + (1 + rate) * (what the oscillator has counted since the
// setting). It is a list of settings, each valid from an instant of true time until the next; a
// step, a change of rate, a slew and the planned end of that slew each add one. So it can be read
// at any instant, also a past one. Readings are exact here, rounded down to 1 ns; what a program
// sees of them is sim/clock/clock_interface.h.
//
// Adjustments must come in order of true time. A slew ends by itself; a step or another slew before
// its end leaves the rest of it undone, a change of rate does not. Each adjustment is passed to the
// observer in order of time, also the end of a slew; who wants that in time calls settle() at
// settles_at().
//
// The clock of an oracle's slave follows the master's: both its clocks are the master's at every
// instant, adjustments of its own have no effect, and it reports the master's adjustments.
//
// Complexity: reading the present O(1), some nanoseconds; the past O(log n) of n adjustments.
// Source: docs/design.md sections 4, 5 and 7; docs/reference/calibration.md section 2 ("Host
// clock").
//
//   SystemClock clock(3, oscillator, from_ms(250));
//   clock.set(now, HostTime(from_ms(1000)));
//   clock.slew(now + from_ms(5), from_ms(2), 500'000);  // 2 ms at 500 ppm: takes 4 s
//   HostTime reading = clock.read(now + from_ms(7));
#ifndef SIMBENCH_SIM_CLOCK_SYSTEM_CLOCK_H_
#define SIMBENCH_SIM_CLOCK_SYSTEM_CLOCK_H_

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "recording/recording.h"
#include "sim/clock/oscillator.h"

namespace simbench::sim {

class SystemClock {
 public:
  using Observer = std::function<void(const ClockAdjustment&)>;

  // Reads `offset` and the steady clock reads `steady_epoch` at true zero.
  SystemClock(std::uint32_t host, OscillatorModel oscillator, Nanoseconds offset = {},
              SteadyTime steady_epoch = {});
  SystemClock(const SystemClock&) = delete;
  SystemClock& operator=(const SystemClock&) = delete;

  const OscillatorModel& oscillator() const {
    return master_ != nullptr ? master_->oscillator() : oscillator_;
  }

  SteadyTime steady(TrueTime t) const;
  // The first instant at which the steady clock reads `at` or more.
  TrueTime when(SteadyTime at) const;

  HostTime read(TrueTime t) const {
    if (master_ != nullptr) return master_->read(t);
    const Setting& current = settings_[current_];
    return t >= current.since && t < current.until ? read(current, t) : read_elsewhere(t);
  }
  // The first instant, not before `now`, at which the clock reads `at` or more if nobody adjusts
  // it meanwhile.
  TrueTime when(HostTime at, TrueTime now) const;

  void set(TrueTime at, HostTime value);
  // Rate of the system clock against the oscillator, replacing the one before. |ppb| < 5e8.
  void adjust_frequency(TrueTime at, double ppb);
  // Adds `offset` gradually by a rate of +-max_rate_ppb, which is > 0 and < 5e8. An offset of 0
  // ends an unfinished slew, whatever the rate.
  void slew(TrueTime at, Nanoseconds offset, double max_rate_ppb);

  // When the planned end of a slew will be reached, if there is one that was not yet reported.
  std::optional<TrueTime> settles_at() const;
  // Reports the end of a slew that was reached at or before `now`.
  void settle(TrueTime now);

  // The setting valid at `now`, as an adjustment that changes nothing.
  ClockAdjustment present(TrueTime now) const;
  // From now on passes adjustments to `observer`, in place of the one before.
  void observe(Observer observer) { observer_ = std::move(observer); }

  // Makes this an oracle's clock. Only before any adjustment; the master must outlive this.
  void follow(SystemClock& master);

 private:
  struct Setting {
    TrueTime since;   // valid from here (the first one: from the beginning of time)
    TrueTime until;   // to before here
    TrueTime anchor;  // where the clock read base + base_part_ns
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
  // What the oscillator has counted since the setting's anchor.
  double counted_ns(const Setting& setting, TrueTime t) const {
    return static_cast<double>((t - setting.anchor).count()) +
           (oscillator_.deviation_ns(t) - setting.anchor_deviation_ns);
  }
  Reading reading(const Setting& setting, TrueTime t) const {
    const Nanoseconds true_ns = t - setting.anchor;
    const double ahead_ns = oscillator_.deviation_ns(t) - setting.anchor_deviation_ns;
    const double local_ns = static_cast<double>(true_ns.count()) + ahead_ns;
    const double extra_ns = setting.base_part_ns + ahead_ns + setting.rate() * local_ns;
    const double floor_ns = std::floor(extra_ns);
    return {setting.base + true_ns + Nanoseconds(static_cast<std::int64_t>(floor_ns)),
            extra_ns - floor_ns};
  }
  HostTime read(const Setting& setting, TrueTime t) const { return reading(setting, t).whole; }
  HostTime read_elsewhere(TrueTime t) const;
  const Setting& setting_at(TrueTime t) const;
  // The first instant at which this setting, were it valid for ever, reads `at` or more.
  TrueTime when(const Setting& setting, HostTime at) const;

  // Ends the present setting at `at`, drops what was planned after it, and returns the next one,
  // which goes on in the same way.
  Setting next_setting(TrueTime at);
  // Adds it and, if it slews, the planned end of that; reports it.
  void add(const Setting& setting);
  void report(std::size_t index);
  void notify(ClockAdjustment adjustment) const;

  std::uint32_t host_;
  OscillatorModel oscillator_;
  SteadyTime steady_epoch_;
  std::vector<Setting> settings_;
  mutable std::size_t current_ = 0;  // where the last reading was found
  std::size_t reported_ = 1;         // settings whose begin was reported
  Observer observer_;
  SystemClock* master_ = nullptr;
  std::vector<SystemClock*> followers_;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_CLOCK_SYSTEM_CLOCK_H_
