// The delays that a user has measured once for a camera model, and takes off arrivals and polls
// (device_time *_calibrated): stated in the scenario, else those that one would measure in its
// world.
//
// Measured are a whole model's constants, never one camera's, to 0.01 ms. From the end of an
// exposure to its arrival it is what a minimum over ten seconds of frames finds: jitter that is a
// frame's own is not in it, jitter that all frames of a host share for long is.
//
//   delay = pipeline latency + mode periods + transfer while the controller's other cameras also
//           transfer + half of latency_camera_max_ms - half of the arrivals' quantum
//           + least delay of the table, or mean least common jitter in ten seconds
//   asymmetry = request_ms - reply_ms
//
// Frames of a controller are taken to be offered at once, of streams without a readout of their
// own. That is the mean delay but for cameras whose latencies or pulses differ: fair sharing then
// delivers sooner.
//
// Stated values name the world in which they were measured, and scenarios/checks.cc refuses them in
// another. Calibrations have errors: /cameras/calibration changes the world, not these values.
//
//   const double delay_ms = calibrated_delay_ms(scenario, *scenario.scored_stream());
#ifndef SIMBENCH_SCENARIOS_CALIBRATION_H_
#define SIMBENCH_SCENARIOS_CALIBRATION_H_

#include "scenarios/scenario.h"

namespace simbench::scenarios {

// `stream` is one of the scenario's.
double calibrated_delay_ms(const Scenario& scenario, const Stream& stream);

double calibrated_asymmetry_ms(const ClockPoll& polls);

}  // namespace simbench::scenarios

#endif  // SIMBENCH_SCENARIOS_CALIBRATION_H_
