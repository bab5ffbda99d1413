// Pulses that a host sees late: when was each of them, at the least?
//
// A train is what one observer (a camera, a pulse line) reports of periodic pulses: for each, when
// the host noticed (steady clock), and the step since the one before on a clock that is good enough
// to count the pulses in between (the camera's, or the steady clock itself). Every sighting is late
// by a delay that has a minimum; the lower envelope of the sightings over the pulse's number is
// where the pulses would have been seen with the minimum delay. Between hosts with equal minimum
// delays it is the same instant: common view (TriggerSync).
//
// The period is given, or the median of the first kFirstSteps steps. A step is as many periods as
// it is nearest to; steps that are not positive are ignored. After kStrangeSteps in a row that are
// more than a quarter of a period off, the train starts again: the rate has changed.
//
// The uncertainty is measured by splitting the pulses: the envelopes of the even and the odd ones
// differ by chance alone; sigma = |difference| / 2.
//
// Complexity: O(1) amortised a pulse. Memory bounded (two_way_estimators.h).
//
//   PulseTrain train({.window = from_ms(30e3)});
//   train.add(step, seen);
//   std::optional<Sighting> pulse = train.nearest(when);
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_PULSES_PULSE_TRAIN_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_PULSES_PULSE_TRAIN_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "algorithms/host_sync/two_way/two_way_estimators.h"
#include "algorithms/ports/time.h"

namespace simbench {

// A pulse on the steady clock, as seen with the least delay.
struct Sighting {
  SteadyTime at{};
  double sigma_ns = 0;
};

class PulseTrain {
 public:
  struct Settings {
    Nanoseconds window = from_ms(30e3);
    std::optional<Nanoseconds> period{};
  };
  static constexpr std::size_t kFirstSteps = 9;
  static constexpr int kStrangeSteps = 8;
  static constexpr std::uint64_t kFewestPulses = 16;

  explicit PulseTrain(Settings settings);

  // `step`: since the pulse added before; of the first one it does not matter.
  void add(Nanoseconds step, SteadyTime seen);
  // The pulse in the middle of the kept ones; nothing before there are kFewestPulses.
  std::optional<Sighting> middle() const;
  // The pulse nearest to `when`, if that lies between the kept ones.
  std::optional<Sighting> nearest(SteadyTime when) const;
  std::optional<Nanoseconds> period() const;

 private:
  void add_numbered(Nanoseconds step, SteadyTime seen);
  void find_period();
  void restart();
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
  Envelope even_;
  Envelope odd_;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_PULSES_PULSE_TRAIN_H_
