// The NTP family of host_sync algorithms, with their parameters and the sources of their defaults.
//
//   ntp, ntp_broadcast_volley, ntp_broadcast_fixed   (family ntp)
//   w32time, w32time_domain                          (families of their own)
//   chrony                                           (family chrony)
//
// w32time_domain is a family of its own: what a scenario sets for a stand-alone machine's W32Time
// is not meant for it.
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_REGISTRATION_NTP_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_REGISTRATION_NTP_H_

#include <vector>

#include "algorithms/registry.h"

namespace simbench {

std::vector<HostSyncEntry> ntp_host_syncs();

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_REGISTRATION_NTP_H_
