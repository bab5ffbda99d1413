// The parameters of two_way.h with the hull, as every algorithm on top of it declares them.
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_PARAMETERS_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_PARAMETERS_H_

#include <vector>

#include "algorithms/host_sync/two_way/two_way.h"
#include "algorithms/host_sync/two_way/two_way_hull.h"
#include "algorithms/parameters.h"

namespace simbench {

std::vector<ParameterSpec> two_way_parameters();
TwoWaySettings two_way_settings(const Parameters& parameters);
TwoWayHull::Settings two_way_hull_settings(const Parameters& parameters);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_PARAMETERS_H_
