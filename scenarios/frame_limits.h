// What a program may change about the frames of a scenario's cameras, as the port of both worlds
// says it.
//
//   const Scenario scenario = load_scenario("8cam_raspberry_30fps");
//   const FrameControlLimits limits = frame_limits(scenario);
//   const bool can_be_longer = limits.longest > limits.frame_length;
#pragma once

#include "algorithms/ports/frame_control.h"
#include "scenarios/scenario.h"

namespace simbench::scenarios {

// The scenario must have /cameras/frame_control.
FrameControlLimits frame_limits(const Scenario& scenario);

}  // namespace simbench::scenarios
