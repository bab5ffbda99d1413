#include "algorithms/host_sync/two_way/two_way_parameters.h"

#include <utility>

#include "algorithms/host_sync/steering_parameters.h"
#include "algorithms/parameter_specs.h"

namespace simbench {
namespace {

const char* const kAssumed = "assumption";

}  // namespace

std::vector<ParameterSpec> two_way_parameters() {
  std::vector<ParameterSpec> specs = {
      number_parameter("warm_up_s", 60, 1, 1e6, "how long the service has run before the capture",
                       kAssumed),
      number_parameter("exchanges", 16, 1, 1e5,
                       "exchanges of the first burst, and of each round that a minimum is taken of",
                       kAssumed),
      number_parameter("burst_interval_ms", 20, 0.1, 1e5, "pace of the first burst", kAssumed),
      number_parameter("interval_ms", 250, 0.1, 1e6, "pace after it, also during the capture",
                       "assumption: 240 exchanges in the window"),
      number_parameter("window_s", 60, 1, 1e5, "span of the hulls and of the estimate of the rate",
                       "assumption: short against the wander of a quartz"),
      number_parameter("max_rate_ppm", 500, 1, 1e4, "largest rate between two hosts",
                       "the limit of adjtimex(2)"),
  };
  for (ParameterSpec& spec : steering_parameters()) specs.push_back(std::move(spec));
  return specs;
}

TwoWaySettings two_way_settings(const Parameters& parameters) {
  TwoWaySettings settings;
  settings.service_time = from_ms(parameters.number("warm_up_s") * 1e3);
  settings.exchanges = static_cast<std::size_t>(parameters.number("exchanges"));
  settings.burst_interval = from_ms(parameters.number("burst_interval_ms"));
  settings.interval = from_ms(parameters.number("interval_ms"));
  settings.steering = steering_settings(parameters);
  settings.steer_interval = settings.steering.settle;
  return settings;
}

TwoWayHull::Settings two_way_hull_settings(const Parameters& parameters) {
  TwoWayHull::Settings settings;
  settings.window = from_ms(parameters.number("window_s") * 1e3);
  settings.max_rate_ppm = parameters.number("max_rate_ppm");
  return settings;
}

}  // namespace simbench
