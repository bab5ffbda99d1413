// Exposures of a rig whose hosts disagree by a known amount, to measure the cost of a millisecond
// of desynchronisation.
//
// Cameras of one host expose together. Hosts are spread over `desync_ms`: the earliest and the
// latest are exactly that far apart, the others are uniform between them. The seed draws the hosts'
// places, the same for every desynchronisation, so that points of a curve are paired.
#pragma once

#include <cstdint>

#include "evaluation/run/exposure_sets.h"
#include "scenarios/scenario.h"

namespace simbench::reconstruction {

// `at_s`: the middle between the earliest and the latest exposure. `index`: of the set, for the
// noise of its frames.
evaluation::ExposureSet desynchronised_set(const scenarios::Scenario& scenario, std::uint64_t seed,
                                           double desync_ms, double at_s, std::uint32_t index);

}  // namespace simbench::reconstruction
