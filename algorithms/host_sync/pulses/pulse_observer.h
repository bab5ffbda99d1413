// What a host sees of the rig's pulses: through its cameras, or on a pulse line.
//
// Each camera, and each pulse line, is a PulseTrain of its own; where there are several, a pulse
// was seen at the mean of what they say, so that cameras of unequal delay hurt less.
//
//   frames    the arrival of each frame less its exposure time: where the exposure begins with the
//             pulse that is the pulse plus a constant, whatever the exposure. Pulses are counted by
//             the camera's clock, across the wrap of its 32-bit stamps. Frames of a camera's first
//             `settle` are left out, and frames of pulses of which not every camera of the host
//             has delivered one: where fewer frames share the bus, they come earlier than ever
//             else. (A camera that falls silent for good thus ends the observation.)
//   kTrigger  the camera's trigger pulses on a line of the host
//   kPps      one pulse a second
//
// collect() takes what has come since the last time, without waiting for more.
//
//   PulseObserver observer(host, {.source = PulseSource::kFrames});
//   co_await observer.collect();
//   if (auto pulse = observer.middle()) tell_the_others(*pulse);
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_PULSES_PULSE_OBSERVER_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_PULSES_PULSE_OBSERVER_H_

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "algorithms/host_sync/pulses/pulse_train.h"
#include "algorithms/ports/host.h"

namespace simbench {

enum class PulseSource : std::uint8_t { kFrames, kTrigger, kPps };

// The port that a source needs, for messages.
const char* port_name(PulseSource source);

class PulseObserver {
 public:
  struct Settings {
    PulseSource source = PulseSource::kFrames;
    Nanoseconds window = from_ms(60e3);
    Nanoseconds settle = from_ms(5e3);
  };

  // The host must outlive this.
  PulseObserver(Host& host, Settings settings);

  // Whether the host has the port.
  bool is_possible() const { return feed_ != nullptr || input_ != nullptr; }
  // Does nothing while another coroutine is at it.
  Task<void> collect();
  // The pulse in the middle of the first train, by the mean over all trains that saw it.
  std::optional<Sighting> middle() const;
  // The pulse nearest to `when`, by the mean over all trains that saw it.
  std::optional<Sighting> nearest(SteadyTime when) const;

 private:
  struct Train {
    PulseTrain train;
    SteadyTime first_arrival{};
    std::uint32_t last_stamp_us = 0;
    std::uint32_t last_used_us = 0;
  };
  Task<void> collect_frames();
  Task<void> collect_pulses();
  void add(const FrameArrival& frame);
  void add_group();

  Host& host_;
  Settings settings_;
  PulseTrain::Settings train_settings_;
  FrameFeed* feed_ = nullptr;
  PulseInput* input_ = nullptr;
  bool is_collecting_ = false;
  std::map<std::uint32_t, Train> trains_;  // by camera; a line has number 0
  SteadyTime last_pulse_{};
  std::vector<FrameArrival> group_;  // frames of one pulse
  Nanoseconds shortest_step_ = Nanoseconds::max();
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_PULSES_PULSE_OBSERVER_H_
