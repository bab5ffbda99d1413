// A rig of processes on this machine: a node for each host of a scenario and a relay between them.
//
// One repetition of the real-network experiment runs on it: `simbench node` once a host, with
// clocks that start at given offsets and skews, whose changes take as long as the scenario says,
// and cameras that play a recording; `simbench relay` with the scenario's network; a conductor's
// rig file and key for RigSource. All files lie in one temporary folder. The destructor ends all
// processes and removes all files.
//
// Network: with `namespaces` every node has a network namespace of its own, joined to the caller's
// (which NetworkSandbox::enter() made) by a veth pair; else every node has ports of its own on
// loopback. Node i reaches the others through the relay only; the conductor reaches nodes directly.
//
// With `programs` nodes run the pipeline's programs, over a network of their own that the relay
// carries by the same law (hardware/relay/wires.h).
//
// Trigger: the conductor's on_command writes the instant at which the recording's zero is played,
// kTriggerLead ahead, and keeps it for trigger_zero().
//
// Errors: ChildError, SandboxError, StreamError, std::runtime_error for a file that cannot be
// written.
//
//   ExperimentRig rig({.scenario = &scenario, .recording = "folder#played/1", .clocks = starts});
//   RigSource source(rig.conductor(), rig.key(), scenario, {});
//   source.record(request, sink);
//   MonotonicTime zero = rig.trigger_zero().value();
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hardware/clock/monotonic_time.h"
#include "hardware/experiment/child_process.h"
#include "hardware/net/secret_key.h"
#include "hardware/rig/rig.h"
#include "recording/temporary_folder.h"
#include "scenarios/scenario.h"

namespace simbench::hardware {

// How a node's clock starts.
struct ClockStart {
  double offset_ms = 0;        // of its system clock
  double skew_ppm = 0;         // of its oscillator
  double set_cost_factor = 1;  // of the scenario's cost of a change
};

// The limits of draw_clock_starts().
inline constexpr double kMaxOffsetMs = 500;
inline constexpr double kMaxSkewPpm = 30;

// Draws from the scenario's sigmas, cut at these limits; the master has no offset. Keyed by (seed,
// host).
std::vector<ClockStart> draw_clock_starts(const scenarios::Scenario& scenario, std::uint64_t seed);

struct ExperimentSettings {
  const scenarios::Scenario* scenario = nullptr;  // outlives the rig
  std::string recording;                          // what the cameras play, as in a rig file
  std::vector<ClockStart> clocks;                 // by host
  std::uint64_t seed = 1;                         // of the relay
  bool namespaces = false;
  bool programs = false;      // a wire for each node, on which its programs speak; needs namespaces
  std::string program_log{};  // where their files stay; empty: nowhere
  std::string program = "/proc/self/exe";  // simbench
  std::vector<std::string> leading{};      // words before its arguments
};

class ExperimentRig {
 public:
  static constexpr Nanoseconds kTriggerLead = std::chrono::milliseconds(250);

  // Returns when all nodes and the relay are ready.
  explicit ExperimentRig(ExperimentSettings settings);
  // Ends them.
  ~ExperimentRig() = default;
  ExperimentRig(const ExperimentRig&) = delete;
  ExperimentRig& operator=(const ExperimentRig&) = delete;

  const Rig& conductor() const { return conductor_; }
  const SecretKey& key() const { return key_; }
  // When the recording's zero was last played; nothing if the trigger was never switched on.
  std::optional<MonotonicTime> trigger_zero() const;
  // Ends the relay; returns its statistics, a line of JSON.
  std::string end_relay();

 private:
  std::string rig_text(std::optional<unsigned> node) const;
  void place(std::size_t hosts);
  void start_relay(const std::vector<std::string>& node_files);
  void start_node(unsigned node, const std::string& file);

  struct Place {
    std::string address;
    std::uint16_t port = 0;
  };

  ExperimentSettings settings_;
  TemporaryFolder folder_;
  // places_[i][j]: where node i reaches host j; [i][i]: where it listens.
  std::vector<std::vector<Place>> places_;
  SecretKey key_;
  Rig conductor_;
  std::vector<std::unique_ptr<ChildProcess>> nodes_;
  std::unique_ptr<ChildProcess> relay_;
};

}  // namespace simbench::hardware
