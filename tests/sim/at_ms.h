// Instants of true time in ms, as tests state and read them.
#ifndef SIMBENCH_TESTS_SIM_AT_MS_H_
#define SIMBENCH_TESTS_SIM_AT_MS_H_

#include "recording/true_time.h"

namespace simbench {

inline TrueTime at_ms(double ms) { return TrueTime(from_ms(ms)); }
inline double ms_of(TrueTime t) { return to_ms(t.time_since_epoch()); }

}  // namespace simbench

#endif  // SIMBENCH_TESTS_SIM_AT_MS_H_
