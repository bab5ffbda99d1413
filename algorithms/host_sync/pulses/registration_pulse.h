// The algorithms that use pulses common to the hosts (common_view.h, gnss.h) with their parameters
// and sources.
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_PULSES_REGISTRATION_PULSE_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_PULSES_REGISTRATION_PULSE_H_

#include <vector>

#include "algorithms/registry.h"

namespace simbench {

std::vector<HostSyncEntry> pulse_host_syncs();

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_PULSES_REGISTRATION_PULSE_H_
