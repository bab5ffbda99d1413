// The rig's pulses as a host observes them: through its cameras, or on a pulse line.
//
//   PulseObserver observer(host, {.source = PulseSource::kFrames});
//   co_await observer.collect();
//   if (auto pulse = observer.middle()) tell_the_others(*pulse);
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "algorithms/host_sync/two_way/two_way_estimators.h"
#include "algorithms/ports/host.h"
#include "algorithms/ports/time.h"
#include "laws/lower_hull.h"

namespace simbench {

// A pulse on the steady clock, as seen with the least delay.
struct Sighting {
  static constexpr std::size_t kGroups = 4;
  SteadyTime at{};
  double sigma_ns = 0;
  // Where each quarter of the pulses puts it, after `at`.
  std::array<double, kGroups> groups_ns{};
};

// Periodic pulses that one observer (a camera, a pulse line) sees late: for each, when the host
// noticed it (steady clock), and the step since the one before on a clock that is good enough to
// count the pulses in between (the camera's, or the steady clock itself). The delay of a sighting
// has a minimum; the lower envelope of the sightings over the pulse's number is where the pulses
// would have been seen with the minimum delay. Between hosts with equal minimum delays it is the
// same instant: common view (TriggerSync).
//
// The period is given, or the median of the first kFirstSteps steps. A step is rounded to whole
// periods; steps that are not positive are ignored. After kStrangeSteps in a row that are more than
// a quarter of a period off, the train starts again: the rate has changed.
//
// The uncertainty is measured by splitting the pulses: neighbours of a second make a block, and
// every fourth block a group. The groups' envelopes differ by chance alone, also where the delays
// of neighbouring pulses go together; sigma = their standard deviation / 2, as of a mean of four
// (of exponential delays, whose minimum gains more by four times the pulses, the error is half of
// that). At both ends of the kept pulses, where not every group has one, none is found.
//
// Complexity: O(1) amortised a pulse. Memory bounded (two_way_estimators.h).
//
//   PulseTrain train({.window = from_ms(30e3)});
//   train.add(step, seen);
//   std::optional<Sighting> pulse = train.nearest(when);
class PulseTrain {
 public:
  struct Settings {
    Nanoseconds window = from_ms(30e3);
    std::optional<Nanoseconds> period{};
  };
  static constexpr std::size_t kFirstSteps = 9;
  static constexpr int kStrangeSteps = 8;
  static constexpr std::uint64_t kFewestPulses = 16;
  static constexpr double kBlockNs = 1e9;

  explicit PulseTrain(Settings settings);

  // `step`: since the pulse added before; ignored for the first one.
  void add(Nanoseconds step, SteadyTime seen);
  // The pulse in the middle of the kept ones; nothing before kFewestPulses were added.
  std::optional<Sighting> middle() const;
  // The pulse nearest to `when`, if that lies between the kept ones.
  std::optional<Sighting> nearest(SteadyTime when) const;
  std::optional<Nanoseconds> period() const;

 private:
  void add_numbered(Nanoseconds step, SteadyTime seen);
  void find_period();
  void restart();
  std::size_t group_of(double number) const;
  std::optional<Sighting> at_number(double number) const;

  Settings settings_;
  std::vector<std::pair<Nanoseconds, SteadyTime>> first_;  // until the period is known
  double period_ns_ = 0;
  bool has_last_ = false;
  double number_ = 0;  // of the last pulse
  int strange_ = 0;
  std::uint64_t pulses_ = 0;
  SteadyTime zero_{};  // x = 0, y = 0
  // x = number * period, y = seen - zero - x.
  Envelope all_;
  std::vector<Envelope> groups_;
};

enum class PulseSource : std::uint8_t { kFrames, kTrigger, kPps };

// The port that a source needs, for messages.
const char* port_name(PulseSource source);

// Each camera, and each pulse line, is a PulseTrain of its own; where several trains saw a pulse,
// it was seen at their mean, so that cameras of unequal delay hurt less. The uncertainty is that of
// the trains' mean (from its groups, so delays that a host's cameras share count in full), and the
// standard error of that mean over the trains, which contains how unequal their least delays are.
//
//   frames    the arrival of each frame less its exposure time: where the exposure begins with the
//             pulse that is the pulse plus a constant, whatever the exposure. Pulses are counted by
//             the camera's clock, across the wrap of its 32-bit stamps. Frames of a camera's first
//             `settle` are left out, and so are pulses of which a camera of the host has delivered
//             no frame: with fewer frames on the bus the others come earlier. (A camera that falls
//             silent for good thus ends the observation.)
//   kTrigger  the cameras' trigger pulses on a line of the host
//   kPps      one pulse a second
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
  // Takes what has come since the last time, without waiting for more. Does nothing while another
  // coroutine collects.
  Task<void> collect();
  // The pulse in the middle of the first train, and the one nearest to `when`.
  std::optional<Sighting> middle() const;
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
