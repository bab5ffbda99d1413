// Where the pulses on a host's lines come from: a GNSS receiver beside the host, or the trigger.
//
// Pulses are numbered and each is a function of its number, so nobody has to generate them: a line
// that no one looks at costs nothing, however long it is connected.
//
// GNSS time is true time plus a constant, the same for all hosts and seeds: it reads 302,400.25 s
// (half a week and a quarter of a second) at true zero. A receiver's pulse k is at k full seconds
// of GNSS time, with an error N(pps_jitter_sigma_us) of its own per pulse and host; its message
// says k seconds.
//
// The trigger's pulses are the main trigger's, during a capture; numbers are slots, and empty slots
// have none. The cable to the host is part of the interrupt's fixed latency.
//
// Source: docs/design.md section 7; scenario /hosts/pulse_lines.
//
//   PpsReceiver receiver(scenario.hosts.pulse_lines, seed, 3);
//   const auto next = receiver.first_from(engine.now());
//   const std::optional<TrueTime> at = receiver.pulse(*next);
#ifndef SIMBENCH_SIM_HOST_PULSE_SOURCES_H_
#define SIMBENCH_SIM_HOST_PULSE_SOURCES_H_

#include <cstdint>
#include <limits>
#include <optional>

#include "algorithms/ports/exchange.h"
#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/trigger/trigger_tree.h"

namespace simbench::sim {

class PulseSource {
 public:
  virtual ~PulseSource() = default;
  // The first pulse due at or after `at`; nothing while it is not known when pulses will come.
  virtual std::optional<std::int64_t> first_from(TrueTime at) const = 0;
  // The number of the last pulse there will be.
  virtual std::int64_t last() const { return std::numeric_limits<std::int64_t>::max(); }
  // When the pulse reaches the host; nothing if it is missing.
  virtual std::optional<TrueTime> pulse(std::int64_t number) const = 0;
  // What the time was at the pulse, if the source tells.
  virtual std::optional<Nanoseconds> told_time(std::int64_t /*number*/) const {
    return std::nullopt;
  }
};

inline constexpr Nanoseconds kGnssTimeAtTrueZero = std::chrono::milliseconds(302'400'250);

class PpsReceiver final : public PulseSource {
 public:
  PpsReceiver(const scenarios::PulseLines& lines, std::uint64_t run_seed, PeerId host);

  std::optional<std::int64_t> first_from(TrueTime at) const override;
  std::optional<TrueTime> pulse(std::int64_t number) const override;
  std::optional<Nanoseconds> told_time(std::int64_t number) const override;

 private:
  std::uint64_t run_seed_;
  PeerId host_;
  double jitter_sigma_us_;
  bool tells_time_;
};

class TriggerLine final : public PulseSource {
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

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_HOST_PULSE_SOURCES_H_
