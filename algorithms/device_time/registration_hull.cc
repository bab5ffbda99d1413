#include "algorithms/device_time/registration_hull.h"

#include "algorithms/device_time/hull.h"
#include "algorithms/device_time/two_way_poll.h"
#include "algorithms/parameter_specs.h"

namespace simbench {
namespace {

constexpr const char* kMaxSkew = "max_skew_ppm";
constexpr const char* kWindowName = "window_s";
constexpr const char* kHullSource = "docs/reference/device_time.md section 1";
constexpr const char* kTicSync =
    "Harrison, Newman: TICSync, 2011; docs/reference/device_time.md section 1";

ParameterSpec max_skew() {
  return number_parameter(kMaxSkew, kDefaultMaxSkewPpm, 1, 100'000,
                          "steeper lines are no clock's: twice what NTP slews at", "RFC 5905");
}

AlgorithmInfo info(const char* name, const char* summary, const char* source) {
  return {.name = name,
          .family = "hull",
          .summary = summary,
          .source = source,
          .parameters = {max_skew()}};
}

DeviceTimeEntry switching(const char* name, double period_s, const char* summary) {
  return {.info = info(name, summary, kTicSync), .make = [period_s](const Parameters& parameters) {
            return make_switching_hull(
                {.period_s = period_s, .max_skew_ppm = parameters.number(kMaxSkew)});
          }};
}

DeviceTimeEntry two_way_poll() {
  return {.info = {.name = "two_way_poll",
                   .family = "two_way_poll",
                   .summary = "two-way convex hulls over polls of the camera's clock, no arrivals",
                   .source = "docs/reference/host_sync.md section 1 (MOOS, TICSync)",
                   .parameters = {max_skew(),
                                  number_parameter(kWindowName, TwoWayPollSettings{}.window_s, 1,
                                                   3600, "polls of this long are used",
                                                   "ours: short against wander")},
                   .needs = {Need::kPolls}},
          .make = [](const Parameters& parameters) {
            return make_two_way_poll({.window_s = parameters.number(kWindowName),
                                      .max_skew_ppm = parameters.number(kMaxSkew)});
          }};
}

}  // namespace

std::vector<DeviceTimeEntry> hull_device_times() {
  return {
      {.info = info("hull_300", "lower hull of the last 300 frames", kHullSource),
       .make =
           [](const Parameters& parameters) {
             return make_window_hull({.frames = 300, .max_skew_ppm = parameters.number(kMaxSkew)});
           }},
      switching("hull_switch_10s", 10, "two growing lower hulls, 10 s apart: 10 to 20 s of frames"),
      switching("hull_switch_60s", 60, "two growing lower hulls, 60 s apart: 1 to 2 min of frames"),
      {.info = info("hull_offline", "lower hull of the whole recording", kHullSource),
       .make =
           [](const Parameters& parameters) {
             return make_offline_hull(parameters.number(kMaxSkew));
           }},
      two_way_poll(),
  };
}

}  // namespace simbench
