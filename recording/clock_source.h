// The interface of a backend that runs the hosts' clocks alone: no cameras, no trigger, no frames.
//
// A run begins at true zero with clocks that are not synchronised, and with host synchronisation.
// The clocks are read at equal intervals; with a loss of the master, which begins at `duration`,
// they are read on until it is over and `recovery` has passed. Readings go on whatever the
// synchronisation does: one that has ended leaves free-running clocks.
//
// Errors are those against the master's clock, the reference of a rig, in seconds: a difference of
// two readings with their part of a nanosecond. A double holds them to 1e-16 of their size.
//
//   struct Last : ClockSink {
//     void on_errors(TrueTime, std::span<const double> errors_s) override { at_end = errors_s[1]; }
//     double at_end = 0;
//   };
//
//   Last last;
//   clock_source.run({.seed = 1, .pipeline = "chrony", .host_sync = sync.get(),
//                     .duration = from_ms(3.6e6), .interval = from_ms(1000)}, last);
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <string>

#include "algorithms/ports/exchange.h"
#include "algorithms/ports/time.h"
#include "recording/share_done.h"
#include "recording/true_time.h"
#include "recording/world_observer.h"

namespace simbench {

class HostSync;

struct ClockRequest {
  std::uint64_t seed = 1;
  std::string pipeline{};         // whose load is drawn
  HostSync* host_sync = nullptr;  // outlives the call; null: none runs
  Nanoseconds duration{};         // with the master
  Nanoseconds interval{};         // between readings
  Nanoseconds master_lost_for{};  // from `duration` on nobody reaches the master; 0: never
  Nanoseconds recovery{};         // after that
  const std::atomic<bool>* cancel = nullptr;
  ShareDone share_done{};  // empty: nobody asks
};

class ClockSink {
 public:
  virtual ~ClockSink() = default;
  // The master's own error, against true time, before each on_errors().
  virtual void on_master(double /*error_s*/) {}
  // Every interval from true zero on: of each host, the first is the master with 0.
  virtual void on_errors(TrueTime at, std::span<const double> errors_s) = 0;
  // How the synchronisation ended on a slave; of those that come to it late, twice.
  virtual void on_outcome(const SyncOutcome& /*outcome*/) {}
  // A real program of a host ended too early.
  virtual void on_program_failure(const ProgramFailure& /*failure*/) {}
  // As WorldObserver has it.
  virtual void on_message(const ObservedMessage& /*message*/) {}
};

struct ClockCost {
  std::uint64_t events = 0;
  std::uint64_t messages = 0;    // sent until the end of `duration`, also the lost ones
  std::uint64_t trace_hash = 0;  // of the simulated events
};

class ClockSource {
 public:
  virtual ~ClockSource() = default;
  // Throws RecordingCancelled, the exceptions of algorithms, and what its own header documents.
  virtual ClockCost run(const ClockRequest& request, ClockSink& sink) = 0;
};

}  // namespace simbench
