// A simulated host's clocks behind the calls of its programs, which take time on its CPU.
//
//  - Cpu: whatever costs time is served one after the other.
//  - ClockPort: the system clock. SteadyPort: the steady clock, read at no cost and exactly.
//  - NicClock: the network card's own clock, and the stamps that the card takes.
//
// Source: docs/reference/calibration.md section 2 (steps 3 and 5); docs/design.md sections 4 and 7;
// scenario /hosts/clock and /hosts/nic; Linux PTP_SYS_OFFSET_EXTENDED.
//
//   const Cpu::Turn turn = cpu.reserve(from_ms(4.5));
//   co_await sleep_until(context, turn.end, "host3: set clock");
//
//   NicClock nic(host);
//   const CrossStamp stamp = co_await nic.cross_stamp();
#pragma once

#include <algorithm>
#include <functional>
#include <string>

#include "algorithms/ports/host.h"
#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/clock/clock_interface.h"
#include "sim/clock/system_clock.h"
#include "sim/engine/engine.h"
#include "sim/engine/random.h"
#include "sim/engine/virtual_executor.h"

namespace simbench::sim {

class SimHost;

// The one CPU of a host; it serves requests in their order.
class Cpu {
 public:
  struct Turn {
    TrueTime start;
    TrueTime end;
  };

  explicit Cpu(const Engine& engine) : engine_(engine) {}

  // Reserves the next free `cost` of CPU time.
  Turn reserve(Nanoseconds cost) {
    const TrueTime start = std::max(engine_.now(), free_at_);
    free_at_ = start + cost;
    return {start, free_at_};
  }

 private:
  const Engine& engine_;
  TrueTime free_at_ = TrueTime::min();
};

// The system clock.
//
//  - A get takes read_cost_ms and returns the reading of its start.
//  - A call that changes the clock (set, adjust_frequency, slew) takes set_cost_ms times the host's
//    factor times exp(N(set_cost_call_log_sigma)); the change counts set_effective_fraction into
//    the call.
// Readings and settings pass the clock's granularity (sim/clock/clock_interface.h).
class ClockPort final : public HostClock {
 public:
  struct Parts {
    VirtualContext& context;
    SystemClock& clock;
    Cpu& cpu;
    const scenarios::HostClockModel& parameters;
  };

  // All parts must outlive the port. `draws` is for the factors of the calls; `host_name` labels
  // waits.
  ClockPort(const Parts& parts, const ClockInterface& interface, double set_cost_factor,
            RandomStream draws, const std::string& host_name);

  Task<HostTime> now() override;
  Task<void> set(HostTime value) override;
  Task<void> adjust_frequency(double ppb) override;
  Task<void> slew(Nanoseconds offset, double max_rate_ppb) override;

  // Any other call that changes the clock: `apply` runs when the change counts. What it refers to
  // must outlive the call.
  using Apply = std::function<void(SystemClock& clock, TrueTime at)>;
  Task<void> change(Apply apply);

 private:
  struct Change {
    TrueTime effective;
    TrueTime end;
  };

  TrueTime true_now() const { return parts_.context.engine().now(); }
  Change begin_change();
  // Schedules the report of a slew's end.
  void settle_in_time();
  void settle();

  Parts parts_;
  ClockInterface interface_;
  Nanoseconds read_cost_;
  double set_cost_ms_;
  RandomStream draws_;
  std::string get_label_;
  std::string set_label_;
};

class SteadyPort final : public SteadyClock {
 public:
  SteadyPort(const Engine& engine, const SystemClock& clock) : engine_(engine), clock_(clock) {}
  SteadyTime now() const override {
    if (engine_.now() != read_at_) {
      read_at_ = engine_.now();
      reading_ = clock_.steady(read_at_);
    }
    return reading_;
  }

 private:
  const Engine& engine_;
  const SystemClock& clock_;
  // A cache: programs read it several times in one instant.
  mutable TrueTime read_at_ = TrueTime::min();
  mutable SteadyTime reading_{};
};

// The clock has an oscillator of its own, N(skew_sigma_ppm) per host, and reads anything within an
// hour at true zero. Every reading has noise N(stamp_jitter_sigma_ns) and is rounded down to
// stamp_resolution_ns.
//
// A call occupies the host's CPU for cross_stamp_cost_ms and reads, steps or adjusts the card in
// the middle of that. The system clock of a cross stamp is read at the beginning and at the end, as
// the kernel does, on its ticks but not rounded to the interface's resolution. A cross stamp reads
// the card later than the middle, by Exp(cross_stamp_exponential_us) that is not in the call's
// duration, as on a bus that is not equally fast both ways; and rarely it is interrupted on either
// side of that (cross_stamp_spike_*). Changes of rate must
// stay within max_adjustment_ppm.
//
// Messages are stamped by their last bit at both ends: when it passes the sender's port, behind
// what was queued there, and when it reaches the receiver, before anything wakes up.
class NicClock final : public HardwareClock {
 public:
  // `host` must outlive the clock.
  explicit NicClock(SimHost& host);

  Task<CrossStamp> cross_stamp() override;
  Task<void> step(Nanoseconds offset) override;
  // As step(), to a reading.
  Task<void> set(HardwareTime value);
  Task<void> adjust_frequency(double ppb) override;
  double max_frequency_ppb() const override;

  // The stamp of an event at `at`, with noise from `draw`.
  HardwareTime stamp(TrueTime at, RandomStream& draw) const;

 private:
  struct Call {
    Cpu::Turn turn;
    TrueTime touch;
  };

  Call begin_call();
  // With the delays that a reading of both clocks meets.
  Call begin_cross_stamp();
  Task<void> wait_until(TrueTime at);

  SimHost& host_;
  SystemClock clock_;
  Granularity resolution_;
  RandomStream read_noise_;
  RandomStream bus_noise_;
  std::string label_;
};

}  // namespace simbench::sim
