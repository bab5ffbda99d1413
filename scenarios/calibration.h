// The delays that a user has measured once for a camera model, and takes off arrivals and polls
// (device_time *_calibrated): stated in the scenario, else those that one would measure in its
// world.
//
// Measured are a whole model's constants, never one camera's, to 0.01 ms. From the end of an
// exposure (of its middle row) to its arrival it is what a hull over some seconds of frames finds:
// jitter that is a frame's own is not in it, jitter that all frames of a host share for long is.
//
//   delay = pipeline latency + mode periods + transfer, with all frames of a pulse that the
//           controller carries, on average over pulses
//           + common jitter, its mean less a standard deviation
//           + the least delay of a table - half of the arrivals' quantum
//   asymmetry = request_ms - reply_ms
//
// Frames of a pulse are offered at different times where cameras have latencies or exposures of
// their own, or a daisy chain; frames that are lost in the camera leave the bus to others. The mean
// is over 6000 frames of a fixed random sequence. A stream that runs free is taken to be alone on
// its controller, and pulses not to overlap.
//
// The common jitter, AR(1) with mean m and coefficient r, counts as m (1 - sqrt((1-r)/(1+r))): 0
// where r = 0, as hulls take jitter off that is each frame's own, and m as r goes to 1.
//
// Stated values name the world in which they were measured, and scenarios/checks.cc refuses them in
// another. Calibrations have errors: /cameras/calibration changes the world, not these values.
//
//   const double delay_ms = calibrated_delay_ms(scenario, *scenario.scored_stream());
#pragma once

#include "scenarios/scenario.h"

namespace simbench::scenarios {

// `stream` is one of the scenario's.
double calibrated_delay_ms(const Scenario& scenario, const Stream& stream);

double calibrated_asymmetry_ms(const ClockPoll& polls);

}  // namespace simbench::scenarios
