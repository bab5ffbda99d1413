// Rigs with cameras of several models: /cameras/groups of a scenario, which state in what each
// group differs from /cameras.
//
// Code that knows cameras of one kind sees a group as a rig of its own: group_alone() is the
// scenario with the cameras of that group and no others. Cameras on one USB controller are of one
// group (scenarios/camera_checks.h), so a group's frames share the bus with each other alone,
// and what holds of a group's own rig (its calibrated delay, its rates, its load) holds in the
// whole one.
//
// A scenario without groups has one, of all cameras: itself.
//
//   for (std::size_t group = 0; group < group_count(scenario.cameras); ++group) {
//     const Scenario alone = group_alone(scenario, group);
//     const double delay_ms = calibrated_delay_ms(alone, *alone.scored_stream());
//   }
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scenarios/scenario.h"

namespace simbench::scenarios {

// At least 1.
std::size_t group_count(const Cameras& cameras);

// The group of each camera.
std::vector<std::size_t> group_of_cameras(const Cameras& cameras);

// The cameras of a group answer one of so many pulses (/cameras/groups/N/pulses_per_frame).
std::int64_t pulses_per_frame(const Cameras& cameras, std::size_t group);

// What is true of all cameras of a group, in place of that of /cameras. Lists with an element for
// each camera stay those of the whole rig.
Cameras cameras_of_group(const Cameras& cameras, std::size_t group);

// The rig of the group's cameras alone, on the hosts that they are on, with a trigger that has the
// pulses that they answer.
Scenario group_alone(const Scenario& scenario, std::size_t group);

}  // namespace simbench::scenarios
