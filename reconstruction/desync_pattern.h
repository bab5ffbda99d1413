// Exposures of a rig whose hosts disagree by a known amount: for the question what a millisecond of
// desynchronisation costs.
//
// Cameras of one host expose together. Hosts are spread over `desync_ms`, the earliest and the
// latest exactly so far apart, the others uniformly between them; which host has which place is
// drawn by the seed, the same for every desynchronisation, so that points of a curve are paired.
#ifndef SIMBENCH_RECONSTRUCTION_DESYNC_PATTERN_H_
#define SIMBENCH_RECONSTRUCTION_DESYNC_PATTERN_H_

#include <cstdint>

#include "evaluation/run/exposure_sets.h"
#include "scenarios/scenario.h"

namespace simbench::reconstruction {

// `at_s`: the middle between the earliest and the latest exposure. `index`: of the set, for the
// noise of its frames.
evaluation::ExposureSet desynchronised_set(const scenarios::Scenario& scenario, std::uint64_t seed,
                                           double desync_ms, double at_s, std::uint32_t index);

}  // namespace simbench::reconstruction

#endif  // SIMBENCH_RECONSTRUCTION_DESYNC_PATTERN_H_
