#include "algorithms/host_sync/steering_parameters.h"

#include "algorithms/parameter_specs.h"

namespace simbench {

std::vector<ParameterSpec> steering_parameters() {
  return {
      number_parameter("step_threshold_ms", 5, 0, 1e9,
                       "the clock is stepped if it is further off than this, else slewed",
                       "assumption: what takes 10 s to slew at 500 ppm"),
      number_parameter("max_slew_ppm", 500, 1, 1e5, "fastest slew", "adjtime(3) on Linux: 500 ppm"),
      number_parameter("steer_interval_ms", 1000, 1, 1e7,
                       "time between two corrections of the clock, each slewed within that time",
                       "assumption: short against the wander, long against a call"),
  };
}

SteeringSettings steering_settings(const Parameters& parameters) {
  SteeringSettings settings;
  settings.step_threshold = from_ms(parameters.number("step_threshold_ms"));
  settings.max_slew_ppm = parameters.number("max_slew_ppm");
  settings.settle = from_ms(parameters.number("steer_interval_ms"));
  return settings;
}

}  // namespace simbench
