// The PTP algorithms (ptp.h) with their parameters and sources.
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_PTP_REGISTRATION_PTP_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_PTP_REGISTRATION_PTP_H_

#include <vector>

#include "algorithms/registry.h"

namespace simbench {

std::vector<HostSyncEntry> ptp_host_syncs();

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_PTP_REGISTRATION_PTP_H_
