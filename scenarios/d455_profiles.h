// The image sizes and rates that a RealSense D455 offers.
//
// Source: librealsense v2.58.2, unit-tests/dds/d455.py. Infrared is left out; depth is Z16, colour
// YUYV. There is no native 45 Hz: 45 is what genlock delivers at 90.
#ifndef SIMBENCH_SCENARIOS_D455_PROFILES_H_
#define SIMBENCH_SCENARIOS_D455_PROFILES_H_

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace simbench::scenarios {

// In ascending order; empty if there is no such size. `kind` is "depth" or "colour".
std::vector<double> offered_rates_hz(std::string_view kind, std::int64_t width,
                                     std::int64_t height);

// "1280x720", ... from the largest to the smallest.
std::vector<std::string> offered_sizes(std::string_view kind);

}  // namespace simbench::scenarios

#endif  // SIMBENCH_SCENARIOS_D455_PROFILES_H_
