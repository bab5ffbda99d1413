// Stage 1, host_sync: what time is it on the other host?
//
// A HostSync is a protocol between one master and its slaves, written as coroutines over the ports.
// It disciplines each slave's system clock so that it agrees with the master's. One object serves a
// whole run; it holds parameters, not state, and its coroutines run concurrently.
//
// Two kinds:
//  - one that ends (the paper's): the capture starts a pause after run_master has returned;
//  - a service (NTP and its kin): it runs for warm_up() before the capture and goes on during it;
//    its coroutines need not return.
//
// Hosts may stand in a chain or a tree: a host then follows one host and serves others, which is
// run_relay()'s part. A protocol that cannot do so has can_relay() false.
//
// Failures are outcomes, not exceptions: report them with Host::report_outcome, once per slave,
// with a message that says what would help.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "algorithms/ports/host.h"

namespace simbench {

// The slaves' system clocks when the run begins.
enum class InitialClocks : std::uint8_t {
  kUnsynchronised,  // have arbitrary offsets
  kLastSet,         // were right hours ago and have run free since
  kMaster,          // are the master's own clock: the limit that no protocol can pass
};

class HostSync {
 public:
  virtual ~HostSync() = default;
  virtual InitialClocks initial_clocks() const { return InitialClocks::kUnsynchronised; }
  // For a service: how long it runs before the capture. Nothing: it ends by itself.
  virtual std::optional<Nanoseconds> warm_up() const { return std::nullopt; }
  // Whether it neither sends nor calls a clock, so that no load of a host or the network reaches
  // it.
  virtual bool is_idle() const { return false; }
  // What the run should say beside its numbers, a line each.
  virtual std::vector<std::string> notes() const { return {}; }
  virtual Task<void> run_master(Host& host, std::vector<PeerId> slaves) = 0;
  virtual Task<void> run_slave(Host& host, PeerId master) = 0;
  // Whether a host can follow one host and serve others.
  virtual bool can_relay() const { return false; }
  // A slave of `master` that serves `slaves`, where it can.
  virtual Task<void> run_relay(Host& host, PeerId master, std::vector<PeerId> /*slaves*/) {
    return run_slave(host, master);
  }
};

}  // namespace simbench
