// The faults of a scenario during a capture (/faults), for queries by the parts that they affect.
//
//  - Outages: hosts and links that stop for a while. A stopped host gets no frames, no pulses and
//    no polls, and its messages are neither sent nor received; its clocks and programs go on. A
//    stopped link only loses the messages.
//  - CameraFaults: cameras that vanish for a while, and first frames that are delivered late.
// A fault clock_step is an event of the capture (sim/rig/capture.h).
//
// Times count from the start of the capture: before start() there are no faults.
//
// Complexity: linear in the number of such faults, a comparison without any.
//
//   Outages outages(scenario.faults);
//   outages.start(engine.now());  // the capture begins
//   const bool is_lost = outages.unreachable(3, engine.now());
#pragma once

#include <cstdint>
#include <vector>

#include "algorithms/ports/exchange.h"
#include "recording/true_time.h"
#include "scenarios/scenario.h"

namespace simbench::sim {

class Outages {
 public:
  explicit Outages(const std::vector<scenarios::Fault>& faults);

  void start(TrueTime capture_start) { start_ = capture_start; }

  bool host_stopped(PeerId host, TrueTime at) const {
    return !outages_.empty() && stopped(host, at, false);
  }
  // The host is stopped or its link is.
  bool unreachable(PeerId host, TrueTime at) const {
    return !outages_.empty() && stopped(host, at, true);
  }

 private:
  struct Outage {
    PeerId host;
    bool of_link;
    Nanoseconds begin;  // after the start of the capture
    Nanoseconds end;
  };

  bool stopped(PeerId host, TrueTime at, bool or_its_link) const;

  std::vector<Outage> outages_;
  TrueTime start_ = TrueTime::max();
};

class CameraFaults {
 public:
  explicit CameraFaults(const std::vector<scenarios::Fault>& faults);

  void start(TrueTime capture_start) { start_ = capture_start; }

  // The camera takes no frames and answers no polls.
  bool vanished(std::uint32_t camera, TrueTime at) const;

  // The extra delay of a frame of the camera. A fault delays one frame: that of the first call for
  // its camera.
  double take_delay_ns(std::uint32_t camera);

 private:
  struct Absence {
    std::uint32_t camera;
    double begin_ms;  // after the start of the capture
    double end_ms;
  };
  struct LateFrame {
    std::uint32_t camera;
    double delay_ns;
    bool taken;
  };

  std::vector<Absence> absences_;
  std::vector<LateFrame> late_frames_;
  TrueTime start_ = TrueTime::max();
};

}  // namespace simbench::sim
