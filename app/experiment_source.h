// The real-network experiment as a backend: one record() is one repetition with fresh processes.
//
// For each request the cameras' capture of its seed is simulated and written as a recording, and a
// rig of processes plays it (hardware/experiment), with clocks that start wrong by amounts drawn
// for the seed. The conductor runs a session of the request's pipeline on that rig, and the capture
// goes to the sink with its truth. Every pipeline of a seed thus meets the same exposures and
// clocks, and this machine's real sockets, schedulers and timers.
//
// The truth is known as exactly as in a simulation. All processes share the machine's monotonic
// clock, which is the true time here. The exposures are those of the played capture, whose zero is
// the earliest exposure that a pulse began (camera/recorded_frames.h); a node's system clock
// follows from its oscillator and its log of adjustments:
//
//   exposure = trigger zero + (exposure in the played capture - its zero)
//   clock of host h at t = map of h's adjustments (steady clock of h at t)
//
// Frames are identified by camera, stream and counter, which are played unchanged.
//
// A pipeline of programs (docs/your_program.md) runs the same programs on the nodes, with the same
// preloaded library around the nodes' clocks, for which namespaces are needed.
//
// Errors: RecordingFailed for a repetition that went wrong (also a host without a clock log, or a
// frame that was not played); others may succeed. A pipeline with a capture_alignment fails, as it
// moves the played frames away from their truth.
//
//   ExperimentSource source(scenario, {.namespaces = !NetworkSandbox::enter()});
//   source.record({.seed = 1, .pipeline = "yoon2021_both", .host_sync = sync.get()}, scorer);
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hardware/clock/node_clock.h"
#include "hardware/experiment/experiment_rig.h"
#include "recording/event.h"
#include "recording/recording.h"
#include "scenarios/scenario.h"

namespace simbench::app {

struct ExperimentOptions {
  bool namespaces = false;                             // the caller is in a NetworkSandbox
  std::function<void(const std::string&)> progress{};  // a line for each step; may be empty
  std::function<bool()> cancelled{};                   // may be empty
  // Gets the relay's statistics after each repetition, a line of JSON (hardware/relay/relay.h).
  std::function<void(const std::string&)> relay_statistics{};  // may be empty
  std::string program_log{};  // where the files of pipelines' programs stay; empty: nowhere
};

class ExperimentSource final : public RecordingSource {
 public:
  // `scenario` outlives this. Throws scenarios::InputError for what a relay cannot imitate.
  ExperimentSource(const scenarios::Scenario& scenario, ExperimentOptions options);

  RecordingCost record(const RecordingRequest& request, RecordingSink& sink) override;

 private:
  // Simulates the cameras' capture into played_ and a folder; returns its name for a rig file.
  std::string record_cameras(std::uint64_t seed);

  // The folder of a repetition; empty: none.
  std::string program_log(std::uint64_t seed) const;

  const scenarios::Scenario& scenario_;
  ExperimentOptions options_;
  TemporaryFolder folder_;
  KeptRecording played_;
};

struct ExperimentTruth {
  const KeptRecording& played;                        // with truth
  MonotonicTime zero;                                 // when its zero was played
  std::vector<hardware::NodeOscillator> oscillators;  // by host
};

// Hands all of `captured` to `sink`, with the played capture's layout, truth and pulses. Throws
// RecordingFailed.
void add_truth(const ExperimentTruth& truth, const KeptRecording& captured, RecordingSink& sink);

}  // namespace simbench::app
