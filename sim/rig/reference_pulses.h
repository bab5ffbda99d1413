// Which exposures belong together where no trigger tells: those nearest to one exposure of the
// rig's reference camera, its first.
//
// The reference camera's exposures are the pulses. They are numbered as slots of the trigger would
// be: the first has the number of the nearest slot, each further one the next number, or a later
// one if it comes more than one and a half periods after the one before. An exposure of another
// camera has the pulse of the nearest one; after the newest one, and before the first, pulses are
// assumed to go on a period apart.
//
// Times are the middles of the exposures; those of the reference camera are added in order.
// Cost: O(log) of the pulses that are kept, the last 256.
//
//   ReferencePulses reference(TrueTime{}, from_ms(33));
//   reference.add(TrueTime(from_ms(330)));
//   const std::int64_t pulse = reference.pulse_of(TrueTime(from_ms(331)));   // 10
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>

#include "recording/true_time.h"
#include "sim/camera/shutter.h"

namespace simbench::sim {

class ReferencePulses {
 public:
  ReferencePulses(TrueTime first_due, Nanoseconds period)
      : first_due_(first_due), period_(period) {}

  void add(TrueTime middle) {
    const std::int64_t number =
        pulses_.empty()
            ? periods_between(first_due_, middle)
            : pulses_.back().number +
                  std::max<std::int64_t>(1, periods_between(pulses_.back().middle, middle));
    pulses_.push_back({middle, number});
    if (pulses_.size() > kKept) pulses_.pop_front();
  }

  // kNoPulse if it would be before slot 0, or there is no reference yet.
  std::int64_t pulse_of(TrueTime middle) const {
    if (pulses_.empty()) return kNoPulse;
    const auto later =
        std::upper_bound(pulses_.begin(), pulses_.end(), middle,
                         [](TrueTime at, const Pulse& pulse) { return at < pulse.middle; });
    if (later == pulses_.begin()) return number_from(*later, middle);
    const Pulse& earlier = *(later - 1);
    if (later == pulses_.end()) return number_from(earlier, middle);
    const bool is_later = later->middle - middle < middle - earlier.middle;
    return std::max(kNoPulse, is_later ? later->number : earlier.number);
  }

 private:
  static constexpr std::size_t kKept = 256;
  struct Pulse {
    TrueTime middle;
    std::int64_t number;
  };

  std::int64_t periods_between(TrueTime from, TrueTime to) const {
    return floor_div((to - from).count() + period_.count() / 2, period_.count());
  }
  std::int64_t number_from(const Pulse& pulse, TrueTime middle) const {
    return std::max(kNoPulse, pulse.number + periods_between(pulse.middle, middle));
  }

  TrueTime first_due_;
  Nanoseconds period_;
  std::deque<Pulse> pulses_;
};

}  // namespace simbench::sim
