// A host's steady clock mapped to its system clock, from the log of its adjustments.
//
// Between two adjustments the system clock is a straight line over the steady clock, so the log
// gives its reading at any steady time. The segment that was valid at a steady time maps it, also
// after a newer one has begun: a frame that was exposed just before a step and delivered after it
// gets the reading from before the step.
//
// Memory: the newest kMaxSegments segments. Steady times before the oldest of them, or before the
// log begins, lie on that segment's line continued back from its `before`. An adjustment that is
// not later than the newest one replaces those from its instant on. A rate that is no number counts
// as 0. Readings saturate at 64 bits and are within 1 ns of the host's.
//
// Complexity: add amortised O(1), to_system O(log segments). Source: docs/design.md section 2.
//
//   ClockMap map;
//   map.add(adjustment);                        // in order
//   std::optional<HostTime> t = map.to_system(steady);
#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "algorithms/ports/clock_adjustment.h"
#include "algorithms/ports/time.h"

namespace simbench {

class ClockMap {
 public:
  static constexpr std::size_t kMaxSegments = 4096;

  void add(const ClockAdjustment& adjustment);
  // Nothing before the first adjustment was added.
  std::optional<HostTime> to_system(SteadyTime steady) const;
  std::size_t segments() const { return segments_.size(); }

 private:
  std::deque<ClockAdjustment> segments_;  // `at` increases
};

}  // namespace simbench
