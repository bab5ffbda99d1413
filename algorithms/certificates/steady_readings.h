// When a host's system clock read what: its stamps mapped back to its steady clock.
//
// The log of adjustments makes the system clock a chain of straight lines over the steady clock
// (recording/recording.h). A reading may have been there more than once, as after a step back, or
// never, as within a step forward; a stamp is rounded besides. The answer is a range: from the
// first to the last steady instant at which the clock read something within [from, to].
//
//   SteadyReadings readings;
//   readings.add(adjustment);   // in order
//   const auto when = readings.when(HostTime(from_ms(10)), HostTime(from_ms(11)));
//   if (when) use(when->first, when->last);
//
// Only what was added before counts, and the newest line goes on. Within 2 ns. Complexity: O(lines
// that lie above `to`, or that the clock came back to); amortised O(1) for new stamps.
#pragma once

#include <optional>
#include <vector>

#include "algorithms/ports/clock_adjustment.h"
#include "algorithms/ports/time.h"

namespace simbench {

struct SteadyRange {
  SteadyTime first{};
  SteadyTime last{};
};

class SteadyReadings {
 public:
  void add(const ClockAdjustment& adjustment);
  // Nothing if the clock never read that, or no adjustment was added.
  std::optional<SteadyRange> when(HostTime from, HostTime to) const;

 private:
  struct Line {
    SteadyTime at{};
    HostTime reads{};
    double rate_ppb = 0;
    HostTime highest_before{};  // what the clock had reached before this line
  };

  static HostTime read(const Line& line, SteadyTime at);
  static SteadyTime instant(const Line& line, HostTime reading);

  std::vector<Line> lines_;
};

}  // namespace simbench
