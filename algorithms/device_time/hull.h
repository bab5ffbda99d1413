// device_time by the lower convex hull: the least delayed frames lie on a line, the edge of the
// hull over the middle of the data (lower_hull.h).
//
//   window     the hull of the last n frames
//   switching  two growing hulls; when the pending one is a period old, it becomes the current one,
//              which gives the stamps, and a new pending one begins (TICSync): the line is over one
//              to two periods of frames, and a step of a clock has no effect after two
//   offline    the hull of the whole recording, the edge over the mean sensor stamp
//
// Properties: with exponential excess of mean b, an error of about b/n over n frames; the fixed
// latency stays in the stamp, as in every one-way method. A rate that changes by w per second adds
// an error of about w W^2 / 8 over W seconds, so the whole past is too long online. An online stamp
// is never later than the arrival.
//
// A slope beyond `max_skew_ppm` is no clock's: the line of that slope under the points is used.
// This only matters within the first frames, when a late one would turn the line.
//
// The first frame, and the first after a clock was set or restarted (offset_stream.h), is stamped
// with its arrival; a frame not later than the newest is stamped from the line and not used.
//
// Complexity a frame: switching O(log vertices), window O(vertices), some 10. Memory: vertices (at
// most LowerHull::kMaxVertices a hull), the window's frames.
// Source: docs/reference/device_time.md sections 1 and 2; Harrison, Newman: TICSync, 2011.
#pragma once

#include <cstddef>
#include <memory>

#include "algorithms/device_time/device_time.h"
#include "algorithms/parameter_binder.h"

namespace simbench {

inline constexpr double kDefaultMaxSkewPpm = 1000;

struct WindowHullSettings {
  std::size_t frames = 300;  // at least 1
  double max_skew_ppm = kDefaultMaxSkewPpm;

  void bind(ParameterBinder& parameters);
};

struct SwitchingHullSettings {
  double period_s = 10;  // of sensor time, positive
  double max_skew_ppm = kDefaultMaxSkewPpm;

  void bind(ParameterBinder& parameters);
};

struct OfflineHullSettings {
  double max_skew_ppm = kDefaultMaxSkewPpm;

  void bind(ParameterBinder& parameters);
};

std::unique_ptr<DeviceTimeEstimator> make_window_hull(WindowHullSettings settings);
std::unique_ptr<DeviceTimeEstimator> make_switching_hull(SwitchingHullSettings settings);
// Must be given the recording with learn() before the first stamp(), and the same frames again.
std::unique_ptr<DeviceTimeEstimator> make_offline_hull(OfflineHullSettings settings = {});

// The parameter max_skew_ppm of all estimators by hulls.
void bind_max_skew(ParameterBinder& parameters, double& max_skew_ppm);

}  // namespace simbench
