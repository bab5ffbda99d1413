// A simulated network card's own clock (PTP hardware clock) and the stamps it takes.
//
// The clock has an oscillator of its own, N(skew_sigma_ppm) per host, and reads anything within an
// hour at true zero. Every reading has noise N(stamp_jitter_sigma_ns) and is rounded down to
// stamp_resolution_ns.
//
// A call occupies the host's CPU for cross_stamp_cost_ms and touches the card in the middle of
// that: there it is read, stepped or adjusted. The system clock of a cross stamp is read at the
// beginning and at the end, as the kernel does, on its ticks but not rounded to the interface's
// resolution. Changes of rate must stay below 5e8 ppb.
//
// Messages are stamped by their last bit at both ends: when it passes the sender's port, behind
// what was queued there, and when it reaches the receiver, before anything wakes up.
//
// Source: docs/design.md section 7; scenario /hosts/nic; Linux PTP_SYS_OFFSET_EXTENDED.
//
//   NicClock nic(host);
//   const CrossStamp stamp = co_await nic.cross_stamp();
#ifndef SIMBENCH_SIM_HOST_NIC_CLOCK_H_
#define SIMBENCH_SIM_HOST_NIC_CLOCK_H_

#include <string>

#include "algorithms/ports/host.h"
#include "sim/clock/system_clock.h"
#include "sim/engine/random.h"
#include "sim/host/cpu.h"

namespace simbench::sim {

class SimHost;

class NicClock final : public HardwareClock {
 public:
  // `host` must outlive the clock.
  explicit NicClock(SimHost& host);

  Task<CrossStamp> cross_stamp() override;
  Task<void> step(Nanoseconds offset) override;
  Task<void> adjust_frequency(double ppb) override;

  // The stamp of what happened at `at`, with noise from `draw`.
  HardwareTime stamp(TrueTime at, RandomStream& draw) const;

 private:
  struct Call {
    Cpu::Turn turn;
    TrueTime touch;
  };

  Call begin_call();
  Task<void> wait_until(TrueTime at);

  SimHost& host_;
  SystemClock clock_;
  RandomStream read_noise_;
  std::string label_;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_HOST_NIC_CLOCK_H_
