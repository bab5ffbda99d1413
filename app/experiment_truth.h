// What was true in a real-network experiment: the exposures of what the cameras played, and what
// every node's clock read then.
//
// All processes of the experiment share the machine's monotonic clock, so that is its true time.
// The cameras play a simulated capture whose exposures are known, from an instant that is known
// (camera/recorded_frames.h: zero is the earliest exposure that a pulse began), and a node's system
// clock at any instant follows from its oscillator and its log of adjustments. So a frame's truth
// is known as exactly as in a simulation, and the same scores can be told:
//
//   exposure = trigger zero + (exposure in the played capture - its zero)
//   clock of host h at t = map of h's adjustments (steady clock of h at t)
//
// Frames are told apart by camera, stream and counter, which are played unchanged.
//
// Errors: RecordingFailed: a host without a clock log (it was lost), a frame that was not played.
//
//   KeptRecording captured;
//   rig_source.record(request, captured);
//   add_truth({.played = played, .zero = *rig.trigger_zero(), .oscillators = ...}, captured, sink);
#ifndef SIMBENCH_APP_EXPERIMENT_TRUTH_H_
#define SIMBENCH_APP_EXPERIMENT_TRUTH_H_

#include <vector>

#include "hardware/clock/node_clock.h"
#include "recording/event.h"

namespace simbench::app {

struct ExperimentTruth {
  const KeptRecording& played;                        // with truth
  MonotonicTime zero;                                 // when its zero was played
  std::vector<hardware::NodeOscillator> oscillators;  // by host
};

// Tells `sink` all of `captured`, with the played capture's layout, truth and pulses.
void add_truth(const ExperimentTruth& truth, const KeptRecording& captured, RecordingSink& sink);

}  // namespace simbench::app

#endif  // SIMBENCH_APP_EXPERIMENT_TRUTH_H_
