// The pulse lines of a host: the sources of pulses, and how the host stamps them.
//
//  - PulseSchedule: a GNSS receiver beside the host (PpsReceiver), or the trigger (TriggerLine).
//    Pulses are numbered and each is a function of its number, so they need no generation: an
//    unused line costs nothing, however long it is connected.
//  - SimPulseInput: the line at the host. A pulse interrupts it, and the interrupt reads its
//    clocks.
//
// Source: docs/design.md section 7; scenario /hosts/pulse_lines; algorithms/ports/host.h
// (PulseInput).
//
//   PpsReceiver receiver(scenario.hosts.pulse_lines, seed, 3);
//   const std::optional<TrueTime> at = receiver.pulse(*receiver.first_from(engine.now()));
//
//   SimPulseInput line(host, receiver, "pps");
//   const std::optional<PulseStamp> stamp = co_await line.next(steady_deadline);
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include "algorithms/ports/exchange.h"
#include "algorithms/ports/host.h"
#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/engine/random.h"
#include "sim/engine/virtual_executor.h"
#include "sim/trigger/trigger_tree.h"

namespace simbench::sim {

class SimHost;

class PulseSchedule {
 public:
  virtual ~PulseSchedule() = default;
  // The first pulse due at or after `at`; nothing while it is not known when pulses will come.
  virtual std::optional<std::int64_t> first_from(TrueTime at) const = 0;
  // The number of the last pulse there will be.
  virtual std::int64_t last() const { return std::numeric_limits<std::int64_t>::max(); }
  // When the pulse reaches the host; nothing if it is missing.
  virtual std::optional<TrueTime> pulse(std::int64_t number) const = 0;
  // The time at the pulse, if the source announces it.
  virtual std::optional<Nanoseconds> announced_time(std::int64_t /*number*/) const {
    return std::nullopt;
  }
};

// GNSS time is true time plus a constant, the same for all hosts and seeds: it reads 302,400.25 s
// (half a week and a quarter of a second) at true zero.
inline constexpr Nanoseconds kGnssTimeAtTrueZero = std::chrono::milliseconds(302'400'250);

// A receiver's pulse k is at k full seconds of GNSS time, with an error N(pps_jitter_sigma_us) per
// pulse and host; its message announces k seconds.
class PpsReceiver final : public PulseSchedule {
 public:
  PpsReceiver(const scenarios::PulseLines& lines, std::uint64_t run_seed, PeerId host);

  std::optional<std::int64_t> first_from(TrueTime at) const override;
  std::optional<TrueTime> pulse(std::int64_t number) const override;
  std::optional<Nanoseconds> announced_time(std::int64_t number) const override;

 private:
  std::uint64_t run_seed_;
  PeerId host_;
  double jitter_sigma_us_;
  bool announces_time_;
};

// The main trigger's pulses, during a capture; numbers are slots, and empty slots have none. The
// cable to the host is part of the interrupt's fixed latency.
class TriggerLine final : public PulseSchedule {
 public:
  // The trigger has started: `tree`, which must outlive the line, has pulses up to slot `last`.
  void start(const TriggerTree& tree, std::int64_t last);

  std::optional<std::int64_t> first_from(TrueTime at) const override;
  std::int64_t last() const override { return last_; }
  std::optional<TrueTime> pulse(std::int64_t number) const override { return tree_->pulse(number); }

 private:
  const TriggerTree* tree_ = nullptr;
  std::int64_t last_ = 0;
};

// A pulse is stamped interrupt_latency_us + Exp(interrupt_latency_exponential_us) after it came,
// drawn per line, host and pulse, times a factor of the host, exp(N(interrupt_latency_log_sigma)):
// machines differ, so latencies do not cancel between them. Stamps are the kernel's, on the system
// clock's ticks but not rounded to the interface's resolution. Interrupts are served in the order
// of the pulses, without delay by the CPU's other work, and next() returns at the instant of the
// stamp.
//
// Pulses are kept from the host's first pulse_input() for this line on. They are not generated
// meanwhile: pulses and clocks can be read in the past, so those that came while no coroutine
// waited are computed at the next call, up to the last 1024. Cost: an event per awaited pulse.
class SimPulseInput final : public PulseInput {
 public:
  // `host` and `source` must outlive the line, `name` tells the lines of a host apart.
  SimPulseInput(SimHost& host, const PulseSchedule& source, std::string_view name);

  Task<std::optional<PulseStamp>> next(SteadyTime deadline) override;

  // As next(), with what no algorithm is told.
  struct Pulse {
    std::int64_t number = 0;  // the source's
    TrueTime at;              // when it reached the host
    PulseStamp stamp{};
  };
  Task<std::optional<Pulse>> next_pulse(SteadyTime deadline);

  // The source has other pulses than before.
  void source_changed() { changed_.notify(); }

 private:
  // When the next pulse that no call has returned is stamped; sets number_ to its number.
  std::optional<TrueTime> next_interrupt();
  PulseStamp stamp(std::int64_t number, TrueTime interrupt) const;

  SimHost& host_;
  const PulseSchedule& source_;
  ComponentKey latency_key_;
  double latency_factor_;
  TrueTime opened_at_;
  WaitPoint changed_;
  std::optional<std::int64_t> number_;
  TrueTime last_interrupt_ = TrueTime::min();
};

}  // namespace simbench::sim
