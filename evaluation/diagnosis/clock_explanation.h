// How much of what a camera's arrivals show its host's clock explains.
//
// The slow part of (arrival minus sensor stamp) is its median over bins as long as the log's
// interval, at least ten frames each. A line is taken out: the camera's own clock has another rate.
// What the log explains is the share of the variance that goes if the log's error is subtracted as
// it is, with the coefficient 1: a host's clock that is ahead makes arrivals late by as much. A
// negative share says that it gets worse. The coefficient that fits best tells a log of another
// clock (0) or of the opposite sign (-1); its interval is by the jackknife over ten blocks of time
// and Student's t.
//
// Complexity: O(n log n) in the frames. Source: Efron 1982, The Jackknife, the Bootstrap and Other
// Resampling Plans, section 3 (delete-a-group variance).
//
//   const ClockExplanation found = explained_by(delays, host_clock.interval_s,
//                                               [&](double at_s) { return
//                                               host_clock.error_at(at_s); });
//   if (found.share > 0.5) print(found.before_ms, found.after_ms);
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "evaluation/diagnosis/camera_delays.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {

// The error of a host's clock at a time of its arrivals; NaN where it is unknown.
using ErrorOfClock = std::function<double(double at_s)>;

struct ClockExplanation {
  std::string camera{};
  std::string host{};
  std::string stream{};
  std::size_t bins = 0;     // with frames and a point of the log
  double before_ms = kNan;  // the deviation of the slow part
  double after_ms = kNan;   // without the log's error
  double noise_ms = kNan;   // what the frames' noise leaves in a bin's median
  double share = kNan;      // of the variance, explained; at most 1
  double coefficient = kNan;
  double coefficient_low = kNan;  // 95 %
  double coefficient_high = kNan;

  // There is something to explain: beyond three times the noise.
  bool moves() const { return before_ms > 3 * noise_ms; }
};

// All NaN with fewer than 12 bins.
ClockExplanation explained_by(const CameraDelays& delays, double interval_s,
                              const ErrorOfClock& error_s);

}  // namespace simbench::evaluation
