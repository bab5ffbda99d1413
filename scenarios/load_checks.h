// What a scenario may say of chains of hosts (/hosts/follows) and of traffic (/network/traffic).
#pragma once

#include "scenarios/scenario.h"

namespace simbench::scenarios {

// Throws InputError unless every host follows the master in the end, traffic passes ports with a
// bandwidth from one host to another, and states what its kind needs and nothing else.
void check_load(const Scenario& scenario);

}  // namespace simbench::scenarios
