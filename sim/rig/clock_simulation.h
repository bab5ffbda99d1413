// The simulated hosts without cameras, as a ClockSource: oscillators, clocks, load and network of a
// scenario, and its host synchronisation as real code, for hours.
//
// A service begins at true zero, not before it as for a capture, so that its convergence is seen.
// There is no trigger and there are no frames: algorithms that need them cannot run here. Faults
// of hosts, links and clocks count from true zero, those of cameras have no effect. All random
// numbers but the load are those of a capture of the same seed.
//
// Memory: constant in time, but for what the synchronisation keeps. Cost: an event per reading
// beside the synchronisation's own.
// Errors: RecordingCancelled, EngineLimitReached, the exceptions of algorithms.
//
//   const auto source = make_clock_simulation(scenario);
//   source->run(clock_request, clock_sink);
#pragma once

#include <memory>

#include "recording/clock_source.h"
#include "scenarios/scenario.h"

namespace simbench::sim {

// The scenario must outlive the source. Sources share nothing: one per thread.
std::unique_ptr<ClockSource> make_clock_simulation(const scenarios::Scenario& scenario);

}  // namespace simbench::sim
