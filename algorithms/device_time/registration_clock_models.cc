#include "algorithms/device_time/registration_clock_models.h"

#include "algorithms/device_time/kalman.h"
#include "algorithms/device_time/librealsense_global.h"
#include "algorithms/device_time/olson.h"
#include "algorithms/device_time/sliding_minimum.h"
#include "algorithms/device_time/theil_sen.h"
#include "algorithms/parameter_specs.h"

namespace simbench {
namespace {

constexpr const char* kSource = "docs/reference/device_time.md section 1";

AlgorithmInfo clock_model_info(const char* name, const char* family, const char* summary,
                               const char* source) {
  return {.name = name, .family = family, .summary = summary, .source = source, .parameters = {}};
}

DeviceTimeEntry olson() {
  AlgorithmInfo olson = clock_model_info(
      "olson_50ppm", "olson", "least delayed frame, forgotten at 50 ppm (passive synchronisation)",
      "Olson, IROS 2010; docs/reference/device_time.md section 1");
  olson.parameters = {number_parameter("alpha_ppm", OlsonSettings{}.alpha_ppm, 0, 100'000,
                                       "forgetting; must exceed the skew", kSource)};
  return {.info = olson, .make = [](const Parameters& parameters) {
            return make_olson({.alpha_ppm = parameters.number("alpha_ppm")});
          }};
}

DeviceTimeEntry kalman() {
  const KalmanSettings defaults;
  AlgorithmInfo kalman = clock_model_info(
      "kalman", "kalman", "Kalman filter of offset and skew; its gate cannot lock itself out",
      "cuckoo_time_translator KalmanOwt, tuned; docs/reference/device_time.md section 1");
  kalman.parameters = {
      number_parameter("initial_offset_sigma_ms", defaults.initial_offset_sigma_ms, 1e-3, 1e6,
                       "uncertainty of the first frame's offset", kSource),
      number_parameter("initial_skew_sigma_ppm", defaults.initial_skew_sigma_ppm, 1e-3, 1e5,
                       "uncertainty of the skew at first", kSource),
      number_parameter("offset_sigma_ms", defaults.offset_sigma_ms, 1e-4, 1e4,
                       "standard deviation of one arrival", kSource),
      number_parameter("skew_sigma_ppm", defaults.skew_sigma_ppm, 0, 1e4,
                       "random walk of the skew, per square root of a second", kSource),
      number_parameter("gate", defaults.gate, 0.1, 1e6,
                       "frames further off, in standard deviations, are rejected", kSource),
      number_parameter("rejections_to_restart", defaults.rejections_to_restart, 1, 1e6,
                       "so many in a row and the filter begins anew", "ours"),
  };
  return {
      .info = kalman, .make = [](const Parameters& parameters) {
        return make_kalman({.initial_offset_sigma_ms = parameters.number("initial_offset_sigma_ms"),
                            .initial_skew_sigma_ppm = parameters.number("initial_skew_sigma_ppm"),
                            .offset_sigma_ms = parameters.number("offset_sigma_ms"),
                            .skew_sigma_ppm = parameters.number("skew_sigma_ppm"),
                            .gate = parameters.number("gate"),
                            .rejections_to_restart =
                                static_cast<int>(parameters.number("rejections_to_restart"))});
      }};
}

}  // namespace

std::vector<DeviceTimeEntry> clock_model_device_times() {
  AlgorithmInfo librealsense = clock_model_info(
      "librealsense_global", "librealsense_global",
      "librealsense's global time over polls of the camera's clock",
      "librealsense src/global_timestamp_reader.cpp; docs/reference/d455.md section 5");
  librealsense.needs = {Need::kPolls};
  return {
      olson(),
      {.info = clock_model_info("minimum_1s", "minimum",
                                "least offset of the last second: the best of the simple ones",
                                kSource),
       .make = [](const Parameters&) { return make_sliding_minimum({.window_s = 1}); }},
      {.info = clock_model_info("theil_sen_300", "theil_sen",
                                "median of slopes over the last 300 frames, a refit every 15",
                                "Sen 1968; docs/reference/device_time.md section 1"),
       .make = [](const Parameters&) { return make_theil_sen({.frames = 300}); }},
      kalman(),
      {.info = librealsense, .make = [](const Parameters&) { return make_librealsense_global(); }},
  };
}

}  // namespace simbench
