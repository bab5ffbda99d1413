// A simulated host's clocks: its steady clock, which is its oscillator, and its system clock on top
// of that, read at instants of true time.
//
// The system clock is a disciplined clock (clocks/disciplined_clock.h has its contract) that keeps
// its last 262,144 settings, so that it can be read at any instant, also a past one. Readings are
// exact, rounded down to 1 ns; programs read it through sim/clock/clock_interface.h.
//
// The clock of an oracle's slave follows the master's: both its clocks are the master's at every
// instant, its own adjustments have no effect, and it reports the master's adjustments.
//
// Source: docs/design.md sections 4, 5 and 7; docs/reference/calibration.md section 2 ("Host
// clock").
//
//   SystemClock clock(3, OscillatorModel(10e-6), from_ms(250));
//   clock.set(now, HostTime(from_ms(1000)));
//   clock.slew(now + from_ms(5), from_ms(2), 500'000);  // 2 ms at 500 ppm: takes 4 s
//   HostTime reading = clock.read(now + from_ms(7));
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "clocks/disciplined_clock.h"
#include "sim/clock/oscillator.h"

namespace simbench::sim {

// A host's oscillator with its steady clock, which reads `steady_epoch` at true zero.
struct HostOscillator {
  using Instant = TrueTime;
  SteadyTime steady_epoch{};
  OscillatorModel model;
  // A cache: programs read their clocks several times in one instant. Not where a look costs less.
  mutable TrueTime last_at = TrueTime::min();
  mutable double last_deviation_ns = 0;

  double deviation_ns(TrueTime t) const {
    return model.is_steady() ? model.deviation_ns(t) : remembered_deviation_ns(t);
  }
  double remembered_deviation_ns(TrueTime t) const {
    if (t != last_at) {
      last_deviation_ns = model.deviation_ns(t);
      last_at = t;
    }
    return last_deviation_ns;
  }
  SteadyTime steady(TrueTime t) const { return steady(t, deviation_ns(t)); }
  SteadyTime steady(TrueTime t, double deviation_ns) const {
    return steady_epoch + t.time_since_epoch() + from_ns_down(deviation_ns);
  }
};

class SystemClock {
 public:
  using Observer = std::function<void(const ClockAdjustment&)>;

  // Reads `offset` and the steady clock reads `steady_epoch` at true zero.
  SystemClock(std::uint32_t host, OscillatorModel oscillator, Nanoseconds offset = {},
              SteadyTime steady_epoch = {});
  SystemClock(const SystemClock&) = delete;
  SystemClock& operator=(const SystemClock&) = delete;

  const OscillatorModel& oscillator() const { return clock_->oscillator().model; }

  SteadyTime steady(TrueTime t) const { return clock_->oscillator().steady(t); }
  // The first instant at which the steady clock reads `at` or more.
  TrueTime when(SteadyTime at) const;

  // In place, as the clock's own.
  [[gnu::always_inline]] HostTime read(TrueTime t) const { return clock_->read(t); }
  // Both clocks at one instant, whose oscillator is looked at once.
  struct Reading {
    HostTime system;
    SteadyTime steady;
  };
  Reading read_both(TrueTime t) const {
    const HostOscillator& oscillator = clock_->oscillator();
    const double deviation_ns = oscillator.deviation_ns(t);
    return {clock_->read(t, deviation_ns), oscillator.steady(t, deviation_ns)};
  }
  // Prepare a reading (clocks::DisciplinedClock).
  void prefetch() const { own_.prefetch(); }
  void prefetch_setting() const { clock_->prefetch_setting(); }
  // How far the clock is ahead of true time, with its part of a nanosecond.
  double ahead_ns(TrueTime t) const {
    return clock_->read_since_ns(t, HostTime(t.time_since_epoch()));
  }
  // The first instant, not before `now`, at which the clock reads `at` or more without a further
  // adjustment.
  TrueTime when(HostTime at, TrueTime now) const;

  void set(TrueTime at, HostTime value);
  void adjust_frequency(TrueTime at, double ppb);
  void slew(TrueTime at, Nanoseconds offset, double max_rate_ppb);

  // A leap second: adds `offset` at once, whatever else is under way.
  void leap(TrueTime at, Nanoseconds offset);
  // A rate on top of what programs set; 0 ends it.
  void smear(TrueTime at, double ppb);

  // The planned end of a slew, if there is one that was not yet reported.
  std::optional<TrueTime> settles_at() const { return own_.settles_at(); }
  // Reports the end of a slew that was reached at or before `now`.
  void settle(TrueTime now) { own_.settle(now); }

  // The setting valid at `now`, as an adjustment that changes nothing.
  ClockAdjustment present(TrueTime now) const;
  // From now on passes adjustments to `observer`, in place of the one before.
  void observe(Observer observer) { observer_ = std::move(observer); }

  // Makes this an oracle's clock. Only before any adjustment; the master must outlive this.
  void follow(SystemClock& master);

 private:
  using Clock = clocks::DisciplinedClock<HostOscillator>;
  bool is_follower() const { return clock_ != &own_; }
  void notify(ClockAdjustment adjustment);

  const Clock* clock_ = &own_;  // the master's, if this one follows it
  Clock own_;
  std::uint32_t host_;
  bool is_adjusted_ = false;
  double frequency_ppb_ = 0;  // as set by programs
  double smear_ppb_ = 0;
  Observer observer_;
  std::vector<SystemClock*> followers_;
};

// How far each clock is from the first, the master's, at `t`; as many `errors` as clocks.
void read_errors(std::span<SystemClock* const> clocks, TrueTime t, std::span<Nanoseconds> errors);

}  // namespace simbench::sim
