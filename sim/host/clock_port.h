// A simulated host's clocks as programs reach them: through calls that take time on its CPU.
//
//  - A get takes read_cost_ms and returns the reading of its start.
//  - A call that changes the clock (set, adjust_frequency, slew) takes set_cost_ms times the host's
//    factor times exp(N(set_cost_call_log_sigma)); the change counts set_effective_fraction into
//    the call.
// Readings and settings pass the clock's granularity (sim/clock/clock_interface.h). The steady
// clock is read at no cost and exactly.
//
// Source: docs/reference/calibration.md section 2 (steps 3 and 5); docs/design.md section 4.
#ifndef SIMBENCH_SIM_HOST_CLOCK_PORT_H_
#define SIMBENCH_SIM_HOST_CLOCK_PORT_H_

#include <string>

#include "algorithms/ports/host.h"
#include "scenarios/scenario.h"
#include "sim/clock/clock_interface.h"
#include "sim/clock/system_clock.h"
#include "sim/engine/random.h"
#include "sim/engine/virtual_executor.h"
#include "sim/host/cpu.h"

namespace simbench::sim {

class ClockPort final : public HostClock {
 public:
  struct Parts {
    VirtualContext& context;
    SystemClock& clock;
    Cpu& cpu;
    const scenarios::HostClock& parameters;
  };

  // All parts must outlive the port. `draws` gives the factors of the calls; `host_name` labels
  // waits.
  ClockPort(const Parts& parts, const ClockInterface& interface, double set_cost_factor,
            RandomStream draws, const std::string& host_name);

  Task<HostTime> now() override;
  Task<void> set(HostTime value) override;
  Task<void> adjust_frequency(double ppb) override;
  Task<void> slew(Nanoseconds offset, double max_rate_ppb) override;

 private:
  struct Change {
    TrueTime effective;
    TrueTime end;
  };

  TrueTime true_now() const { return parts_.context.engine().now(); }
  Change begin_change();
  // Has the end of a slew reported when it comes.
  void settle_in_time();

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
  SteadyTime now() const override { return clock_.steady(engine_.now()); }

 private:
  const Engine& engine_;
  const SystemClock& clock_;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_HOST_CLOCK_PORT_H_
