// What a scenario may say of laws that are tables or have a common part.
#pragma once

#include <string>
#include <vector>

#include "scenarios/scenario.h"

namespace simbench::scenarios {

// A table is empty or has two numbers at least, and ascends. Throws InputError.
void check_quantiles(const Scenario& scenario, const std::string& pointer,
                     const std::vector<double>& table);

// Its table is one, and a common part lasts for some time. Throws InputError.
void check_delay_law(const Scenario& scenario, const std::string& pointer, const DelayLaw& law);

}  // namespace simbench::scenarios
