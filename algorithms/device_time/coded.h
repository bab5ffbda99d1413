// device_time of cameras on a coded trigger: the pulses are the common clock. Needs
// Need::kTriggerCode.
//
// Each frame whose pulse is known (coded_trigger/code_decoder.h) is a point: the stamp of the
// camera's clock when the pulse came, but for a constant, and the time at which the trigger's table
// has that pulse. The line through a camera's last `frames` such points turns its stamps into the
// trigger's time, which all cameras share: stamps are relative() to its first pulse. Neither
// arrivals nor hosts' clocks are in the result. It is robust, since a frame whose stamp is not
// where the code has a pulse is no point.
//
// Error: white noise of the stamps, sigma, stays in a stamp, and sqrt(4 / frames) of it comes from
// the line; the jitter of a pulse is common to all cameras, and so is the rate of the trigger's
// oscillator. What differs between cameras from pulse to stamp, cables and delays of their own,
// stays: all cameras of one pulse have the stamps of its arrival. Half of a known exposure is taken
// off and put back, so unequal exposures do not matter.
//
// A frame that comes before its camera's place in the code is known, a fraction of a second after a
// steady start, has the sensor stamp counted from the camera's first frame (sensor_normalised), and
// is on no common clock. All cameras must find their places in the code's first cycle: one that
// starts later is whole cycles off, as nothing else tells it the time. gatherers.h knows better.
//
// Online. Complexity: O(1) a frame once the place is known. Memory: the decoder's and the window's.
// Source: docs/coded_trigger.md section 5.
//
//   auto estimator = make_coded({.frames = 300});
//   estimator->on_coded_pulses(pulses);
//   for (const DeviceSample& sample : frames) global.push_back(estimator->stamp(sample));
#pragma once

#include <cstddef>
#include <memory>

#include "algorithms/coded_trigger/code_search.h"
#include "algorithms/device_time/device_time.h"
#include "algorithms/parameter_binder.h"

namespace simbench {

struct CodedTimeSettings {
  CodeDecoderSettings decoder;
  std::size_t frames = 300;  // of the line, at least 2

  void bind(ParameterBinder& parameters);
};

std::unique_ptr<DeviceTimeEstimator> make_coded(const CodedTimeSettings& settings = {});

}  // namespace simbench
