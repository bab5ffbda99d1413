// Instants as tests state and read them: in ms, or never.
#pragma once

#include "algorithms/ports/time.h"
#include "recording/true_time.h"

namespace simbench {

inline TrueTime at_ms(double ms) { return TrueTime(from_ms(ms)); }
inline HostTime host_ms(double ms) { return HostTime(from_ms(ms)); }
inline double ms_of(TrueTime t) { return to_ms(t.time_since_epoch()); }
inline double ms_of(HostTime t) { return to_ms(t.time_since_epoch()); }

inline constexpr SteadyTime kNoDeadline = SteadyTime::max();

}  // namespace simbench
