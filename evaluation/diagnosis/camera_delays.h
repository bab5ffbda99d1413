// What the arrivals of one camera's frames say of its host's clock: arrival minus sensor stamp.
//
// Both the delay of a frame and the error of the host's clock are in that difference: a host's
// clock that is set forth by 5 ms makes all later frames 5 ms "later". The first 5 s of recordings
// of 20 s and more are left out, since cameras are unsteady there.
//
// Complexity: O(n log n) in the frames.
//
//   if (const auto delays = camera_delays(recorded.streams[0])) {
//     for (const DelayJump& jump : delay_jumps(*delays)) use(jump.at_s, jump.step_ms);
//   }
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/statistics/statistics.h"
#include "recording/recorded_streams.h"

namespace simbench::evaluation {

// A camera's frames without the unsteady start, in order of delivery.
struct CameraDelays {
  std::string camera{};
  std::string host{};
  std::string stream{};
  bool stamped_by_host = false;
  std::size_t left_out = 0;          // frames before the first one here
  std::vector<double> arrival_s{};   // since the zero of the arrivals
  std::vector<double> sensor_ms{};   // since the first frame's
  std::vector<double> delay_ms{};    // arrival minus sensor stamp, less that of the first frame
  double period_ms = kNan;           // the median distance of arrivals
  double noise_ms = kNan;            // of delay_ms, from frame to frame: a robust deviation
  std::optional<double> stamp_ms{};  // the first frame's sensor stamp, of stamps from 1970
  double first_s() const { return arrival_s.front(); }
  double last_s() const { return arrival_s.back(); }
};

// Nothing for fewer than 30 frames, stamps of another unit than the arrivals' (rates that differ by
// more than 5 %), or arrivals that are the stamps.
std::optional<CameraDelays> camera_delays(const RecordedStream& stream);

// A lasting change of (arrival minus sensor stamp): the difference of the medians of 15 frames on
// either side that is beyond ten times the noise and 0.5 ms. Frames that come late and in time
// again within 5 s are a busy host and none.
struct DelayJump {
  double at_s = 0;  // the last arrival before it
  double step_ms = 0;
};
std::vector<DelayJump> delay_jumps(const CameraDelays& delays);

// The smallest jump that shows in the camera's arrivals.
double smallest_jump_ms(const CameraDelays& delays);

}  // namespace simbench::evaluation
