// What a studio must be beyond its schema, and what looks wrong about one that is allowed.
#ifndef SIMBENCH_SCENARIOS_STUDIO_CHECKS_H_
#define SIMBENCH_SCENARIOS_STUDIO_CHECKS_H_

#include <string>
#include <vector>

#include "scenarios/scenario.h"

namespace simbench::scenarios {

// Throws InputError; a scenario without a studio is right.
void check_studio(const Scenario& scenario);

// A line each, with its place, as warnings() has them.
std::vector<std::string> studio_warnings(const Scenario& scenario);

}  // namespace simbench::scenarios

#endif  // SIMBENCH_SCENARIOS_STUDIO_CHECKS_H_
