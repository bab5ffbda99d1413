// What a scenario may say beside a wireless cell (/network/wifi).
#pragma once

#include "scenarios/scenario.h"

namespace simbench::scenarios {

// Throws InputError unless the cell's hosts exist and one of them is a station, its numbers fit
// each other, and the network has nothing that a cell does not: switches in a line, clocks and
// foreign traffic in switches, Nagle's algorithm, capture traffic. Linear in the wired hosts.
void check_wifi(const Scenario& scenario);

}  // namespace simbench::scenarios
