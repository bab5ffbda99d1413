// The simulated backend: a scenario's whole world, from the first synchronisation message to the
// last frame, as a RecordingSource.
//
// One call of record() is one run of the world: oscillators and clocks, the host synchronisation of
// the request as real code over the simulated ports, a pause, then the capture. All random numbers
// follow from (seed, component); the request's pipeline only selects the hosts' load. Equal
// requests give identical recordings.
//
// Timeline, in true time: zero is the start of synchronisation. A synchronisation that ends by
// itself is followed by wait_before_capture_ms and the capture; a service begins its warm_up()
// before zero and goes on during the capture.
//
// Errors: record() throws SimulationError when the synchronisation comes to a standstill before the
// capture (with what every coroutine waits for), scenarios::InputError for a world too large for
// the engine's limits, RecordingCancelled, and the exceptions of algorithms.
//
//   const auto source = make_simulation(scenario);
//   KeptRecording recording;
//   source->record({.seed = 1, .pipeline = "yoon2021_both", .host_sync = &host_sync}, recording);
#pragma once

#include <memory>
#include <stdexcept>

#include "recording/recording.h"
#include "scenarios/scenario.h"
#include "sim/engine/engine.h"

namespace simbench::sim {

class SimulationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The scenario must outlive the source. Sources share nothing: one per thread.
std::unique_ptr<RecordingSource> make_simulation(const scenarios::Scenario& scenario);
// With limits of its own; a request's `cancel` replaces theirs.
std::unique_ptr<RecordingSource> make_limited_simulation(const scenarios::Scenario& scenario,
                                                         const EngineLimits& limits);

}  // namespace simbench::sim
