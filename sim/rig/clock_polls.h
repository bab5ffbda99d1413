// Device-clock polls: each host reads its cameras' clocks at a fixed cadence while they stream.
//
// A poll reads the host's clocks at t0 (the system clock through its interface, the steady clock
// exactly), reaches the camera after the request's delay, where it reads the register in whole
// microseconds, and reads the host's clocks again at t1 after the reply's delay, when it is
// reported. The arrival quantum does not apply to polls.
//
// Polls of a camera begin at its start + phase + n * interval_ms of true time, the phase anywhere
// in the interval, and before the end of the capture. A poll that takes longer than the interval
// skips those due meanwhile. A camera that has vanished does not reply, and a host that has stopped
// does not poll.
//
// All polls of a seed may be less symmetric than was measured (/cameras/calibration): half of that
// lengthens the request, half of it shortens the reply, and neither becomes negative.
//
// All delays are keyed by (camera, number of the poll). Cost: one event per poll, below 200 ns;
// with an interval of 0 there is nothing at all, not even a handler.
//
// Source: scenario /cameras/clock_poll; docs/reference/d455.md section 5.
//
//   ClockPolls polls(scenario, seed, engine, hosts, capture, sink);
//   polls.start();  // after the capture has been started
#ifndef SIMBENCH_SIM_RIG_CLOCK_POLLS_H_
#define SIMBENCH_SIM_RIG_CLOCK_POLLS_H_

#include <cstdint>
#include <vector>

#include "recording/recording.h"
#include "scenarios/scenario.h"
#include "sim/engine/engine.h"
#include "sim/host/host_group.h"
#include "sim/rig/capture.h"

namespace simbench::sim {

class ClockPolls final : private EventHandler {
 public:
  // All references outlive the polls.
  ClockPolls(const scenarios::Scenario& scenario, std::uint64_t seed, Engine& engine,
             HostGroup& hosts, Capture& capture, RecordingSink& sink);

  void start();

 private:
  struct Poll {
    TrueTime first;  // when poll 0 begins
    std::int64_t number = 0;
    TrueTime begin;
    TrueTime read;
  };

  void handle(const Event& event) override;
  // Sends the camera's poll of this number, unless the capture is over by then.
  void send(std::uint32_t camera, std::int64_t number);
  void report(std::uint32_t camera);

  const scenarios::Scenario& scenario_;
  std::uint64_t seed_;
  Engine& engine_;
  HandlerId id_ = 0;
  HostGroup& hosts_;
  Capture& capture_;
  RecordingSink& sink_;
  Nanoseconds interval_;
  double asymmetry_error_ms_;  // of the seed
  std::vector<Poll> polls_;    // by camera
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_RIG_CLOCK_POLLS_H_
