// device_time of cameras that filmed a clock of LEDs (RocSync): no arrivals, no host clocks. Needs
// Need::kLedClock.
//
// Each sighting is a point (sensor stamp of the frame, middle of its lit LEDs). The stamps of all
// frames are those of one robust line through a camera's sightings, on the LED clock's time, which
// all cameras share: stamps are relative() to its zero. A camera's clock thus needs to be even, and
// nothing else: neither its host's clock nor the delivery of its frames are in the result.
//
// Published: RANSAC, a residual threshold of one frame period, at most 1000 trials, then least
// squares through the inliers; frame numbers as the abscissa, so that a lost frame breaks the line;
// the begin of the exposure as the ordinate. Here:
//
//   line     Theil-Sen through at most kConsensus sightings, evenly spaced among all: the median
//            of the slopes between each two and of the levels. Deterministic, and it bears 29 % of
//            wrong readings, in which a wrong turn is 100 ms
//   inliers  within threshold_ms of that line
//   result   least squares through the inliers
//
// over the camera's stamps, which count through lost frames, and of the middle, which the sensor
// stamp means. The published limits of quality (RMSE, R2, share of inliers) only warn; none here.
//
// Error: a step of 1 ms leaves each middle with 0.2 ms (two ends, uniform) and, if the frames meet
// the steps in all phases, the line with 0.2 ms * 2 / sqrt(n) at most at its ends. At 30 fps they
// meet them in three phases, and some of the 0.2 ms stays in all of a camera's stamps. Then the
// camera's clock where it is no line: wander, most between two windows. A rolling shutter is not
// corrected, as in the published program: the stamp is that of the row that sees the LEDs, up to
// half of the readout beside the frame's middle. What the LED clock's own oscillator is wrong by,
// all cameras share.
//
// Fallbacks: one sighting, or all at one stamp, give a line at the camera's own rate; where none is
// within the threshold of the robust line, as of two that contradict each other, all are used.
// Without any sighting the stamp counts from the camera's first frame, as sensor_normalised does,
// and is on no common clock. A camera that is restarted while it records breaks the line.
//
// Offline. Complexity: learn() O(n + kConsensus^2), a frame O(1). Memory: the sightings.
// Source: docs/reference/capture_alignment.md section 5 (RocSync: video.py); Sen, JASA 1968.
//
//   auto estimator = make_rocsync_led({.threshold_ms = 33});
//   for (const LedSample& sighting : sightings) estimator->on_led_sighting(sighting);
//   estimator->learn(frames);
//   GlobalTime on_led_clock = estimator->stamp(frames[0]);
#pragma once

#include <cstddef>
#include <memory>

#include "algorithms/device_time/device_time.h"
#include "algorithms/parameter_binder.h"

namespace simbench {

struct RocsyncLedSettings {
  static constexpr std::size_t kConsensus = 256;

  double threshold_ms = 33.3;  // of an inlier's residual, positive

  void bind(ParameterBinder& parameters);
};

std::unique_ptr<DeviceTimeEstimator> make_rocsync_led(RocsyncLedSettings settings = {});

}  // namespace simbench
