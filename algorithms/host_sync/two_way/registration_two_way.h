// The two-way algorithms (two_way.h) with their parameters and sources.
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_REGISTRATION_TWO_WAY_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_REGISTRATION_TWO_WAY_H_

#include <vector>

#include "algorithms/registry.h"

namespace simbench {

std::vector<HostSyncEntry> two_way_host_syncs();

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_REGISTRATION_TWO_WAY_H_
