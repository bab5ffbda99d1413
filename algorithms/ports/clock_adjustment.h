// A change of a host's system clock, an entry of the host's log of adjustments.
//
// At `at` the clock read `before`; from then on it reads `after` and runs at `rate_ppb` against the
// host's steady clock. The log begins with an adjustment that changes nothing, so the log alone
// maps steady time to system time at any instant (algorithms/device_time/clock_map.h).
// Source: docs/design.md section 2.
#pragma once

#include <cstdint>

#include "algorithms/ports/time.h"

namespace simbench {

struct ClockAdjustment {
  std::uint32_t host = 0;
  SteadyTime at{};
  HostTime before{};
  HostTime after{};
  double rate_ppb = 0;  // of the system clock against the steady clock, from now on
};

}  // namespace simbench
