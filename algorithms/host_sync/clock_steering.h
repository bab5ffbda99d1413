// The own system clock: estimating it from coarse readings, and steering it along a line.
//
// Estimating. A reading is rounded down to the clock's granularity (100 ns to 15.6 ms), but between
// adjustments the clock is an exact line over the steady clock, and this object makes all the
// adjustments itself. The reading that lies highest above the predicted line was rounded least: N
// readings find a line that is late by 1 / N of the granularity. The highest of the last kMemory to
// 2 kMemory counts. A step by another program is detected at once: a forward one as a higher
// reading, a backward one as a reading that falls below by more than rounding explains (twice the
// largest fall seen and kSmallestFall; kLargestGranularity at first).
//
// Steering. steer() makes the clock follow a ClockLine: it steps if the clock is further off than
// step_threshold (the step allows for the delay of the last set call; the rest is slewed the next
// time), else sets the rate to the line's and slews the rest within `settle`, at most at
// max_slew_ppm. Offset and rate are thus both right, without a loop gain. Less than kIgnored is
// left alone: each adjustment is a call that costs time.
//
// Only one coroutine at a time may steer; others may observe meanwhile.
// Complexity: O(1). Source: docs/design.md section 4; docs/reference/calibration.md section 2
// (coarse read, cost of set).
//
//   SteeredClock clock(host, {});
//   clock.observe(message.received, message.received_steady);
//   co_await clock.steer(line);
#pragma once

#include <algorithm>

#include "algorithms/parameter_binder.h"
#include "algorithms/ports/host.h"
#include "algorithms/ports/time.h"

namespace simbench {

// Another clock as a straight line over the own steady clock.
//
// Estimators of a remote clock return it and the steering of a system clock takes it: neither
// depends on how the own system clock was set or slewed meanwhile.
//
//   ClockLine line{.at = s, .value = m, .rate_ppb = 12'000};   // at s it read m, and gains 12 ppm
//   HostTime then = line.read(s + from_ms(1000));              // m + 1.000012 s
struct ClockLine {
  SteadyTime at{};
  HostTime value{};
  double rate_ppb = 0;  // against the steady clock

  HostTime read(SteadyTime when) const {
    const Nanoseconds since = when - at;
    const double gained_ns = static_cast<double>(since.count()) * rate_ppb * 1e-9;
    return value + since + from_ns(gained_ns);
  }
  // The instant at which it reads `reading`, to the nanosecond.
  SteadyTime when(HostTime reading) const {
    SteadyTime guess = at + (reading - value);
    // Each pass multiplies the error by the rate, which is far below 1e-2.
    for (int pass = 0; pass < 4; ++pass) guess += reading - read(guess);
    return guess;
  }
};

struct SteeringSettings {
  Nanoseconds step_threshold = from_ms(5);
  double max_slew_ppm = 500;
  Nanoseconds settle = from_ms(1000);

  void bind(ParameterBinder& parameters);
};

class SteeredClock {
 public:
  static constexpr Nanoseconds kMemory{30'000'000'000};
  static constexpr Nanoseconds kLargestGranularity{20'000'000};
  static constexpr Nanoseconds kSmallestFall{10'000};
  static constexpr int kFirstReadings = 16;
  static constexpr Nanoseconds kIgnored{20};

  // The host must outlive this.
  SteeredClock(Host& host, SteeringSettings settings) : host_(host), settings_(settings) {}

  // A reading of the system clock, and of the steady clock at the same instant.
  void observe(HostTime reading, SteadyTime at);
  // Reads both clocks.
  Task<void> look();
  bool is_known() const { return is_known_; }
  // The system clock at a recent or near instant, and back; before the first observation both
  // clocks count as equal.
  HostTime at(SteadyTime when) const;
  SteadyTime when(HostTime reading) const;
  // A reading that is off by no more than this is explained by rounding, else by a step.
  Nanoseconds uncertainty() const { return largest_plausible_fall(); }

  Task<void> steer(ClockLine line);
  // How far the clock is ahead of a line now.
  Nanoseconds lead_over(const ClockLine& line) const;

 private:
  // The clock without observations: from `since` on it goes on at `rate`, plus a slew.
  struct Prediction {
    SteadyTime since{};
    HostTime value{};
    double part_ns = 0;  // on top of value
    double rate = 0;     // against the steady clock
    double slew_rate = 0;
    double slew_ns = 0;  // what is left of it

    // Nanoseconds gained on the steady clock since `since`.
    double gained_ns(SteadyTime when) const;
  };

  HostTime predicted(SteadyTime when) const;
  // Starts a new prediction where the old one is at `when`.
  void go_on_from(SteadyTime when);
  Nanoseconds highest() const { return std::max(highest_, highest_before_); }
  Nanoseconds largest_plausible_fall() const;
  void forget();
  Task<void> step_to(ClockLine line);

  Host& host_;
  SteeringSettings settings_;
  Prediction prediction_;
  bool is_known_ = false;
  // Readings above the prediction: the highest of the present and the last period of kMemory.
  SteadyTime period_begin_{};
  Nanoseconds highest_{0};
  Nanoseconds highest_before_{0};
  int readings_ = 0;
  Nanoseconds largest_fall_{0};
  // From the beginning of a set call to the instant at which it takes effect.
  Nanoseconds set_delay_{0};
};

}  // namespace simbench
