// What an adjusted clock reads over monotonic time: the last settings of a software clock.
//
// The clock reads setting + (1 + rate) * (what the node's oscillator has counted since the
// setting). A step, a change of rate, a slew and the planned end of that slew each begin a setting.
// The last kHistory are kept, so that stamps of the recent past are read under the setting of their
// time; what is older is read under the oldest.
//
// The same semantics as the simulated clock's (sim/clock/system_clock.h): a slew ends by itself; a
// step or another slew before its end leaves the rest of it undone, a change of rate does not. Each
// adjustment is told to the observer in order of time, also the end of a slew: who wants that in
// time calls settle() at settles_at(). Adjustments come in order of time.
//
// Precision: a setting keeps its part of a nanosecond, so that a rate of 1e-9 survives hours and
// any number of adjustments; readings are rounded down to 1 ns. Values and offsets beyond 146 years
// are cut to that.
//
// Errors: ClockError for a rate that is not finite or not below 0.5; nothing has then changed.
//
//   SystemTimeline timeline(3, oscillator, now, os_time);
//   timeline.slew(now, from_ms(2), 500'000);  // 2 ms at 500 ppm: takes 4 s
//   HostTime reading = timeline.read(kernel_stamp);
#ifndef SIMBENCH_HARDWARE_CLOCK_SYSTEM_TIMELINE_H_
#define SIMBENCH_HARDWARE_CLOCK_SYSTEM_TIMELINE_H_

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include "hardware/clock/node_clock.h"

namespace simbench::hardware {

class SystemTimeline {
 public:
  static constexpr std::size_t kHistory = 64;

  // Reads `reads` at `at`. `host` is the number under which adjustments are told.
  SystemTimeline(std::uint32_t host, const NodeOscillator& oscillator, MonotonicTime at,
                 HostTime reads);

  const NodeOscillator& oscillator() const { return oscillator_; }
  HostTime read(MonotonicTime at) const;
  // The first instant, not before `now`, at which the clock reads `at` or more if nobody adjusts it
  // meanwhile.
  MonotonicTime when(HostTime at, MonotonicTime now) const;

  void set(MonotonicTime at, HostTime value);
  // The same, at rate 0.
  void restart(MonotonicTime at, HostTime value);
  // Rate against the oscillator, replacing the one before.
  void adjust_frequency(MonotonicTime at, double ppb);
  // Adds `offset` gradually by a rate of +-max_rate_ppb. An offset of 0 ends an unfinished slew,
  // whatever the rate.
  void slew(MonotonicTime at, Nanoseconds offset, double max_rate_ppb);

  // When the planned end of a slew will be reached, if there is one that was not yet told.
  std::optional<MonotonicTime> settles_at() const;
  // Tells the end of a slew that was reached at or before `now`.
  void settle(MonotonicTime now);

  ClockAdjustment present(MonotonicTime now) const;
  void observe(NodeClock::Observer observer) { observer_ = std::move(observer); }

 private:
  struct Setting {
    MonotonicTime since;  // valid from here until the next one's
    HostTime base;        // what the clock read then, whole
    double base_part_ns = 0;
    double frequency = 0;     // rate that stays, as a fraction
    double slew_rate = 0;     // rate that ends with the slew
    double slew_left_ns = 0;  // then
    double rate() const { return frequency + slew_rate; }
  };
  struct Reading {
    HostTime whole;
    double part_ns = 0;
  };

  double counted_ns(const Setting& setting, MonotonicTime at) const;
  Reading reading(const Setting& setting, MonotonicTime at) const;
  const Setting& setting_at(MonotonicTime at) const;
  MonotonicTime when(const Setting& setting, HostTime at) const;
  // What the setting is from `at` on.
  Setting gone_on(const Setting& setting, MonotonicTime at) const;
  // The present setting, going on from `at`; what was planned is settled or forgotten.
  Setting next_setting(MonotonicTime at);
  // Adds and tells it, and plans the end of its slew.
  void add(const Setting& setting);
  void begin(const Setting& setting);

  std::uint32_t host_;
  NodeOscillator oscillator_;
  std::deque<Setting> settings_;
  std::optional<Setting> planned_;  // after the present slew
  NodeClock::Observer observer_;
};

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_CLOCK_SYSTEM_TIMELINE_H_
