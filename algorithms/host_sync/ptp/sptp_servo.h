// What the client of SPTP (sptp.h) makes of its exchanges: a path delay, an offset, a frequency.
// They only compute.
//
// Source: facebook/time, ptp/sptp/client/measurements.go and sptp.go, servo/pi.go. Left out: its
// check for late ticks of its own timer, the choice among several servers, and the rounding of its
// filter to whole nanoseconds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "algorithms/host_sync/ptp/ptp_port.h"
#include "algorithms/host_sync/ptp/ptp_servo.h"
#include "algorithms/ports/time.h"

namespace simbench {

// The stamps of an exchange: the Sync leaves the server at t1 and arrives at t2, the Delay_Req
// leaves the client at t3 and arrives at t4; with the corrections of transparent clocks.
struct SptpExchange {
  std::int64_t t1 = 0;
  std::int64_t t2 = 0;
  std::int64_t t3 = 0;
  std::int64_t t4 = 0;
  Nanoseconds sync_correction{0};
  Nanoseconds request_correction{0};

  Nanoseconds from_server() const { return Nanoseconds(t2 - t1) - sync_correction; }
  Nanoseconds to_server() const { return Nanoseconds(t4 - t3) - request_correction; }
};

// The path delay: the median of the last `length` that were not discarded. Discarded are those
// below discard_below, and those that are above both discard_from and `multiplier` times the path
// delay once the window is full and the latter product is above discard_below; the first one never
// is.
//
//   SptpPathDelay delay({});
//   const Nanoseconds offset = delay.offset(SptpExchange{});
class SptpPathDelay {
 public:
  struct Settings {
    std::size_t length = 59;
    Nanoseconds discard_below{0};
    Nanoseconds discard_from{20'000};
    double multiplier = 3;
  };

  explicit SptpPathDelay(Settings settings) : settings_(settings), median_(settings.length) {}

  // Client minus server: the way from the server, less the path delay.
  Nanoseconds offset(const SptpExchange& exchange);

 private:
  bool is_discarded(Nanoseconds delay) const;

  Settings settings_;
  MovingMedian median_;
  std::size_t taken_ = 0;
  Nanoseconds path_delay_{0};
};

// A PI servo whose input passes a filter of spikes.
//
// An offset is a spike if it exceeds 15 us and 3 s + T (3 f + 20 ppb), with the standard deviations
// s of the last 30 offsets and f of the last 30 frequencies at which the offset was within 100 ns,
// and the time T since the last correction. After a spike, or without an exchange, the clock runs
// at the mean of those 30 frequencies (before there are 30: 0). After 15 spikes in a row the servo
// begins anew. A step leaves the frequency as it is until the next exchange.
//
//   SptpServo servo({.first_step_threshold_ns = 20'000});
//   const SptpServo::Answer answer = servo.sample(offset_ns, t2_ns, now);
class SptpServo {
 public:
  enum class Action : std::uint8_t { kNone, kStep, kSetFrequency };
  struct Answer {
    Action action = Action::kNone;
    double ppb = 0;
    bool is_locked = false;
  };

  explicit SptpServo(ServoSettings settings) : pi_(PiServo::kSimplePtp, settings) {}

  Answer sample(double offset_ns, std::int64_t local_ns, SteadyTime now);
  // An exchange has failed.
  Answer hold() const {
    return {.action = Action::kSetFrequency, .ppb = mean_ppb_, .is_locked = false};
  }
  double first_frequency_s() const { return pi_.first_frequency_s(); }

 private:
  bool is_spike(double offset_ns, SteadyTime now);
  void remember(double offset_ns, double ppb);

  PiServo pi_;
  std::deque<double> offsets_ns_;
  std::deque<double> frequencies_ppb_;
  double offset_sigma_ns_ = 0;
  double frequency_sigma_ppb_ = 0;
  double mean_ppb_ = 0;
  int spikes_ = 0;
  SteadyTime last_correction_{};
};

}  // namespace simbench
