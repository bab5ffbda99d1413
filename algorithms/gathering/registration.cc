#include "algorithms/gathering/registration.h"

#include <cmath>
#include <cstdint>
#include <utility>

#include "algorithms/gathering/approximate_time.h"
#include "algorithms/gathering/epsilon.h"
#include "algorithms/gathering/genlock.h"
#include "algorithms/gathering/k4a_capture_sync.h"
#include "algorithms/gathering/librealsense_syncer.h"
#include "algorithms/gathering/oracle.h"
#include "algorithms/gathering/phase_binning.h"
#include "algorithms/gathering/yoon2021.h"
#include "algorithms/parameter_specs.h"

namespace simbench {
namespace {

const char* const kRos = "ros_comm message_filters sync_policies/approximate_time.h";

GatheringEntry genlock(const char* name, GenlockOrder::Variant variant, const char* summary) {
  return {.info = {.name = name,
                   .family = "genlock",
                   .summary = summary,
                   .source = "Yoon et al. 2021, GenLock; docs/reference/paper.md section 8",
                   .parameters = {}},
          .make = [variant](const Parameters&, const GatheringSetup& setup) {
            return make_genlock_gatherer(setup, variant);
          }};
}

// `share` of a duration.
Nanoseconds scaled(Nanoseconds duration, double share) {
  return Nanoseconds(std::llround(static_cast<double>(duration.count()) * share));
}

std::vector<ParameterSpec> approximate_time_parameters(double lower_bound_periods) {
  return {
      number_parameter("age_penalty", 0.1, 0, 1e3,
                       "how much narrower a later set must be, as a share of its lateness", kRos),
      number_parameter("lower_bound_periods", lower_bound_periods, 0, 1,
                       "least time between two frames of a source, in frame periods; 0: none",
                       kRos),
      number_parameter("queue", 10, 1, 1e4, "frames that may wait per source", kRos)};
}

ApproximateTimeOptions approximate_time_options(const Parameters& parameters,
                                                const GatheringSetup& setup) {
  ApproximateTimeOptions options;
  options.age_penalty = parameters.number("age_penalty");
  options.lower_bound = scaled(setup.period, parameters.number("lower_bound_periods"));
  options.queue = static_cast<std::uint32_t>(parameters.number("queue"));
  return options;
}

GatheringEntry approximate_time() {
  std::vector<ParameterSpec> parameters = approximate_time_parameters(0);
  parameters.push_back(number_parameter("max_interval_periods", 0, 0, 1e3,
                                        "largest range of a set, in frame periods; 0: any", kRos));
  return {.info = {.name = "approximate_time",
                   .family = "approximate_time",
                   .summary = "the narrowest sets around a pivot, of any width (ROS)",
                   .source = kRos,
                   .parameters = std::move(parameters)},
          .make = [](const Parameters& given, const GatheringSetup& setup) {
            ApproximateTimeOptions options = approximate_time_options(given, setup);
            options.max_interval = scaled(setup.period, given.number("max_interval_periods"));
            return make_approximate_time_gatherer(setup, options);
          }};
}

GatheringEntry approximate_time_bounded() {
  return {.info = {.name = "approximate_time_bounded",
                   .family = "approximate_time",
                   .summary = "the same with sets up to T_int and frames half a period apart",
                   .source = kRos,
                   .parameters = approximate_time_parameters(0.5)},
          .make = [](const Parameters& given, const GatheringSetup& setup) {
            ApproximateTimeOptions options = approximate_time_options(given, setup);
            options.max_interval = setup.interval;
            return make_approximate_time_gatherer(setup, options);
          }};
}

GatheringEntry k4a() {
  const char* const source = "Azure-Kinect-Sensor-SDK src/capturesync/capturesync.c";
  return {.info = {.name = "k4a",
                   .family = "k4a",
                   .summary = "windows of one period around the frames of the first camera",
                   .source = source,
                   .parameters = {number_parameter(
                       "delay_us", 0, -1e6, 1e6,
                       "how much later the others are exposed than the first camera", source)}},
          .make = [](const Parameters& parameters, const GatheringSetup& setup) {
            return make_k4a_gatherer(setup, from_ms(parameters.number("delay_us") * 1e-3));
          }};
}

GatheringEntry phase_binning() {
  const char* const source = "practice of genlock rigs; docs/reference/gathering.md";
  return {
      .info = {.name = "phase_binning",
               .family = "phase_binning",
               .summary = "the nearest point of the common period's grid, which follows the stamps",
               .source = source,
               .parameters = {number_parameter("decay", 0.98, 0, 0.999999,
                                               "weight of a frame in the phase, against its "
                                               "successor's",
                                               source)}},
      .make = [](const Parameters& parameters, const GatheringSetup& setup) {
        return make_phase_binning_gatherer(setup, parameters.number("decay"));
      }};
}

template <class Make>
GatheringEntry without_parameters(const char* name, const char* summary, const char* source,
                                  Make make, std::vector<Need> needs = {}) {
  return {.info = {.name = name,
                   .family = name,
                   .summary = summary,
                   .source = source,
                   .parameters = {},
                   .needs = std::move(needs)},
          .make = [make](const Parameters&, const GatheringSetup& setup) { return make(setup); }};
}

}  // namespace

std::vector<GatheringEntry> builtin_gathering_algorithms() {
  return {
      without_parameters("yoon2021",
                         "fronts within T_int are a set, else the earliest front is given up",
                         "Yoon et al. 2021, Algorithm 3; docs/reference/paper.md section 5",
                         make_yoon2021_gatherer),
      genlock("genlock", GenlockOrder::Variant::kReanchored,
              "frames of one trigger pulse, counted from frame to frame"),
      genlock("genlock_printed", GenlockOrder::Variant::kFirstStamp,
              "frames of one trigger pulse, counted from the first stamp: drifts (as printed)"),
      approximate_time(),
      approximate_time_bounded(),
      without_parameters(
          "epsilon", "fronts within T_int are a set, else all near the earliest are given up",
          "ros2/message_filters sync_policies/approximate_epsilon_time", make_epsilon_gatherer),
      without_parameters("librealsense",
                         "half a period around the earliest front; emits partial sets",
                         "librealsense src/sync.cpp; docs/reference/d455.md section 6",
                         make_librealsense_gatherer),
      k4a(),
      phase_binning(),
      without_parameters("oracle", "frames of one true pulse",
                         "limit: no policy can find more sets", make_oracle_gatherer,
                         {Need::kTruth}),
  };
}

}  // namespace simbench
