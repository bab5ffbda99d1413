// Semantic checks of cameras that a capture_alignment steers, beyond the schema: /cameras/
// frame_control fits the streams, the trigger's rate and the exposure, and /cameras/stamp_clock the
// polls.
//
// Throws InputError with the place, what was found and what is allowed (fail_at, loader.h).
//
//   check_frame_control(scenario);  // after the checks of the streams
#pragma once

#include "scenarios/scenario.h"

namespace simbench::scenarios {

void check_frame_control(const Scenario& scenario);

}  // namespace simbench::scenarios
