// --set /json/pointer=value, applied to the merged scenario.
#ifndef SIMBENCH_SCENARIOS_OVERRIDES_H_
#define SIMBENCH_SCENARIOS_OVERRIDES_H_

#include <cstddef>
#include <nlohmann/json.hpp>

#include "scenarios/loader.h"
#include "scenarios/places.h"

namespace simbench::scenarios {

// Replaces the value that the pointer names; null removes it. The pointer must name something that
// is there, but for /algorithms/NAME/PARAMETER: the algorithms know their parameters and defaults
// themselves. Throws InputError.
void apply_override(const Override& setting, std::size_t level, nlohmann::json& document,
                    Places& places);

}  // namespace simbench::scenarios

#endif  // SIMBENCH_SCENARIOS_OVERRIDES_H_
