// A pulse line of a simulated host: pulses interrupt it, and the interrupt reads its clocks.
//
// A pulse is stamped interrupt_latency_us + Exp(interrupt_latency_exponential_us) after it came,
// drawn per line, host and pulse; stamps are the kernel's, on the system clock's ticks but not
// rounded to the interface's resolution. Interrupts are served in the order of the pulses. They are
// not delayed by the CPU's other work, and next() returns at the instant of the stamp.
//
// Pulses are kept from the host's first pulse_input() for this line on. They need not be generated
// meanwhile: pulses and clocks can be asked about the past, so what came while nobody waited is
// worked out when somebody asks, as far as the last 1024 pulses reach. Cost: an event per pulse
// that is waited for; none otherwise.
//
// Source: docs/design.md section 7; algorithms/ports/host.h (PulseInput).
#ifndef SIMBENCH_SIM_HOST_SIM_PULSE_INPUT_H_
#define SIMBENCH_SIM_HOST_SIM_PULSE_INPUT_H_

#include <cstdint>
#include <optional>
#include <string_view>

#include "algorithms/ports/host.h"
#include "sim/engine/random.h"
#include "sim/engine/virtual_executor.h"
#include "sim/host/pulse_sources.h"

namespace simbench::sim {

class SimHost;

class SimPulseInput final : public PulseInput {
 public:
  // `host` and `source` must outlive the line, `name` tells the lines of a host apart.
  SimPulseInput(SimHost& host, const PulseSource& source, std::string_view name);

  Task<std::optional<PulseStamp>> next(SteadyTime deadline) override;

  // The source knows more than before.
  void source_changed() { changed_.notify(); }

 private:
  // When the next pulse that was not yet given out is stamped; makes number_ its number.
  std::optional<TrueTime> next_interrupt();
  PulseStamp stamp(std::int64_t number, TrueTime interrupt) const;

  SimHost& host_;
  const PulseSource& source_;
  ComponentKey latency_key_;
  TrueTime opened_at_;
  WaitPoint changed_;
  std::optional<std::int64_t> number_;
  TrueTime last_interrupt_ = TrueTime::min();
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_HOST_SIM_PULSE_INPUT_H_
