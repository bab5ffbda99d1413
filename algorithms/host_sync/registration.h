// simbench's own host_sync algorithms, as the registry lists them.
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
