// What the schema cannot say: members of a scenario that must agree with each other.
#ifndef SIMBENCH_SCENARIOS_CHECKS_H_
#define SIMBENCH_SCENARIOS_CHECKS_H_

#include "scenarios/scenario.h"

namespace simbench::scenarios {

// Throws InputError about the first contradiction.
void check(const Scenario& scenario);

}  // namespace simbench::scenarios

#endif  // SIMBENCH_SCENARIOS_CHECKS_H_
