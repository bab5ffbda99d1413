// simbench's own host_sync algorithms, with their parameters and the sources of their defaults.
//
//   yoon2021_network, yoon2021_time, yoon2021_both, yoon2021_neither   (family yoon2021)
//   w32time                                                            (family w32time)
//   free_running, ntp_last_set, oracle                                 (no parameters)
//   two_way_min_rtt, two_way_independent_minima, two_way_hull, ...     (registration_two_way.h)
//   ptp_e2e_software, ptp_p2p_software, ptp_e2e_hardware, ...          (registration_ptp.h)
//   common_view, trigger_wired, pps, gnss                              (registration_pulse.h)
//
// Named explicitly instead of registering themselves: a linker drops what nothing refers to from a
// static library, and an algorithm with it.
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_REGISTRATION_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_REGISTRATION_H_

#include <vector>

#include "algorithms/registry.h"

namespace simbench {

std::vector<HostSyncEntry> builtin_host_sync_algorithms();

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_REGISTRATION_H_
