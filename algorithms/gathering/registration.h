// simbench's own gathering algorithms, as the registry lists them.
#ifndef SIMBENCH_ALGORITHMS_GATHERING_REGISTRATION_H_
#define SIMBENCH_ALGORITHMS_GATHERING_REGISTRATION_H_

#include <vector>

#include "algorithms/registry.h"

namespace simbench {

std::vector<GatheringEntry> builtin_gathering_algorithms();

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_GATHERING_REGISTRATION_H_
