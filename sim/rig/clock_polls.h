// Device-clock polls: each host reads its cameras' clocks at a fixed cadence while they stream.
//
// A poll begins, reaches the camera after the request's delay, where it reads the register in whole
// microseconds, and ends after the reply's delay. The capture (sim/rig/capture.h) adds what the
// clocks read: the camera's, and its host's at both ends. The capture starts at true zero here.
//
// Polls of a camera begin at its start + phase + n * interval_ms of true time, the phase anywhere
// in the interval, and before the end of the capture. A poll that takes longer than the interval
// skips those due meanwhile. A camera that has vanished does not reply.
//
// All polls of a seed may be less symmetric than was measured (/cameras/calibration): half of that
// lengthens the request, half of it shortens the reply, and neither becomes negative.
//
// All delays are keyed by (camera, number of the poll). Cost: one event per poll, below 200 ns.
//
// Source: scenario /cameras/clock_poll; docs/reference/d455.md section 5.
//
//   ClockPolls polls(scenario, seed, camera_faults, capture_end);
//   std::vector<CameraPoll> ended;
//   polls.hand_out(then, ended);  // those that end before then
#pragma once

#include <cstdint>
#include <vector>

#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/engine/event_queue.h"
#include "sim/faults/faults.h"

namespace simbench::sim {

// A reading of a camera's clock, at `read` between its begin and its end.
struct CameraPoll {
  std::uint32_t camera = 0;
  TrueTime begin{};  // the host asks
  TrueTime read{};   // the camera reads its clock
  TrueTime end{};    // the host has the reading
};

class ClockPolls {
 public:
  // All references outlive the polls. None begins at `end` or later.
  ClockPolls(const scenarios::Scenario& scenario, std::uint64_t seed, const CameraFaults& faults,
             TrueTime end);

  // Replaces `polls` by those that end before `then` and were not handed out, in order.
  void hand_out(TrueTime then, std::vector<CameraPoll>& polls);

 private:
  struct Poll {
    TrueTime first;  // when poll 0 begins
    std::int64_t number = 0;
    TrueTime begin;
    TrueTime read;
  };

  // Sends the camera's poll of this number, unless the capture is over by then.
  void send(std::uint32_t camera, std::int64_t number);

  const scenarios::Scenario& scenario_;
  std::uint64_t seed_;
  const CameraFaults& faults_;
  Nanoseconds interval_;
  TrueTime end_;
  double asymmetry_error_ms_;  // of the seed
  std::vector<Poll> polls_;    // by camera
  EventQueue ends_;            // payload: camera
};

}  // namespace simbench::sim
