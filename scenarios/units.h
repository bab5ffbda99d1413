// Units stand last in names: "latency_ms" is in ms.
//
//   unit_in_name("max_rate_ppm");   // "ppm"
//   unit_in_name("stamps");         // ""
#pragma once

#include <string>
#include <string_view>

namespace simbench::scenarios {

// The unit of a member of a scenario or a parameter of an algorithm; "" if its name states none.
std::string unit_in_name(std::string_view name);

}  // namespace simbench::scenarios
