// Short forms for the parameters that an algorithm declares (algorithms/parameters.h).
//
//   entry.info.parameters = {
//       number_parameter("window_s", 10, 0.1, 1e6, "span of the hull", "TICSync"),
//       choice_parameter("stamps", {"transmit", "naive"}, "what t1 and t3 are", "NTP")};
#ifndef SIMBENCH_ALGORITHMS_PARAMETER_SPECS_H_
#define SIMBENCH_ALGORITHMS_PARAMETER_SPECS_H_

#include <string>
#include <vector>

#include "algorithms/parameters.h"

namespace simbench {

// A number from `low` to `high`, both included.
ParameterSpec number_parameter(std::string name, double fallback, double low, double high,
                               std::string meaning, std::string source);

// One of `choices`; the first is the default.
ParameterSpec choice_parameter(std::string name, std::vector<std::string> choices,
                               std::string meaning, std::string source);

// Yes or no.
ParameterSpec flag_parameter(std::string name, bool fallback, std::string meaning,
                             std::string source);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_PARAMETER_SPECS_H_
