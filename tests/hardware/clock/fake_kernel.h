// A kernel whose clocks go when the test says so: what clock_gettime, clock_settime and adjtimex do
// on Linux, as far as an OsClock uses them.
#pragma once

#include <cmath>

#include "hardware/clock/os_clock.h"

namespace simbench::hardware {

class FakeKernel final : public ClockCalls {
 public:
  static constexpr double kUnitsPerPpm = 65536;

  // The frequency moves both clocks; every reading takes 20 ns.
  void advance(Nanoseconds raw) {
    const auto raw_ns = static_cast<long double>(raw.count());
    raw_ns_ += raw_ns;
    monotonic_ns_ += raw_ns * (1 + static_cast<long double>(frequency) / kUnitsPerPpm * 1e-6L);
  }
  // What an oscillator that nobody touches has counted.
  long double raw_ns() const { return raw_ns_; }
  MonotonicTime monotonic_now_reads() const {
    return start_ + Nanoseconds(static_cast<std::int64_t>(std::floor(monotonic_ns_)));
  }
  HostTime system_now_reads() const {
    return HostTime(monotonic_now_reads().time_since_epoch() + ahead);
  }

  MonotonicTime monotonic() override {
    advance(Nanoseconds(20));
    return monotonic_now_reads();
  }
  HostTime system() override {
    advance(Nanoseconds(20));
    return system_now_reads();
  }
  int set_system(HostTime value) override {
    ++setter_calls;
    if (error != 0) return error;
    ahead = value.time_since_epoch() - monotonic_now_reads().time_since_epoch();
    return 0;
  }
  int adjust(timex& request) override {
    if (request.modes != 0) {
      ++setter_calls;
      if (error != 0) return error;
      frequency = request.freq;
    }
    request.freq = frequency;
    request.status = status;
    return 0;
  }

  Nanoseconds ahead{1'700'000'000'000'000'000};
  long frequency = 0;
  int status = STA_UNSYNC;
  int error = 0;  // of calls that set something
  int setter_calls = 0;

 private:
  // Timers of the context under test follow the real clock, from which this one starts.
  MonotonicTime start_ = monotonic_now();
  long double raw_ns_ = 0;
  long double monotonic_ns_ = 0;
};

}  // namespace simbench::hardware
