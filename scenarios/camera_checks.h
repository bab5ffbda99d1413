// What a scenario may ask of its camera models: sizes, rates and sync modes that their profiles
// have (scenarios/camera_profile.h), and groups of cameras that one rig can hold
// (scenarios/camera_groups.h).
#pragma once

#include "scenarios/scenario.h"

namespace simbench::scenarios {

// Throws InputError unless the models have what is asked of them, and the groups hold all cameras,
// share no USB controller and answer the pulses that they get.
void check_camera_models(const Scenario& scenario);

}  // namespace simbench::scenarios
